# SPDX-License-Identifier: Apache-2.0
"""The command `levelwind`."""

import shutil
from collections.abc import Callable
from typing import Any

import typer
from typer.core import TyperGroup

from levelwind import interrupt
from levelwind.commands import (
    access,
    bench,
    cam,
    commission,
    conformance,
    field,
    lay,
    log,
    offline,
    operate,
    parameters,
    rope,
    serve,
)
from levelwind.errors import ToolError
from levelwind.show import terminal

EXIT_INTERRUPTED = 130
HELP_COLUMNS_MIN = 72


class _Group(TyperGroup):
    """Turns errors into one message on standard error and an exit status."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except ToolError as error:
            terminal.say(f"levelwind: {error}")
            raise typer.Exit(EXIT_INTERRUPTED if interrupt.is_behind(error) else 1) from None
        except KeyboardInterrupt:
            raise typer.Exit(EXIT_INTERRUPTED) from None


app = typer.Typer(
    cls=_Group,
    help="Set up, watch and exercise a levelwind controller over Modbus.",
    epilog="Port: --port or the environment variable LEVELWIND_PORT. "
    "Exit status: 0 done, 1 failed or refused, 2 wrong usage, 130 Ctrl-C.",
    # The frames of the help need room, or option names would be cut.
    rich_markup_mode="rich" if shutil.get_terminal_size().columns >= HELP_COLUMNS_MIN else None,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

COMMANDS: dict[str, dict[str, Callable[..., None]]] = {
    "Operate": {
        "identify": operate.identify,
        "status": operate.status,
        "watch": operate.watch,
        "log": log.log,
        "index": operate.index,
        "reacquire": operate.reacquire,
        "stop": operate.stop,
        "clear-fault": operate.clear_fault,
        "acknowledge": operate.acknowledge,
        "set-rope": operate.set_rope,
        "mode": operate.mode,
        "jog": operate.jog,
        "trim": operate.trim,
    },
    "Set up": {
        "get": parameters.get,
        "set": parameters.set_values,
        "diff": parameters.diff,
        "apply": parameters.apply,
        "revert": parameters.revert,
        "save": parameters.save,
        "factory": parameters.factory,
        "unlock": access.unlock,
        "lock": access.lock,
        "line": access.line,
        "commission": commission.commission,
        "backup": field.backup,
        "restore": field.restore,
        "run": field.run,
    },
    "Serve": {
        "serve": serve.serve,
    },
    "Without a controller": {
        "map": parameters.map_,
        "plan": offline.plan,
        "lay": lay.lay,
        "rope": rope.rope,
        "replay": offline.replay,
    },
    "Simulator": {
        "sim": bench.sim,
        "launch": bench.launch,
        "demo": bench.demo,
    },
    "Any Modbus RTU slave": {
        "conformance": conformance.conformance,
    },
}
for panel, commands in COMMANDS.items():
    for name, function in commands.items():
        app.command(name, rich_help_panel=panel)(function)
app.add_typer(serve.launches, name="launches", rich_help_panel="Serve")
app.add_typer(commission.app, name="report", rich_help_panel="Set up")
app.add_typer(cam.app, name="cam", rich_help_panel="Without a controller")


def main() -> None:
    """Entry point."""
    interrupt.prepare()
    terminal.prepare()
    terminal.run(app)
