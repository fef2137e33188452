# SPDX-License-Identifier: Apache-2.0
"""Machine files: read right, or refused with the line, the value and the limit."""

import re
from pathlib import Path

import pytest
from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.line.points import PARAMETERS
from levelwind.map_table import ChannelFault, SwitchFault
from levelwind.simulate import machine, simulator

ROOT = Path(__file__).parents[2]


def written(folder: Path, text: str) -> Path:
    path = folder / "winch.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_sample_is_the_default_machine_with_every_figure():
    sample = machine.read(ROOT / "profiles" / "machine.yaml")
    assert dict(sample.given) == {n: f.default for n, f in native.machine_figures().items()}


def test_every_figure_is_documented_with_its_limits():
    text = (ROOT / "doc" / "machine.md").read_text(encoding="utf-8")
    for figure in native.machine_figures().values():
        row = next(line for line in text.splitlines() if line.startswith("| `") and (
            re.search(rf"`{figure.name}`", line.split(" | ")[0])
        ))  # fmt: skip
        if not figure.words:
            assert f"{figure.min:.6g} to {figure.max:.7g}" in row, figure.name


def test_words_are_those_of_the_bench_registers():
    figures = native.machine_figures()
    switch = tuple(fault.label for fault in SwitchFault)
    assert figures["switch_plus_fault"].words == figures["switch_minus_fault"].words == switch
    assert figures["overtravel_plus_fault"].words == switch[:3]
    assert figures["encoder_a_fault"].words == tuple(fault.label for fault in ChannelFault)


def test_a_file_names_what_differs(tmp_path: Path):
    winch = machine.read(
        written(
            tmp_path,
            "screw_lead_mm: 010\nswitch_minus_mm: -7.05e1\nmotor_reversed: true\n"
            "switch_plus_fault: shorted\n",
        )
    )
    assert dict(winch.given) == {
        "screw_lead_mm": 10,
        "switch_minus_mm": -70.5,
        "motor_reversed": 1,
        "switch_plus_fault": 5,
    }
    assert winch["encoder_pulses_per_rev"] == 360
    assert winch.um_per_ustep == 5


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", r"winch\.yaml: a machine is lines of"),
        ("- screw_lead_mm: 10", r"winch\.yaml: a machine is lines of"),
        ("screw_lead: 10", r"winch\.yaml, line 1: no machine has a figure screw_lead\. Did you"),
        ("start_mm: 1\nscrew_lead_mm: ten", r"line 2: screw_lead_mm: ten: give a number with a"),
        ("screw_lead_mm: 12,7", "12,7: give a number with a decimal point, 0.1 to 1000"),
        ("screw_lead_mm: [10]", "screw_lead_mm: .*: give a number"),
        ("screw_lead_mm: .nan", "give a number with a decimal point"),
        ("screw_lead_mm:", "screw_lead_mm: None: give a number"),
        ("\nscrew_lead_mm: 0.05", "line 2: screw_lead_mm: 0.05 is outside its limits: 0.1 to 1000"),
        ("microsteps_per_rev: 1600.5", "1600.5 is no whole number"),
        ("motor_reversed: yes", "motor_reversed: yes: give false or true"),
        ("motor_reversed: 1", "motor_reversed: 1: give false or true"),
        ("encoder_a_fault: dead", "dead: give none or stuck_low or stuck_high or flicker"),
        (
            "start_mm: 0\novertravel_mm: 95",
            r"winch\.yaml: end_stop_mm: 90 must be more than overtravel_mm 95",
        ),
        (
            "start_mm: 0\nswitch_plus_mm: 87",
            "line 2: switch_plus_mm: 87 must be less than overtravel_mm 86",
        ),
        ("start_mm: 91", "line 1: start_mm: 91 must be between minus and plus end_stop_mm 90"),
        (
            "microsteps_per_rev: 2010",
            "2010 must be a multiple of a quarter of full_steps_per_rev 200",
        ),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, said: str):
    with pytest.raises(ToolError, match=said):
        machine.read(written(tmp_path, text))


def test_the_simulator_gets_what_differs():
    winch = machine.make({"screw_lead_mm": 12.7, "motor_reversed": 1})
    line = simulator.arguments("/tmp/port", machine=winch)
    assert line[-4:] == ["--figure", "screw_lead_mm=12.7", "--figure", "motor_reversed=1"]


def test_parameters_describe_the_machine_that_they_are_right_for():
    """Machine to parameters and back."""
    figures = {
        "encoder_pulses_per_rev": 600,
        "encoder_ratio_numerator": 5,
        "encoder_ratio_denominator": 3,
        "screw_lead_mm": 12.7,
        "microsteps_per_rev": 1600,
        "switch_plus_mm": 60.5,
        "switch_minus_mm": -72.25,
        "overtravel_mm": 80,
        "end_stop_mm": 84,
        "switch_late_ms": 2.5,
        "motor_reversed": 1,
        "encoder_channels_swapped": 1,
        "encoder_b_inverted": 1,
    }
    described = machine.describing(machine.make(figures).parameters())
    for name, value in figures.items():
        tolerance = 1.5 if name == "overtravel_mm" else 1e-9  # no parameter tells where it is
        assert described[name] == pytest.approx(value, abs=tolerance), name
    factory = machine.describing({p.name: p.default or 0 for p in PARAMETERS})
    assert dict(factory.figures) == dict(machine.make({}).figures)


@pytest.mark.parametrize(
    "changes",
    [
        {
            "switch_plus_um": 78_400,
            "switch_minus_um": 2_000,
            "reversal_minus_um": 0,
            "flange_minus_um": -3_000,
        },
        {"travel_um": 166_000},
        {"microsteps_per_rev": 1999},
        {"switch_hysteresis_um": 100},
        {"switch_delay_us": 300},
    ],
)
def test_every_set_describes_a_machine(changes: dict[str, int]):
    values = {p.name: p.default or 0 for p in PARAMETERS} | changes
    if "switch_minus_um" in changes:
        values["centre_position_um"] = 40_000
    winch = machine.describing(values)
    assert winch["switch_minus_mm"] * 1000 == values["switch_minus_um"]
    assert winch["start_mm"] <= winch["switch_plus_mm"]


def test_pull_out_is_where_the_motor_pulls_as_much_as_it_needs():
    winch = machine.make({
        "holding_acceleration_mm_per_s2": 8000,
        "half_torque_speed_mm_per_s": 300,
        "top_speed_mm_per_s": 150,
        "friction_mm_per_s2": 500,
    })  # fmt: skip
    for need in (0, 1000, 5000):
        speed = winch.pull_out_mm_per_s(need)
        assert 0 < speed < 150
        assert 8000 * (1 - speed / 150) / (1 + speed / 300) == pytest.approx(need + 500)
        assert winch.pull_out_acceleration_mm_per_s2(speed) == pytest.approx(need)
    assert winch.pull_out_mm_per_s(8000) == 0


def test_the_right_set_of_the_default_machine_describes_it():
    values = machine.make({}).parameters()
    factory = {point.name: point.default for point in PARAMETERS}
    differing = {name for name, value in values.items() if value != factory[name]}
    assert not {n for n in differing if n.startswith(("encoder", "screw", "micro", "travel"))}
    assert abs(values["reversal_plus_um"] - factory["reversal_plus_um"]) < 10
