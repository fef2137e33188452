# SPDX-License-Identifier: Apache-2.0
"""The command `levelwind`."""

import shutil
from collections import UserDict
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from levelwind import interrupt
from levelwind.errors import ToolError
from levelwind.show import terminal

EXIT_INTERRUPTED = 130
HELP_COLUMNS_MIN = 72


class _Loading(UserDict[str, Any]):
    """Commands by name. Each is imported when it is asked for: nobody waits for what others need.

    What it holds until then is (panel of the help, module.function in levelwind.commands).
    """

    def __getitem__(self, name: str) -> Any:
        if isinstance(self.data[name], tuple):
            self.data[name] = _load(name, *self.data[name])
        return self.data[name]


def _load(name: str, panel: str, place: str) -> Any:
    """A command of typer, or a group of them."""
    module, _, member = place.rpartition(".")
    found = getattr(import_module(f"levelwind.commands.{module}"), member)
    alone = typer.Typer(rich_markup_mode=MARKUP, add_completion=False)
    if not isinstance(found, typer.Typer):
        alone.command(name, rich_help_panel=panel)(found)
        return typer.main.get_command(alone)
    alone.add_typer(found, name=name, rich_help_panel=panel)
    group: Any = typer.main.get_command(alone)
    return group.commands[name]


class _Group(TyperGroup):
    """Turns errors into one message on standard error and an exit status."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands = _Loading(
            {name: (panel, at) for panel, named in COMMANDS.items() for name, at in named.items()}
        )

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except ToolError as error:
            terminal.say(f"levelwind: {error}")
            raise typer.Exit(EXIT_INTERRUPTED if interrupt.is_behind(error) else 1) from None
        except KeyboardInterrupt:
            raise typer.Exit(EXIT_INTERRUPTED) from None


# The frames of the help need room, or option names would be cut.
MARKUP: Any = "rich" if shutil.get_terminal_size().columns >= HELP_COLUMNS_MIN else None

app = typer.Typer(
    cls=_Group,
    help="Set up, watch and exercise a levelwind controller over Modbus.",
    epilog="Port: --port or the environment variable LEVELWIND_PORT. "
    "Exit status: 0 done, 1 failed or refused, 2 wrong usage, 130 Ctrl-C.",
    rich_markup_mode=MARKUP,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

COMMANDS = {
    "Operate": {
        "identify": "operate.identify",
        "status": "operate.status",
        "watch": "operate.watch",
        "log": "log.log",
        "index": "operate.index",
        "reacquire": "operate.reacquire",
        "stop": "operate.stop",
        "clear-fault": "operate.clear_fault",
        "acknowledge": "operate.acknowledge",
        "set-rope": "operate.set_rope",
        "mode": "operate.mode",
        "jog": "operate.jog",
        "trim": "operate.trim",
    },
    "Set up": {
        "get": "parameters.get",
        "set": "parameters.set_values",
        "diff": "parameters.diff",
        "apply": "parameters.apply",
        "revert": "parameters.revert",
        "save": "parameters.save",
        "factory": "parameters.factory",
        "unlock": "access.unlock",
        "lock": "access.lock",
        "line": "access.line",
        "commission": "commission.commission",
        "backup": "field.backup",
        "restore": "field.restore",
        "run": "field.run",
        "report": "commission.app",
    },
    "Serve": {
        "serve": "serve.serve",
        "launches": "serve.launches",
    },
    "Without a controller": {
        "map": "parameters.map_",
        "plan": "offline.plan",
        "lay": "lay.lay",
        "rope": "rope.rope",
        "replay": "offline.replay",
        "cam": "cam.app",
    },
    "Simulator": {
        "sim": "bench.sim",
        "launch": "bench.launch",
        "demo": "bench.demo",
    },
    "Any Modbus RTU slave": {
        "conformance": "conformance.conformance",
    },
}


def _print_version(wanted: bool) -> None:
    if wanted:
        from levelwind.map_table import PRODUCT_VERSION  # noqa: PLC0415 - the whole map with it

        typer.echo(f"levelwind {PRODUCT_VERSION}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Print the tool's version.", callback=_print_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Options that stand before the command."""


def main() -> None:
    """Entry point."""
    interrupt.prepare()
    terminal.prepare()
    terminal.run(app)
