"""Files of cam tables: text and CSV of two columns (a row number before them is skipped), XLSX."""

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from zipfile import BadZipFile

from levelwind.errors import ToolError

SEPARATORS = re.compile(r"[\s,;]+")
XLSX = (".xlsx", ".xlsm")
COLUMNS = ("master", "slave")


def read(path: Path) -> tuple[tuple[int, int], ...]:
    """The rows (master, slave) of a file; ToolError names the line that is wrong."""
    try:
        lines = _sheet(path) if path.suffix.lower() in XLSX else _text(path)
        rows = tuple(_rows(path, lines))
    except OSError as error:
        raise ToolError(f"{path} cannot be read: {error.strerror or error}.") from error
    if not rows:
        raise ToolError(f"{path} has no rows: two columns are wanted, master and slave.")
    return rows


def write(path: Path, rows: Iterable[Sequence[int]], comments: Sequence[str] = ()) -> None:
    """A file that read() reads; the suffix says whether it is XLSX, CSV or plain text."""
    try:
        if path.suffix.lower() in XLSX:
            _write_sheet(path, rows)
            return
        separator = "," if path.suffix.lower() == ".csv" else "\t"
        lines = [f"# {comment}" for comment in comments]
        lines += [separator.join(COLUMNS), *(separator.join(map(str, row)) for row in rows)]
        path.write_text("\n".join(lines) + "\n")
    except OSError as error:
        raise ToolError(f"{path} cannot be written: {error.strerror or error}.") from error


def _text(path: Path) -> Iterator[list[str]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ToolError(f"{path} is no text: {error}.") from error
    for line in text.splitlines():
        content = line.split("#")[0].strip()
        yield [cell.strip("\"'") for cell in SEPARATORS.split(content)] if content else []


def _sheet(path: Path) -> Iterator[list[str]]:
    from openpyxl import load_workbook  # noqa: PLC0415 - half a second that text does not need
    from openpyxl.utils.exceptions import InvalidFileException  # noqa: PLC0415

    try:
        book = load_workbook(path, read_only=True, data_only=True)
    except (InvalidFileException, KeyError, ValueError, BadZipFile) as error:
        raise ToolError(f"{path} is no XLSX workbook: {error}.") from error
    for row in book.active.iter_rows(values_only=True):
        yield [str(cell) for cell in row if cell is not None]
    book.close()


def _write_sheet(path: Path, rows: Iterable[Sequence[int]]) -> None:
    from openpyxl import Workbook  # noqa: PLC0415

    book = Workbook()
    book.active.append(COLUMNS)
    for row in rows:
        book.active.append(list(row))
    book.save(path)


def _rows(path: Path, lines: Iterable[list[str]]) -> Iterator[tuple[int, int]]:
    """Rows of numbers; words are a heading before the first of them, and wrong after it."""
    columns = 0
    for number, cells in enumerate(lines, 1):
        if not cells:
            continue
        values = [_number(cell) for cell in cells]
        if columns == 0 and None in values:
            continue
        where = f"{path}, line {number}: {' '.join(cells)!r}"
        columns = columns or len(values)
        if columns not in (2, 3) or len(values) != columns:
            raise ToolError(
                f"{where} has {len(values)} columns, limit {columns if columns in (2, 3) else 3}: "
                "master and slave, or row number, master and slave, the same in every line."
            )
        master, slave = values[-2:]
        if master is None or slave is None:
            raise ToolError(f"{where}: master and slave must be whole numbers.")
        yield master, slave


def _number(cell: str) -> int | None:
    """A whole number, also as a spreadsheet may write it: 1500.0."""
    try:
        value = float(cell)
        return int(cell) if cell.lstrip("+-").isdigit() else int(value) if value % 1 == 0 else None
    except (ValueError, OverflowError):
        return None
