# SPDX-License-Identifier: Apache-2.0
"""The tool starts at once: it imports what the command needs, and nothing for the others."""

import subprocess
import sys

import pytest
from levelwind.map_table import PRODUCT_VERSION

# The tool as it is, which at its end says what it has imported.
TELLING = """
import atexit, sys
atexit.register(lambda: print("imported:", *sys.modules, file=sys.__stderr__))
from levelwind.cli import main
main()
"""
# Each takes a tenth of a second to a second: pictures, reports, spreadsheets, the server.
HEAVY = {
    *("numpy", "matplotlib", "PIL", "fontTools", "fpdf", "jinja2", "openpyxl", "lxml"),
    *("starlette", "uvicorn", "websockets", "prometheus_client", "distributed"),
}


def start(*arguments: str) -> tuple[subprocess.CompletedProcess[str], set[str]]:
    """A command that was run, and all modules that it has imported."""
    done = subprocess.run(
        [sys.executable, "-c", TELLING, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    told = done.stderr.splitlines()[-1].split()
    assert told[0] == "imported:", done.stderr
    return done, set(told[1:])


def packages(modules: set[str]) -> set[str]:
    return {module.partition(".")[0] for module in modules}


def subjects(modules: set[str]) -> set[str]:
    return {m for m in modules if m.startswith("levelwind.commands.")}


def test_all_commands_together_need_no_heavy_package_to_start():
    done, modules = start("--help")
    assert done.returncode == 0
    assert len(subjects(modules)) > 10  # the help has asked each for its first line
    assert not HEAVY & packages(modules)


@pytest.mark.parametrize("command", ["status", "stop", "index"])
def test_a_command_in_the_field_waits_for_no_other(command: str):
    done, modules = start(command, "--port", "/dev/no-such-port")
    assert "There is no port" in done.stderr
    assert subjects(modules) == {"levelwind.commands.operate"}
    assert not (HEAVY | {"yaml", "sqlite3"}) & packages(modules)


def test_the_version_needs_neither_a_command_nor_modbus():
    done, modules = start("--version")
    assert done.stdout == f"levelwind {PRODUCT_VERSION}\n"
    assert not subjects(modules)
    assert "pymodbus" not in packages(modules)
