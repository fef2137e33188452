# SPDX-License-Identifier: Apache-2.0
"""What commands print: JSON for programs, tables for people."""

import csv
import json
import sys
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

from levelwind.line.points import format_value, set_bits
from levelwind.map_table import Flag, LaunchInhibit, Point
from levelwind.show.terminal import say

GAP = 2
INDENT = "    "
LAST_COLUMN_MIN = 20


class _Console(Console):
    """Prints text as it is: brackets are no markup, and no name or path is cut or broken."""

    def print(self, *objects: Any, **options: Any) -> None:
        """As Console.print()."""
        if all(isinstance(text, str) for text in objects):
            options = {"overflow": "ignore", "crop": False, **options}
        super().print(*objects, **options)


# A pipe has no width: its lines are not broken.
_terminal = sys.stdout is not None and sys.stdout.isatty()
console = _Console(highlight=False, markup=False, emoji=False, width=None if _terminal else 100_000)


def warn(text: str) -> None:
    """One line on standard error; the command goes on."""
    say(f"levelwind: {text}")


def print_json(value: object) -> None:
    """One JSON document, and nothing else, on standard output."""
    print(json.dumps(value, indent=2))


def json_value(point: Point, value: int) -> object:
    """A value for JSON: enum names, flags by name, numbers as they are."""
    if point.bits is Flag:
        inside = range(point.bits_from, point.bits_from + 16 * point.words)
        return {bit.label: bool(value >> bit - inside.start & 1) for bit in Flag if bit in inside}
    if point.name == "launch_inhibit":
        return set_bits(LaunchInhibit, value)
    if point.enum is not None:
        return format_value(point, value)
    return bool(value) if point.type == "bit" else value


def print_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """A plain table; columns whose name ends with > are right aligned.

    Names and digits stay whole. Where the terminal is too narrow the last column is broken between
    words; if that is not enough, the last columns go under the others, each with its heading.
    """
    heading = [column.rstrip(">") for column in columns]
    table = [[" ".join(cell.split("\n")) for cell in row] for row in rows]
    widths = [max(map(cell_len, cells)) for cells in zip(heading, *table, strict=True)]
    kept = _columns_that_fit(heading, table, widths)
    right = [column.endswith(">") for column in columns]
    if any(columns):
        for line in _lines(heading[:kept], widths, right):
            console.print(Text(line, style="bold"), overflow="ignore", crop=False, no_wrap=True)
    for row in table:
        for line in [*_lines(row[:kept], widths, right), *_under(heading[kept:], row[kept:])]:
            console.print(line, no_wrap=True)


def _columns_that_fit(heading: list[str], table: list[list[str]], widths: list[int]) -> int:
    """How many columns stand side by side; narrows the last one if that lets all of them."""
    room = console.width - sum(widths[:-1]) - GAP * (len(widths) - 1)
    words = [word for row in table for word in row[-1].split()]
    if room >= min(widths[-1], max(LAST_COLUMN_MIN, *map(cell_len, [heading[-1], *words]))):
        widths[-1] = min(widths[-1], room)
        return len(widths)
    kept = 1
    while sum(widths[: kept + 1]) + GAP * kept <= console.width:
        kept += 1
    return kept


def _lines(cells: list[str], widths: list[int], right: list[bool]) -> Iterator[str]:
    """A row; the last cell may go on in further lines."""
    wrapped = _wrapped(cells[-1], widths[len(cells) - 1])
    for number, last in enumerate(wrapped):
        line = ""
        shown = [*cells[:-1], last] if number == 0 else [*[""] * (len(cells) - 1), last]
        for cell, width, to_the_right in zip(shown, widths, right, strict=False):
            blanks = " " * (width - cell_len(cell))
            line += (blanks + cell if to_the_right else cell + blanks) + " " * GAP
        yield line.rstrip()


def _under(heading: list[str], cells: list[str]) -> Iterator[str]:
    """The columns that have no room beside the others."""
    line = ""
    for name, cell in zip(heading, cells, strict=True):
        item = f"{name}: {cell}" if name else cell
        if not cell:
            continue
        if line and len(INDENT) + cell_len(line) + GAP + cell_len(item) > console.width:
            yield from (INDENT + part for part in _wrapped(line, console.width - len(INDENT)))
            line = ""
        line = f"{line}{' ' * GAP}{item}" if line else item
    if line:
        yield from (INDENT + part for part in _wrapped(line, console.width - len(INDENT)))


def _wrapped(text: str, width: int) -> list[str]:
    """Broken between words, if it must be."""
    if cell_len(text) <= width:
        return [text]
    return textwrap.wrap(
        text, max(width, 1), break_long_words=False, break_on_hyphens=False
    ) or [""]  # fmt: skip


def print_csv(rows: Sequence[Mapping[str, object]]) -> None:
    """Rows with the same keys as CSV on standard output."""
    writer = csv.DictWriter(sys.stdout, rows[0].keys() if rows else ())
    writer.writeheader()
    writer.writerows(rows)
