"""A short campaign holds; and controllers that have been broken on purpose are caught by it."""

import os
import subprocess
from itertools import count, islice
from pathlib import Path

import pytest
from levelwind.native import find

from .__main__ import campaign, play_seed
from .launch import LIBRARY, Invariant
from .scenario import FAULTS, scenario

ROOT = Path(__file__).parents[2]
LAUNCHES = 120
MUTANT_LAUNCHES = 60
INCLUDES = (
    *("lib/lw_core/include", "lib/lw_core/generated", "lib/lw_core/src"),
    *("lib/lw_plant/include", "sim", "tests/campaign"),
)


def test_a_short_campaign_holds():
    launches = list(campaign(range(1, 1 + LAUNCHES)))
    broken = [launch.summary() for launch in launches if launch.verdict.broken is not None]
    assert not broken, "\n".join(broken)
    assert {fault for launch in launches for fault in launch.faults} == set(FAULTS)
    outcomes = [launch.outcome for launch in launches]
    for outcome in ("fault", "LOS told", "no alarm"):
        assert outcomes.count(outcome) > LAUNCHES // 10, outcomes


# What is broken: file, right text, wrong text, in launches with which fault, what must notice.
MUTANTS = {
    "no LOS of type 1 is told": (
        "tracking.c",
        "if (!controller->seen[side]) {\n\t\t\trecord(",
        "if (false) {\n\t\t\trecord(",
        "stuck_switch",
        Invariant.SILENT,
    ),
    "no LOS of type 2 is told": (
        "tracking.c",
        "record(controller, &controller->los2[side], at->pos_usteps * LW_USTEP);",
        "",
        "slip",
        Invariant.SILENT,
    ),
    "no LOS of type 2 is noticed": (
        "tracking.c",
        "\tif (error <= tolerance &&",
        "\tif (error <= 100000 || error <= tolerance &&",
        "stall",
        Invariant.SILENT,
        Invariant.RECOVERY,
    ),
    "a LOS is not made good": (
        "tracking.c",
        "motion->request_correction_usteps -= error;",
        "motion->request_correction_usteps -= error / 4;",
        "stall",
        Invariant.RECOVERY,
    ),
    "a switch is judged without regard to the direction": (
        "controller.c",
        "return direction == lw_side_direction(side);",
        "return direction == lw_side_direction(side) || direction != 0;",
        "drum_reversal",
        Invariant.FALSE_ALARM,
    ),
    "the permit does not ask for an index": (
        "controller.c",
        "controller->state != LW_STATE_TRACKING || !controller->indexed",
        "false",
        "power_cut",
        Invariant.PERMIT,
    ),
    "an overtravel switch blocks no steps": (
        "controller.c",
        "\t\t\tactuated);\n",
        "\t\t\tfalse);\n",
        "overtravel",
        Invariant.OVERTRAVEL,
    ),
}


def build(folder: Path, source: Path, text: str) -> Path:
    """The campaign library with one source of the core replaced."""
    mutant = folder / source.name
    mutant.write_text(text)
    library = folder / LIBRARY
    built = find(LIBRARY).parent
    archives = [next(built.rglob(f"liblw_{name}.a")) for name in ("world", "plant", "core")]
    judge = (ROOT / "tests/campaign" / name for name in ("judge.c", "launch.c"))
    includes = (f"-I{ROOT / include}" for include in INCLUDES)
    subprocess.run(
        [
            *(os.environ.get("CC", "cc"), "-std=c11", "-O1", "-fPIC", "-shared", "-w", *includes),
            # The linker takes from an archive what is still missing: not the right version.
            *(mutant, *judge, *archives, "-lm", "-o", library),
        ],
        check=True,
    )
    return library


@pytest.mark.parametrize("name", MUTANTS)
def test_a_broken_controller_is_caught(name: str, tmp_path: Path):
    file, right, wrong, fault, *invariants = MUTANTS[name]
    source = ROOT / "lib/lw_core/src" / file
    text = source.read_text()
    assert text.count(right) == 1, f"{file} has changed: adapt the mutant"
    library = build(tmp_path, source, text.replace(right, wrong))
    seeds = islice((seed for seed in count(1) if fault in scenario(seed).faults), MUTANT_LAUNCHES)
    verdicts = (play_seed(seed, library).verdict.broken for seed in seeds)
    assert next((verdict for verdict in verdicts if verdict is not None), None) in invariants
