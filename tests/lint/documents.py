# SPDX-License-Identifier: Apache-2.0
"""What documents name must be there: files, folders, functions, `./dev` commands, local links.

A path may be given from the root, or from a folder that the sentence is about (`motion/law.c` of
the core): it is there if some file's path ends with it.
"""

import os
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from told import tell
from tree import files_of

ROOT = Path(__file__).resolve().parents[2]

CODE = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
DEV = re.compile(r"(?:^|[\s`])\./dev ([a-z]+)")
# A source's name alone, or a path with a folder in it; of other names alone a user's own are most.
FILE = re.compile(
    r"(?:[\w*-]+\.(?:c|h|py|md|sh|cmake)"
    r"|(?:[\w.*-]+/)+[\w*-]+\.(?:c|h|py|md|yaml|yml|json|toml|sh|cmake|html|png|svg))"
)
FOLDER = re.compile(r"(?:[\w.-]*[A-Za-z_][\w.-]*/)+(?:[\w.-]*[A-Za-z_][\w.-]*)?")
# A function of this repository, or of what it uses: some source names it.
FUNCTION = re.compile(r"(?:(\w+)\(\)|((?:lw|LW)_\w+))")
NAME = re.compile(r"[A-Za-z_]\w*")
SOURCES = (".c", ".h", ".py", ".js", ".html", ".yaml", ".conf", ".cmake", ".txt", "Kconfig")
# What is made by running something is not there yet.
MADE = ("out/", "build/", "/", "~", "../", ".venv")
PLACEHOLDER = re.compile(r"[A-Z]{4,}|\.\.\.|<|FILE|NAME")


class Tree:
    """The files of a repository, what their paths end with, and the names that sources hold."""

    def __init__(self, files: Iterable[str], names: Iterable[str] = ()) -> None:
        self.names = frozenset(names)
        self.ends: set[str] = set()
        for file in files:
            parts = file.split("/")
            stem = re.sub(r"\.\w+$", "", parts[-1])
            for begin in range(len(parts)):
                self.ends.add("/".join(parts[begin:]))
                self.ends.add("/".join([*parts[begin:-1], stem]))
                for end in range(begin + 1, len(parts)):
                    self.ends.add("/".join(parts[begin:end]))

    def has(self, path: str) -> bool:
        path = path.rstrip("/")
        if "*" not in path:
            return path in self.ends
        pattern = re.compile(re.escape(path).replace(r"\*", r"[^/]*"))
        return any(pattern.fullmatch(end) for end in self.ends)


def named_paths(text: str) -> Iterator[str]:
    """The paths that a document names as code, without braces and arguments."""
    for found in CODE.finditer(text):
        for word in re.split(r"[\s;]+|,(?![^{]*\})", found[1]):
            match = re.fullmatch(r"(.*)\{([^}]*)\}(.*)", word)
            if match:
                yield from (match[1] + part + match[3] for part in match[2].split(","))
            else:
                yield word.split("::")[0].rstrip(":")


def problems(document: str, text: str, tree: Tree, commands: Iterable[str]) -> Iterator[str]:
    """What a document names that is not there."""
    in_blocks = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    for name in dict.fromkeys(named_paths(in_blocks)):
        if name.startswith(MADE) or PLACEHOLDER.search(name):
            continue
        path = name.removeprefix("./")
        folder = FOLDER.fullmatch(path) and (path.endswith("/") or tree.has(path.split("/")[0]))
        if (folder or FILE.fullmatch(path)) and not tree.has(path):
            yield f"{document}: `{path}` is not there"
        function = FUNCTION.fullmatch(name)
        if function and (function[1] or function[2]) not in tree.names:
            yield f"{document}: `{name}` stands in no source"
    for found in LINK.finditer(in_blocks):
        is_local = "://" not in found[1] and not found[1].startswith("mailto:")
        if is_local and not tree.has(os.path.normpath(Path(document).parent / found[1])):
            yield f"{document}: the link to {found[1]} leads nowhere"
    for found in DEV.finditer(text):
        if found[1] not in commands:
            yield f"{document}: `./dev {found[1]}` is no command"


def check(root: Path) -> Iterator[str]:
    files = list(files_of(root))
    sources = [root / file for file in files if file.endswith(SOURCES) and (root / file).is_file()]
    names = {name for path in sources for name in NAME.findall(path.read_text(encoding="utf-8"))}
    tree = Tree(files, names)
    commands = re.findall(r"^cmd_(\w+)\(\)", (root / "dev").read_text(encoding="utf-8"), re.M)
    for file in files:
        if file.endswith(".md") and file != "CHANGELOG.md" and (root / file).is_file():
            yield from problems(file, (root / file).read_text(encoding="utf-8"), tree, commands)


if __name__ == "__main__":
    sys.exit(tell(check(ROOT)))
