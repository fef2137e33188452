# SPDX-License-Identifier: Apache-2.0
"""YAML files that people write: a value is the text that stands there, mistakes name the line.

YAML has rules of its own for numbers, by version: 012000 is octal 5120, 1:30 is 90, 8E1 is 80.0. So
here a value is text, and whoever wants a number of it reads it as on the command line.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml

from levelwind.errors import ToolError
from levelwind.files.tables import read_text

_NULL, _MERGE = "tag:yaml.org,2002:null", "tag:yaml.org,2002:merge"


class Text(str):
    """A scalar, and the line it stands in."""

    __slots__ = ("line",)
    line: int


class LineError(ToolError):
    """A mistake in a value of a file."""

    def __init__(self, line: int, text: str) -> None:
        super().__init__(text)
        self.line = line


@contextmanager
def at(text: object) -> Iterator[None]:
    """What is wrong with this key or value is told with its line."""
    try:
        yield
    except LineError:
        raise
    except ToolError as error:
        if not isinstance(text, Text):
            raise
        raise LineError(text.line, str(error)) from None


class _Loader(yaml.SafeLoader):
    """Text, null, lists, and mappings in which no name stands twice."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        first_lines: dict[str, int] = {}
        for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
            line = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                raise LineError(line, "a name must be one word.")
            if key.tag == _NULL:
                raise LineError(line, "a name is missing before the colon.")
            if key.tag != _MERGE and key.value in first_lines:
                raise LineError(
                    line, f"{key.value} stands twice, first in line {first_lines[key.value]}: "
                    "leave one of them."
                )  # fmt: skip
            first_lines[key.value] = line
        return super().construct_mapping(node, deep)


def _text(loader: _Loader, node: yaml.ScalarNode) -> Text:
    text = Text(loader.construct_scalar(node))
    text.line = node.start_mark.line + 1
    return text


_Loader.yaml_implicit_resolvers = {
    first: [(tag, form) for tag, form in resolvers if tag in (_NULL, _MERGE)]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
# No sets, no bytes, no dates: a file says them in words.
_Loader.yaml_constructors = {
    tag: yaml.SafeLoader.yaml_constructors[tag]
    for tag in (_NULL, "tag:yaml.org,2002:seq", "tag:yaml.org,2002:map", None)
}
for _tag in ("str", "int", "float", "bool", "timestamp"):  # all but the first only if written out
    _Loader.add_constructor(f"tag:yaml.org,2002:{_tag}", _text)


class _Dumper(yaml.SafeDumper):
    """Quotes what any version of YAML would take for a number."""


def _quoted(dumper: _Dumper, text: str) -> yaml.ScalarNode:
    style = "'" if re.match(r"[-+.]?[0-9]", text) else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style)


_Dumper.add_representer(str, _quoted)


def load(path: Path) -> object:
    """The document in a YAML file."""
    try:
        return yaml.load(read_text(path), _Loader)
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.") from error
    except LineError as error:
        raise placed(path, error) from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f", line {mark.line + 1}" if mark else ""
        raise ToolError(f"{path}{place}: {error.problem or error.context}.") from error
    except yaml.reader.ReaderError as error:
        raise ToolError(
            f"{path}: the character {error.character:#04x} is none of a text: save it as UTF-8."
        ) from error
    except RecursionError:
        raise ToolError(f"{path}: brackets within brackets without end.") from None


def placed(path: Path, error: ToolError) -> ToolError:
    """A mistake with its file, and its line if that is known."""
    line = f", line {error.line}" if isinstance(error, LineError) else ""
    return ToolError(f"{path}{line}: {error}")


def dump(document: object) -> str:
    """A document that load() reads, and every other reader of YAML."""
    return yaml.dump(document, Dumper=_Dumper, sort_keys=False, allow_unicode=True)
