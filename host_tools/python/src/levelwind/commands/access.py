# SPDX-License-Identifier: Apache-2.0
"""Commands about getting at a controller: its write lock and its line settings."""

import contextlib
import dataclasses
import time
from typing import Annotated, Literal

import typer

from levelwind.errors import ToolError, UnknownOutcomeError
from levelwind.line.connection import with_device
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.line.parameter_sets import read_set, replace_set
from levelwind.line.points import parse_value
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command, Flag
from levelwind.show.output import console


@with_device
def unlock(
    device: Device,
    code: Annotated[str | None, typer.Argument(help="Asked for if it is left out.")] = None,
) -> None:
    """Open the write lock. It closes by itself after lock_timeout_s, or by `lock`."""
    if not flag(read_live(device), Flag.LOCKED):
        console.print("Not locked.")
        return
    if code is None:
        code = typer.prompt("Code", hide_input=True)
    device.write({"unlock": parse_value(POINTS["unlock"], code)})
    console.print(f"Open for {_active(device, 'lock_timeout_s')} s. `levelwind lock` closes it.")


@with_device
def lock(device: Device) -> None:
    """Close the write lock."""
    device.write({"unlock": 0})
    if not flag(read_live(device), Flag.LOCKED):
        raise ToolError(
            "There is no code: `levelwind set lock_code=...`, `apply`, `unlock`, `save`."
        )
    console.print("Locked.")


@with_device
def line(
    device: Device,
    new_unit: Annotated[int | None, typer.Option(help="Unit id.", metavar="1..247")] = None,
    new_baud: Annotated[int | None, typer.Option(help="Line speed.")] = None,
    new_line: Annotated[
        Literal["8E1", "8O1", "8N1", "8N2"] | None,
        typer.Option(help="Data bits, parity, stop bits."),
    ] = None,
) -> None:
    """Change the line settings, save them if the controller answers, else go back."""
    given = {"unit_id": new_unit, "baud_rate": new_baud, "line_format": new_line}
    values = {n: parse_value(POINTS[n], v) for n, v in given.items() if v is not None}
    if not values:
        raise ToolError("Nothing to change: give --new-unit, --new-baud or --new-line.")
    live = read_live(device)
    if flag(live, Flag.STAGED) or flag(live, Flag.DIRTY):
        raise ToolError(
            "Other parameters are staged or not saved, and would be saved with the line settings: "
            "`levelwind diff` shows them; apply, revert or save them first."
        )
    replace_set(device, values)
    changed = dataclasses.replace(
        device.line,
        unit=values.get("unit_id", device.line.unit),
        baud=values.get("baud_rate", device.line.baud),
        format=new_line or device.line.format,
    )
    confirm_s = _active(device, "line_confirm_s")
    with contextlib.suppress(UnknownOutcomeError):  # then the trial itself shows it
        device.write({"command": int(Command.TRY_LINE)})
    device.close()
    begin = time.monotonic()
    answering = _wait_for_answer(changed, confirm_s)
    if answering is None:
        time.sleep(max(0.0, begin + confirm_s - time.monotonic()))  # heard now, it would stay
        _go_back(device.line, confirm_s)
        raise ToolError(f"No answer from {changed}. {device.line} is in use again.")
    with answering:
        answering.command(Command.SAVE)
    console.print(f"Saved. The controller is at {changed} from now on.")


def _active(device: Device, name: str) -> int:
    """A parameter in force."""
    return read_set(device, "active", [POINTS[name]])[name]


def _wait_for_answer(line: Line, limit_s: float) -> Device | None:
    """A connection on which the controller has answered."""
    deadline = time.monotonic() + limit_s
    device = Device(dataclasses.replace(line, timeout_s=min(line.timeout_s, limit_s / 4)))
    while time.monotonic() < deadline:
        try:
            device.value("self_test")
        except ToolError:
            continue
        return device
    device.close()
    return None


def _go_back(line: Line, limit_s: float) -> None:
    """Wait for the controller at the old settings, and drop the new ones."""
    device = _wait_for_answer(line, limit_s)
    if device is None:
        raise ToolError(f"No answer from {line} either. Restart the controller: nothing was saved.")
    with device:
        device.command(Command.REVERT)
