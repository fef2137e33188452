# SPDX-License-Identifier: Apache-2.0
"""Cam tables on the laptop: files, check, picture, replay, and the level-wind law as a table."""

import json
import re
from pathlib import Path

import pytest
from levelwind.cam import levelwind as cam_levelwind
from levelwind.cam import report as cam_report
from levelwind.cam.table import Cam, CamRefusedError, Limits, Scale, Table
from levelwind.cli import app
from levelwind.core.ideal_screw import Screw, State
from levelwind.errors import ToolError
from levelwind.files import cam_files
from levelwind.map_table import CamInterpolation, Reason
from typer.testing import CliRunner

NOTE = """\
\tMaster\tSlave\t
Row\tPosition\tPosition\t
1\t0\t0\t
2\t40000\t1500\t
3\t60000\t0\t
4\t80000\t-50000\t
5\t100000\t-50000\t
6\t120000\t0\t
7\t140000\t4000\t
8\t160000\t4000\t
9\t180000\t1350\t
10\t195000\t0\t
10\t200000\t0\t
"""
LIMITS = Limits(60_000, 200_000)


@pytest.fixture
def note(tmp_path: Path) -> Path:
    path = tmp_path / "note.txt"
    path.write_text(NOTE)
    return path


def levelwind(*arguments: object):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_the_note_as_it_is_printed(note: Path):
    rows = cam_files.read(note)
    assert len(rows) == 11
    assert rows[0] == (0, 0)
    assert rows[3] == (80_000, -50_000)
    assert rows[10] == (200_000, 0)


@pytest.mark.parametrize("suffix", [".txt", ".csv", ".xlsx"])
def test_what_is_written_reads_back(tmp_path: Path, suffix: str):
    rows = ((0, -5), (10, 2**31 - 1), (2**31 - 1, -(2**31)))
    path = tmp_path / f"table{suffix}"
    cam_files.write(path, rows, ["a comment, with 2 numbers: 3"])
    assert cam_files.read(path) == rows


@pytest.mark.parametrize(
    "text",
    [
        "0 0\n10 5\n",
        "master;slave\n0;0\n10;5\n",
        "\ufeff1, 0, 0\n2, 10.0, 5\n",
        '# 7 7\n\n"0","0"  # begin\n10,+5\n',
    ],
)
def test_forms_of_text(tmp_path: Path, text: str):
    path = tmp_path / "table"
    path.write_text(text, encoding="utf-8")
    assert cam_files.read(path) == ((0, 0), (10, 5))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no rows"),
        ("0 0\n10\n", "line 2: '10' has 1 columns, limit 2"),
        ("0\n", "line 1: '0' has 1 columns, limit 2"),
        ("0 0\n1 10 5\n", "line 2: '1 10 5' has 3 columns, limit 2"),
        ("0 0\nten 5\n", "line 2, column 1: 'ten' is no whole number"),
        ("0 0\n10 5.5\n", "whole number"),
        ("0 0\n10 nan\n", "whole number"),
        ("0 0\n10 inf\n", "whole number"),
    ],
)
def test_a_wrong_file_is_named_with_its_line(tmp_path: Path, text: str, message: str):
    path = tmp_path / "table.txt"
    path.write_text(text)
    with pytest.raises(ToolError, match=message):
        cam_files.read(path)


def test_files_that_are_none(tmp_path: Path):
    with pytest.raises(ToolError, match="cannot be read: No such file"):
        cam_files.read(tmp_path / "nothing.txt")
    for name in ("table.txt", "table.xlsx"):
        path = tmp_path / name
        path.write_bytes(b"\xff\x00\x80")
        with pytest.raises(ToolError, match=r"is no (text|XLSX workbook).*save it as CSV UTF-8"):
            cam_files.read(path)


def test_check_says_what_the_table_asks_for(note: Path):
    result = levelwind("cam", "check", note, "--interp", "trapezoid", "--json")
    document = json.loads(result.stdout)
    assert document["slope_max_permille"] == 2778
    assert document["slope_max_row"] == 3
    assert document["steps_per_s_at_top_edge_rate"] == 166_680
    assert (document["min_usteps"], document["max_usteps"]) == (-50_000, 4_000)
    assert document["warnings"] == []
    assert "2.500 microsteps per edge at once" in levelwind("cam", "check", note).stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--slave", "161/100"), "Row 3: .*too many steps per edge.*: 4025, limit 4000"),
        (("--step-rate", "149999"), "Row 3: .*steps per second.*: 150000, limit 149999"),
        (("--slave", "1"), "--slave: '1' is no fraction"),
        (("--master", "0/1"), "--master: 0 is out of range, limits 1 to 10000"),
    ],
)
def test_check_refuses_with_row_value_and_limit(
    note: Path, arguments: tuple[str, ...], message: str
):
    result = levelwind("cam", "check", note, *arguments)
    assert result.exit_code == 1
    assert re.search(message, result.stderr), result.stderr


def test_too_many_rows_and_too_large_numbers():
    with pytest.raises(CamRefusedError) as refused:
        cam_report.report(Table(tuple((i, 0) for i in range(257))), Scale(), LIMITS)
    assert (refused.value.reason, refused.value.row) == (Reason.CAM_TOO_MANY_ROWS, 257)
    with pytest.raises(ToolError, match="Row 2: 2147483648 is beyond 32 bits"):
        cam_report.report(Table(((0, 0), (2**31, 0))), Scale(), LIMITS)


@pytest.mark.parametrize(
    ("rows", "interpolation", "warnings"),
    [
        (((0, 0), (1000, 100), (2000, 200), (3000, 0)), 0, ["Smoothness: at row 3", "0.300 "]),
        (((0, 0), (1000, 50), (2000, 0)), 0, []),
        (((0, 0), (1000, 2800), (2000, 0)), 1, ["Ratio: from row 1", "3.111 times"]),
        (((0, 0), (1000, 20), (1004, 20), (2000, 0)), 0, ["Spacing: from row 2", "67 us", "83 us"]),
        (((0, 0), (1000, 20), (1009, 20), (2000, 0)), 0, []),
        (((0, 0), (1000, 20), (1009, 20), (2000, 0)), 1, ["Spacing: from row 2", "10 edges"]),
        (((0, 0), (1000, 9), (2000, 0)), 0, ["Smallest ratio: from row 1", "in 111 edges"]),
    ],
)
def test_the_notes_warnings_with_numbers(
    rows: tuple[tuple[int, int], ...], interpolation: int, warnings: list[str]
):
    table = Table(rows, CamInterpolation(interpolation))
    found = cam_report.report(table, Scale(), LIMITS).warnings
    assert len(found) == min(1, len(warnings)), found
    assert all(text in found[0] for text in warnings)


@pytest.mark.parametrize("interpolation", ["linear", "trapezoid"])
def test_plot_draws_a_picture(note: Path, tmp_path: Path, interpolation: str):
    picture = tmp_path / "note.png"
    result = levelwind("cam", "plot", note, picture, "--interp", interpolation)
    assert result.exit_code == 0, result.output
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("interpolation", "pos", "max_pos"), [("linear", 638, 750), ("trapezoid", 625, 750)]
)
def test_replay_runs_the_compiled_cam(note: Path, interpolation: str, pos: int, max_pos: int):
    """Row 1 to 2: 1500 in 40000; the trapezoid's plateau has 10/9 of that slope."""
    result = levelwind(
        "replay", "--cam", note, "--interp", interpolation, "--drum", "+20000,-3000", "--json"
    )
    document = json.loads(result.stdout)
    assert document["pos"] == pos
    assert (document["min_pos"], document["max_pos"]) == (0, max_pos)
    assert document["pulses"] == 2 * max_pos - pos
    assert document["edges"] == 23_000


def test_replay_of_a_table_that_advances(tmp_path: Path):
    path = tmp_path / "gearing.csv"
    path.write_text("0,0\n3,2\n")
    refused = levelwind("replay", "--cam", path, "--drum", "9")
    assert refused.exit_code == 1
    assert "Row 2: Last minus first slave" in refused.stderr
    result = levelwind("replay", "--cam", path, "--advancing", "--drum", "-3000", "--json")
    assert json.loads(result.stdout)["pos"] == -2000
    assert levelwind("replay", "--drum", "9").exit_code == 1


@pytest.mark.parametrize(
    "screw",
    [
        Screw(23, 1187, 8000, -8000),
        Screw(23, 1187, 8000, -8000, 500, 77),
        Screw(65535, 1, 300, -200),
        Screw(1000, 60, 500, -500, 0, 3),
        Screw(9, 3000, 9000, -1000),
    ],
    ids=str,
)
def test_the_law_as_a_cam_stays_within_a_microstep_of_the_law(screw: Screw):
    """At every edge of a period, by the compiled cam."""
    orbit = screw.orbit(State(screw.sweep_begin, screw.ks))
    table = Table(cam_levelwind.rows(screw))
    cam_report.report(table, Scale(), LIMITS)
    _, trace, _ = Cam(table, Scale()).run([orbit.period_edges], orbit.period_edges)
    law = [orbit.after(edge).m >> 16 for edge in range(orbit.period_edges)]
    assert max(abs(a - b) for a, b in zip(trace.tolist(), law, strict=True)) <= 1


def test_a_law_with_too_long_reversals_is_no_table():
    with pytest.raises(ToolError, match=r"needs \d+ rows, limit 256"):
        cam_levelwind.rows(Screw(4, 16_000, 8000, -8000))


def test_from_levelwind_writes_a_table_that_passes(tmp_path: Path):
    path = tmp_path / "law.csv"
    assert levelwind("cam", "from-levelwind", path).exit_code == 0
    result = levelwind("cam", "check", path, "--json")
    assert json.loads(result.stdout)["cycle_edges"] == 81_560
