# SPDX-License-Identifier: Apache-2.0
"""The fault campaign: `./dev campaign`. Exit status 1 if an invariant was broken."""

import argparse
import multiprocessing
import os
import shlex
import sys
import time
from collections import Counter
from contextlib import nullcontext
from pathlib import Path
from typing import NamedTuple

from levelwind.map_table import Flag
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from .launch import Invariant, memory_bits, memory_part, play, play_apart
from .report import OUTCOMES, Launch, by_fault, by_invariant, by_worker, draw, write
from .scenario import flip_scenario, scenario
from .workers import Played, Pool, cluster, local_pool, play_all, run_worker

FLIP_OUTCOMES = ("harmless", "told", "restart", "moved", "silent")
REPORT = Path("out/campaign.html")
LINE_LAUNCHES = 500  # where no bar can be drawn, a line for so many


class Flip(NamedTuple):
    """A launch in which a bit of the controller's memory was flipped."""

    seed: int
    part: str
    outcome: str
    summary: str


def play_flip(seed: int, library: Path | None = None, bit: int | None = None) -> Flip:
    """Play the flip of a seed, of a bit by chance or of this one."""
    s, bit = flip_scenario(seed, memory_bits(library), bit)
    ending, verdict = play_apart(s, library)
    part = memory_part(bit, library)
    if verdict is None:
        return Flip(seed, part, "restart", f"flip {seed}: bit {bit} of {part}: {ending.name}")
    launch = Launch(seed, [f"bit {bit} of {part}"], verdict)
    if verdict.broken is not None:
        outcome = "silent" if verdict.broken == Invariant.SILENT else "moved"
    elif launch.outcome == "no alarm" and verdict.flags >> Flag.LAUNCH_PERMIT & 1:
        outcome = "harmless"
    else:
        outcome = "told"
    return Flip(seed, part, outcome, launch.summary())


def flips(seeds: range) -> int:
    """Flip bits, and tell by part of the memory what came of it."""
    with multiprocessing.Pool(os.cpu_count()) as pool:
        played = sorted(pool.imap_unordered(play_flip, seeds, chunksize=8))
    bad = [flip for flip in played if flip.outcome in ("silent", "moved")]
    print("\n".join(flip.summary for flip in bad))
    print(f"{'memory':26} {'bits':>6}" + "".join(f"{o:>10}" for o in FLIP_OUTCOMES))
    parts = Counter(flip.part for flip in played)
    for part, count in [*parts.most_common(), ("all", len(played))]:
        of_part = Counter(flip.outcome for flip in played if part in ("all", flip.part))
        print(f"{part:26} {count:6}" + "".join(f"{of_part[o]:10}" for o in FLIP_OUTCOMES))
    return bool(bad)


def replay(seed: int) -> int:
    """Play one launch again, tell it, and draw it."""
    s = scenario(seed)
    verdict, trace = play(s, traced=True)
    launch = Launch(seed, s.faults, verdict)
    print(f"carriage at {s.carriage_um} um" + (", harmless" if s.harmless else ""))
    print("\n".join(s.story), launch.summary(), sep="\n")
    picture = REPORT.with_name(f"campaign_{seed}.png")
    picture.parent.mkdir(exist_ok=True)
    draw(trace, launch.summary()).savefig(picture)
    print(picture)
    return verdict.broken is not None


def play_with_progress(seeds: range, pool: Pool) -> list[Played]:
    """Play all; say at once which launch broke an invariant."""
    console = Console(stderr=True)
    columns = (
        *(TextColumn("launches"), BarColumn(), MofNCompleteColumn()),
        *(TextColumn("{task.fields[rate]}"), TimeRemainingColumn()),
    )
    pieces = []
    began = time.monotonic()
    done = 0
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task("launches", total=len(seeds), rate="")
        for played in play_all(seeds, pool):
            pieces.append(played)
            for launch in played.launches:
                if launch.verdict.broken is not None:
                    progress.console.print(launch.summary(), highlight=False)
            done += len(played.launches)
            rate = f"{done / (time.monotonic() - began):.0f} a second"
            progress.update(task, completed=done, rate=rate)
            if progress.disable and done // LINE_LAUNCHES != (
                (done - len(played.launches)) // LINE_LAUNCHES
            ):
                print(f"{done} of {len(seeds)} launches, {rate}", file=sys.stderr, flush=True)
    return pieces


def main() -> int:
    """Play, print, report."""
    parser = argparse.ArgumentParser(prog="./dev campaign", description=__doc__)
    parser.add_argument("--launches", type=int, default=10_000, metavar="N", help="how many")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="the first one's seed")
    parser.add_argument("--replay", type=int, metavar="SEED", help="only this one, with a picture")
    parser.add_argument("--report", type=Path, default=REPORT, metavar="FILE", help="HTML")
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="play on a Dask cluster: tcp://HOST:8786"
    )
    parser.add_argument(
        "--worker",
        metavar="ADDRESS",
        help="instead: play for the Dask scheduler there, on all cores",
    )
    parser.add_argument(
        "--flips", type=int, metavar="N", help="instead: flip N bits of the controller's memory"
    )
    arguments = parser.parse_args()
    if arguments.worker is not None:
        run_worker(arguments.worker)
    if arguments.flips is not None:
        return flips(range(arguments.seed, arguments.seed + arguments.flips))
    if arguments.replay is not None:
        return replay(arguments.replay)

    began = time.monotonic()
    seeds = range(arguments.seed, arguments.seed + arguments.launches)
    with cluster(arguments.scheduler) if arguments.scheduler else nullcontext(local_pool) as pool:
        pieces = play_with_progress(seeds, pool)
    # In the order of their seeds: the order in which they were played is another each time.
    launches = sorted((x for piece in pieces for x in piece.launches), key=lambda x: x.seed)
    write(arguments.report, launches, f"./dev campaign {shlex.join(sys.argv[1:])}", pieces)

    print(f"{'fault':18} {'launches':>9}" + "".join(f"{o:>14}" for o in OUTCOMES))
    for fault, *counts in by_fault(launches):
        print(f"{fault:18} {counts[0]:9}" + "".join(f"{c:14}" for c in counts[1:]))
    broken = 0
    for name, statement, count in by_invariant(launches):
        print(f"{'FAILED' if count else 'ok':7} {name:12} {statement}")
        broken += count
    slow = max(launches, key=lambda x: x.verdict.slow_turns)
    print(
        f"most rope laid wrong and not told, on a drum too slow for its watch: "
        f"{slow.verdict.slow_turns:.2f} drum turns, launch {slow.seed}"
    )
    edges = sum(x.verdict.pin_edges for x in launches)
    hours = sum(x.verdict.duration_ms for x in launches) / 3.6e6
    print(f"{hours:.1f} h of winch time, {edges / 1e6:.0f} million edges")
    for host, process, count, seconds, _ in by_worker(pieces):
        print(f"{host}, process {process}: {count} launches, {seconds:.0f} s of its processor")
    took_s = time.monotonic() - began
    print(
        f"{arguments.report}: {len(launches)} launches in {took_s:.0f} s, "
        f"{len(launches) / took_s:.0f} a second"
    )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
