# SPDX-License-Identifier: Apache-2.0
"""The command about metres of rope."""

from math import isfinite
from typing import Annotated

import typer

from levelwind.commands.lay import Assignments, File, FromDevice, pair, parameters_of
from levelwind.errors import ToolError
from levelwind.lay import rope as metres
from levelwind.lay.wind import edges_per_drum_rev
from levelwind.line.connection import Json, with_line
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.show.output import print_json, print_table
from levelwind.show.terminal import say

TURN_OFF = 0.1
"""A drum turned so much too far or not far enough, as an eye may miss."""


def _turns_by_hand(line: Line, lengths_m: tuple[float, float], edges_per_rev: float) -> float:
    """Turns that the controller counts between two moments."""
    counts = []
    for length_m in lengths_m:
        say(f"Wind until {length_m:g} m are on the drum, rest it, then press Enter.")
        try:
            input()
        except EOFError:
            raise ToolError(
                "Nobody pressed Enter: give the turns between the two lengths by --turns."
            ) from None
        with Device(line) as device:
            counts.append(device.value("net_edges"))
    return (counts[1] - counts[0]) / edges_per_rev


@with_line
def rope(
    line: Line,
    file: File = None,
    fit: Annotated[
        str | None,
        typer.Option(
            help="Fit the packing: two known lengths on the drum, metres, as 100/800.",
            metavar="M/M",
        ),
    ] = None,
    turns: Annotated[
        float | None,
        typer.Option(help="Drum turns between them; else the controller counts them."),
    ] = None,
    from_device: FromDevice = False,
    assignments: Assignments = None,
    json_output: Json = False,
) -> None:
    """Fit how tightly rope packs, so that metres follow the growing layers."""
    if fit is None:
        raise ToolError("Give --fit with two known lengths, as --fit 100/800.")
    first_m, second_m = pair("--fit", fit, "100/800")
    if not 0 <= first_m < second_m <= metres.ROPE_M_MAX:
        raise ToolError(
            f"--fit {fit}: two lengths on the drum, the shorter first, 0 to {metres.ROPE_M_MAX} m."
        )
    if turns is None and not from_device:
        raise ToolError("Give --turns, or --from-device to have the controller count them.")
    if turns is not None and not (isfinite(turns) and turns > 0):
        raise ToolError(f"--turns {turns:g}: the drum turns from {first_m:g} to {second_m:g} m.")
    parameters = parameters_of(line, file, from_device, assignments)
    drum = metres.drum(parameters)
    if turns is None:
        turns = _turns_by_hand(line, (first_m, second_m), float(edges_per_drum_rev(parameters)))
    permille = round(metres.fit(drum, first_m, second_m, turns) * 1000)
    # How well the lengths tell it: by how much a small mistake in the turns moves it.
    least, most = (
        round(metres.fit(drum, first_m, second_m, turns + off, clip=True) * 1000)
        for off in (-TURN_OFF, TURN_OFF)
    )
    command = f"levelwind set rope_packing_permille={permille}"
    if json_output:
        print_json(
            {
                "turns": round(turns, 4),
                "rope_packing_permille": permille,
                "rope_packing_permille_within": [least, most],
                "set": command,
            }
        )
        return
    radius_mm = drum.wound_radius_m(second_m, permille / 1000) * 1000
    print_table(
        ("", "value>", "unit", ""),
        [
            ("turns", f"{turns:.2f}", "", f"from {first_m:g} to {second_m:g} m"),
            (
                "packing",
                str(permille),
                "1/1000",
                f"{least} to {most} if {TURN_OFF:g} turns are off",
            ),
            (
                "wound radius",
                f"{radius_mm:.1f}",
                "mm",
                f"with {second_m:g} m; bare {drum.radius_m * 1000:.1f} mm",
            ),
        ],
    )
    print(f"\n{command}")
