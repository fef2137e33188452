# SPDX-License-Identifier: Apache-2.0
"""Lists of names with reasons: a name on a line, and indented below it the reason for it.

Names in a row share the reason below them. Lines that begin with # are comments.
"""

from pathlib import Path


def read_reasons(path: Path) -> dict[str, str]:
    """The reason of each name; a name without one ends the program."""
    reasons: dict[str, str] = {}
    names: list[str] = []
    for line in path.read_text().splitlines():
        if line.startswith("  "):
            reasons |= {name: f"{reasons.get(name, '')} {line.strip()}".strip() for name in names}
        elif line and not line.startswith("#"):
            if names and names[-1] in reasons:
                names = []
            names.append(line)
    if names and names[-1] not in reasons:
        raise SystemExit(f"{path}: no reason below '{names[-1]}'")
    return reasons
