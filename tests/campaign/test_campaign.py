# SPDX-License-Identifier: Apache-2.0
"""A short campaign holds; and controllers that have been broken on purpose are caught by it."""

import os
import subprocess
from itertools import count, islice
from pathlib import Path

import pytest
from levelwind.core.native import find

from .__main__ import play_flip
from .launch import LIBRARY, Invariant, memory_bits, memory_part
from .scenario import FAULTS, scenario
from .workers import play_all, play_seed

ROOT = Path(__file__).parents[2]
LAUNCHES = 120
MUTANT_LAUNCHES = 60
FLIPS = 60
INCLUDES = (
    *("lib/lw_core/include", "lib/lw_core/generated", "lib/lw_core/src/control"),
    *("lib/lw_plant/include", "sim", "tests/campaign"),
)


def test_a_short_campaign_holds():
    launches = [x for played in play_all(range(1, 1 + LAUNCHES)) for x in played.launches]
    broken = [launch.summary() for launch in launches if launch.verdict.broken is not None]
    assert not broken, "\n".join(broken)
    assert {fault for launch in launches for fault in launch.faults} == set(FAULTS)
    outcomes = [launch.outcome for launch in launches]
    for outcome in ("fault", "LOS told", "no alarm"):
        assert outcomes.count(outcome) > LAUNCHES // 10, outcomes


# What is broken: file, right text, wrong text, in launches with which fault, what must notice.
MUTANTS = {
    "no LOS of type 1 is told": (
        "control/los_judge.c",
        "if (!controller->los.triggered[side]) {\n\t\t\tlw_los_note(",
        "if (false) {\n\t\t\tlw_los_note(",
        "stuck_switch",
        Invariant.SILENT,
    ),
    "no LOS of type 2 is told": (
        "control/los_judge.c",
        "lw_los_note(&controller->los.los2[side], ",
        "(void)(controller->los.los2[side].set, ",
        "slip",
        Invariant.SILENT,
    ),
    "no LOS of type 2 is noticed": (
        "control/los_judge.c",
        "\tif (error <= tolerance &&",
        "\tif (error <= 100000 || error <= tolerance &&",
        "stall",
        Invariant.SILENT,
        Invariant.RECOVERY,
    ),
    "a LOS is not made good": (
        "control/los_judge.c",
        "motion->request_correction_usteps -= error;",
        "motion->request_correction_usteps -= error / 4;",
        "stall",
        Invariant.RECOVERY,
    ),
    "a switch is judged without regard to the direction": (
        "control/carriage.c",
        "return direction == lw_side_direction(side);",
        "return direction == lw_side_direction(side) || direction != 0;",
        "drum_reversal",
        Invariant.FALSE_ALARM,
    ),
    "the permit does not ask for an index": (
        "control/controller.c",
        "controller->state != LW_STATE_TRACKING || !controller->indexed",
        "false",
        "power_cut",
        Invariant.PERMIT,
    ),
    "an overtravel switch blocks no steps": (
        "control/controller.c",
        "lw_carriage_side_bit(side), actuated);",
        "lw_carriage_side_bit(side), false);",
        "overtravel",
        Invariant.OVERTRAVEL,
    ),
    "a dead channel is not told": (
        "control/drum_watch.c",
        "\t\twatch->fault = fault;\n",
        "",
        "dead_channel",
        Invariant.SILENT,
    ),
    "a loose wire is not told": (
        "control/drum_watch.c",
        "\t\twatch->fault = fault;\n",
        "",
        "loose_channel",
        Invariant.SILENT,
    ),
    "index pulses are not compared with the edges": (
        "control/drum_watch.c",
        "\tif (told->pulses > 0 && ",
        "\tif (told->pulses > 1000 && ",
        "lost_edges",
        Invariant.SILENT,
    ),
    "rocking about an edge is taken for a dead channel at once": (
        "control/drum_watch.c",
        "if (running ||\n",
        "if (true || running ||\n",
        "rocking",
        Invariant.FALSE_ALARM,
    ),
    "rope laid while the carriage stood is not told": (
        "control/rope_watch.c",
        "\t\twatch->set = true;\n",
        "",
        "overtravel",
        Invariant.STANDING,
    ),
    "a switch that cannot be actuated keeps the permit": (
        "control/switch_check.c",
        "controller->now_us - check->plausible_us[side] > contact_us;",
        "false;",
        "stuck_switch",
        Invariant.PERMIT,
    ),
    "an echo is taken for a request": (
        "modbus/slave.c",
        "if (slave->sent_length == 0 ||",
        "if (true || slave->sent_length == 0 ||",
        "echo",
        Invariant.LINE,
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


def test_a_bit_that_flips_moves_nothing_and_lays_nothing_wrong_in_silence():
    flips = [play_flip(seed) for seed in range(1, 1 + FLIPS)]
    assert [f.summary for f in flips if f.outcome in ("moved", "silent")] == []
    assert [f.outcome for f in flips].count("harmless") > FLIPS // 2


@pytest.mark.parametrize("kept", [True, False])
def test_a_parameter_that_flips_is_harmless_by_its_copy_alone(kept: bool, tmp_path: Path):
    source = ROOT / "lib/lw_core/src/device/set_copy.c"
    right, wrong = "if (lw_same(", "if (true || lw_same("
    text = source.read_text()
    assert text.count(right) == 1, "adapt the mutant"
    library = build(tmp_path, source, text if kept else text.replace(right, wrong))
    bits = [bit for bit in range(memory_bits(library)) if memory_part(bit, library) == "active"]
    flips = [play_flip(seed, library, bit) for seed, bit in enumerate(bits[14::32])]
    assert any(flip.outcome in ("moved", "silent") for flip in flips) != kept
