# SPDX-License-Identifier: Apache-2.0
"""Measure, against the budgets: `./dev bench [--json FILE] [--record]`.

Exit status 1 if one is not met, or if an edge has become dearer than recorded.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
sys.path.insert(0, str(Path(__file__).parent.parent / "integration"))

import board_bench
import edge_cost
import readme_numbers
from budgets import FASTER_THAN_REAL_TIME_MIN, LAY_SEARCH_MAX_S
from latency import ANSWER_MAX_MS, BAUD, REGISTERS, of_target
from levelwind.core.native import SIMULATOR, find
from levelwind.lay import search
from levelwind.lay.rope import LAUNCH_M, turns_of
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command
from slave import NATIVE_SIM
from world import MILLIRPM_PER_EDGE_PER_S, World

TOP_EDGES_PER_S = 48_000  # 40 m/s of rope
POLLED_S = 10.0
BEHIND_MAX_MS = 200  # from there on lw_sim gives lost time up
LATENCY_READS = 2000
LAY_PATTERNS = 2000
LAY_ROPE_UM = 5000
LAW_CASES = ("sweep", "reversal", "direction_change", "cam_linear", "cam_trapezoid")


@dataclass
class Result:
    """One line of the table."""

    name: str
    target: str
    options: str
    min: float
    avg: float
    max: float
    unit: str
    before: float | None = None  # what it was, where that is known


def result(name: str, target: str, options: str, values: list[float], unit: str) -> Result:
    """Over the values of one measurement."""
    return Result(name, target, options, min(values), statistics.fmean(values), max(values), unit)


def unpaced() -> list[Result]:
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
    return [result("faster than real time", "simulator", options, factors, "x")]


def polled() -> list[Result]:
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


def poll(device: Device) -> list[Result]:
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
        Result("edges lost", "lw_sim", f"{options}, {edges} edges", lost, lost, lost, "edges"),
        result("behind real time at the end", "lw_sim", options, [late_ms], "ms"),
        result("polls", "lw_sim", options, [len(latencies) / took_s], "1/s"),
        result("latency of a poll", "lw_sim", options, latencies, "ms"),
    ]


def answers(target: str) -> list[Result]:
    """A read of 20 registers at the fastest drum, from the end of the request on."""
    with tempfile.TemporaryDirectory() as folder:
        found = of_target(target, Path(folder), LATENCY_READS)
    options = (
        f"{REGISTERS} registers, {BAUD} baud, {TOP_EDGES_PER_S} edges/s, {LATENCY_READS} reads"
    )
    own = f"{options}, without waiting for a processor"
    return [
        result("answer, median", target, options, [found.median_ms], "ms"),
        result("answer, 99.9 %", target, options, [found.slowest_permille_ms], "ms"),
        result("answer, the slave's time", target, own, found.slave_ms, "ms"),
    ]


def lay_search() -> list[Result]:
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
    return [result("lay search, 2000 patterns", "levelwind lay", options, [took_s], "s")]


def wait_for_rest(device: Device) -> None:
    """Until the controller sees the drum at rest."""
    while not device.value("drum_at_rest"):
        time.sleep(0.01)


def counters(device: Device) -> dict[str, int]:
    """Edges counted and transitions made, of a resting drum."""
    return device.read_names("net_edges", "bench_transitions")


def law(case: str) -> Result:
    """Instructions of the encoder interrupt's path through the core, edge by edge."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind"
        subprocess.run(
            [
                *("valgrind", "--tool=callgrind", f"--callgrind-out-file={out}"),
                *("--toggle-collect=encoder_interrupt", "--dump-instr=no"),
                *("--dump-after=encoder_interrupt", "--combine-dumps=yes"),
                *(find("lw_law_bench"), case),
            ],
            check=True,
            capture_output=True,
        )
        counts = [int(n) for n in re.findall(r"^totals: (\d+)", out.read_text(), re.M)]
    counts = [count for count in counts if count]  # the last part holds what comes after
    assert len(counts) == 1000, f"{len(counts)} edges counted"
    options = f"{os.uname().machine}, callgrind, 1000 edges, 4 edges per pulse"
    return result(f"edge: {case.replace('_', ' ')}", "core", options, counts, "instructions")


def arm(record: bool) -> list[str]:
    """Instructions per edge on Arm, beside the record; what is dearer, or misses its target."""
    if not edge_cost.available():
        print(f"\nno compiler for Arm: {edge_cost.HOW_TO_INSTALL}")
        return []
    costs, sizes = edge_cost.measure_all(tuple(edge_cost.CPUS))
    print("\n" + edge_cost.table(costs, sizes))
    if record:
        edge_cost.write_record(costs, sizes)
    return edge_cost.failures(costs, edge_cost.recorded())


def main() -> int:
    """Print a table, write JSON, say what is not met."""
    parser = argparse.ArgumentParser(prog="./dev bench", description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the results here, too")
    parser.add_argument("--record", action="store_true", help="compare with these from now on")
    arguments = parser.parse_args()

    targets = ["sim", "native_sim"] if NATIVE_SIM.exists() else ["sim"]
    if len(targets) < 2:
        print(f"bench: native_sim left out, {NATIVE_SIM} is not built", file=sys.stderr)
    board = board_bench.measure()
    results = [
        *unpaced(),
        *polled(),
        *(r for target in targets for r in answers(target)),
        *(law(case) for case in LAW_CASES),
        *lay_search(),
        *(
            Result(r.name, "nucleo_f446re", r.options, r.min, r.avg, r.max, r.unit, r.before)
            for r in board
        ),
    ]
    width = max(len(r.name) for r in results)
    print(f"{'':{width}}  {'min':>9} {'avg':>9} {'max':>9}")
    for r in results:
        figures = " ".join(f"{value:9.2f}" for value in (r.min, r.avg, r.max))
        before = "" if r.before is None else f"; {r.before:g} before"
        print(f"{r.name:{width}}  {figures}  {r.unit:12}  {r.target}: {r.options}{before}")
    document = json.dumps([asdict(r) for r in results], indent=2) + "\n"
    if arguments.json:
        arguments.json.write_text(document)
    if arguments.record:
        readme_numbers.FIGURES.write_text(document)

    by_name = {r.name: r for r in results}
    failures = []
    if by_name["faster than real time"].avg < FASTER_THAN_REAL_TIME_MIN:
        failures.append(f"the simulator is less than {FASTER_THAN_REAL_TIME_MIN}x real time")
    if by_name["edges lost"].max != 0:
        failures.append("the simulator has lost edges")
    if by_name["behind real time at the end"].max > BEHIND_MAX_MS:
        failures.append("the simulator has not kept up with real time")
    for late in (r for r in results if r.name == "answer, the slave's time"):
        if late.max > ANSWER_MAX_MS:
            failures.append(f"{late.target} has answered after more than {ANSWER_MAX_MS:g} ms")
    if by_name["lay search, 2000 patterns"].max > LAY_SEARCH_MAX_S:
        failures.append(f"a search of 2,000 patterns took more than {LAY_SEARCH_MAX_S} s")
    failures += board_bench.failures(board)
    failures += arm(arguments.record)
    if arguments.record:
        readme_numbers.write()
    for failure in failures:
        print(f"bench: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
