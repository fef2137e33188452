# SPDX-License-Identifier: Apache-2.0
"""The help of every command, on terminals that are narrow and know few letters."""

import os
import sys

import pytest
import typer
from levelwind.cli import app
from on_terminal import TERMINALS, leaves, on_a_terminal, words

COMMANDS = ["", *leaves(typer.main.get_command(app))]
# One start for all of them: each would take a quarter of a second.
EVERY_HELP = """
import sys
from levelwind.cli import app
from levelwind.show import terminal
terminal.prepare()
for name in sys.argv[1:]:
    print("\\f", flush=True)
    app([*name.split(), "--help"], standalone_mode=False)
"""


@pytest.mark.parametrize("terminal", TERMINALS)
def test_the_help_names_every_option_whole(terminal: str) -> None:
    columns, changes = TERMINALS[terminal]
    line = [sys.executable, "-c", EVERY_HELP, *COMMANDS]
    env = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    status, shown = on_a_terminal(line, columns, env | changes)
    assert status == 0, shown
    begun, *helps = shown.split("\f")
    assert not begun
    for name, text in zip(COMMANDS, helps, strict=True):
        command = typer.main.get_command(app)
        for part in name.split():
            command = command.commands[part]
        options = {option for parameter in command.params for option in parameter.opts}
        options = {option for option in options if option.startswith("-")}
        assert "--help" in words(text, digits=True), name
        assert options <= words(text, digits=True), (
            f"{name}: {sorted(options - words(text, digits=True))} in\n{text}"
        )
