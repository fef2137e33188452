# SPDX-License-Identifier: Apache-2.0
"""Commands for work in the field: back up, restore, scripted setup."""

from pathlib import Path
from typing import Annotated

import typer

from levelwind.errors import ToolError
from levelwind.files import backups, script
from levelwind.line.connection import Json, with_device
from levelwind.line.device import Device
from levelwind.line.parameter_sets import COPIES, replace_set
from levelwind.map_table import Command
from levelwind.show.output import console, print_json

YamlFile = Annotated[Path, typer.Argument(help="YAML file.", metavar="FILE")]


@with_device
def backup(
    device: Device,
    file: YamlFile,
    copy: Annotated[str, typer.Option("--set", help="staged, active or stored.")] = "active",
) -> None:
    """Write all parameters to a file. A cam table is not in it: `levelwind cam download`."""
    if copy not in COPIES:
        raise ToolError(f"--set {copy}: give one of {', '.join(COPIES)}.")
    kept = backups.write(device, copy, file)
    console.print(f"{file}: the {copy} parameters.")
    if kept is not None:
        console.print(f"{kept}: what was in that file before.")


@with_device
def restore(
    device: Device,
    file: YamlFile,
    save: Annotated[bool, typer.Option("--save", help="Store them too.")] = False,
) -> None:
    """Make the parameters of a backup active, all or none."""
    values = backups.read(file, backups.read_firmware(device))
    indexed = device.value("indexed")
    replace_set(device, values)
    if save:
        device.command(Command.SAVE)
    console.print(f"{len(values)} parameters active{' and saved' if save else ''}.")
    if indexed and not device.value("indexed"):
        console.print("The position is unknown now: `levelwind index`.")


@with_device
def run(device: Device, file: YamlFile, json_output: Json = False) -> None:
    """Run a setup script; every step is checked before the first one is sent."""
    steps = script.load(file)
    results = []
    failure = None
    for number, step in enumerate(steps, 1):
        try:
            detail = step.run(device)
        except ToolError as error:
            failure = error
        results.append(
            {
                "step": number,
                "text": step.text,
                "ok": failure is None,
                "detail": detail if failure is None else str(failure),
            }
        )
        if not json_output and failure is None:
            console.print(f"{number:2d}/{len(steps)} {step.text}{f': {detail}' if detail else ''}")
        if failure is not None:
            break
    if json_output:
        print_json({"ok": failure is None, "steps": results})
    if failure is not None:
        raise ToolError(f"{file}, step {results[-1]['step']} ({results[-1]['text']}): {failure}")
