# SPDX-License-Identifier: Apache-2.0
"""The command that owns the port and serves everybody; and what it has recorded."""

import os
import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from levelwind import whole_file
from levelwind.errors import ToolError
from levelwind.line.connection import Json, with_line
from levelwind.line.port import Line
from levelwind.show.output import console, print_json, print_table, warn
from levelwind.simulate import machine, simulator

NO_PACKAGES = "The server needs more packages: pip install 'levelwind[serve]'"
NO_PTY = {"port": None, "tcp": "127.0.0.1:0"}
RECORD_ENV = "LEVELWIND_RECORD"


def _pin_path() -> Path:
    base = os.environ.get("APPDATA") if os.name == "nt" else os.environ.get("XDG_CONFIG_HOME")
    return Path(base or Path.home() / ".config") / "levelwind" / "pin.json"


@with_line
def serve(
    line: Line,
    listen: Annotated[
        str, typer.Option(help="Where the page is.", metavar="HOST:PORT")
    ] = "127.0.0.1:8080",
    modbus_tcp: Annotated[
        str | None, typer.Option(help="Serve Modbus TCP there, too.", metavar="HOST:PORT")
    ] = None,
    write_from: Annotated[
        list[str] | None,
        typer.Option(
            help="Modbus TCP clients that may write; others only read.", metavar="ADDRESS/MASK"
        ),
    ] = None,
    record: Annotated[
        Path | None, typer.Option(help="Record every launch there.", metavar="FILE.sqlite")
    ] = None,
    keep: Annotated[int, typer.Option(help="So many launches; older ones go.", min=1)] = 1000,
    allow_commands: Annotated[
        bool, typer.Option("--allow-commands", help="The page may command, with a PIN.")
    ] = False,
    set_pin: Annotated[
        bool, typer.Option("--set-pin", help="Ask for a new PIN first, and keep it, hashed.")
    ] = False,
    commission: Annotated[
        Path | None,
        typer.Option(
            help="The page leads the guided commissioning, too (doc/commissioning.md): report "
            "and state are there.",
            metavar="FOLDER",
        ),
    ] = None,
    pin_file: Annotated[Path | None, typer.Option(help="Where the PIN is kept.")] = None,
    name: Annotated[
        list[str] | None,
        typer.Option(help="Name by which browsers may reach the page, beside localhost."),
    ] = None,
    simulate: Annotated[
        bool, typer.Option("--simulator", help="A simulated winch, launch after launch.")
    ] = False,
    speed: Annotated[str, typer.Option(help="Of the simulator: factor of real time.")] = "1",
    machine_file: Annotated[
        Path | None,
        typer.Option(
            "--machine", help="Simulate this machine (doc/machine.md).", metavar="FILE.yaml"
        ),
    ] = None,
) -> None:
    """Own the port: a page for the operator, Modbus TCP for others, a recorder. Until Ctrl-C."""
    try:
        from levelwind.serve import gateway, guard, run  # noqa: PLC0415 - an extra, and a second
    except ModuleNotFoundError as error:
        raise ToolError(f"{NO_PACKAGES} (there is no {error.name}).") from None
    pin = guard.PinFile(pin_file or _pin_path())
    if set_pin:
        pin.set(typer.prompt("New PIN", hide_input=True, confirmation_prompt=True))
    if allow_commands and not pin.exists():
        raise ToolError(f"--allow-commands: there is no PIN in {pin.path}. Set one: --set-pin.")
    if commission and not allow_commands:
        raise ToolError("--commission: its steps move the carriage; give --allow-commands, too.")
    if commission and simulate:
        raise ToolError(
            "--commission: the demonstration drives this winch. Give the --port of a `levelwind "
            "sim` in another terminal."
        )
    if write_from and modbus_tcp is None:
        raise ToolError(
            "--write-from: it is for clients of --modbus-tcp HOST:PORT; give that, too."
        )
    for one in name or []:
        if not guard.is_name(one):
            raise ToolError(f"--name {one}: give the name alone, for example winch.local.")
    if machine_file and not simulate:
        raise ToolError("--machine: a real winch is as it is; give --simulator, too.")
    winch = machine.read(machine_file) if machine_file else None
    with ExitStack() as stack:
        if simulate:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="levelwind-")))
            at = {"port": str(folder / "port")} if os.name == "posix" else NO_PTY
            arguments = simulator.arguments(**at, speed=speed, machine=winch)
            line = Line(stack.enter_context(simulator.Simulator(arguments)).port)
        setting = run.Setting(
            line,
            listen,
            modbus_tcp,
            record,
            keep,
            pin if allow_commands else None,
            tuple(gateway.networks(write_from or [])),
            frozenset(name or []),
            commission=commission,
            demonstrate=simulate,
            parameters=winch.parameters() if winch else None,
        )
        run.run(setting, lambda url: print(f"ready {url}", flush=True), warn)


launches = typer.Typer(help="Launches that `levelwind serve --record` has recorded.")

Record = Annotated[
    Path, typer.Option("--record", envvar=RECORD_ENV, help="The record.", metavar="FILE.sqlite")
]
Number = Annotated[int, typer.Argument(help="Of the launch, from `list`.", min=1)]
RECORD_DEFAULT = Path("launches.sqlite")


def _result_words(result: dict[str, object]) -> str:
    """A launch's result in a line."""
    if "launch_permit" not in result:
        return str(result.get("cut", "being recorded, or cut by a kill"))
    words = [f"permit {result['launch_permit']}"]
    for name in ("los", "faults"):
        found = result.get(name)
        words += map(str, found) if isinstance(found, list) else []
    if "cut" in result:
        words.append(str(result["cut"]).splitlines()[0])
    return "; ".join(words)


def _numbers(result: dict[str, Any]) -> tuple[str, str]:
    """The greatest speed, of hauling in or pulling out, and the rope; of a cut launch nothing."""
    if "rope_m" not in result:
        return "", ""
    speeds = result["max_rope_speed_m_per_s"], -result["min_rope_speed_m_per_s"]
    return f"{max(speeds):.1f}", f"{result['rope_m']:+.1f}"


@launches.command("list")
def list_(
    record: Record = RECORD_DEFAULT,
    last: Annotated[int | None, typer.Option(help="Only so many.", min=1)] = None,
    json_output: Json = False,
) -> None:
    """Show the launches, newest first."""
    from levelwind.serve.recorder import Launches  # noqa: PLC0415 - only where it is used

    found = Launches(record).list(last)
    if json_output:
        print_json(found)
        return
    rows = [
        (
            str(one["id"]),
            one["began"].replace("T", " ")[:19],
            f"{one['seconds'] or 0:.1f}",
            *_numbers(one["result"]),
            _result_words(one["result"]),
        )
        for one in found
    ]
    print_table(("no.>", "began (UTC)", "s>", "max m/s>", "rope m>", "result"), rows)


@launches.command("show")
def show(
    number: Number,
    record: Record = RECORD_DEFAULT,
    plot: Annotated[Path | None, typer.Option(help="Picture to write.")] = None,
    json_output: Json = False,
) -> None:
    """Show one launch: result, events, parameters; --plot draws it."""
    from levelwind.serve.recorder import Launches, event_times_s  # noqa: PLC0415

    launch = Launches(record).one(number)
    if plot is not None:
        if not launch["samples"]:
            raise ToolError(f"Launch {number} has no samples.")
        from levelwind.show.recorder import write_plot  # noqa: PLC0415

        write_plot(launch["samples"], plot)
    if json_output:
        print_json(launch)
        return
    console.print(f"launch {number}, began {launch['began']}, ended {launch['ended'] or 'not yet'}")
    console.print(f"result: {_result_words(launch['result'] or {})}")
    console.print(f"firmware {launch['firmware']}, parameters {launch['parameters_sha256'][:16]}")
    console.print(f"{len(launch['samples'])} samples")
    rows = [
        (f"{seconds:.1f}", e["event"], e["detail"], e["state"])
        for e, seconds in zip(launch["events"], event_times_s(launch), strict=True)
    ]
    if rows:
        print_table(("s>", "event", "detail", "state"), rows)


@launches.command("export")
def export(
    number: Number,
    csv: Annotated[Path | None, typer.Option("--csv", help="Table to write.")] = None,
    record: Record = RECORD_DEFAULT,
) -> None:
    """Write the samples of one launch as CSV, to --csv FILE or standard output."""
    from levelwind.serve.recorder import Launches  # noqa: PLC0415

    table = Launches(record).csv(number)
    if csv is None:
        print(table, end="")
    else:
        whole_file.write(csv, table)
