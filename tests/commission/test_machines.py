# SPDX-License-Identifier: Apache-2.0
"""Machines of other people are commissioned by answers alone, judged by the plant's truth; and what
is wrong in one is named in its step."""

from pathlib import Path

import pytest
from levelwind.commission import session
from levelwind.commission.guide import STEPS
from levelwind.errors import ToolError
from levelwind.map_table import Command
from levelwind.simulate import machine
from machines import MOTORS, WRONG, some
from right_machines import RIGHT
from winch import Winch, hands
from world import World

NAMES = [step.name for step in STEPS]
LAUNCH_MILLIRPM = 600_000  # 24 m/s of rope; the person asks for 30


def commissioned(
    figures: dict[str, float], folder: Path, monkeypatch: pytest.MonkeyPatch, **answers: object
) -> tuple[Winch, machine.Machine]:
    """A winch of these figures and a person who knows its parts."""
    truth = machine.make(figures)
    plus_mm, minus_mm = truth["switch_plus_mm"], truth["switch_minus_mm"]
    beyond_mm = truth["overtravel_mm"]
    winch = Winch(World(machine=figures), folder, monkeypatch)
    room_mm = min(4.6, 0.6 * (beyond_mm - max(plus_mm, -minus_mm)))
    winch.answers |= hands(plus_mm, minus_mm, beyond_mm) | {
        "encoder.pulses": int(truth["encoder_pulses_per_rev"]),
        "stepper.lead_mm": truth["screw_lead_mm"],
        "geometry.room_plus_mm": room_mm,
        "geometry.room_minus_mm": room_mm,
    }
    winch.answers |= {name.replace("__", "."): answer for name, answer in answers.items()}
    winch.session.save()
    return winch, truth


@pytest.mark.parametrize("name", some(list(RIGHT), 7))
def test_a_right_machine_from_factory_values_to_a_launch(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    winch, truth = commissioned(RIGHT[name], tmp_path, monkeypatch)
    world = winch.world
    values = winch.go_on().active
    transitions = 4 * values["encoder_pulses_per_rev"] * values["encoder_ratio_numerator"]
    assert transitions == truth.transitions_per_drum_rev * values["encoder_ratio_denominator"]
    assert values["microsteps_per_rev"] == truth["microsteps_per_rev"]
    assert values["screw_lead_um"] == pytest.approx(1000 * truth["screw_lead_mm"], rel=0.01)
    span_um = 1000 * (truth["switch_plus_mm"] - truth["switch_minus_mm"])
    assert values["switch_plus_um"] - values["switch_minus_um"] == pytest.approx(span_um, abs=200)
    middle_um = 500 * (truth["switch_plus_mm"] + truth["switch_minus_mm"])
    believed_um = world.value("position_um") + middle_um - values["centre_position_um"]
    assert believed_um == pytest.approx(world.truth.carriage_um, abs=200)
    assert world.permit

    slips, furthest_um = world.truth.pole_slips, 0.0  # those of the pull-out
    world.write(
        bench_drum_acceleration_millirpm_per_s=200_000, bench_drum_speed_millirpm=LAUNCH_MILLIRPM
    )
    for _ in range(1000):
        world.run(0.01)
        furthest_um = max(furthest_um, abs(world.truth.carriage_um))
    assert not world.flags & {"los", "faulted"}, f"{world}"
    assert world.truth.pole_slips == slips
    assert furthest_um < 1000 * truth["overtravel_mm"]


@pytest.mark.parametrize("name", some(list(WRONG), 4))
def test_a_wrong_machine_is_named_in_its_step(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    figures, answers, code = WRONG[name]
    winch, truth = commissioned(figures, tmp_path, monkeypatch)
    winch.answers |= answers
    world, reached_um = winch.world, [0.0]
    winch.client.after = lambda: reached_um.append(abs(world.truth.carriage_um))
    with pytest.raises(ToolError, match="What is done so far is kept"):
        winch.go_on()
    results = session.load(winch.session.path).results
    (step,) = [step for step, held in results.items() if not held.done]
    (finding,) = [finding for finding in results[step].findings if finding.wrong]
    assert finding.code == code
    assert code.startswith(step)
    assert NAMES.index(step) == len(results) - 1, "later steps have begun"
    world.run(3.0)
    assert "moving" not in world.flags
    assert max(reached_um) < 1000 * truth["end_stop_mm"] - 500
    assert "not_accepted" in world.flags


@pytest.mark.parametrize("name", some(list(MOTORS), 5))
def test_the_trip_is_20_to_40_percent_under_the_motors_pull_out(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    # Slow enough a rope that none of them is too weak for it.
    winch, truth = commissioned(MOTORS[name], tmp_path, monkeypatch, geometry__rope_m_per_s=22)
    values = winch.go_on().active
    world, trip = winch.world, values["overspeed_trip_edges_per_s"]
    world.command(Command.STOP)
    world.apply(
        overspeed_warning_edges_per_s=900_000,
        overspeed_trip_edges_per_s=1_000_000,
        switch_delay_us=0,
        span_tolerance_um=3000,
        los_recoveries_max=0,
    )
    edges_per_rev = world.value("edges_per_1000_drum_revs") / 1000

    def follows(edges_per_s: float) -> bool:
        """A drum as fast as that, through a reversal or two."""
        world.index()
        slips = world.truth.pole_slips
        speed = round(edges_per_s / edges_per_rev * 60_000)
        for millirpm in (speed, 0):
            world.write(
                bench_drum_acceleration_millirpm_per_s=8_000_000, bench_drum_speed_millirpm=millirpm
            )
            world.run(1.5)
        world.stop_drum()
        world.command(Command.STOP)
        return world.truth.pole_slips == slips

    low, high = trip, 4 * trip
    while high - low > 0.03 * trip:
        middle = (low + high) / 2
        low, high = (middle, high) if follows(middle) else (low, middle)
    assert 0.6 * low < trip < 0.8 * high, f"{truth.given}: pull-out at {low:.0f} edges/s"
