"""What commands print: JSON for programs, tables for people."""

import csv
import json
import sys
from collections.abc import Iterable, Mapping, Sequence

from rich.console import Console
from rich.table import Table

from levelwind.map_table import Flag, LaunchInhibit, Point
from levelwind.points import format_value, set_bits

# A pipe has no width: do not cut its lines at 80 columns.
console = Console(highlight=False, width=None if sys.stdout.isatty() else 140)


def warn(text: str) -> None:
    """One line on standard error; the command goes on."""
    print(f"levelwind: {text}", file=sys.stderr)


def print_json(value: object) -> None:
    """One JSON document, and nothing else, on standard output."""
    print(json.dumps(value, indent=2))


def json_value(point: Point, value: int) -> object:
    """A value for JSON: enum names, flags by name, numbers as they are."""
    if point.name == "flags":
        return {bit.label: bool(value >> bit & 1) for bit in Flag}
    if point.name == "launch_inhibit":
        return set_bits(LaunchInhibit, value)
    if point.enum is not None:
        return format_value(point, value)
    return bool(value) if point.type == "bit" else value


def print_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """A plain table; columns whose name ends with > are right aligned."""
    table = Table(box=None, pad_edge=False, show_header=any(columns))
    for column in columns:
        table.add_column(column.rstrip(">"), justify="right" if column.endswith(">") else "left")
    for row in rows:
        table.add_row(*row)
    console.print(table)


def print_csv(rows: Sequence[Mapping[str, object]]) -> None:
    """Rows with the same keys as CSV on standard output."""
    writer = csv.DictWriter(sys.stdout, rows[0].keys() if rows else ())
    writer.writeheader()
    writer.writerows(rows)
