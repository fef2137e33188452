# SPDX-License-Identifier: Apache-2.0
"""Commands that need no controller: from millimetres to registers, and the law replayed."""

from dataclasses import asdict
from math import isfinite
from pathlib import Path
from typing import Annotated

import typer

from levelwind.commands import cam
from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.line.connection import Json
from levelwind.line.points import parse_assignments
from levelwind.plan import planning
from levelwind.show.output import print_json, print_table, warn

Plot = Annotated[Path | None, typer.Option("--plot", help="Picture to write.")]
TRACE_POINTS = 20_000


def _pair(text: str | None, name: str, example: str) -> tuple[float, float] | tuple[None, None]:
    """Two numbers with a slash between, as in the example."""
    if text is None:
        return None, None
    try:
        first, second = map(float, text.split("/"))
        return first, second
    except ValueError:
        raise typer.BadParameter(
            f"{text!r}: give two numbers, as in {example}", param_hint=name
        ) from None


def plan(
    pitch_mm: Annotated[float | None, typer.Option(help="Carriage travel per drum rev.")] = None,
    lead_mm: Annotated[float | None, typer.Option(help="Carriage travel per screw rev.")] = None,
    belt_mm_per_rev: Annotated[
        float | None, typer.Option(help="Belt: carriage travel per pulley rev, instead of a lead.")
    ] = None,
    microsteps: Annotated[int | None, typer.Option(help="Microsteps per stepper rev.")] = None,
    ppr: Annotated[int | None, typer.Option(help="Encoder pulses per rev.")] = None,
    edges: Annotated[int | None, typer.Option(help="Edges used per pulse: 1, 2, 4.")] = None,
    ratio: Annotated[str | None, typer.Option(help="Encoder/drum revs, as 4/1 or 4.")] = None,
    rope_per_rev_mm: Annotated[float | None, typer.Option(help="Rope per drum rev.")] = None,
    overshoot_mm: Annotated[float | None, typer.Option(help="Run past a reversal point.")] = None,
    reversal_mm: Annotated[str | None, typer.Option(help="Reversal points, as +80/-80.")] = None,
    flange_mm: Annotated[str | None, typer.Option(help="Flanges, as +82.5/-82.5.")] = None,
    switch_mm: Annotated[str | None, typer.Option(help="Limit switches, as +78/-78.")] = None,
    travel_mm: Annotated[float | None, typer.Option(help="Between the end stops.")] = None,
    assignments: Annotated[
        list[str] | None, typer.Option("--set", help="Any parameter.", metavar="NAME=VALUE")
    ] = None,
    rope_speed: Annotated[
        float, typer.Option(help="Rope speed for rates and times, m/s.", min=0.01, max=200)
    ] = 20.0,
    plot: Plot = None,
    json_output: Json = False,
) -> None:
    """Millimetres in, registers out: what the core makes of a parameter set, or why it refuses."""
    if lead_mm is not None and belt_mm_per_rev is not None:
        raise ToolError("Give --lead-mm for a screw or --belt-mm-per-rev for a belt, not both.")
    gear = None if ratio is None else planning.ratio(ratio)
    reversal_plus, reversal_minus = _pair(reversal_mm, "--reversal-mm", "80/-80")
    flange_plus, flange_minus = _pair(flange_mm, "--flange-mm", "82.5/-82.5")
    switch_plus, switch_minus = _pair(switch_mm, "--switch-mm", "78/-78")
    in_mm = {
        "pitch_um": pitch_mm,
        "screw_lead_um": lead_mm if belt_mm_per_rev is None else belt_mm_per_rev,
        "rope_per_drum_rev_um": rope_per_rev_mm,
        "overshoot_um": overshoot_mm,
        "reversal_plus_um": reversal_plus,
        "reversal_minus_um": reversal_minus,
        "flange_plus_um": flange_plus,
        "flange_minus_um": flange_minus,
        "switch_plus_um": switch_plus,
        "switch_minus_um": switch_minus,
        "travel_um": travel_mm,
    }
    plain = {
        "microsteps_per_rev": microsteps,
        "encoder_pulses_per_rev": ppr,
        "encoder_edges_per_pulse": edges,
        "encoder_ratio_numerator": gear and gear.numerator,
        "encoder_ratio_denominator": gear and gear.denominator,
    }
    for name, number in {**in_mm, "--rope-speed": rope_speed}.items():
        if number is not None and not isfinite(number):
            raise ToolError(f"{name.removesuffix('_um')} {number}: give a number.")
    given = {name: round(mm * 1000) for name, mm in in_mm.items() if mm is not None}
    given |= {name: int(value) for name, value in plain.items() if value is not None}
    # Factory values that were given are set too: the controller may hold others.
    changes = planning.check(given) | parse_assignments(assignments or [])
    moved = planning.along(changes)
    if moved:
        warn(
            "Not given, moved along: "
            + ", ".join(f"{name} {um / 1000:g} mm" for name, um in moved.items())
            + ". Measure them, and give them."
        )
    changes |= planning.check(moved)
    result = planning.plan(changes, rope_speed, belt=belt_mm_per_rev is not None)
    for warning in result.warnings():
        warn(warning)
    if plot is not None:
        planning.plot(result, plot)
    if json_output:
        print_json(result.document() | {"moved_along": moved})
        return
    print_table(("quantity", "value>", "unit", ""), result.rows())
    if changes:
        # Not through the console, which would break the line: it is there to be copied.
        print("\nlevelwind set " + " ".join(f"{n}={v}" for n, v in changes.items()))


def replay(
    drum: Annotated[
        str, typer.Option(help="Runs of drum edges, as +20000,-3000.", metavar="EDGES,...")
    ],
    ka: Annotated[int | None, typer.Option(help="Slope change per edge, Q16.16.")] = None,
    nr: Annotated[int | None, typer.Option(help="Edges from sweep slope to zero slope.")] = None,
    lplus: Annotated[int | None, typer.Option(help="L+, microsteps.")] = None,
    lminus: Annotated[int | None, typer.Option(help="L-, microsteps.")] = None,
    m: Annotated[int, typer.Option(help="Start position, Q16.16.")] = 0,
    u: Annotated[int | None, typer.Option(help="Start slope, Q16.16; default Ks.")] = None,
    dwell_plus: Annotated[int, typer.Option(help="Dwell at the plus side, edges.")] = 0,
    dwell_minus: Annotated[int, typer.Option(help="Dwell at the minus side, edges.")] = 0,
    breaker_edges: Annotated[
        int, typer.Option(help="Most that the ribbon breaker adds to a dwell, edges.")
    ] = 0,
    breaker_cycles: Annotated[
        int, typer.Option(help="Double traverses in which it goes up and down once.")
    ] = 0,
    cam_file: Annotated[
        Path | None, typer.Option("--cam", help="Follow this cam table instead of the law.")
    ] = None,
    interpolation: cam.Interpolation = "linear",
    advancing: cam.Advancing = False,
    master: cam.Master = "1/1",
    slave: cam.Slave = "1/1",
    ramp: cam.Ramp = 10,
    plot: Plot = None,
    json_output: Json = False,
) -> None:
    """Run the compiled law, or a cam, over runs of forward and backward drum edges."""
    runs = planning.parse_runs(drum)
    points = TRACE_POINTS if plot else 0
    lines: tuple[int, ...] = ()
    if cam_file is not None:
        table = cam.load(cam_file, interpolation, advancing)
        document, trace, stride = cam.replay(table, cam.scale_of(master, slave, ramp), runs, points)
        title = table.name
    else:
        if ka is None or nr is None or lplus is None or lminus is None:
            raise ToolError("Give --ka, --nr, --lplus and --lminus for the law, or --cam FILE.")
        setup = planning.replay_setup(
            ka,
            nr,
            lplus,
            lminus,
            m,
            ka * nr if u is None else u,
            dwells=(dwell_plus, dwell_minus),
            breaker=(breaker_edges, breaker_cycles),
        )
        result, trace, stride = native.replay(setup, runs, points)
        document, title, lines = asdict(result), f"Ka {ka}, Nr {nr}", (lplus, lminus)
    if plot is not None:
        if not trace:
            raise ToolError("There is nothing to draw: no edges.")
        planning.plot_replay(trace, stride, title, lines, plot)
    if json_output:
        print_json(document)
    else:
        print_table(("", "value>"), [(name, str(value)) for name, value in document.items()])
