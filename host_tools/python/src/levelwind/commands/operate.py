"""Commands for the operator: what is going on, and what shall happen."""

import time
from pathlib import Path
from typing import Annotated, Literal, NoReturn

import typer
from rich.live import Live

from levelwind import recorder
from levelwind.connection import Json, with_device
from levelwind.device import Device
from levelwind.errors import RefusedError, ToolError
from levelwind.map_table import (
    MAP_VERSION,
    POINTS,
    PRODUCT_CODE,
    PRODUCT_NAME,
    SELF_TEST,
    VENDOR,
    Command,
    Fault,
    Flag,
    Mode,
    State,
)
from levelwind.motion import INDEX_LIMIT_S, hold_jog
from levelwind.output import console, json_value, print_json
from levelwind.parameter_sets import read_sets
from levelwind.points import enum_label, format_value, parse_value
from levelwind.status import (
    Travel,
    describe_state,
    flag,
    read_live,
    read_status,
    read_travel,
    render,
    status_json,
)

WATCH_PERIOD_S = 0.2


@with_device
def identify(device: Device, json_output: Json = False) -> None:
    """Show what answers: product, version, map version, host."""
    points = [p for p in POINTS.values() if p.block == "status" and p.address < 100]
    values = device.read(points)
    if values["self_test"] != SELF_TEST:
        raise ToolError(
            f"{device.line} answers, but is no levelwind: register 0 reads "
            f"0x{values['self_test']:08X} instead of 0x{SELF_TEST:08X}."
        )
    if json_output:
        print_json({p.name: json_value(p, values[p.name]) for p in points})
        return
    version = ".".join(str(values[f"version_{part}"]) for part in ("major", "minor", "patch"))
    host = POINTS["host"]
    console.print(
        f"{VENDOR} {PRODUCT_CODE} ({PRODUCT_NAME}), version {version}, map {values['map_version']}"
    )
    console.print(f"host {format_value(host, values['host'])}, at {device.line}")
    if values["map_version"] != MAP_VERSION:
        console.print(f"This tool knows map {MAP_VERSION}: use the tool of the same release.")


@with_device
def status(
    device: Device,
    watch: Annotated[bool, typer.Option("--watch", help="Keep showing, until Ctrl-C.")] = False,
    json_output: Json = False,
) -> None:
    """Show state, launch permit, LOS, position, speed and switches."""
    if json_output:
        print_json(status_json(read_status(device)))
        return
    travel = read_travel(device)
    if not watch:
        console.print(render(read_status(device), travel))
        return
    if not console.is_terminal or console.is_dumb_terminal:
        _print_changes(device, travel)
    with Live(render(read_status(device), travel), console=console, auto_refresh=False) as live:
        while True:
            time.sleep(WATCH_PERIOD_S)
            live.update(render(read_status(device), travel), refresh=True)


def _print_changes(device: Device, travel: Travel) -> NoReturn:
    """Where nothing can be drawn over: the view again whenever what it says has changed."""
    shown = None
    while True:
        now = read_status(device)
        told = {name: now[name] for name in ("state", "fault", "flags", "launch_inhibit")}
        if told != shown:
            console.print(render(now, travel))
            shown = told
        time.sleep(WATCH_PERIOD_S)


@with_device
def index(device: Device) -> None:
    """Find the position (homing) and wait for the end. Ctrl-C stops the carriage."""
    with console.status("Indexing") as shown:

        def show() -> None:
            live = read_live(device)
            place = f"{live['position_um'] / 1000:+.1f} mm"
            shown.update(f"{describe_state(live)} ({place})")

        try:
            device.command(Command.INDEX, show, INDEX_LIMIT_S)
        except RefusedError as error:
            raise RefusedError(f"{error}{_span_error(device)}") from None
        except KeyboardInterrupt:
            device.command(Command.STOP)
            raise
    live = read_live(device)
    console.print(
        f"Indexed: {enum_label(State, live['state'])} at {live['position_um'] / 1000:+.2f} mm; "
        f"the other switch was {live['span_error_um'] / 1000:+.2f} mm from its place."
    )


def _span_error(device: Device) -> str:
    """After an indexing that failed by it: how far from its place the other switch was."""
    if device.value("fault") != Fault.INDEX_SPAN:
        return ""
    error_um = device.value("span_error_um")
    active = read_sets(device, [POINTS["span_tolerance_um"]])["active"]
    return (
        f"\nIt was {error_um / 1000:+.2f} mm from its place, or not there at all: "
        f"the search ends {active['span_tolerance_um'] / 1000:.2f} mm past it (span_tolerance_um)."
    )


@with_device
def stop(device: Device) -> None:
    """Stop every motion now."""
    device.command(Command.STOP)
    console.print("Stop accepted. It holds until `levelwind mode` or `levelwind index`.")


@with_device
def clear_fault(device: Device) -> None:
    """Acknowledge a fault whose cause is gone. Indexing is needed afterwards."""
    fault = device.value("fault")
    device.command(Command.CLEAR_FAULT)
    if fault:
        console.print(f"Cleared: {enum_label(Fault, fault)}. Position unknown? `levelwind index`.")
    else:
        console.print("There was no fault.")


@with_device
def mode(
    device: Device,
    mode: Annotated[
        Literal["track", "centre", "off"],
        typer.Argument(help="track: follow the drum; centre: hold the middle; off: no current."),
    ],
) -> None:
    """Say what the carriage shall do. Taken over when the drum is at rest; off at once."""
    device.write({"mode": int(Mode[mode.upper()])})
    live = read_live(device)
    in_force = enum_label(Mode, live["active_mode"])
    waits = "" if in_force == mode or flag(live, Flag.DRUM_AT_REST) else " until the drum rests"
    console.print(f"Asked for {mode}; in force: {in_force}{waits}.")


@with_device
def jog(
    device: Device,
    direction: Annotated[Literal["plus", "minus"], typer.Argument(help="Which way.")],
    seconds: Annotated[float, typer.Option("--for", help="Seconds.", min=0.05)] = 1.0,
) -> None:
    """Move the carriage by hand. Ctrl-C, or losing the line, stops it."""
    why = hold_jog(device, direction, seconds)
    live = read_live(device)
    place = f"{live['position_um'] / 1000:+.2f} mm"
    if flag(live, Flag.INDEXED):
        place = f"at {place}"
    else:
        place = f"{place} from where the jog began (position unknown)"
    console.print(f"{enum_label(State, live['state'])}, {place}{f'; {why}' if why else ''}")


@with_device
def trim(
    device: Device,
    plus_um: Annotated[int | None, typer.Option(help="Shift of the plus reversal, um.")] = None,
    minus_um: Annotated[int | None, typer.Option(help="Shift of the minus reversal, um.")] = None,
    json_output: Json = False,
) -> None:
    """Shift the reversal points, also while tracking; without options show the shift."""
    given = {"trim_plus_um": plus_um, "trim_minus_um": minus_um}
    values = {n: parse_value(POINTS[n], v) for n, v in given.items() if v is not None}
    if values:
        device.write(device.read_names(*given) | values)
    now = device.read_names(*given)
    pending = flag(read_live(device), Flag.TRIM_PENDING)
    if json_output:
        print_json({**now, "trim_pending": pending})
        return
    waits = " (waits for the sweep)" if pending else ""
    console.print(f"plus {now['trim_plus_um']} um, minus {now['trim_minus_um']} um{waits}")


@with_device
def watch(
    device: Device,
    plot: Annotated[
        str | None, typer.Option(help="Picture to write, or `live` for a window.")
    ] = None,
    seconds: Annotated[float, typer.Option(help="How long.", min=0.1)] = 10.0,
    csv: Annotated[Path | None, typer.Option(help="Table to write.")] = None,
) -> None:
    """Record position, speeds and flags over time. Ctrl-C keeps what was recorded."""
    if plot is None and csv is None:
        raise ToolError("Say where to: --plot FILE.png, --plot live or --csv FILE.")
    recording: recorder.Recording = []
    try:
        recorder.record(device, seconds, plot == "live", recording)
    finally:  # also what Ctrl-C or a lost line cut short
        if recording:
            if csv is not None:
                recorder.write_csv(recording, csv)
            if plot not in (None, "live"):
                recorder.write_plot(recording, Path(plot))
        taken_s = recording[-1]["time_s"] if recording else 0
        console.print(f"{len(recording)} records in {taken_s:.1f} s.")
