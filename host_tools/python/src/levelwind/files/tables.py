# SPDX-License-Identifier: Apache-2.0
"""Tables that people make: CSV in any dialect, plain text, XLSX.

A table is read right or refused, with file, line and cell. Nobody can know whether 1.000 is one or
a thousand: that is refused, too.
"""

import codecs
import csv
import math
import os
import re
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

from levelwind.errors import ToolError

XLSX = (".xlsx", ".xlsm")
SAVE_AS = "save it as CSV UTF-8, or as XLSX"
SIZE_MAX_BYTES = 32 * 1024 * 1024
DIGITS_MAX = 18
SHOWN_MAX = 40

Content = str | int | float
Mark = str  # a decimal point or a decimal comma

# What a spreadsheet shows instead of a number, in any language; else # begins a comment.
_FAILED = r"#(?:[A-ZÄÖÜ]+(?:/0)?[!?]|N/A|NV(?!\w)|#+(?=[\"\s]*[;,\t]))"
_CODE = re.compile(rf'(?:[^"#/]|"[^"]*"?|/(?!/)|{_FAILED})*')
_COMMENT = re.compile(rf"//|(?!{_FAILED})#")
_DATA_LINE = re.compile(r"[\s;,\"]*[+-]?[.,]?[0-9]")
_QUOTED = re.compile(r'"[^"]*"')
_SEPARATOR_LINE = re.compile(r'"?sep=([;,|:\t ])"?[;,\s]*', re.IGNORECASE)
_NUMBER = re.compile(r"([+-]?)([0-9]*)(?:([.,])([0-9]*))?([eE][+-]?[0-9]+)?")
_NO_HEADING = re.compile(r"[=#]|\W*\d|[+-]?(?:nan|inf|infinity)$", re.IGNORECASE)


@dataclass(frozen=True)
class Row:
    """A line that is not blank. Cells that are missing at its end count as empty."""

    number: int
    cells: tuple[Content, ...]


@dataclass(frozen=True)
class Table:
    """What a file holds: lines of words above, then lines of values."""

    path: Path
    headings: tuple[Row, ...]
    rows: tuple[Row, ...]
    first_column: int = 0  # columns left of the table, which are empty
    blanks: bool = False  # what stands between the cells

    def place(self, row: Row, column: int | None = None) -> str:
        """Where a row, or one of its cells, stands, as the program shows it that made the file."""
        if column is None:
            return f"{self.path}, line {row.number}"
        if self.path.suffix.lower() in XLSX:
            return f"{self.path}, cell {_letters(self.first_column + column)}{row.number}"
        return f"{self.path}, line {row.number}, column {self.first_column + column + 1}"

    def cell(self, row: Row, column: int) -> Content:
        """What stands in a cell, which must not be empty."""
        content = row.cells[column] if column < len(row.cells) else ""
        if content == "":
            raise ToolError(f"{self.place(row, column)}: the cell is empty; write the number.")
        return content

    def whole_numbers(self, column: int) -> list[int]:
        """The whole numbers of a column, also as 1500.0 or 1500,0."""
        marks = self._marks(column)
        return [self._whole(row, column, marks) for row in self.rows]

    def real_numbers(self, column: int) -> list[float]:
        """The numbers of a column."""
        marks = self._marks(column)
        return [self._real(row, column, marks) for row in self.rows]

    def _marks(self, column: int) -> set[Mark]:
        """What must be the decimal sign in a column, because it cannot be one of thousands."""
        found = set()
        for row in self.rows:
            content = row.cells[column] if column < len(row.cells) else ""
            parts = _NUMBER.fullmatch(content) if isinstance(content, str) else None
            if parts and parts[3] and not _maybe_thousands(parts):
                found.add(parts[3])
        return found

    def _parts(self, row: Row, column: int, marks: set[Mark], kind: str) -> re.Match[str]:
        content = str(self.cell(row, column))
        parts = _NUMBER.fullmatch(content)
        if content.startswith("="):
            self._refuse(
                row, column, "is a formula without a stored result: open and save the file in a "
                "spreadsheet program, or write the number."
            )  # fmt: skip
        if not parts or not (parts[2] or parts[4]):
            self._refuse(row, column, f"is no {kind}: write it as 1500, without separators.")
        if parts[3] and len(marks) == 2:
            self._refuse(
                row, column, "stands in a column with decimal points and decimal commas: use one."
            )
        if parts[3] and marks and parts[3] not in marks:
            self._refuse(
                row, column, f"has a {parts[3]!r} where the column's decimal sign is "
                f"{min(marks)!r}: write it without thousands separators."
            )  # fmt: skip
        return parts

    def _whole(self, row: Row, column: int, marks: set[Mark]) -> int:
        content = self.cell(row, column)
        if isinstance(content, float) and content.is_integer() and abs(content) < 10**DIGITS_MAX:
            return int(content)
        if isinstance(content, int):
            return content
        if isinstance(content, float):
            self._refuse(row, column, "is no whole number: round it.")
        parts = self._parts(row, column, marks, "whole number")
        if _maybe_thousands(parts):
            self._ambiguous(row, column, parts)
        if parts[5]:
            self._refuse(row, column, "is rounded: show all digits of the number, as in 150000.")
        if (parts[4] or "").strip("0") or not parts[2]:
            self._refuse(row, column, "is no whole number: round it.")
        if len(parts[2]) > DIGITS_MAX:
            self._refuse(row, column, f"has more than {DIGITS_MAX} digits: what is it to be?")
        return int(parts[1] + parts[2])

    def _real(self, row: Row, column: int, marks: set[Mark]) -> float:
        content = self.cell(row, column)
        if isinstance(content, str):
            parts = self._parts(row, column, marks, "number")
            if _maybe_thousands(parts) and not marks:
                self._ambiguous(row, column, parts)
            content = float(content.replace(",", "."))
        if not math.isfinite(content):
            self._refuse(row, column, "is no number that can be meant.")
        return float(content)

    def _ambiguous(self, row: Row, column: int, parts: re.Match[str]) -> NoReturn:
        one = f"{parts[1]}{parts[2]}.{parts[4]}".rstrip("0").rstrip(".")
        thousand = f"{parts[1]}{parts[2]}{parts[4]}"
        self._refuse(row, column, f"may be {one} or {thousand}: write {one} or {thousand}.")

    def _refuse(self, row: Row, column: int, why: str) -> NoReturn:
        raise ToolError(f"{self.place(row, column)}: {shown(self.cell(row, column))} {why}")


def shown(content: object) -> str:
    """What stands there, for a message: in quotes, one line, not the length of a page."""
    text = str(content)
    return repr(text if len(text) <= SHOWN_MAX else text[: SHOWN_MAX - 3] + "...")


def _maybe_thousands(parts: re.Match[str]) -> bool:
    """1.000, 12.345, 999,000: three digits behind the sign, one to three before it."""
    return (
        bool(parts[3])
        and len(parts[4]) == 3
        and 1 <= len(parts[2]) <= 3
        and not parts[2].startswith("0")
        and not parts[5]
    )


def read(path: Path) -> Table:
    """The table in a file; ToolError names the line that is wrong."""
    try:
        if path.suffix.lower() in XLSX:
            rows, separator = list(_sheet(path)), ""
        else:
            lines, separator = _taken_apart(read_text(path))
            rows = list(_text(path, lines, separator))
    except OSError as error:
        raise ToolError(f"{path} cannot be read: {error.strerror or error}.") from error
    first = min((_first_used(row) for row in rows), default=0)
    rows = [Row(row.number, row.cells[first:]) for row in rows]
    begin = next((i for i, row in enumerate(rows) if not _is_heading(row)), len(rows))
    return Table(path, tuple(rows[:begin]), tuple(rows[begin:]), first, separator == " ")


def _first_used(row: Row) -> int:
    return next(i for i, content in enumerate(row.cells) if content != "")


def _is_heading(row: Row) -> bool:
    return all(isinstance(c, str) and not _NO_HEADING.match(c) for c in row.cells)


def _row(number: int, cells: Iterable[Content]) -> Row | None:
    """A row without the empty cells at its end; None if nothing is left, or a comment."""
    kept = list(cells)
    while kept and kept[-1] == "":
        kept.pop()
    used = [content for content in kept if content != ""]
    if not used or (len(used) == 1 and isinstance(used[0], str) and _COMMENT.match(used[0])):
        return None
    return Row(number, tuple(kept))


# ---- text ----------------------------------------------------------------------------------------


def read_text(path: Path) -> str:
    """The text of a file in UTF-8, UTF-16 with its mark, or the old Windows encoding.

    Numbers and names that mean something are ASCII: what else the old encodings may hold is only
    shown. May raise OSError.
    """
    with path.open("rb") as file:
        data = file.read(SIZE_MAX_BYTES + 1)
    if len(data) > SIZE_MAX_BYTES:
        raise ToolError(f"{path} is larger than {SIZE_MAX_BYTES // 2**20} MB: is it the right one?")
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = data.decode("utf-16", "replace")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("cp1252", "replace")
    if "\0" in text:
        line = len(_lines(text[: text.index("\0")]))
        raise ToolError(f"{path}, line {line}: a zero byte, so this is no text: {SAVE_AS}.")
    return text


def _lines(text: str) -> list[str]:
    """As an editor counts them."""
    return re.split(r"\r\n|\r|\n", text)


def _taken_apart(text: str) -> tuple[list[str], str]:
    """The lines without comments, and what stands between their cells."""
    lines = _lines(text)
    named = _SEPARATOR_LINE.fullmatch(lines[0])
    if named:
        lines[0] = ""
    lines = [found[0].rstrip() if (found := _CODE.match(line)) else "" for line in lines]
    return lines, named[1] if named else _separator(lines)


def _text(path: Path, lines: list[str], separator: str) -> Iterator[Row]:
    for number, line in enumerate(lines, 1):
        if not line:
            continue
        try:
            (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
        except csv.Error as error:
            raise ToolError(
                f"{path}, line {number}: {shown(line)} cannot be taken apart: {error}. "
                'Is a quote (") not closed?'
            ) from None
        row = _row(number, (cell.strip() for cell in cells))
        if row is not None:
            yield row


def _separator(lines: list[str]) -> str:
    """What stands between the numbers: the first of ; tab , that is there, else blanks."""
    data = [line for line in lines if _DATA_LINE.match(line)] or lines
    text = "\n".join(_QUOTED.sub("", line) for line in data)
    return next((separator for separator in (";", "\t", ",") if separator in text), " ")


# ---- spreadsheets --------------------------------------------------------------------------------


def _sheet(path: Path) -> Iterator[Row]:
    """The first worksheet that is shown. A formula without a stored result gives itself."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what of the workbook is not a cell
            both = zip(_cells(path, results=True), _cells(path, results=False), strict=True)
            rows = [
                [_content(f if v is None else v) for v, f in zip(values, formulas, strict=True)]
                for values, formulas in both
            ]
    except (ToolError, OSError):
        raise
    except Exception as error:  # whatever a broken file makes of the library
        reason = str(error).partition("\n")[0]
        raise ToolError(f"{path} is no XLSX workbook: {reason}. Please {SAVE_AS}.") from error
    for number, cells in enumerate(rows, 1):
        row = _row(number, cells)
        if row is not None:
            yield row


def openpyxl() -> ModuleType:
    """The library for workbooks; half a second that text does not need.

    Without lxml, which it takes where it is there: a full disk is an OSError then, as elsewhere.
    """
    os.environ["OPENPYXL_LXML"] = "False"
    import openpyxl as library  # noqa: PLC0415

    return library


def _cells(path: Path, *, results: bool) -> list[tuple[Any, ...]]:
    book = openpyxl().load_workbook(path, read_only=True, data_only=results)
    sheets = [sheet for sheet in book.worksheets if sheet.sheet_state == "visible"]
    if not sheets:
        raise ToolError(f"{path} has no worksheet: {SAVE_AS}.")
    sheets[0].reset_dimensions()  # what the file says of its size may be wrong
    rows = list(sheets[0].iter_rows(values_only=True))
    book.close()
    width = max(map(len, rows), default=0)
    return [(*row, *(None,) * (width - len(row))) for row in rows]


def _content(value: object) -> Content:
    if value is None:
        return ""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value).strip()
    # The digits that a spreadsheet shows: 0.1 * 3 * 10 is 3 there.
    return float(f"{value:.15g}") if isinstance(value, float) else value


def _letters(column: int) -> str:
    """A column as a spreadsheet names it: A to Z, AA and on."""
    name = ""
    column += 1
    while column:
        column, digit = divmod(column - 1, 26)
        name = chr(ord("A") + digit) + name
    return name
