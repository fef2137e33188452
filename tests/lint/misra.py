# SPDX-License-Identifier: Apache-2.0
"""The core against MISRA C:2012, by cppcheck's addon: what doc/misra.md does not deviate from.

A rule that is broken and has no deviation is an error, and so is a deviation that nothing needs.
The table of deviations is of one version of cppcheck: others find more, or less.
"""

import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from told import tell

ROOT = Path(__file__).resolve().parents[2]
DEVIATIONS = "doc/misra.md"
ROW = re.compile(r"^\| D\d+ \| ([\d., ]+) \|", re.M)
FOUND = re.compile(r"^(\S+:\d+): misra-c2012-(\d+\.\d+)$", re.M)
CACHE = "build/misra"


def deviations(text: str) -> set[str]:
    """The rules that the document deviates from."""
    return {rule.strip() for row in ROW.findall(text) for rule in row.split(",")}


def problems(found: Iterable[tuple[str, str]], deviated: set[str]) -> Iterator[str]:
    """What is wrong, of the places at which a rule is broken."""
    broken = set()
    for place, rule in found:
        broken.add(rule)
        if rule not in deviated:
            yield f"{place}: MISRA C:2012 rule {rule}, from which {DEVIATIONS} does not deviate"
    for rule in sorted(deviated - broken):
        yield f"{DEVIATIONS}: rule {rule} is kept: nothing needs the deviation"


def broken_rules(cache: Path, *paths: str) -> list[tuple[str, str]]:
    """Place and rule, once each: a header is seen from many sources. What has not changed is not
    looked at again: the cache knows."""
    cache.mkdir(parents=True, exist_ok=True)
    command = [
        *("cppcheck", "--addon=misra", "--enable=style", "--std=c11", "--quiet", "-j2"),
        *(f"--cppcheck-build-dir={cache}", "--template={file}:{line}: {id}"),
        *("-I", "lib/lw_core/include", "-I", "lib/lw_core/generated", *paths),
    ]
    run = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT)
    return sorted({(place, rule) for place, rule in FOUND.findall(run.stderr)})


def check(root: Path) -> Iterator[str]:
    """What is wrong with the core."""
    deviated = deviations((root / DEVIATIONS).read_text(encoding="utf-8"))
    found = broken_rules(root / CACHE, "lib/lw_core/src", "lib/lw_core/generated")
    yield from problems(found, deviated)


if __name__ == "__main__":
    sys.exit(tell(check(ROOT)))
