# SPDX-License-Identifier: Apache-2.0
"""Measure, against the budgets: `./dev bench [--json FILE] [--record] [--against REV]`.

Exit status 1 if one is not met, or if what is counted has become dearer than recorded.
"""

import argparse
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
sys.path.insert(0, str(Path(__file__).parent.parent / "integration"))

import board_bench
import counted
import edge_cost
import readme_numbers
from budgets import (
    ANSWER_PERMILLE_MAX_MS,
    FASTER_THAN_REAL_TIME_MIN,
    LAUNCHES_PER_S_MIN,
    LAY_SEARCH_MAX_S,
)
from campaign.workers import play_all
from counted import TOP_EDGES_PER_S
from figure import FIGURES, Figure, dearer, document, figure, side_by_side, table, without_name
from latency import ANSWER_MAX_MS, BAUD, REGISTERS, of_target
from levelwind.core.native import SIMULATOR, find
from levelwind.lay import search
from levelwind.lay.rope import LAUNCH_M, turns_of
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command
from slave import NATIVE_SIM
from world import MILLIRPM_PER_EDGE_PER_S, World

POLLED_S = 10.0
BEHIND_MAX_MS = 200  # from there on lw_sim gives lost time up
LATENCY_READS = 2000
LAY_PATTERNS = 2000
LAY_ROPE_UM = 5000
LAUNCHES = 1000
PARTS = ("unpaced", "polled", "answers", "counted", "launches", "lay", "board", "arm")
ROOT = Path(__file__).parents[2]
ELSEWHERE = "LEVELWIND_BENCH_SOURCES" in os.environ  # another revision is being measured


def unpaced() -> list[Figure]:
    """The whole world in this process, at top speed, as fast as it can."""
    world = World().index()
    world.drum(TOP_EDGES_PER_S)
    world.run(3.0)
    factors = []
    for _ in range(5):
        began = time.perf_counter()
        world.run(20.0)
        factors.append(20.0 / (time.perf_counter() - began))
    assert "tracking" in world.flags
    options = f"{TOP_EDGES_PER_S} edges/s, one process, 5 x 20 s"
    limits = {"avg_min": FASTER_THAN_REAL_TIME_MIN}
    return [figure("faster than real time", "simulator", options, factors, "x", limits=limits)]


def polled() -> list[Figure]:
    """The simulator program in real time on one core, polled without a pause over a pty."""
    with tempfile.TemporaryDirectory() as folder:
        port = f"{folder}/port"
        simulator = subprocess.Popen(
            [find(SIMULATOR), "--port", port], stdout=subprocess.PIPE, text=True
        )
        try:
            os.sched_setaffinity(simulator.pid, {max(os.sched_getaffinity(0))})
            assert simulator.stdout is not None
            simulator.stdout.readline()  # it is ready
            with Device(Line(port)) as device:
                return poll(device)
        finally:
            simulator.terminate()
            simulator.wait()


def poll(device: Device) -> list[Figure]:
    """Index, turn the drum, poll, stop the drum, count."""
    device.write({"index_rate_edges_per_s": 50_000})
    device.command(Command.APPLY)
    wait_for_rest(device)
    device.command(Command.INDEX)
    before = counters(device)
    device.write(
        {
            "bench_drum_speed_millirpm": round(TOP_EDGES_PER_S * MILLIRPM_PER_EDGE_PER_S),
            "bench_drum_acceleration_millirpm_per_s": 2_000_000,
        }
    )
    status = [p for p in POINTS.values() if p.block == "status" and 100 <= p.address < 131]
    latencies = []
    began = time.perf_counter()
    began_ms = device.value("bench_time_ms")
    speed = 0
    while time.perf_counter() - began < POLLED_S:
        asked = time.perf_counter()
        speed = device.read(status)["drum_speed_edges_per_s"]
        latencies.append((time.perf_counter() - asked) * 1000)
    took_s = time.perf_counter() - began
    late_ms = took_s * 1000 - (device.value("bench_time_ms") - began_ms)
    device.write({"bench_drum_speed_millirpm": 0})
    wait_for_rest(device)
    after = counters(device)

    assert abs(speed - TOP_EDGES_PER_S) < 0.02 * TOP_EDGES_PER_S, f"the drum made {speed} edges/s"
    # Two edges per pulse: every transition of channel A.
    edges = (after["bench_transitions"] + 1) // 2 - (before["bench_transitions"] + 1) // 2
    lost = float(abs(edges - (after["net_edges"] - before["net_edges"])))
    assert edges > TOP_EDGES_PER_S * (POLLED_S - 1)
    options = f"{TOP_EDGES_PER_S} edges/s, real time, one core, pymodbus over a pty, {took_s:.0f} s"
    return [
        figure(
            *("edges lost", "lw_sim", f"{options}, {edges} edges", [lost], "edges"),
            limits={"max_max": 0},
        ),
        figure(
            *("behind real time at the end", "lw_sim", options, [late_ms], "ms"),
            limits={"max_max": BEHIND_MAX_MS},
        ),
        figure("polls", "lw_sim", options, [len(latencies) / took_s], "1/s"),
        figure("latency of a poll", "lw_sim", options, latencies, "ms"),
    ]


def answers(target: str) -> list[Figure]:
    """A read of 20 registers at the fastest drum, from the end of the request on."""
    with tempfile.TemporaryDirectory() as folder:
        found = of_target(target, Path(folder), LATENCY_READS)
    options = (
        f"{REGISTERS} registers, {BAUD} baud, {TOP_EDGES_PER_S} edges/s, {LATENCY_READS} reads"
    )
    own = f"{options}, without waiting for a processor"
    return [
        figure("answer, median", target, options, [found.median_ms], "ms"),
        figure(
            *("answer, 99.9 %", target, options, [found.slowest_permille_ms], "ms"),
            limits={"max_max": ANSWER_PERMILLE_MAX_MS} if target == "sim" else {},
        ),
        figure(
            *("answer, the slave's time", target, own, found.slave_ms, "ms"),
            limits={"max_max": ANSWER_MAX_MS},
        ),
    ]


def lay_search() -> list[Figure]:
    """`levelwind lay`: so many settings of the factory machine, each laid and judged."""
    parameters = {p.name: p.default or 0 for p in POINTS.values() if p.block == "parameters"}
    pitch_um, dwell_millirev = (10_800, 13_200), (0, 300)
    band = search.Band(pitch_um, dwell_millirev, LAY_PATTERNS)
    tried = 0

    def count(_done: int, total: int) -> None:
        nonlocal tried
        tried = total

    began = time.perf_counter()
    search.recommend(parameters, band, LAY_ROPE_UM, turns_of(parameters, LAUNCH_M), count)
    took_s = time.perf_counter() - began
    assert tried >= LAY_PATTERNS * 0.95, f"only {tried} tried"
    options = (
        f"{tried} patterns, {LAUNCH_M:g} m of {LAY_ROPE_UM / 1000:g} mm, "
        f"{len(os.sched_getaffinity(0))} processors"
    )
    limits = {"max_max": LAY_SEARCH_MAX_S}
    name = "lay search, 2000 patterns"
    return [figure(name, "levelwind lay", options, [took_s], "s", limits=limits)]


def launches() -> list[Figure]:
    """Launches of the fault campaign on all cores."""
    seeds = range(1, 1 + LAUNCHES)
    began = time.perf_counter()
    pieces = list(play_all(seeds))
    rate = LAUNCHES / (time.perf_counter() - began)
    cores = len(os.sched_getaffinity(0))
    own = [1000 * piece.seconds / len(piece.launches) for piece in pieces]
    options = f"{LAUNCHES} launches, {cores} processors"
    return [
        figure(
            *("launches of the campaign", "campaign", options, [rate], "1/s"),
            limits={"avg_min": LAUNCHES_PER_S_MIN * cores / 2},
        ),
        figure("a launch of the campaign, processor", "campaign", options, own, "ms"),
    ]


def wait_for_rest(device: Device) -> None:
    """Until the controller sees the drum at rest."""
    while not device.value("drum_at_rest"):
        time.sleep(0.01)


def counters(device: Device) -> dict[str, int]:
    """Edges counted and transitions made, of a resting drum."""
    return device.read_names("net_edges", "bench_transitions")


def arm(record: bool) -> list[Figure]:
    """Instructions per edge on Arm, beside the record."""
    if not edge_cost.available():
        print(f"bench: Arm left out, no compiler: {edge_cost.HOW_TO_INSTALL}", file=sys.stderr)
        return []
    costs, sizes = edge_cost.measure_all(tuple(edge_cost.CPUS))
    if record:
        edge_cost.write_record(costs, sizes)
    return edge_cost.figures(costs, sizes)


def measure(record: bool, only: set[str]) -> list[Figure]:
    """Everything, or some of it."""
    targets = ["sim", "native_sim"] if NATIVE_SIM.exists() and not ELSEWHERE else ["sim"]
    if len(targets) < 2 and "answers" in only:
        print(f"bench: native_sim left out, {NATIVE_SIM} is not built", file=sys.stderr)
    parts: dict[str, Callable[[], list[Figure]]] = {
        "unpaced": unpaced,
        "polled": polled,
        "answers": lambda: [f for target in targets for f in answers(target)],
        "counted": counted.measure,
        "launches": launches,
        "lay": lay_search,
        "board": lambda: [] if ELSEWHERE else board_bench.measure(),
        "arm": lambda: arm(record),
    }
    return [f for part, measured in parts.items() if part in only for f in measured()]


def of_revision(revision: str, only: set[str]) -> list[dict[str, object]]:
    """The same measurements of another revision's core, plant and simulator, built beside this."""
    with tempfile.TemporaryDirectory(prefix="levelwind_") as folder:
        tree, build, archive = (f"{folder}/{name}" for name in ("tree", "build", "tree.tar"))
        subprocess.run(["git", "-C", ROOT, "archive", "-o", archive, revision], check=True)
        with tarfile.open(archive) as packed:
            packed.extractall(tree)
        # The programs that are measured are those of today, around that revision's sources.
        for program in ("law_bench.c", "world_bench.c", "CMakeLists.txt"):
            Path(tree, "tests/bench", program).write_bytes(
                (ROOT / "tests/bench" / program).read_bytes()
            )
        preset = ("-DCMAKE_BUILD_TYPE=RelWithDebInfo", "-DLW_BUILD_TESTS=OFF", "-DLW_WERROR=OFF")
        for command in (
            ["cmake", "-S", tree, "-B", build, "-G", "Ninja", *preset],
            ["cmake", "--build", build],
        ):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        results = Path(folder) / "results.json"
        subprocess.run(
            [sys.executable, __file__, "--json", str(results), "--only", *sorted(only)],
            stdout=subprocess.DEVNULL,
            env={**os.environ, "LEVELWIND_NATIVE_DIR": build, "LEVELWIND_BENCH_SOURCES": tree},
            check=False,  # what it was may miss today's targets
        )
        return json.loads(results.read_text())  # type: ignore[no-any-return]


def main() -> int:
    """Print a table, write JSON, say what is not met."""
    parser = argparse.ArgumentParser(prog="./dev bench", description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the results here, too")
    parser.add_argument("--record", action="store_true", help="compare with these from now on")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS, help="not all of it")
    parser.add_argument(
        "--against", metavar="REV", help="measure that revision, too, and show both side by side"
    )
    arguments = parser.parse_args()

    only = set(arguments.only)
    if arguments.record and only != set(PARTS):
        parser.error("--record wants all of it, not --only some")
    record = json.loads(FIGURES.read_text()) if FIGURES.exists() else []
    figures = measure(arguments.record, only)
    print(table(figures))
    text = json.dumps(document(figures), indent=2) + "\n"
    if arguments.json:
        arguments.json.write_text(text)
    failures = [told for f in figures for told in f.missed()]
    failures += [f"{name} ({target}): twice" for name, target in without_name(figures)]
    if arguments.record:
        FIGURES.write_text(text)
        readme_numbers.write()
    elif not ELSEWHERE:
        failures += dearer(figures, record)
    if arguments.against:
        print("\n" + side_by_side(figures, of_revision(arguments.against, only), arguments.against))
    for failure in failures:
        print(f"bench: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
