# SPDX-License-Identifier: Apache-2.0
"""Instructions on this machine's processor, counted by callgrind: the same in every run."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from figure import Figure, figure
from levelwind.core.native import find

TESTS = Path(__file__).parent.parent
TOP_EDGES_PER_S = 48_000  # 40 m/s of rope
LAW_CASES = ("sweep", "reversal", "direction_change", "cam_linear", "cam_trapezoid")
SEED = 22  # of the campaign: 11 s, 9 of them tracking, 337,000 edges
PLAY = """
from campaign.launch import play
from campaign.scenario import scenario
play(scenario({}))
"""


def available() -> bool:
    """Is there a callgrind?"""
    return shutil.which("valgrind") is not None


def _callgrind(command: list[str], *options: str) -> tuple[str, str]:
    """What it has counted, and what the program has printed."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *options, *command],
            check=True,
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])},
        )
        return out.read_text(), done.stdout


def _total(counted: str) -> int:
    return sum(int(n) for n in re.findall(r"^totals: (\d+)", counted, re.M))


def law(case: str) -> Figure:
    """Instructions of the encoder interrupt's path through the core, edge by edge."""
    counted, _ = _callgrind(
        [str(find("lw_law_bench")), case],
        *("--toggle-collect=encoder_interrupt", "--dump-instr=no"),
        *("--dump-after=encoder_interrupt", "--combine-dumps=yes"),
    )
    counts = [int(n) for n in re.findall(r"^totals: (\d+)", counted, re.M)]
    counts = [count for count in counts if count]  # the last part holds what comes after
    assert len(counts) == 1000, f"{len(counts)} edges counted"
    options = f"{os.uname().machine}, callgrind, 1000 edges, 4 edges per pulse"
    name = f"edge: {case.replace('_', ' ')}"
    return figure(name, "core", options, counts, "instructions", counted=True)


def second() -> Figure:
    """The whole simulated machine for a second."""
    counted, edges = _callgrind(
        [str(find("lw_world_bench"))], "--toggle-collect=virtual_second", "--dump-instr=no"
    )
    assert abs(int(edges) - TOP_EDGES_PER_S) < 0.01 * TOP_EDGES_PER_S, f"{edges} edges"
    options = f"{os.uname().machine}, callgrind, {TOP_EDGES_PER_S} edges/s"
    name = "a second of the simulator"
    return figure(
        name, "simulator", options, [_total(counted) / 1e6], "million instructions", counted=True
    )


def launch() -> Figure:
    """A launch of the campaign, judged."""
    counted, _ = _callgrind(
        [sys.executable, "-c", PLAY.format(SEED)], "--toggle-collect=lw_world_run"
    )
    options = f"{os.uname().machine}, callgrind, seed {SEED}"
    values = [_total(counted) / 1e6]
    return figure(
        "a launch of the campaign",
        "campaign",
        options,
        values,
        "million instructions",
        counted=True,
    )


def measure() -> list[Figure]:
    """All of it."""
    return [*(law(case) for case in LAW_CASES), second(), launch()]
