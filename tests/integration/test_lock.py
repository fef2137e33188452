# SPDX-License-Identifier: Apache-2.0
"""The write lock as the tool sees it; what it guards is tested in tests/system."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from levelwind.cli import app
from levelwind.map_table import POINTS, Command, Result
from slave import Slave
from typer.testing import CliRunner

CODE = 471_100


@pytest.fixture
def tool(slave: Slave) -> Iterator[Callable[..., tuple[int, str]]]:
    """Runs a command of the tool: exit status and what it said. The slave is locked."""
    assert slave.write("lock_code", CODE) == 0
    assert slave.command(Command.APPLY) == Result.DONE
    slave.close()

    def run(name: str, *arguments: str) -> tuple[int, str]:
        done = CliRunner().invoke(app, [name, "--port", slave.port, *arguments])
        return done.exit_code, done.output

    yield run
    again = Slave(slave.port)
    again.write("unlock", CODE)
    assert again.write("lock_code", 0) == 0
    assert again.command(Command.APPLY) == Result.DONE
    again.close()


def test_unlock_and_lock(tool: Callable[..., tuple[int, str]]) -> None:
    status, said = tool("set", "pitch_um=11000")
    assert status == 1
    assert "The write lock is closed" in said
    assert "The write lock is closed" in tool("status")[1]
    assert tool("unlock", str(CODE)) == (0, "Open for 300 s. `levelwind lock` closes it.\n")
    assert tool("unlock", str(CODE)) == (0, "Not locked.\n")
    assert tool("set", "pitch_um=11000")[0] == 0
    assert tool("lock") == (0, "Locked.\n")
    status, said = tool("apply")
    assert status == 1
    assert "The write lock is closed" in said


def test_a_backup_does_not_hold_the_code_and_keeps_it(
    tool: Callable[..., tuple[int, str]], tmp_path: Path
) -> None:
    backup = tmp_path / "backup.yaml"
    assert tool("backup", str(backup))[0] == 0
    assert str(CODE) not in backup.read_text()
    assert f"lock_code: {POINTS['lock_code'].max}" in backup.read_text()
    tool("unlock", str(CODE))
    assert tool("restore", str(backup))[0] == 0
    tool("lock")
    assert tool("set", "pitch_um=11000")[0] == 1
    assert tool("unlock", str(CODE))[0] == 0
