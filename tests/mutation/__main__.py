# SPDX-License-Identifier: Apache-2.0
"""Mutation testing of the core: `./dev mutate`, and a fixed sample of it in `./dev test`.

One build of the unit tests holds all mutants (mutants.py). Each test runs once and notes which
mutants would have changed anything in it; then each mutant runs those tests alone, the fastest
first, until one fails. tests/README.md says what to do with one that survives.
"""

import argparse
import hashlib
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from reasons import read_reasons

from .mutants import Mutant, write_mutants

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
BUILD = ROOT / "build" / "mutate"
CORE = ROOT / "lib" / "lw_core"
REPORT = ROOT / "out" / "mutation.txt"
FOLDERS = ["motion", "control", "modbus"]
SCORE_MIN_PERCENT = 95
SAMPLE_SIZE = 200
# A mutant counts as endless after so many times a test's own processor time, and this.
LIMIT_FACTOR = 4
LIMIT_SPARE_MS = 200
SAMPLE = HERE / "sample.txt"
SAMPLE_HEAD = """\
# The mutants that ./dev test runs, one a line. Made by ./dev mutate --renew-sample: those that
# still exist and are killed stay, the others are replaced.
"""
EQUIVALENT = HERE / "equivalent.txt"


@dataclass
class Test:
    """One test of one program."""

    program: Path
    name: str
    cpu_ms: float
    notices: set[str]  # "site,variant" of the mutants that would change anything in it

    def fails_on(self, mutant: Mutant) -> bool:
        limit_ms = str(LIMIT_FACTOR * round(self.cpu_ms) + LIMIT_SPARE_MS)
        here = {"LW_MUTATION": mutant.switch, "LW_MUTATION_TEST": self.name}
        here["LW_MUTATION_LIMIT_MS"] = limit_ms
        # Twice: a test that edges interrupt may fail from the load of the machine alone.
        return run(self.program, here) != 0 and run(self.program, here) != 0


def run(program: Path, environment: dict[str, str]) -> int:
    """Run a program of tests, silently; its exit status."""
    # Without the copy of this process that subprocess makes: a mutant may take a millisecond.
    silence = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0), (os.POSIX_SPAWN_DUP2, 1, 2)]
    pid = os.posix_spawn(program, [program], os.environ | environment, file_actions=silence)
    return os.waitpid(pid, 0)[1]


def observe(program: Path, sites: str) -> list[Test]:
    """Run tests on the original, and see what they notice of some sites."""
    notes = BUILD / f"{program.name}.notes"
    if run(program, {"LW_MUTATION": str(notes), "LW_MUTATION_SITES": sites}) != 0:
        raise SystemExit(f"{program.name} fails without any mutant: ./dev unit {program.name}")
    tests = []
    for line in notes.read_text().splitlines():
        name, cpu_us, *switches = line.split(" ")
        tests.append(Test(program, name, int(cpu_us) / 1000, set(switches)))
    return tests


def killer(mutant: Mutant, tests: list[Test]) -> Test | None:
    """Which test fails on a mutant, if one does. `tests`: the fastest first."""
    noticing = (test for test in tests if mutant.switch in test.notices)
    return next((test for test in noticing if test.fails_on(mutant)), None)


def build() -> list[Mutant]:
    """All mutants, and the programs that hold them."""
    mutants = write_mutants(CORE, BUILD / "lw_core", FOLDERS)
    for command in (["cmake", "--preset", "mutate"], ["cmake", "--build", "--preset", "mutate"]):
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(done.stdout + done.stderr)
    return mutants


def judge(mutants: list[Mutant]) -> dict[str, Test | None]:
    """The killer of each mutant."""
    sources = sorted((ROOT / "tests" / "unit").glob("test_*.c"))
    sites = ",".join({mutant.switch.split(",")[0] for mutant in mutants})
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        of_programs = pool.map(lambda source: observe(BUILD / source.stem, sites), sources)
        tests = sorted((t for tests in of_programs for t in tests), key=lambda test: test.cpu_ms)
        killers: dict[str, Test | None] = {}
        found = pool.map(lambda mutant: (mutant.name, killer(mutant, tests)), mutants)
        for name, test in found:
            killers[name] = test
            if sys.stderr.isatty():
                print(f"\r{len(killers)} of {len(mutants)}", end="\r", file=sys.stderr)
    return killers


# ---- the lists -----------------------------------------------------------------------------------


def read_sample() -> list[str]:
    lines = SAMPLE.read_text().splitlines() if SAMPLE.exists() else []
    return [line for line in lines if line and not line.startswith("#")]


def renew_sample(mutants: list[Mutant]) -> None:
    """A sample of mutants that are killed: those of the old one first, others by chance."""
    equivalent = read_reasons(EQUIVALENT)
    order = dict.fromkeys(read_sample(), "")
    candidates = [mutant for mutant in mutants if mutant.name not in equivalent]
    candidates.sort(
        key=lambda m: order.get(m.name, hashlib.sha256(m.name.encode()).hexdigest()),
    )
    killers = judge(candidates[: SAMPLE_SIZE + SAMPLE_SIZE // 4])
    killed = [name for name, test in killers.items() if test][:SAMPLE_SIZE]
    SAMPLE.write_text(SAMPLE_HEAD + "".join(f"{name}\n" for name in sorted(killed)))
    print(
        f"{len(killed)} mutants in {SAMPLE.relative_to(ROOT)}, {len(set(killed) - set(order))} new"
    )


def run_sample(mutants: list[Mutant]) -> int:
    """Does every mutant of the sample still exist, and is it killed?"""
    named = {mutant.name: mutant for mutant in mutants}
    sample = read_sample()
    gone = [name for name in sample if name not in named]
    for name in gone:
        print(f"{SAMPLE.relative_to(ROOT)}: no such mutant any more: {name}", file=sys.stderr)
    if gone or len(sample) != SAMPLE_SIZE:
        print(
            f"{len(sample) - len(gone)} of {SAMPLE_SIZE} mutants of the sample exist."
            " If the code was changed on purpose, ./dev mutate --renew-sample replaces the others.",
            file=sys.stderr,
        )
        return 1
    killers = judge([named[name] for name in sample])
    return tell_survivors([named[name] for name, test in killers.items() if test is None])


def tell_survivors(survivors: list[Mutant]) -> int:
    for mutant in survivors:
        place = f"{mutant.file.relative_to(ROOT)}:{mutant.line}"
        print(f"{place}: no unit test fails on: {mutant.name}", file=sys.stderr)
    return len(survivors) > 0


def run_all(mutants: list[Mutant], pattern: str) -> int:
    """All mutants, or those whose name matches: the score of each folder, and its survivors."""
    equivalent = read_reasons(EQUIVALENT)
    chosen = [mutant for mutant in mutants if re.search(pattern, mutant.name)]
    if not chosen:
        raise SystemExit(f"no mutant's name matches '{pattern}'")
    killers = judge(chosen)
    REPORT.parent.mkdir(exist_ok=True)
    with REPORT.open("w") as report:
        for mutant in chosen:
            test = killers[mutant.name]
            by = f"{test.program.name}: {test.name}" if test else "SURVIVED"
            if not test and mutant.name in equivalent:
                by = f"equivalent: {equivalent[mutant.name]}"
            print(mutant.name, by, sep="\t", file=report)
    survivors = [m for m in chosen if not killers[m.name] and m.name not in equivalent]
    failed = False
    tell_survivors(survivors)
    for folder in FOLDERS:
        names = [mutant.name for mutant in chosen if mutant.folder == folder]
        killed = sum(killers[name] is not None for name in names)
        judged = killed + sum(mutant.folder == folder for mutant in survivors)
        if judged:
            score = 100 * killed / judged
            failed |= score < SCORE_MIN_PERCENT
            print(
                f"{folder}: {killed} of {judged} killed, {score:.1f} %;"
                f" {len(names) - judged} equivalent"
            )
    for name in equivalent:
        wrong = "is killed" if killers.get(name) else ""
        if name not in {mutant.name for mutant in mutants}:
            wrong = "does not exist"
        if wrong:
            print(f"{EQUIVALENT.relative_to(ROOT)}: {wrong}: {name}", file=sys.stderr)
            failed = True
    print(f"Which test kills which mutant: {REPORT.relative_to(ROOT)}")
    return int(failed)


def main() -> int:
    parser = argparse.ArgumentParser(prog="./dev mutate", description=__doc__)
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "pattern", nargs="?", default="", help="part of a name, a regular expression"
    )
    which.add_argument("--sample", action="store_true", help="the fixed sample alone")
    which.add_argument("--renew-sample", action="store_true", help="replace what is gone from it")
    arguments = parser.parse_args()
    mutants = build()
    if arguments.sample:
        return run_sample(mutants)
    if arguments.renew_sample:
        renew_sample(mutants)
        return 0
    return run_all(mutants, arguments.pattern)


if __name__ == "__main__":
    sys.exit(main())
