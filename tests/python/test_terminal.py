# SPDX-License-Identifier: Apache-2.0
"""What is printed arrives: on narrow terminals, in other encodings, on a full disk."""

import codecs
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from levelwind.cli import app
from levelwind.show import output, terminal
from rich.cells import cell_len
from typer.testing import CliRunner

LEVELWIND = [sys.executable, "-c", "from levelwind.cli import main; main()"]


def run(*arguments: str | bytes, env: dict[str, str] | None = None, **options: object):
    return subprocess.run(
        [*LEVELWIND, *arguments],
        env={**os.environ, "COLUMNS": "80", **(env or {})},
        stderr=subprocess.PIPE,
        check=False,
        **options,
    )


# ---- tables on terminals of any width ------------------------------------------------------------

WORDS = st.from_regex(r"[a-z_]{1,40}|[+-]?[0-9]{1,20}(\.[0-9]{2})?|\[/?[a-z]+\]", fullmatch=True)
CELLS = st.lists(WORDS, min_size=1, max_size=6).map(" ".join)


@given(
    st.integers(10, 200),
    st.integers(1, 7).flatmap(
        lambda n: st.lists(
            st.tuples(WORDS, *[st.one_of(WORDS, st.just(""), CELLS)] * (n - 1)), max_size=4
        ).map(lambda rows: (n, rows))
    ),
)
def test_no_word_of_a_table_is_cut_or_broken(
    columns: int, table: tuple[int, list[tuple[str, ...]]]
) -> None:
    count, rows = table
    headings = [f"heading{i}{'>' * (i % 2)}" for i in range(count)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(output.console, "_width", columns)
        with output.console.capture() as capture:
            output.print_table(headings, rows)
    shown = capture.get()
    longest = max((cell_len(word) for word in shown.split()), default=0)
    for line in shown.splitlines():
        assert cell_len(line) <= max(columns, longest + len(output.INDENT) + len("heading0: "))
    words = [word.removesuffix(":") for word in shown.split()]
    for row in rows:
        for word in " ".join(row).split():
            assert word in words, shown
            words.remove(word)


def test_the_last_column_is_broken_between_words() -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(output.console, "_width", 40)
        with output.console.capture() as capture:
            output.print_table(("name", "value>", "meaning"), [("a", "7", "word " * 8)])
    assert capture.get().splitlines() == [
        "name  value  meaning",
        "a         7  word word word word word",
        "             word word word",
    ]


# ---- encodings -----------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp437", "utf-8"])
def test_every_character_goes_somewhere(encoding: str) -> None:
    codecs.register_error(terminal.PLAIN, terminal._replace)
    for code in (*range(0x2600), 0x3042, 0xD7A3, 0xFFFD, 0x1F4A9):
        assert len(chr(code).encode(encoding, terminal.PLAIN).decode(encoding)) == 1
    for drawn, plain in [("━", "-"), ("█", "#"), ("…", "."), ("é", "e"), ("╭", "+")]:
        shown = drawn.encode(encoding, terminal.PLAIN).decode(encoding)
        assert shown in (drawn, plain)


@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_a_name_in_another_encoding_is_its_own_bytes(tmp_path: Path, encoding: str) -> None:
    name = os.fsencode(tmp_path) + b"/\xe9[b]\xff.csv"
    Path(os.fsdecode(name)).write_text("0;0\n7;x\n")
    done = run("cam", "check", name, env={"PYTHONIOENCODING": encoding}, stdout=subprocess.PIPE)
    assert done.returncode == 1
    assert name in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("columns", "env"),
    [
        ("80", {"PYTHONIOENCODING": "latin-1:strict"}),
        ("40", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
    ],
)
def test_help_and_wrong_usage_in_plain_characters(columns: str, env: dict[str, str]) -> None:
    for arguments, status in ((["plan", "--help"], 0), (["mode", "fäst"], 2)):
        done = run(*arguments, env={**env, "COLUMNS": columns}, stdout=subprocess.PIPE)
        assert done.returncode == status
        assert b"Traceback" not in done.stderr


# ---- where nothing can be written ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "unbuffered"), [("map", ""), ("map", "1"), ("map --json", ""), ("--help", "")]
)
def test_a_full_disk_is_one_line(arguments: str, unbuffered: str) -> None:
    with Path("/dev/full").open("wb") as full:
        done = run(*arguments.split(), env={"PYTHONUNBUFFERED": unbuffered}, stdout=full)
    assert done.returncode == 1
    (said,) = done.stderr.decode().splitlines()
    assert said.startswith("levelwind: the output cannot be written: No space left on device.")


def test_a_reader_that_has_read_enough_is_no_error() -> None:
    there, here = os.pipe()
    os.close(there)
    done = run("map", stdout=here)
    os.close(here)
    assert (done.returncode, done.stderr) == (1, b"")


def test_closed_streams_are_no_error() -> None:
    for close in (">&-", "2>&-", ">&- 2>&-"):
        line = " ".join(f"'{part}'" for part in [*LEVELWIND, "map", "pitch"])
        done = subprocess.run(
            ["sh", "-c", f"{line} {close}"], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0
        assert "Traceback" not in done.stderr


def test_error_messages_on_a_full_disk_keep_the_exit_status() -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run([*LEVELWIND, "status", "--port", "/none"], stderr=full, check=False)
    assert done.returncode == 1


# ---- brackets ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["[bold]x[/no]", "$\\frac{$ [red]"])
def test_a_name_is_shown_as_it_is(tmp_path: Path, name: str) -> None:
    folder = tmp_path / name.replace("/", "_")
    folder.mkdir()
    table, picture = folder / "cam.csv", folder / "cam.png"
    table.write_text("0;0\n1000;100\n2000;0\n")
    result = CliRunner().invoke(app, ["cam", "plot", str(table), str(picture)])
    assert result.exit_code == 0, result.output
    assert f"Wrote {picture}." in re.sub(r"\n", "", result.stdout)
    renamed = folder / f"{name.replace('/', '_')}.csv"
    table.rename(renamed)
    for line in (
        ["cam", "plot", str(renamed), str(picture)],
        ["replay", "--cam", str(renamed), "--drum", "9", "--plot", str(picture)],
    ):
        result = CliRunner().invoke(app, line)
        assert result.exit_code == 0, result.output


def leave_no_room() -> None:
    """No file of this process can be longer than a byte."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (1, 1))


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".xlsx", ".png", ".pdf"])
def test_a_file_that_has_no_room_is_one_line_and_leaves_what_was_there(
    tmp_path: Path, suffix: str
) -> None:
    table = tmp_path / "table.csv"
    table.write_text("0;0\n1000;20\n2000;0\n")
    path, full = tmp_path / f"old{suffix}", tmp_path / f"full{suffix}"
    path.write_text("old")
    full.symlink_to("/dev/full")
    command = (
        ["cam", "plot", str(table)] if suffix in (".png", ".pdf") else ["cam", "from-levelwind"]
    )
    done = run(*command, str(full), stdout=subprocess.PIPE)
    assert (done.returncode, done.stdout) == (1, b"")
    assert (
        done.stderr.decode() == f"levelwind: {full} cannot be written: No space left on device.\n"
    )

    done = run(*command, str(path), stdout=subprocess.PIPE, preexec_fn=leave_no_room,
               env={"PYTHONDONTWRITEBYTECODE": "1"})  # fmt: skip
    assert done.returncode == 1
    # Others may say that they keep no cache on such a disk.
    told = done.stderr.decode().splitlines()[-1]
    assert told.startswith(f"levelwind: {path} cannot be written: File too large")
    assert path.read_text() == "old"
    assert {p.name for p in tmp_path.iterdir()} == {"table.csv", path.name, full.name}
