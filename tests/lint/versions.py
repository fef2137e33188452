# SPDX-License-Identifier: Apache-2.0
"""One version number: everything that states it states the same."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

from told import tell

ROOT = Path(__file__).resolve().parents[2]

# Where it stands, and how it looks there. The first is the source; the map's files are generated.
PLACES = (
    ("modbus_map/registers.yaml", r"^  version: \{major: (\d+), minor: (\d+), patch: (\d+)\}"),
    ("lib/lw_core/generated/lw/map.h", r"LW_VERSION_STRING \"(.+)\""),
    ("host_tools/python/src/levelwind/map_table.py", r"^PRODUCT_VERSION = \"(.+)\""),
    ("host_tools/python/pyproject.toml", r"^version = \"(.+)\""),
    ("app/VERSION", r"VERSION_MAJOR = (\d+)\nVERSION_MINOR = (\d+)\nPATCHLEVEL = (\d+)"),
    ("CHANGELOG.md", r"^## \[(\d+\.\d+\.\d+)\]"),
)


def stated(root: Path) -> Iterator[tuple[str, str]]:
    """Each place with the version that it states, "" for none."""
    for file, pattern in PLACES:
        found = re.search(pattern, (root / file).read_text(encoding="utf-8"), re.MULTILINE)
        yield file, ".".join(found.groups()) if found else ""


def problems(root: Path) -> list[str]:
    """What differs from the first place."""
    (source, version), *others = stated(root)
    return [
        f"{file} states version {other or 'none'}, {source} {version}"
        for file, other in others
        if other != version or not version
    ]


if __name__ == "__main__":
    sys.exit(tell(problems(ROOT)))
