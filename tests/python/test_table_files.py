# SPDX-License-Identifier: Apache-2.0
"""Tables as people and their programs write them: read right, or refused with the cell."""

import codecs
import csv
import io
import zipfile
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from levelwind.errors import ToolError
from levelwind.files import cam_files, profiles
from openpyxl import Workbook
from openpyxl.chart import LineChart, Reference

HILL = ((0, 0), (720, 120), (1440, 240), (2160, 360))
GEARING = profiles.Gearing(2_400_000, 2_880_000, 4.0)


def written(folder: Path, content: str | bytes, name: str = "table.csv") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def cam(folder: Path, content: str | bytes) -> tuple[tuple[int, int], ...]:
    return cam_files.read(written(folder, content))


def speeds(folder: Path, content: str | bytes) -> profiles.Profile:
    return profiles.read(written(folder, content, "profile.csv"), GEARING)


def refusal(folder: Path, content: str | bytes, read=cam) -> str:
    with pytest.raises(ToolError) as refused:
        read(folder, content)
    said = str(refused.value)
    assert len(said.splitlines()) == 1
    assert len(said) < 400
    return said


# ---- kinds ---------------------------------------------------------------------------------------


def test_a_decimal_comma_is_a_decimal_sign(tmp_path: Path):
    assert cam(tmp_path, "0;0,0\n720;120,0\n1440;240,0\n2160;360,0\n") == HILL
    assert cam(tmp_path, "0\t0,0\n720\t120,0\n1440\t240,0\n2160\t360,0\n") == HILL
    assert cam(tmp_path, '0,"0,0"\n720,"120,0"\n1440,"240,0"\n2160,"360,0"\n') == HILL
    assert "line 2, column 2: '120,5' is no whole" in refusal(tmp_path, "0;0,0\n720;120,5\n")
    assert "point" in refusal(tmp_path, "0;0,0\n720;120.0\n")


def test_a_decimal_comma_between_commas_is_refused(tmp_path: Path):
    assert "line 1" in refusal(tmp_path, "0,0,0\n720,120,0\n1440,240,0\n")
    assert "line 2" in refusal(tmp_path, "master,slave\n0,0,0\n720,120,0\n")
    text = "time_s,drum_rpm\n0,0,0,0\n1,5,100,0\n"
    assert "line 2" in refusal(tmp_path, text, speeds)


@pytest.mark.parametrize("third", ["1", "0", "x", "5.5"])
def test_a_third_column_is_never_the_slave(tmp_path: Path, third: str):
    rows = "".join(f"{m} {s} {third}\n" for m, s in HILL)
    assert "line 1: " in refusal(tmp_path, rows)
    assert cam(tmp_path, "master slave what\n" + rows) == HILL
    assert cam(tmp_path, "what\tslave\tmaster\n" + "".join(
        f"{third}\t{s}\t{m}\n" for m, s in HILL)) == HILL  # fmt: skip


def test_a_row_number_is_one_only_if_it_counts_the_rows(tmp_path: Path):
    counted = "".join(f"{i};{m};{s}\n" for i, (m, s) in enumerate(HILL, 1))
    assert cam(tmp_path, counted) == HILL
    assert "line 1" in refusal(tmp_path, counted.replace("3;", "4;", 1))


def test_columns_are_taken_by_the_names_above_them(tmp_path: Path):
    swapped = "".join(f"{s},{m}\n" for m, s in HILL)
    assert cam(tmp_path, "Slave [usteps],Master [edges]\n" + swapped) == HILL
    assert cam(tmp_path, "slave,x\n" + swapped) == HILL
    assert cam(tmp_path, "slave_usteps  master_edges\n" + swapped.replace(",", " ")) == HILL
    assert "heading" in refusal(tmp_path, "master,slave\n0,0,1\n")
    assert "line 1" in refusal(tmp_path, "master,master,slave\n0,0,1\n")
    assert "line 2, column 3: the cell is empty" in refusal(
        tmp_path, "master;what;slave\n0;7\n720;7;120\n"
    )


@pytest.mark.parametrize("comment", ["// start", "# start", "  //", "#"])
def test_a_comment_behind_the_first_row_does_not_cost_the_row(tmp_path: Path, comment: str):
    assert cam(tmp_path, f"0 0 {comment}\n720 120\n1440 240\n2160 360\n") == HILL


@pytest.mark.parametrize(
    "first",
    ["0 0 ! start", "0 0 start", "0 x", "x 0", "0o 0", "5 m", "nan nan", "-inf 0", "1/2 3",
     "2024 table", "=A1 =B1", "#DIV/0! 0", "#WERT! 0", "#N/A 0", "O 0", "#### ; 0"],
)  # fmt: skip
def test_a_first_row_that_is_wrong_is_no_heading(tmp_path: Path, first: str):
    assert "line 1" in refusal(tmp_path, f"{first}\n720 120\n1440 240\n2160 360\n")


@pytest.mark.parametrize("text", ["1.000", "-1.000", "12.345", "999.000"])
@pytest.mark.parametrize("sign", [".", ","])
def test_what_may_be_thousands_is_refused(tmp_path: Path, text: str, sign: str):
    text = text.replace(".", sign)
    said = refusal(tmp_path, f"0;0\n{text};{text}\n")
    assert f"line 2, column 1: {text!r} may be" in said
    said = refusal(tmp_path, f"time_s;motor_rpm\n0;0\n10;{text}\n", speeds)
    assert f"line 3, column 2: {text!r} may be" in said


def test_what_cannot_be_thousands_is_a_decimal(tmp_path: Path):
    assert cam(tmp_path, "0.000;0\n720.0;120.00\n1440.000;240\n02160.000;360.0\n") == HILL
    assert speeds(tmp_path, "time_s;drum_rpm\n0.000;0,5\n1.500;1,500\n") == [(0, 500), (1500, 1500)]
    assert "line 2" in refusal(tmp_path, "0 0\n1.000.000 5\n")
    assert "line 2" in refusal(tmp_path, "0;0\n1'000;5\n")
    assert "line 2" in refusal(tmp_path, "0;0\n1 000;5\n")
    assert "line 2" in refusal(tmp_path, "0;0\n1\u00a0000;5\n")
    assert "line 2" in refusal(tmp_path, "0;0\n1.000,5;5\n")


def test_a_rounded_number_is_refused(tmp_path: Path):
    assert "line 2, column 1: '1,5E+05' is rounded" in refusal(tmp_path, "0;0\n1,5E+05;5\n")


def test_leading_zeros_are_decimal(tmp_path: Path):
    assert cam(tmp_path, "000 0\n0720 120\n1440 0240\n+2160 360\n") == HILL


def test_what_is_too_long_for_a_number_is_told(tmp_path: Path):
    assert "line 2, column 2" in refusal(tmp_path, f"0 0\n1 {'9' * 5000}\n")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16", "utf-16-le"])
def test_encodings(tmp_path: Path, encoding: str):
    text = "Über dem Maß;größer\r\n" + "".join(f"{m};{s}\r\n" for m, s in HILL)
    content = text.encode(encoding)
    if encoding == "utf-16-le":
        assert "line 1" in refusal(tmp_path, content)
        assert "save it as CSV UTF-8" in refusal(tmp_path, content)
        content = codecs.BOM_UTF16_LE + content
    assert cam(tmp_path, content) == HILL
    text = "time_s;Böe;drum_rpm\n0;ä;0\n0,5;ö;20\n"
    assert speeds(tmp_path, text.encode(encoding.removesuffix("-le"))) == [(0, 0), (500, 20_000)]


def test_what_a_spreadsheet_leaves_in_csv(tmp_path: Path):
    rows = "".join(f'"{m}";{s};;;\n' for m, s in HILL)
    assert cam(tmp_path, f"sep=;\n;;\nmaster;slave;;\n{rows};;;;\n") == HILL
    assert cam(tmp_path, f'"# law: a; b, c"\n{rows}') == HILL
    assert cam(tmp_path, "".join(f";;{m};{s}\n" for m, s in HILL)) == HILL
    assert speeds(tmp_path, "sep=;\ntime_s;drum_rpm;\n0;0;;\n1,5;20;\n") == [(0, 0), (1500, 20_000)]
    assert speeds(tmp_path, "Time_s;drum_rpm\ns;rpm\n0;0\n1;2\n") == [(0, 0), (1000, 2000)]


@pytest.mark.parametrize("read", [cam, speeds])
def test_a_quote_that_is_not_closed_is_told_with_its_line(tmp_path: Path, read):
    for rest in ("", "x" * 130_000, "x," * 100_000):
        said = refusal(tmp_path, f'time_s,drum_rpm\n0,0\n"1,{rest}\n2,5\n', read)
        assert "line 3" in said
        assert "quote" in said


def test_times_since_an_epoch_are_times(tmp_path: Path):
    text = "time_s,drum_rpm\n1764450000.25,0\n1764450001.75,5\n"
    assert speeds(tmp_path, text) == [(0, 0), (1500, 5000)]
    said = refusal(tmp_path, "time_s,drum_rpm\n0,0\n1764450001,5\n", speeds)
    assert "line 3, column 1" in said
    assert "limit 100000 s" in said


# ---- spreadsheets --------------------------------------------------------------------------------


def workbook(path: Path, rows: tuple[tuple[object, ...], ...]) -> Workbook:
    book = Workbook()
    for row in rows:
        book.active.append(row)
    book.save(path)
    return book


def add_chart_sheet(book: Workbook) -> None:
    chart = LineChart()
    chart.add_data(Reference(book.worksheets[0], range_string="Sheet!$A$1:$A$4"))
    book.create_chartsheet("chart", 0).add_chart(chart)


def test_the_first_worksheet_is_read_whichever_is_active(tmp_path: Path):
    path = tmp_path / "cam.xlsx"
    book = workbook(path, HILL)
    book.create_sheet("notes").append((1, 2))
    book.active = 1
    book.save(path)
    assert cam_files.read(path) == HILL
    add_chart_sheet(book)
    book.active = 0
    book.save(path)
    assert cam_files.read(path) == HILL


def test_a_workbook_of_nothing_but_a_chart_is_refused(tmp_path: Path):
    path = tmp_path / "cam.xlsx"
    book = workbook(path, HILL)
    add_chart_sheet(book)
    book.remove(book["Sheet"])
    book.save(path)
    with pytest.raises(ToolError, match="no worksheet"):
        cam_files.read(path)


def rewritten(path: Path, old: bytes, new: bytes) -> None:
    """A workbook with something replaced in its first sheet."""
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    assert old in parts[sheet]
    parts[sheet] = parts[sheet].replace(old, new)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)


def test_all_rows_are_read_whatever_size_a_sheet_says_it_has(tmp_path: Path):
    path = tmp_path / "cam.xlsx"
    workbook(path, HILL)
    rewritten(path, b'<dimension ref="A1:B4"', b'<dimension ref="A1"')
    assert cam_files.read(path) == HILL


@pytest.mark.parametrize("column", [0, 1])
@pytest.mark.parametrize("third", [(), (9,)])
def test_a_formula_without_its_result_is_named(tmp_path: Path, column: int, third: tuple[int, ...]):
    rows = [[*row, *third] for row in HILL]
    for i, row in enumerate(rows, 1):
        row[column] = f"=C{i}+1"
    workbook(tmp_path / "cam.xlsx", tuple(map(tuple, rows)))
    for heading in ((), ("master", "slave", "third")[: 2 + len(third)]):
        path = tmp_path / "named.xlsx"
        workbook(path, (*((heading,) if heading else ()), *map(tuple, rows)))
        with pytest.raises(ToolError) as refused:
            cam_files.read(path)
        if heading or not third:
            cell = f"cell {'AB'[column]}{1 + bool(heading)}"
            assert cell in str(refused.value)
            assert "formula without a stored result" in str(refused.value)


def test_an_empty_cell_is_named(tmp_path: Path):
    path = tmp_path / "cam.xlsx"
    workbook(path, (("master", "slave", "what"), (0, 0, 1), (720, None, 1)))
    with pytest.raises(ToolError, match=r"cam\.xlsx, cell B3: the cell is empty"):
        cam_files.read(path)


def test_cells_of_a_workbook(tmp_path: Path):
    path = tmp_path / "cam.xlsx"
    workbook(path, ((None, 0.0, 0), (None, 720.0, 0.1 * 3 * 400), (None, "1440", "240,0")))
    assert cam_files.read(path) == HILL[:3]
    for wrong in (True, "1.000", "#DIV/0!", 0.5, "x"):
        workbook(path, ((0, 0), (720, wrong)))
        with pytest.raises(ToolError, match="cell B2"):
            cam_files.read(path)


def test_a_workbook_of_speeds(tmp_path: Path):
    path = tmp_path / "profile.xlsx"
    workbook(path, (("time_s", "drum_rpm"), (0, 0), (1.125, 1.125)))
    assert profiles.read(path, GEARING) == [(0, 0), (1125, 1125)]


@pytest.mark.parametrize("cut", [10, 200, 1000])
def test_a_broken_workbook_is_one_line(tmp_path: Path, cut: int):
    path = tmp_path / "cam.xlsx"
    workbook(path, HILL)
    content = path.read_bytes()
    path.write_bytes(content[:-cut])
    with pytest.raises(ToolError, match=r"is no XLSX workbook.*CSV UTF-8"):
        cam_files.read(path)
    path.write_bytes(content)
    rewritten(path, b"<sheetData>", b"<sheetData><row><oops>")
    with pytest.raises(ToolError, match="is no XLSX workbook"):
        cam_files.read(path)


# ---- made at random ------------------------------------------------------------------------------
# What is drawn is the numbers and the habits of whoever writes them. The file is made from both, so
# what it means is known without any reader.

GROUPS = st.sampled_from(["", ".", ",", "'", " ", "\u00a0", "\u202f"])
ENCODINGS = st.sampled_from(["utf-8", "utf-8-sig", "cp1252", "utf-16"])
SEPARATORS = st.sampled_from([";", ",", "\t", " ", "; ", ", ", "  ", " ; "])
HEADINGS = st.sampled_from(
    [None, (), ("master", "slave"), ("Master [edges]", "Slave [usteps]"), ("x", "y"),
     ("Hauptachse", "Größe"), ("MASTER", "SLAVE")]
)  # fmt: skip
COMMENTS = st.sampled_from(["", "# note", "// note", "#1;2,3", "// 5 5", '# 5" pulley'])
THIRDS = st.sampled_from(["", "behind", "before", "count"])


def grouped(digits: str, group: str) -> str:
    if not group:
        return digits
    head = len(digits) % 3
    return group.join(
        filter(None, [digits[:head], *(digits[i : i + 3] for i in range(head, len(digits), 3))])
    )


@st.composite
def habits(draw: st.DrawFn) -> dict[str, object]:
    decimal = draw(st.sampled_from([".", ","]))
    return {
        "decimal": decimal,
        "places": draw(st.integers(0, 4)),
        "group": draw(GROUPS.filter(lambda group: group != decimal)),
        "separator": draw(SEPARATORS),
        "quoted": draw(st.booleans()),
        "encoding": draw(ENCODINGS),
        "heading": draw(HEADINGS),
        "swapped": draw(st.booleans()),
        "comment": draw(COMMENTS),
        "above": draw(COMMENTS),
        "third": draw(THIRDS),
        "trailing": draw(st.sampled_from(["", ";;", ",", "\t"])),
        "end": draw(st.sampled_from(["\n", "\r\n", "\r"])),
        "sep_line": draw(st.booleans()),
    }


def formatted(value: Decimal, how: dict[str, object]) -> str:
    """A number as somebody of these habits writes it."""
    sign = "-" if value < 0 else ""
    whole, _, fraction = f"{abs(value):.{how['places']}f}".partition(".")
    text = sign + grouped(whole, str(how["group"]))
    return f"{text}{how['decimal']}{fraction}" if fraction else text


def joined(cells: list[str], how: dict[str, object]) -> str:
    separator = str(how["separator"])
    if how["quoted"]:
        line = io.StringIO()
        csv.writer(line, delimiter=separator.strip() or separator[0], lineterminator="").writerow(
            cells
        )
        return line.getvalue()
    return separator.join(cells)


def written_by_habit(
    rows: list[tuple[Decimal, Decimal]], heading: tuple[str, ...], third: list[str], how: dict
) -> bytes:
    lines = []
    if how["sep_line"]:
        lines.append(f"sep={str(how['separator']).strip() or str(how['separator'])[0]}")
    if how["above"]:
        lines.append(str(how["above"]))
    order = [1, 0] if how["swapped"] else [0, 1]

    def placed(first: str, second: str, more: str) -> list[str]:
        pair = [(first, second)[i] for i in order]
        if how["third"] == "behind":
            return [*pair, more]
        return [more, *pair] if how["third"] else pair

    if heading:
        lines.append(joined(placed(*heading, "what"), how) + str(how["trailing"]))
    for i, (row, more) in enumerate(zip(rows, third, strict=True)):
        text = placed(
            *(formatted(value, how) for value in row),
            str(i + 1) if how["third"] == "count" else more,
        )
        lines.append(
            joined(text, how) + str(how["trailing"]) + f" {how['comment']}" * bool(how["comment"])
        )
    return (str(how["end"]).join(lines) + str(how["end"])).encode(str(how["encoding"]), "replace")


def says_its_order(heading: object) -> bool:
    return bool(heading) and str(heading[0]).lower().startswith("master")


THIRD = st.lists(st.sampled_from(["0", "1", "7", "note", "1.5", ""]), min_size=6, max_size=6)
ENOUGH = 0.15  # a reader that refuses everything reads nothing wrong


@pytest.fixture
def outcomes() -> Iterator[list[bool]]:
    """Whether each table was read; many must have been."""
    read: list[bool] = []
    yield read
    assert sum(read) > ENOUGH * len(read)


RANDOM = settings(max_examples=1000, suppress_health_check=[HealthCheck.function_scoped_fixture])


@RANDOM
@given(
    st.lists(st.tuples(st.integers(0, 3000), st.integers(-3000, 3000)), min_size=1, max_size=6),
    st.booleans(),
    THIRD,
    habits(),
)
def test_random_cam_tables_are_read_right_or_refused(
    tmp_path: Path,
    outcomes: list[bool],
    values: list[tuple[int, int]],
    begins_at_0: bool,
    third: list[str],
    how: dict[str, object],
):
    # Only a heading with names can tell a reader that the columns are swapped, and only quotes
    # that a comma between commas does not begin another column that may hold anything.
    how["swapped"] = how["swapped"] and says_its_order(how["heading"])
    commas = "," in (how["group"], how["decimal"] if how["places"] else "")
    blank = how["group"] == " " == str(how["separator"])[0]
    clash = (commas and str(how["separator"]).strip() == ",") or blank
    how["quoted"] = how["quoted"] or (clash and how["third"] in ("behind", "before"))
    if begins_at_0:
        values[0] = (0, values[0][1])
    rows = [(Decimal(a), Decimal(b)) for a, b in values]
    content = written_by_habit(rows, how["heading"] or (), third[: len(rows)], how)
    try:
        found = cam(tmp_path, content)
    except ToolError as error:
        assert "table.csv" in str(error)
        outcomes.append(False)
        return
    outcomes.append(True)
    assert found == tuple(values), content


@RANDOM
@given(
    st.lists(
        st.tuples(st.integers(1, 4000), st.integers(-999_999, 999_999)), min_size=2, max_size=6
    ),
    THIRD,
    habits(),
)
def test_random_profiles_are_read_right_or_refused(
    tmp_path: Path,
    outcomes: list[bool],
    values: list[tuple[int, int]],
    third: list[str],
    how: dict[str, object],
):
    """Steps in ms, and speeds in thousandths: as many places as are written are meant."""
    time_ms, rows = 0, []
    for step_ms, millirpm in values:
        time_ms += step_ms
        rows.append((Decimal(time_ms) / 1000, Decimal(millirpm) / 1000))
    content = written_by_habit(rows, ("time_s", "drum_rpm"), third[: len(rows)], how)
    places = int(str(how["places"]))
    meant = [tuple(Decimal(f"{value:.{places}f}") for value in row) for row in rows]
    try:
        found = speeds(tmp_path, content)
    except ToolError as error:
        assert "profile.csv" in str(error)
        outcomes.append(False)
        return
    outcomes.append(True)
    begin = meant[0][0]
    assert [(Decimal(t) / 1000, Decimal(v) / 1000) for t, v in found] == [
        (time - begin, speed) for time, speed in meant
    ], content
