# SPDX-License-Identifier: Apache-2.0
"""Files of cam tables: two columns, master and slave; CSV, text or XLSX."""

import io
import re
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from levelwind import whole_file
from levelwind.errors import ToolError
from levelwind.files import tables
from levelwind.files.tables import Row, Table

COLUMNS = ("master", "slave")
WANTED = "master and slave"


def read(path: Path) -> tuple[tuple[int, int], ...]:
    """The rows (master, slave) of a file; ToolError names the cell that is wrong."""
    table = tables.read(path)
    if not table.rows:
        raise ToolError(f"{path} has no rows: two columns are wanted, {WANTED}.")
    master, slave = _named(table) or _by_position(table)
    return tuple(zip(table.whole_numbers(master), table.whole_numbers(slave), strict=True))


def _named(table: Table) -> tuple[int, int] | None:
    """The columns that a heading names; None if there is no such heading."""
    width = max(len(row.cells) for row in table.rows)
    found = None
    for heading in table.headings:
        names = len(heading.cells)
        masters, slaves = (_columns_named(heading, name) for name in COLUMNS)
        if not (masters or slaves) or names == 1 or (table.blanks and names != width != 2):
            continue  # words, a title, or names of more than one word
        if names < width:
            longest = next(row for row in table.rows if len(row.cells) > names)
            raise ToolError(
                f"{table.place(longest)}: {_line(longest)} has {len(longest.cells)} cells, the "
                f"heading in line {heading.number} {names}: give each column a name."
            )
        pair = _pair(masters, slaves, two=width == 2 and (table.blanks or names == 2))
        if pair is None or found not in (None, pair):
            raise ToolError(
                f"{table.place(heading)}: {_line(heading)} does not say which column is which: "
                "name one column master and one slave."
            )
        found = pair
    return found


def _columns_named(heading: Row, name: str) -> list[int]:
    word = re.compile(rf"(?<![^\W_]){name}(?![^\W_])", re.IGNORECASE)
    return [i for i, cell in enumerate(heading.cells) if word.search(str(cell))]


def _pair(masters: list[int], slaves: list[int], *, two: bool) -> tuple[int, int] | None:
    """One column each. Of `two` columns their order tells, and one name tells the other."""
    if len(masters) > 1 or len(slaves) > 1 or masters == slaves:
        return None
    if two:
        swapped = bool(slaves) and (slaves[0] == 0 or (bool(masters) and slaves < masters))
        swapped = swapped or (not slaves and masters[0] > 0)
        return (1, 0) if swapped else (0, 1)
    return (masters[0], slaves[0]) if masters and slaves else None


def _by_position(table: Table) -> tuple[int, int]:
    """Two columns; or three, of which the first counts the rows."""
    ((width, _),) = Counter(len(row.cells) for row in table.rows).most_common(1)
    width = width if width in (2, 3) else 2
    for row in table.rows:
        if len(row.cells) != width:
            raise ToolError(
                f"{table.place(row)}: {_line(row)} has {len(row.cells)} columns, limit {width}: "
                f"{WANTED}, the same in every line."
            )
    if width == 2:
        return 0, 1
    # A table begins at 0: with thousands between commas, 1,500,7 is no row 1.
    counted = [str(row.cells[0]) for row in table.rows]
    begins_at_0 = re.fullmatch(r"0([.,]0+)?", str(table.rows[0].cells[1]))
    if counted != [str(i + 1) for i in range(len(counted))] or not begins_at_0:
        row = table.rows[0]
        raise ToolError(
            f"{table.place(row)}: {_line(row)} has 3 columns, and the first does not count rows "
            f"that begin at 0. Leave only {WANTED}, or put a heading above that names them."
        )
    return 1, 2


def _line(row: Row) -> str:
    return tables.shown(" ".join(map(str, row.cells)))


def write(path: Path, rows: Iterable[Sequence[int]], comments: Sequence[str] = ()) -> None:
    """A file that read() reads; the suffix says whether it is XLSX, CSV or plain text."""
    if path.suffix.lower() in tables.XLSX:
        try:
            content = _sheet(rows)
        except OSError as error:
            where = tempfile.gettempdir()
            raise ToolError(
                f"{path} cannot be written: {error.strerror} in {where}, where it is prepared."
            ) from error
        whole_file.write(path, content)
        return
    separator = "," if path.suffix.lower() == ".csv" else "\t"
    lines = [f"# {' '.join(comment.split())}" for comment in comments]
    lines += [separator.join(COLUMNS), *(separator.join(map(str, row)) for row in rows)]
    whole_file.write(path, "\n".join(lines) + "\n")


def _sheet(rows: Iterable[Sequence[int]]) -> bytes:
    book = tables.openpyxl().Workbook()
    book.active.append(COLUMNS)
    for row in rows:
        book.active.append(list(row))
    content = io.BytesIO()
    book.save(content)
    return content.getvalue()
