"""The fault campaign: `./dev campaign`. Exit status 1 if an invariant was broken."""

import argparse
import multiprocessing
import os
import shlex
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from .launch import play
from .report import OUTCOMES, Launch, by_fault, by_invariant, draw, write
from .scenario import scenario

REPORT = Path("out/campaign.html")


def play_seed(seed: int, library: Path | None = None) -> Launch:
    """Play the launch of a seed."""
    s = scenario(seed)
    return Launch(seed, s.faults, play(s, library=library)[0])


def campaign(seeds: range) -> Iterator[Launch]:
    """Play all, on all cores, as they are done."""
    with multiprocessing.Pool(os.cpu_count()) as pool:
        yield from pool.imap_unordered(play_seed, seeds, chunksize=8)


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


def main() -> int:
    """Play, print, report."""
    parser = argparse.ArgumentParser(prog="./dev campaign", description=__doc__)
    parser.add_argument("--launches", type=int, default=10_000, metavar="N", help="how many")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="the first one's seed")
    parser.add_argument("--replay", type=int, metavar="SEED", help="only this one, with a picture")
    parser.add_argument("--report", type=Path, default=REPORT, metavar="FILE", help="HTML")
    arguments = parser.parse_args()
    if arguments.replay is not None:
        return replay(arguments.replay)

    began = time.monotonic()
    launches = []
    for launch in campaign(range(arguments.seed, arguments.seed + arguments.launches)):
        launches.append(launch)
        if launch.verdict.broken is not None:
            print(launch.summary())
        if len(launches) % 500 == 0:
            print(f"{len(launches)} launches, {time.monotonic() - began:.0f} s", flush=True)
    launches.sort(key=lambda x: x.seed)
    write(arguments.report, launches, f"./dev campaign {shlex.join(sys.argv[1:])}")

    print(f"{'fault':18} {'launches':>9}" + "".join(f"{o:>14}" for o in OUTCOMES))
    for fault, *counts in by_fault(launches):
        print(f"{fault:18} {counts[0]:9}" + "".join(f"{c:14}" for c in counts[1:]))
    broken = 0
    for name, statement, count in by_invariant(launches):
        print(f"{'FAILED' if count else 'ok':7} {name:12} {statement}")
        broken += count
    print(f"{arguments.report}: {len(launches)} launches in {time.monotonic() - began:.0f} s")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
