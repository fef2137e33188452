# SPDX-License-Identifier: Apache-2.0
"""What the stacks may need, by cmake/stack_bounds.py: against what they are seen to need, against
the compiler's own count, and what it says of an image that it does not know.
"""

import copy
import importlib.util
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from levelwind.map_table import POINTS, Command, Result

from board.machine import IMAGE, Board, available

pytestmark = [
    pytest.mark.skipif(bool(available()), reason=available()),
    pytest.mark.skipif(
        importlib.util.find_spec("elftools") is None, reason="no pyelftools: ./dev firmware"
    ),
]

STACK_BOUNDS = Path(__file__).parents[2] / "cmake/stack_bounds.py"
DECLARED = yaml.safe_load(STACK_BOUNDS.with_suffix(".yaml").read_text())
BUILD = IMAGE.parents[1]
MEASURED = ("supervisor", "limits", "modbus", "storage", "interrupts")


def run(*options: str | Path) -> subprocess.CompletedProcess[str]:
    """The script on the image that the board runs."""
    command = [sys.executable, STACK_BOUNDS, BUILD, *options]
    return subprocess.run(command, check=False, capture_output=True, text=True)


def test_no_stack_is_seen_to_need_more_than_it_may_need():
    found = json.loads(run("--json").stdout)
    board = Board()
    board.apply(pitch_um=11_000)
    assert board.command(Command.SAVE) == Result.DONE
    board.index()
    board.drum(24_000, 240_000)
    for point in POINTS.values():
        if point.space == "input" and point.block in ("status", "active"):
            board.read(point.name)
    board.stop_drum()
    board.run(2.0)
    free = board.read(*(f"stack_free_{name}_bytes" for name in MEASURED))
    for name in MEASURED:
        used = found[name]["size"] - free[f"stack_free_{name}_bytes"]
        assert 0 < used <= found[name]["need"], name


def test_a_function_has_the_frame_that_the_compiler_says():
    """Of those with a name that is theirs alone. The compiler leaves out parameters that it puts
    from registers onto the stack, so a few are larger."""
    frames = json.loads(run("--frames").stdout)
    said: dict[str, set[int]] = {}
    for file in BUILD.rglob("*.su"):
        for line in file.read_text().splitlines():
            place, size, how = line.split("\t")
            if how == "static":
                said.setdefault(place.split(":")[-1], set()).add(int(size))
    both = {name: (frames[name], *said[name]) for name in frames if len(said.get(name, ())) == 1}
    assert len(both) > 500
    assert {name: pair for name, pair in both.items() if pair[0] < pair[1]} == {}
    assert len([name for name, pair in both.items() if pair[0] != pair[1]]) < 10


def without(group: str, name: str) -> Callable[[dict[str, Any]], None]:
    """Take a declaration away."""

    def change(declared: dict[str, Any]) -> None:
        inside = declared[group]
        inside.remove(name) if isinstance(inside, list) else inside.pop(name)

    return change


def with_pointer(caller: str, callee: str) -> Callable[[dict[str, Any]], None]:
    """Declare one more."""
    return lambda declared: declared["pointers"].setdefault(caller, []).append(callee)


def small(declared: dict[str, Any]) -> None:
    """The supervisor on the smallest stack that there is."""
    declared["threads"]["supervisor"]["stack"] = declared["threads"]["system work queue"]["stack"]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (without("pointers", "lw_homing_tick"), "lw_homing_tick calls by a pointer"),
        (without("pointers", "call_back"), "on_no calls by a pointer, in call_back: declare what"),
        (without("uncalled", "on_encoder"), "on_encoder may be called by a pointer: declare by"),
        (without("pointers", "catch_up"), "on_index calls by a pointer, in catch_up: declare what"),
        (with_pointer("is_running", "main"), "is_running is declared, and nothing that runs"),
        (with_pointer("z_arm_nmi", "no_such"), "no_such is declared to be called, and is not in"),
        (with_pointer("z_arm_nmi", "z_arm_nmi"), "recursion: z_arm_nmi -> z_arm_nmi. Declare how"),
        (small, "supervisor may need "),
    ],
)
def test_what_it_does_not_know_is_an_error_with_the_name(
    change: Callable[[dict[str, Any]], None], told: str, tmp_path: Path
):
    assert run().returncode == 0
    declared = copy.deepcopy(DECLARED)
    change(declared)
    file = tmp_path / "declared.yaml"
    file.write_text(yaml.safe_dump(declared))
    result = run("--declared", file)
    assert result.returncode == 1
    assert told in result.stderr
