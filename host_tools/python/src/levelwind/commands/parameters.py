# SPDX-License-Identifier: Apache-2.0
"""Commands about parameters: read, write, make active, keep."""

from dataclasses import asdict
from typing import Annotated, Literal

import typer

from levelwind.errors import ToolError
from levelwind.line.connection import Json, with_device
from levelwind.line.device import Device
from levelwind.line.parameter_sets import COPIES, read_sets
from levelwind.line.plant import write_plant
from levelwind.line.points import (
    PARAMETERS,
    format_value,
    limits_text,
    lookup,
    parse_assignments,
)
from levelwind.map_table import POINTS, Command, Point
from levelwind.show.output import console, json_value, print_csv, print_json, print_table

Names = Annotated[list[str] | None, typer.Argument(help="Names, or parts of names.")]


def _matching(names: list[str]) -> list[Point]:
    """Points of exactly these names, or whose names contain one of them."""
    chosen: dict[str, Point] = {}
    for name in names:
        exact = POINTS.get(name)
        found = [exact] if exact else [p for p in POINTS.values() if name in p.name]
        chosen |= {p.name: p for p in found or [lookup(name)]}
    return list(chosen.values())


@with_device
def get(device: Device, names: Names = None, json_output: Json = False) -> None:
    """Show registers: parameters as staged, active and stored. Without names: all parameters."""
    points = _matching(names) if names else PARAMETERS
    parameters = [p for p in points if p.mirrors]
    others = [p for p in points if not p.mirrors]
    sets = read_sets(device, parameters)
    values = device.read(others)
    if json_output:
        document: dict[str, object] = {
            p.name: {
                **{copy: json_value(p, sets[copy][p.name]) for copy in COPIES},
                "unit": p.unit,
                "min": p.min,
                "max": p.max,
                "default": p.default,
            }
            for p in parameters
        }
        document |= {
            p.name: {"value": json_value(p, values[p.name]), "unit": p.unit} for p in others
        }
        print_json(document)
        return
    if parameters:
        rows = [
            (
                p.name,
                *(format_value(p, sets[copy][p.name]) for copy in COPIES),
                p.unit,
                "" if p.enum else limits_text(p).removesuffix(f" {p.unit}"),
            )
            for p in parameters
        ]
        print_table(("name", "staged>", "active>", "stored>", "unit", "limits"), rows)
    if others:
        rows = [(p.name, format_value(p, values[p.name]), p.unit, p.text) for p in others]
        print_table(("name", "value>", "unit", "meaning"), rows)


@with_device
def set_values(
    device: Device,
    assignments: Annotated[list[str], typer.Argument(help="NAME=VALUE ...", metavar="NAME=VALUE")],
) -> None:
    """Write registers, all or nothing. Parameters are staged: `apply` makes them active."""
    values = parse_assignments(assignments)
    for name in values:
        if POINTS[name].space != "holding":
            raise ToolError(f"{name} is a coil: give its command instead of setting it.")
    if any(POINTS[name].block == "bench" for name in values):
        write_plant(device, values)
    else:
        device.write(values)
    if any(POINTS[name].mirrors for name in values):
        console.print("Staged. `levelwind apply` makes it active.")
    else:
        console.print("Written.")


@with_device
def apply(device: Device) -> None:
    """Check the staged parameters as a whole and make them active."""
    indexed = device.value("indexed")
    device.command(Command.APPLY)
    console.print("Active. `levelwind save` keeps it over a power cut.")
    if indexed and not device.value("indexed"):
        console.print("The position is unknown now: `levelwind index`.")


@with_device
def revert(device: Device) -> None:
    """Drop the staged parameters: staged becomes active again."""
    device.command(Command.REVERT)
    console.print("Reverted: staged equals active.")


@with_device
def save(device: Device) -> None:
    """Write the active parameters to non-volatile storage."""
    device.command(Command.SAVE)
    console.print("Saved.")


@with_device
def factory(
    device: Device,
    scope: Annotated[
        Literal["motion", "line", "all"],
        typer.Argument(help="motion: all but the line settings; line: only those."),
    ],
) -> None:
    """Stage factory values. `diff` shows, `apply` makes them active."""
    device.command(Command[f"FACTORY_{scope.upper()}"])
    console.print("Staged. `levelwind diff` shows what would change, `levelwind apply` does it.")


@with_device
def diff(device: Device, json_output: Json = False) -> None:
    """Show the parameters whose staged, active and stored values differ."""
    sets = read_sets(device, PARAMETERS)
    differing = [p for p in PARAMETERS if len({sets[copy][p.name] for copy in COPIES}) > 1]
    if json_output:
        print_json({p.name: {c: json_value(p, sets[c][p.name]) for c in COPIES} for p in differing})
    elif not differing:
        console.print("Staged, active and stored parameters are equal.")
    else:
        rows = [
            (p.name, *(format_value(p, sets[copy][p.name]) for copy in COPIES), p.unit)
            for p in differing
        ]
        print_table(("name", "staged>", "active>", "stored>", "unit"), rows)


def map_(
    names: Names = None,
    json_output: Json = False,
    csv_output: Annotated[bool, typer.Option("--csv", help="Print CSV.")] = False,
) -> None:
    """Show the register table; with names only what matches."""
    points = _matching(names) if names else list(POINTS.values())
    if json_output:
        print_json([{**asdict(p), "enum": _enum(p), "bits": _bits(p)} for p in points])
    elif csv_output:
        print_csv(
            [
                {
                    "name": p.name,
                    "space": p.space,
                    "address": p.address,
                    "type": p.type,
                    "unit": p.unit,
                    "limits": limits_text(p).removesuffix(f" {p.unit}"),
                    "default": "" if p.default is None else format_value(p, p.default),
                    "text": p.text,
                }
                for p in points
            ]
        )
    else:
        rows = [
            (p.space, str(p.address), _number(p), p.type, p.name, p.unit, p.text) for p in points
        ]
        print_table(("space", "address>", "1-based>", "type", "name", "unit", "meaning"), rows)


def _number(point: Point) -> str:
    """The address in the counting that many HMIs show: 40001 is holding register 0."""
    prefix = {"coil": 0, "discrete": 1, "input": 3, "holding": 4}[point.space]
    number = point.address + 1
    return f"{prefix}{number:04d}" if number <= 9999 else f"{prefix}{number:05d}"


def _enum(point: Point) -> dict[str, int] | None:
    return {member.label: int(member) for member in point.enum} if point.enum else None


def _bits(point: Point) -> dict[str, int] | None:
    return {member.label: int(member) for member in point.bits} if point.bits else None
