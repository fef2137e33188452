"""The command `levelwind`."""

import signal
import sys
from types import FrameType
from typing import Any

import typer
from typer.core import TyperGroup

from levelwind.commands import (
    access,
    bench,
    cam,
    conformance,
    field,
    log,
    offline,
    operate,
    parameters,
)
from levelwind.errors import ToolError

EXIT_INTERRUPTED = 130


class _Group(TyperGroup):
    """Turns errors into one message on standard error and an exit status."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except ToolError as error:
            print(f"levelwind: {error}", file=sys.stderr)
            raise typer.Exit(1) from None
        except KeyboardInterrupt:
            raise typer.Exit(EXIT_INTERRUPTED) from None


app = typer.Typer(
    cls=_Group,
    help="Set up, watch and exercise a levelwind controller over Modbus RTU.",
    epilog="Port: --port or the environment variable LEVELWIND_PORT. "
    "Exit status: 0 done, 1 failed or refused, 2 wrong usage, 130 Ctrl-C.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

for panel, commands in {
    "Operate": {
        "identify": operate.identify,
        "status": operate.status,
        "watch": operate.watch,
        "log": log.log,
        "index": operate.index,
        "stop": operate.stop,
        "clear-fault": operate.clear_fault,
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
        "backup": field.backup,
        "restore": field.restore,
        "run": field.run,
    },
    "Without a controller": {
        "map": parameters.map_,
        "plan": offline.plan,
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
}.items():
    for name, function in commands.items():
        app.command(name, rich_help_panel=panel)(function)
app.add_typer(cam.app, name="cam", rich_help_panel="Without a controller")


def _end(number: int, _: FrameType | None) -> None:
    """End as Ctrl-C does, so that whatever a command has set in motion is stopped."""
    raise KeyboardInterrupt(signal.Signals(number).name)


def main() -> None:
    """Entry point."""
    signal.signal(signal.SIGTERM, _end)
    if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:  # as nohup wants it
        signal.signal(signal.SIGHUP, _end)
    app()
