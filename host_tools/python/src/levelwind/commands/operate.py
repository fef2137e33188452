# SPDX-License-Identifier: Apache-2.0
"""Commands for the operator: what is going on, and what shall happen."""

import time
from collections.abc import Callable
from math import isfinite
from pathlib import Path
from typing import Annotated, Literal, NoReturn

import typer
from rich.live import Live
from rich.panel import Panel

from levelwind import interrupt
from levelwind.errors import RefusedError, ToolError
from levelwind.line import switch_delay
from levelwind.line.connection import Json, with_device, with_line
from levelwind.line.device import Device
from levelwind.line.live import (
    IDENTITY_POINTS,
    Travel,
    flag,
    image_of,
    read_live,
    read_status,
    read_travel,
    version_of,
)
from levelwind.line.motion import INDEX_LIMIT_S, hold_jog
from levelwind.line.parameter_sets import read_sets
from levelwind.line.points import check_limits, enum_label, format_value, parse_value
from levelwind.line.port import Line
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
from levelwind.show import recorder
from levelwind.show.output import console, json_value, print_json
from levelwind.show.status import describe_state, render, render_no_data, status_json

WATCH_PERIOD_S = 0.2
NO_DATA_AFTER_S = 1.0
REACQUIRE_LIMIT_S = 120.0  # two traverses of a slow drum
MEASURED_RATES_MIN = 2


@with_device
def identify(device: Device, json_output: Json = False) -> None:
    """Show what answers: product, version, map version, host."""
    values = device.read(IDENTITY_POINTS)
    if values["self_test"] != SELF_TEST:
        raise ToolError(
            f"{device.line} answers, but is no levelwind: register 0 reads "
            f"0x{values['self_test']:08X} instead of 0x{SELF_TEST:08X}."
        )
    if json_output:
        known = {p.name: json_value(p, values[p.name]) for p in IDENTITY_POINTS}
        print_json({**known, "image": image_of(values)})
        return
    host = POINTS["host"]
    console.print(
        f"{VENDOR} {PRODUCT_CODE} ({PRODUCT_NAME}), version {version_of(values)}, "
        f"map {values['map_version']}"
    )
    console.print(f"image {image_of(values) or 'not known: a simulator has none'}")
    console.print(f"host {format_value(host, values['host'])}, at {device.line}")
    if values["map_version"] != MAP_VERSION:
        console.print(f"This tool knows map {MAP_VERSION}: use the tool of the same release.")


@with_line
def status(
    line: Line,
    watch: Annotated[bool, typer.Option("--watch", help="Keep showing, until Ctrl-C.")] = False,
    json_output: Json = False,
) -> None:
    """Show state, launch permit, LOS, position, speed and switches."""
    with Device(line) as device:
        now = read_status(device)
        if json_output:
            print_json(status_json(now))
            return
        if not watch:
            console.print(render(now, read_travel(device)))
            return
    watching = Watching(line)
    if console.is_terminal and not console.is_dumb_terminal:
        # Drawn by a thread of its own: a reading that hangs must not leave the last one standing.
        with Live(
            get_renderable=watching.view,
            console=console,
            refresh_per_second=1 / WATCH_PERIOD_S,
            transient=True,
        ):
            watching.run(lambda: None)
    # Where nothing can be drawn over: the view again whenever what it says has changed.
    shown = None

    def show() -> None:
        nonlocal shown
        if watching.told != shown:
            shown = watching.told
            console.print(watching.view())

    watching.run(show)


class Watching:
    """A status that is read again and again, and whether it still may be shown."""

    def __init__(self, line: Line) -> None:
        self.told: object = None
        """What the view says; it is another one whenever the view has another meaning."""
        self._line = line
        self._panel: Panel | None = None
        self._reason = "waiting for the first answer"
        self._heard_s = time.monotonic()
        self._patience_s = NO_DATA_AFTER_S

    def view(self) -> Panel:
        """What to show now; nothing that is old."""
        panel, silent_s = self._panel, time.monotonic() - self._heard_s
        if panel is None or silent_s > self._patience_s:
            return render_no_data(self._reason, silent_s)
        return panel

    def run(self, show: Callable[[], None]) -> NoReturn:
        """Read for ever, also after the port or the controller was gone. Until Ctrl-C."""
        while True:
            try:
                with Device(self._line) as device:
                    travel = read_travel(device)
                    while True:
                        self._read(device, travel)
                        show()
                        time.sleep(WATCH_PERIOD_S)
            except ToolError as error:
                if interrupt.is_behind(error):
                    raise
                self._panel, self._reason, self.told = None, str(error), "no data"
                show()
            time.sleep(WATCH_PERIOD_S)

    def _read(self, device: Device, travel: Travel) -> None:
        began = time.monotonic()
        now = read_status(device)
        self._heard_s = time.monotonic()
        # A slow line takes its time; several of these without an answer are too many.
        self._patience_s = max(NO_DATA_AFTER_S, 3 * (self._heard_s - began + WATCH_PERIOD_S))
        self._panel, self._reason = render(now, travel), "The last request has not been answered."
        self.told = [now[name] for name in ("state", "fault", "flags", "flags_2", "launch_inhibit")]


@with_device
def index(
    device: Device,
    rates: Annotated[
        str | None,
        typer.Option(
            help="Index at each of these rates and say how late the switches tell, for "
            "switch_delay_us. The index is invalid afterwards.",
            metavar="2500,5000,10000,...",
        ),
    ] = None,
) -> None:
    """Find the position (homing) and wait for the end. Ctrl-C stops the carriage."""
    if rates is not None:
        _index_at_rates(device, rates)
        return
    with console.status("Indexing", spinner="line") as shown:

        def show() -> None:
            live = read_live(device)
            place = f"{live['position_um'] / 1000:+.1f} mm"
            shown.update(f"{describe_state(live)} ({place})")

        try:
            device.command(Command.INDEX, show, INDEX_LIMIT_S)
        except RefusedError as error:
            raise error.saying(f"{error}{_span_error(device)}") from None
        except KeyboardInterrupt:
            device.command(Command.STOP)
            raise
    live = read_live(device)
    console.print(
        f"Indexed: {enum_label(State, live['state'])} at {live['position_um'] / 1000:+.2f} mm; "
        f"the other switch was {live['span_error_um'] / 1000:+.2f} mm from its place."
    )


def _index_at_rates(device: Device, rates: str) -> None:
    """Measure the switches' delay and propose switch_delay_us."""
    point = POINTS["index_rate_edges_per_s"]
    wanted = [parse_value(point, rate) for rate in rates.split(",")]
    if len(set(wanted)) < MEASURED_RATES_MIN:
        raise ToolError(f"--rates {rates}: a delay shows between different rates only: give two.")
    with console.status("Indexing", spinner="line") as shown:
        try:
            samples, in_force_us = switch_delay.measure(
                device, wanted, lambda rate: shown.update(f"Indexing at {rate} edges/s")
            )
        except RefusedError as error:
            raise error.saying(f"{error}{_span_error(device)}") from None
    delay = switch_delay.fit(samples)
    for sample in samples:
        console.print(
            f"{sample.rate_edges_per_s:>7} edges/s, {sample.speed_um_per_s / 1000:6.1f} mm/s: "
            f"the switches are {sample.apart_um / 1000:+.2f} mm too far apart."
        )
    proposed_us = switch_delay.proposal_us(in_force_us, delay)
    console.print(
        f"They tell {delay.delay_us / 1000:+.2f} ms late beyond switch_delay_us={in_force_us}; the "
        f"worst of these is {delay.residual_um / 1000:.2f} mm off that line. At no speed they are "
        f"{delay.apart_um / 1000:+.2f} mm too far apart: their calibrated positions.\n"
        f"`levelwind set switch_delay_us={proposed_us}`, then apply, save, and index."
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
def reacquire(device: Device) -> None:
    """After a restart in a launch: take up the turning drum. The carriage moves at once."""
    with console.status("Taking up the drum", spinner="line"):
        device.command(Command.REACQUIRE, limit_s=REACQUIRE_LIMIT_S)
    live = read_live(device)
    console.print(
        f"Following again, at {live['position_um'] / 1000:+.2f} mm. The rope may be laid wrong: "
        "after the launch look at it, then `levelwind index`."
    )


@with_device
def stop(device: Device) -> None:
    """Stop every motion now."""
    device.command(Command.STOP)
    console.print("Stop accepted. It holds until `levelwind mode` or `levelwind index`.")


@with_device
def clear_fault(device: Device) -> None:
    """Acknowledge a fault whose cause is gone. Indexing is needed afterwards."""
    before = read_live(device)
    wiring = [side for side in ("plus", "minus") if flag(before, Flag[f"WIRING_{side.upper()}"])]
    try:
        device.command(Command.CLEAR_FAULT)
    except RefusedError as refusal:
        still = "".join(
            f"\nThe wiring of the {side} limit switch is still faulty." for side in wiring
        )
        raise refusal.saying(f"{refusal}{still}") from None
    cleared = [enum_label(Fault, before["fault"])] if before["fault"] else []
    cleared += [f"wiring fault of the {side} limit switch" for side in wiring]
    if cleared:
        console.print(f"Cleared: {', '.join(cleared)}. Position unknown? `levelwind index`.")
    else:
        console.print("There was no fault.")


@with_device
def acknowledge(device: Device) -> None:
    """Say that somebody has looked at rope that was laid while the carriage stood. First index."""
    millirev = device.value("rope_standing_millirev")
    device.command(Command.ACKNOWLEDGE_ROPE)
    if millirev:
        console.print(f"Acknowledged: {millirev / 1000:.1f} drum turns of rope.")
    else:
        console.print("No rope was laid while the carriage stood.")


@with_device
def set_rope(
    device: Device,
    metres: Annotated[float, typer.Argument(help="Metres of rope that are on the drum now.")],
) -> None:
    """Say how much rope is on the drum, where that is known. The drum must be at rest."""
    if not isfinite(metres):
        raise ToolError(f"{metres}: metres of rope on the drum.")
    device.write({"set_rope_mm": check_limits(POINTS["set_rope_mm"], round(metres * 1000))})
    device.command(Command.SET_ROPE)
    console.print(f"{device.value('rope_on_drum_mm') / 1000:.1f} m on the drum.")


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
