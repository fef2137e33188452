# SPDX-License-Identifier: Apache-2.0
"""The rooms of the repository and the arrows between them, as rooms.yaml allows them.

An arrow goes from a file to another whose header it includes, whose module it imports, or in which
a function stands that it names. Two things are wrong: an arrow that rooms.yaml does not allow, and
a circle of files, also within a room. A header stands below the C files that it speaks of.
"""

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import yaml
from told import tell

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "host_tools/python/src/levelwind"
C_FOLDERS = ("lib", "drivers", "include/lw", "sim", "app", "host_tools/c")

COMMENT_OR_TEXT = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"", re.DOTALL)
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]+[<\"]([^>\"]+)[>\"]", re.MULTILINE)
# A definition begins in the first column; what stands before the name may span lines.
DEFINITION = re.compile(
    r"^(?!typedef\b|struct\s+\w+\s*\{|enum\b|else\b|#)([A-Za-z_][\w \t*]*?)\b(\w+)"
    r"\(([^;{}]*)\)\s*\{",
    re.MULTILINE,
)
# To declare a function is not to lean on it.
DECLARATION = re.compile(
    r"^(?!typedef\b|return\b|#)[A-Za-z_][\w \t*]*?\b(\w+)\([^;{}]*\)[^;{}]*;", re.MULTILINE
)
# A member of a struct, an enumeration or a struct may have the name of a function.
NAME = re.compile(r"(?<![\w.>])(?<!enum )(?<!struct )([A-Za-z_]\w*)")


@dataclass(frozen=True)
class Arrow:
    """One file leans on another: on which, by which name."""

    source: str
    target: str
    name: str

    def __str__(self) -> str:
        return f"{self.source} -> {self.target} ({self.name})"


@dataclass
class Room:
    """A room, the files in it, and the rooms that it may use."""

    name: str
    files: list[str]
    uses: list[str]


@dataclass
class Rooms:
    """A list of rooms, the lowest first."""

    rooms: list[Room]
    problems: list[str] = field(default_factory=list)

    @staticmethod
    def of(entries: Iterable[dict]) -> "Rooms":
        result = Rooms([])
        for entry in entries:
            room = Room(entry["room"], entry["files"], entry["uses"])
            below = [lower.name for lower in result.rooms]
            for used in room.uses:
                if used not in below:
                    result.problems.append(
                        f"rooms.yaml: {room.name} uses {used}, which does not stand before it"
                    )
            result.rooms.append(room)
        return result

    def room_of(self, path: str) -> Room | None:
        def depth(room: Room) -> int:
            fitting = [f for f in room.files if path == f or path.startswith(f + "/")]
            return max(map(len, fitting), default=-1)

        found = max(self.rooms, key=depth)
        return found if depth(found) >= 0 else None


def without_comments(text: str) -> str:
    return COMMENT_OR_TEXT.sub(
        lambda found: '""' if found[0].startswith('"') else "\n" * found[0].count("\n") or " ", text
    )


def definitions(path: str, text: str) -> Iterator[str]:
    """The functions of a C file that others can name; `text` without comments."""
    for found in DEFINITION.finditer(text):
        if path.endswith(".h") or "static" not in found[1].split():
            yield found[2]


def included(path: str, name: str, files: Iterable[str]) -> str | None:
    """The file of this repository that an #include means, None for others'."""
    beside = f"{path.rpartition('/')[0]}/{name}"
    if beside in files:
        return beside
    return next(
        (f for f in files if f.endswith((f"/include/{name}", f"/generated/{name}"))),
        f"include/{name}" if f"include/{name}" in files else None,
    )


def c_arrows(files: dict[str, str]) -> Iterator[Arrow]:
    """All arrows between C files, by path and text. Other than a path's name nothing is read."""
    bare = {path: without_comments(text) for path, text in files.items()}
    homes: dict[str, set[str]] = {}
    for path, text in bare.items():
        for name in definitions(path, text):
            homes.setdefault(name, set()).add(path)
    for path, text in files.items():
        for found in INCLUDE.finditer(text):
            target = included(path, found[1], files)
            if target:
                yield Arrow(path, target, f'#include "{found[1]}"')
        named = dict.fromkeys(NAME.findall(bare[path]))
        own = local_functions(bare[path]) | set(DECLARATION.findall(bare[path]))
        for name in named:
            # A function that stands in several files (a driver for each board) is nobody's.
            if name in homes and len(homes[name]) == 1 and name not in own:
                yield Arrow(path, *homes[name], name + "()")


def local_functions(text: str) -> set[str]:
    return {found[2] for found in DEFINITION.finditer(text)}


def python_arrows(files: dict[str, str], package: str) -> Iterator[Arrow]:
    """All arrows between the modules of a package, by path within it and text."""

    def file_of(module: list[str]) -> str | None:
        path = "/".join(module)
        return next((f for f in (f"{path}.py", f"{path}/__init__.py") if f in files), None)

    for path, text in files.items():
        folder = path.split("/")[:-1]
        for node in ast.walk(ast.parse(text)):
            modules: list[tuple[list[str], str]] = []
            if isinstance(node, ast.Import):
                modules = [(alias.name.split("."), "") for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                base = [package, *folder][: len(folder) + 2 - node.level] if node.level else []
                base += node.module.split(".") if node.module else []
                modules = [(base, alias.name) for alias in node.names]
            for module, name in modules:
                if module[0] != package:
                    continue
                target = file_of([*module[1:], name]) or file_of(module[1:])
                if target and target != path:
                    yield Arrow(path, target, f"import {'.'.join(module)} {name}".strip())


def circles(arrows: Iterable[Arrow]) -> list[list[Arrow]]:
    """Groups of files of which each leads to every other: the arrows within each group."""
    arrows = list(arrows)
    after: dict[str, set[str]] = {}
    for arrow in arrows:
        after.setdefault(arrow.source, set()).add(arrow.target)

    def reach(start: str) -> set[str]:
        seen: set[str] = set()
        rest = [start]
        while rest:
            for following in after.get(rest.pop(), ()):
                if following not in seen:
                    seen.add(following)
                    rest.append(following)
        return seen

    reached = {name: reach(name) for name in after}
    groups = {
        frozenset(other for other in reached[name] if name in reached.get(other, ()))
        for name in after
        if name in reached[name]
    }
    return [
        [arrow for arrow in arrows if arrow.source in group and arrow.target in group]
        for group in sorted(groups, key=sorted)
    ]


def problems(rooms: Rooms, files: Iterable[str], arrows: Iterable[Arrow]) -> Iterator[str]:
    """All that is wrong, one line each."""
    yield from rooms.problems
    for path in files:
        if rooms.room_of(path) is None:
            yield f"{path} stands in no room of rooms.yaml"
    arrows = list(dict.fromkeys(arrows))
    for arrow in arrows:
        source, target = rooms.room_of(arrow.source), rooms.room_of(arrow.target)
        if source and target and source is not target and target.name not in source.uses:
            yield f"{arrow}: {source.name} may not use {target.name}"
    for circle in circles(arrows):
        shown: dict[tuple[str, str], list[Arrow]] = {}
        for arrow in circle:
            shown.setdefault((arrow.source, arrow.target), []).append(arrow)
        lines = [
            str(some[0]) + f" and {len(some) - 1} more" * (len(some) > 1) for some in shown.values()
        ]
        yield "a circle:\n    " + "\n    ".join(lines)


def read(folder: Path, paths: Iterable[Path]) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text(encoding="utf-8") for p in sorted(paths)}


def check(root: Path) -> Iterator[str]:
    """All that is wrong in a tree with this repository's folders."""
    allowed = yaml.safe_load((root / "tests/lint/rooms.yaml").read_text(encoding="utf-8"))
    c_files = read(root, (p for f in C_FOLDERS for p in (root / f).rglob("*.[ch]")))
    yield from problems(Rooms.of(allowed["c"]), c_files, c_arrows(c_files))
    package = root / PACKAGE
    modules = read(package, package.rglob("*.py"))
    yield from problems(Rooms.of(allowed["python"]), modules, python_arrows(modules, package.name))


if __name__ == "__main__":
    sys.exit(tell(check(ROOT)))
