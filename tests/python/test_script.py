# SPDX-License-Identifier: Apache-2.0
"""Setup scripts are checked as a whole before anything is sent."""

from pathlib import Path
from typing import Any

import pytest
from levelwind.errors import ToolError
from levelwind.files import script
from levelwind.map_table import Mode

SETUP = Path(__file__).parents[2] / "profiles" / "field_setup.yaml"


class FakeDevice:
    """Remembers what is written, answers what it is told."""

    def __init__(self, **values: int) -> None:
        self.values = values
        self.log: list[Any] = []

    def write(self, values: dict[str, int]) -> None:
        self.log.append(dict(values))

    def command(self, command: Any, **_: Any) -> None:
        self.log.append(command.label)

    def read(self, points: Any) -> dict[str, int]:
        return {point.name: self.values[point.name] for point in points}


def load(folder: Path, text: str) -> list[script.Step]:
    path = folder / "script.yaml"
    path.write_text(text, encoding="utf-8")
    return script.load(path)


def run(steps: list[script.Step], device: FakeDevice) -> None:
    for step in steps:
        step.run(device)


def test_steps_reach_the_device_in_order(tmp_path: Path):
    device = FakeDevice()
    steps = load(
        tmp_path,
        "- note: hello\n- set: {pitch_um: 11000, index_switch: minus}\n- apply\n- mode: off\n"
        "- factory: line\n- index\n",
    )
    run(steps, device)
    assert device.log == [
        {"pitch_um": 11000, "index_switch": 1},
        "apply",
        {"mode": Mode.OFF},
        "factory_line",
        "index",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("set: 3\n", "a script is a list"),
        ("- apply\n- wat: 1\n", "step 2: unknown step 'wat'"),
        ("- apply: now\n", "step 1: apply takes no argument"),
        ("- {apply: null, save: null}\n", "one word"),
        ("- set: {pitch_um: 5}\n", "pitch_um=5 is outside its limits: 10 to 100000 um"),
        ("- set: {pitch: 5}\n", "Did you mean pitch_um"),
        ("- set: {state: ready}\n", "state cannot be written"),
        ("- set: {bench_stall: 1}\n", "bench_stall cannot be written by set"),
        ("- bench: {pitch_um: 11000}\n", "pitch_um cannot be written by bench"),
        ("- mode: fast\n", "give one of off, track, centre"),
        ("- expect: {state: flying}\n", "flying is none of unindexed"),
        ("- expect: {position_um: {least: 3}}\n", "a range has min, max or both"),
        ("- expect: {position_um: []}\n", "empty list"),
        ("- expect: {position_um: high}\n", "high is no whole number"),
        ("- wait: {til: {}}\n", "unknown til"),
        ("- wait: {until: {los: false}, timeout_s: -1}\n", "timeout_s is a number of seconds"),
        ("- jog: {direction: up, seconds: 1}\n", "direction is plus or minus"),
        ("- jog: {direction: plus}\n", "seconds is a number"),
        ("- [\n", r"script\.yaml, line 2: expected"),
    ],
)
def test_mistakes_are_named_before_anything_is_sent(tmp_path: Path, text: str, message: str):
    with pytest.raises(ToolError, match=message):
        load(tmp_path, text)


@pytest.mark.parametrize(
    ("wanted", "value", "holds"),
    [
        ("7", 7, True),
        ("7", 8, False),
        ("{min: 5}", 4, False),
        ("{min: 5}", 5, True),
        ("{max: 5}", 5, True),
        ("{max: 5}", 6, False),
        ("{min: -2, max: 2}", -3, False),
        ("[1, 3]", 3, True),
        ("[1, 3]", 2, False),
    ],
)
def test_expect(tmp_path: Path, wanted: str, value: int, holds: bool):
    steps = load(tmp_path, f"- expect: {{position_um: {wanted}}}\n")
    if holds:
        run(steps, FakeDevice(position_um=value))
    else:
        with pytest.raises(ToolError, match=f"but it is {value}"):
            run(steps, FakeDevice(position_um=value))


def test_expect_reads_flags_enumerations_and_copies(tmp_path: Path):
    text = "- expect: {los: false, state: [ready, tracking], active.pitch_um: 11000}\n"
    steps = load(tmp_path, text)
    run(steps, FakeDevice(los=0, state=7, **{"active.pitch_um": 11000}))
    with pytest.raises(ToolError, match="state ready or tracking, but it is fault"):
        run(steps, FakeDevice(los=0, state=12, **{"active.pitch_um": 11000}))


def test_wait_gives_up(tmp_path: Path):
    steps = load(tmp_path, "- wait: {until: {los: true}, timeout_s: 0.01}\n")
    with pytest.raises(ToolError, match=r"not within 0.01 s: los 1, but it is 0"):
        run(steps, FakeDevice(los=0))


def test_the_field_setup_of_the_demonstration_is_valid():
    assert [s.text for s in script.load(SETUP)].count("apply") == 1
