# SPDX-License-Identifier: Apache-2.0
"""Coverage of branches and conditions (MC/DC) of the core by its unit tests: `./dev coverage`.

clang 19 counts both: each condition must have been true and false, and each condition of a decision
must have been shown to decide it alone. What has not is listed with its reason in exceptions.txt,
and nothing else is.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from reasons import read_reasons

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "mcdc"
CORE = ROOT / "lib" / "lw_core"
EXCEPTIONS = Path(__file__).resolve().parent / "exceptions.txt"
BY_CHANCE = "By chance:"
FOLDERS = ("motion", "control", "modbus", "storage")
CLANG_MIN = 19
NAME_MAX = 100


@dataclass
class Folder:
    """What there is in a folder, and which of it has been seen."""

    branches: dict[str, bool] = field(default_factory=lambda: defaultdict(bool))
    conditions: dict[str, bool] = field(default_factory=lambda: defaultdict(bool))


def tools() -> tuple[str, str, str] | None:
    """clang of the newest version that counts conditions, llvm-profdata and llvm-cov."""
    for version in range(CLANG_MIN + 10, CLANG_MIN - 1, -1):
        clang, *others = [
            shutil.which(f"{name}-{version}") for name in ("clang", "llvm-profdata", "llvm-cov")
        ]
        if clang and all(others) and can_link(clang):
            return (clang, *others)
    return None


def can_link(clang: str) -> bool:
    """The library that counts is a package of its own."""
    command = [clang, "-fprofile-instr-generate", "-x", "c", "-", "-o", os.devnull]
    program = "int main(void) { return 0; }"
    return (
        subprocess.run(
            command, input=program, text=True, capture_output=True, check=False
        ).returncode
        == 0
    )


def call(*command: str | Path, **environment: str) -> str:
    done = subprocess.run(
        command, cwd=ROOT, env=os.environ | environment, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise SystemExit(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def measure(clang: str, profdata: str, cov: str) -> dict:
    """Build, run all unit tests, and have clang's account of the core."""
    call("cmake", "--preset", "mcdc", f"-DCMAKE_C_COMPILER={clang}")
    call("cmake", "--build", "--preset", "mcdc")
    names = sorted(path.stem for path in (ROOT / "tests" / "unit").glob("test_*.c"))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(
            pool.map(
                lambda name: call(BUILD / name, LLVM_PROFILE_FILE=str(BUILD / f"{name}.profraw")),
                names,
            )
        )
    merged = BUILD / "all.profdata"
    call(profdata, "merge", "-sparse", *(BUILD / f"{n}.profraw" for n in names), "-o", merged)
    objects = [option for name in names[1:] for option in ("-object", BUILD / name)]
    sources = [CORE / part / folder for part in ("src", "include/lw") for folder in FOLDERS]
    files = [path for folder in sources if folder.is_dir() for path in folder.iterdir()]
    told = call(
        cov, "export", BUILD / names[0], *objects, "-instr-profile", merged, "-sources", *files
    )
    return json.loads(told)["data"][0]


def text_at(lines: list[str], region: list[int]) -> str:
    """The source of a region, on one line."""
    first, begin, last, end = region[:4]
    if first == last:
        text = lines[first - 1][begin - 1 : end - 1]
    else:
        inside = lines[first : last - 1]
        text = " ".join([lines[first - 1][begin - 1 :], *inside, lines[last - 1][: end - 1]])
    text = " ".join(text.split())
    half = NAME_MAX // 2
    return text if len(text) <= NAME_MAX else f"{text[:half]}...{text[-half:]}"


class Source:
    """A file, and what its regions are called."""

    def __init__(self, path: Path, functions: list[tuple[int, str]]) -> None:
        self.lines = path.read_text().splitlines()
        self.file = f"{path.parent.name}/{path.name}"
        self.functions = functions  # first line and name, in order
        self.places: dict[str, list[list[int]]] = defaultdict(list)

    def name(self, region: list[int]) -> str:
        """The same text may stand in a function more than once: then it has a number."""
        function = [name for line, name in self.functions if line <= region[0]][-1]
        name = f"{self.file}:{function}: {text_at(self.lines, region)}"
        places = self.places[name]
        if region[:4] not in places:
            places.append(region[:4])
        at = places.index(region[:4])
        return f"{name} #{at + 1}" if at else name


def judge(data: dict) -> dict[str, Folder]:
    """Of each folder, which outcomes were seen. A header counts once, wherever it is compiled."""
    functions = sorted(
        (each["filenames"][0], each["regions"][0][0], each["name"].split(":")[-1])
        for each in data["functions"]
    )
    folders = {folder: Folder() for folder in FOLDERS}
    for file in data["files"]:
        path = Path(file["filename"])
        folder = folders[path.parent.name]
        here = [(line, name) for place, line, name in functions if place == file["filename"]]
        source = Source(path, here)
        branches = sorted(file["branches"])
        for region in branches:
            name = source.name(region)
            folder.branches[f"{name} => never true"] |= region[4] > 0
            folder.branches[f"{name} => never false"] |= region[5] > 0
        for *region, _, _, shown in sorted(file["mcdc_records"]):
            name = source.name(region)
            inside = sorted({tuple(b[:4]) for b in branches if is_within(b, region)})
            for number, decides in enumerate(shown):
                said = f"#{number + 1}"
                if len(inside) == len(shown):
                    said = text_at(source.lines, inside[number])
                folder.conditions[f"{name} => not decided by {said}"] |= decides
    return folders


def is_within(region: list[int], outer: list[int]) -> bool:
    return outer[:2] <= region[:2] and region[2:4] <= outer[2:4]


def report(folders: dict[str, Folder]) -> bool:
    """Say what is missing and what is listed in vain. @return whether neither is"""
    exceptions = read_reasons(EXCEPTIONS)
    by_chance = {name for name, reason in exceptions.items() if reason.startswith(BY_CHANCE)}
    missing, known = set(), set()
    for name, folder in folders.items():
        said = []
        for what, outcomes in (("branches", folder.branches), ("conditions", folder.conditions)):
            left = [outcome for outcome, covered in outcomes.items() if not covered]
            missing |= set(left)
            known |= set(outcomes)
            listed = sum(outcome in exceptions for outcome in left)
            said.append(f"{len(outcomes) - len(left)} of {len(outcomes)} {what} ({listed} listed)")
        print(f"{name}: {', '.join(said)}")
    for outcome in sorted(missing - set(exceptions)):
        print(f"no unit test: {outcome}", file=sys.stderr)
    in_vain = set(exceptions) - missing - (by_chance & known)
    for outcome in sorted(in_vain):
        print(f"{EXCEPTIONS.relative_to(ROOT)}: covered, or gone: {outcome}", file=sys.stderr)
    return missing <= set(exceptions) and not in_vain


def main() -> int:
    parser = argparse.ArgumentParser(prog="./dev coverage", description=__doc__)
    parser.add_argument("--can", action="store_true", help="only: is there a clang that can do it?")
    arguments = parser.parse_args()
    found = tools()
    if arguments.can or found is None:
        return found is None
    return not report(judge(measure(*found)))


if __name__ == "__main__":
    sys.exit(main())
