# SPDX-License-Identifier: Apache-2.0
"""Every source says under which licence it is, in its first lines: SPDX-License-Identifier."""

import sys
from collections.abc import Iterator
from pathlib import Path

from tree import files_of

ROOT = Path(__file__).resolve().parents[2]
LICENSE = "Apache-2.0"
LINE = f"SPDX-License-Identifier: {LICENSE}"
SUFFIXES = {".c": f"/* {LINE} */", ".h": f"/* {LINE} */", ".py": f"# {LINE}", ".sh": f"# {LINE}"}
BY_NAME = {"dev": SUFFIXES[".sh"], "run": SUFFIXES[".sh"]}


def line_of(path: Path) -> str | None:
    """The line that a file must have, None if it is no source. An empty file needs none."""
    return SUFFIXES.get(path.suffix) or BY_NAME.get(path.name)


def has_line(text: str, line: str) -> bool:
    """The line is the first, or stands behind the one that names the interpreter."""
    first, _, rest = text.partition("\n")
    return not text or (rest if first.startswith("#!") else text).startswith(line + "\n")


def sources(root: Path) -> Iterator[tuple[Path, str]]:
    for name in files_of(root):
        path = root / name
        line = line_of(path)
        if line and path.is_file() and not path.is_symlink():
            yield path, line


def main() -> int:
    """Exit status 0: every source has it. With --add, those that lack it get it."""
    lacking = [
        (path, line)
        for path, line in sources(ROOT)
        if not has_line(path.read_text(encoding="utf-8"), line)
    ]
    for path, line in lacking:
        if "--add" in sys.argv[1:]:
            text = path.read_text(encoding="utf-8")
            first, end, rest = text.partition("\n")
            shebang = first + end if first.startswith("#!") else ""
            path.write_text(f"{shebang}{line}\n{rest if shebang else text}", encoding="utf-8")
        else:
            print(f"{path.relative_to(ROOT)} lacks the line `{line}`", file=sys.stderr)
    return 1 if lacking and "--add" not in sys.argv[1:] else 0


if __name__ == "__main__":
    sys.exit(main())
