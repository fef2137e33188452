# SPDX-License-Identifier: Apache-2.0
"""Commands about rope on the drum."""

from math import isfinite
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from levelwind.errors import ToolError
from levelwind.lay import field, report, rope, search, sources
from levelwind.lay.wind import edges_per_drum_rev, wind
from levelwind.line.connection import Json, with_line
from levelwind.line.device import Device
from levelwind.line.parameter_sets import read_set
from levelwind.line.points import parse_assignments
from levelwind.line.port import Line
from levelwind.map_table import POINTS, MotionProfile
from levelwind.show.output import console, print_json, print_table, warn

PATTERNS = 400
PATTERNS_MAX = 20_000
CURVE_POINTS = 240
PITCH_PART = 0.1
DWELL_MILLIREV = (0, 300)

File = Annotated[
    Path | None,
    typer.Argument(help="Backup, or what `plan --json` prints. Default: factory.", metavar="FILE"),
]
FromDevice = Annotated[
    bool, typer.Option("--from-device", help="The active parameters of the controller instead.")
]
Assignments = Annotated[
    list[str] | None, typer.Option("--set", help="Any parameter.", metavar="NAME=VALUE")
]


def parameters_of(
    line: Line, file: Path | None, from_device: bool, assignments: list[str] | None
) -> dict[str, int]:
    """The set that is meant."""
    if from_device and file is not None:
        raise ToolError("Give FILE or --from-device, not both.")
    if from_device:
        with Device(line) as device:
            values = read_set(device, "active")
            trim = device.read_names("trim_plus_um", "trim_minus_um")
        if any(trim.values()):
            shifts = ", ".join(f"{name} {um}" for name, um in trim.items())
            warn(f"The reversal points are trimmed: {shifts}. It is laid so.")
            values = sources.trimmed(values, *trim.values())
    elif file is not None:
        values, missing = sources.read(file)
        if missing:
            warn(f"{file} lacks {', '.join(missing)}: taken from the factory set.")
    else:
        values = dict(sources.FACTORY)
    return sources.changed(values, parse_assignments(assignments or []))


def pair(option: str, text: str, example: str) -> tuple[float, float]:
    """Two numbers with a slash between, the lower first."""
    try:
        low, high = map(float, text.split("/"))
    except ValueError:
        raise ToolError(f"{option} {text}: give two numbers, as in {example}.") from None
    if not (isfinite(low) and isfinite(high) and low <= high):
        raise ToolError(f"{option} {text}: give the lower number first, as in {example}.")
    return low, high


def _band(
    parameters: dict[str, int], pitch: str | None, dwell: str | None, patterns: int
) -> search.Band:
    lowest, highest = (POINTS["pitch_um"].min or 0) / 1000, (POINTS["pitch_um"].max or 0) / 1000
    if pitch is None:
        now_mm = float(wind(parameters).pitch_mm)
        low, high = now_mm * (1 - PITCH_PART), now_mm * (1 + PITCH_PART)
        low, high = max(lowest, round(low, 1)), min(highest, max(round(high, 1), round(low, 1)))
    else:
        low, high = pair("--band-pitch", pitch, "10.5/13")
        if low < lowest or high > highest:
            raise ToolError(f"--band-pitch {pitch}: limits {lowest:g} to {highest:g} mm.")
    dwell_max = POINTS["dwell_plus_millirev"].max or 0
    dwell_low, dwell_high = DWELL_MILLIREV
    if dwell is not None:
        shortest, longest = pair("--band-dwell", dwell, "0/300")
        if not 0 <= shortest <= longest <= dwell_max or shortest % 1 or longest % 1:
            raise ToolError(
                f"--band-dwell {dwell}: whole thousandths of a drum turn, limits 0 to {dwell_max}."
            )
        dwell_low, dwell_high = int(shortest), int(longest)
    return search.Band((round(low * 1000), round(high * 1000)), (dwell_low, dwell_high), patterns)


def _diameter_um(parameters: dict[str, int], rope_mm: float | None) -> int:
    limit = POINTS["rope_diameter_um"].max or 0
    if rope_mm is None:
        rope_um = parameters["rope_diameter_um"]
        if rope_um == 0:
            raise ToolError(
                "The rope's diameter is not known (rope_diameter_um is 0). Measure it, and give "
                "--rope-mm 5, or set it: levelwind set rope_diameter_um=5000"
            )
        return rope_um
    if not isfinite(rope_mm) or not 1 <= round(rope_mm * 1000) <= limit:
        raise ToolError(
            f"--rope-mm {rope_mm:g}: the rope's diameter, limits 0.001 to {limit / 1000:g} mm."
        )
    return round(rope_mm * 1000)


def _check_length(parameters: dict[str, int], rope_m: float) -> None:
    if not isfinite(rope_m) or not 0 < rope_m <= rope.ROPE_M_MAX:
        raise ToolError(
            f"--rope-m {rope_m:g}: the length of rope to lay, above 0, at most {rope.ROPE_M_MAX} m."
        )
    turns = rope.turns_of(parameters, rope_m)
    if turns > field.TURNS_MAX:
        raise ToolError(
            f"--rope-m {rope_m:g}: {turns:.3g} drum turns, limit {field.TURNS_MAX}. Lay less rope, "
            "or check rope_per_drum_rev_um."
        )
    edges = turns * float(edges_per_drum_rev(parameters))
    if edges > field.EDGES_MAX:
        raise ToolError(
            f"--rope-m {rope_m:g}: {edges:.3g} edges of this encoder, limit {field.EDGES_MAX:.3g}. "
            "Lay less rope."
        )


@with_line
def lay(
    line: Line,
    file: File = None,
    from_device: FromDevice = False,
    assignments: Assignments = None,
    rope_mm: Annotated[
        float | None, typer.Option(help="Rope diameter; default: rope_diameter_um of the set.")
    ] = None,
    rope_m: Annotated[
        float, typer.Option(help="Length of rope to lay; default: a launch.")
    ] = rope.LAUNCH_M,
    band_pitch: Annotated[
        str | None,
        typer.Option(help="Pitches to try, mm, as 10.5/13. Default: 10 % around.", metavar="MM/MM"),
    ] = None,
    band_dwell: Annotated[
        str | None,
        typer.Option(
            help="Dwells to try, 1/1000 drum turn, as 0/300.", metavar="MILLIREV/MILLIREV"
        ),
    ] = None,
    patterns: Annotated[
        int,
        typer.Option(help="Settings to try; 0: recommend nothing.", min=0, max=PATTERNS_MAX),
    ] = PATTERNS,
    plot: Annotated[Path | None, typer.Option("--plot", help="Picture to write.")] = None,
    json_output: Json = False,
) -> None:
    """How the rope will lie: wind ratio, ribbons, evenness, and better settings."""
    parameters = parameters_of(line, file, from_device, assignments)
    if plot is not None:
        from levelwind.show.plots import check_format  # noqa: PLC0415 - matplotlib takes a second

        check_format(plot)
    parameters["rope_diameter_um"] = _diameter_um(parameters, rope_mm)
    _check_length(parameters, rope_m)
    if parameters["motion_profile"] == MotionProfile.CAM:
        warn(
            "motion_profile is cam: the carriage follows a cam table. What follows is told of the "
            "screw, by pitch and dwell."
        )
    band = _band(parameters, band_pitch, band_dwell, patterns)
    result = report.lay(parameters, rope_m)
    recommended: list[search.Recommendation] = []
    curve = []
    # On standard error: what a program reads stays clean.
    on_terminal = Console(stderr=True)
    with Progress(
        console=on_terminal, transient=True, disable=not on_terminal.is_terminal
    ) as progress:
        if patterns:
            task = progress.add_task("trying settings", total=None)
            recommended = search.recommend(
                parameters, band, result.rope_um, result.turns,
                lambda done, total: progress.update(task, completed=done, total=total),
            )  # fmt: skip
        if plot is not None:
            low, high = band.pitch_um
            pitches = [low + (high - low) * i // CURVE_POINTS for i in range(CURVE_POINTS + 1)]
            drawing = progress.add_task("over pitch", total=len(pitches))
            curve = search.over_pitch(
                parameters, pitches, result.rope_um, result.turns,
                lambda done: progress.update(drawing, completed=done),
            )  # fmt: skip
    if plot is not None:
        from levelwind.lay import plots  # noqa: PLC0415 - matplotlib takes a second

        plots.draw(result, curve, recommended, plot)
    if json_output:
        print_json(result.document(recommended))
        return
    _show(result, recommended, patterns)


def _show(result: report.Lay, recommended: list[search.Recommendation], patterns: int) -> None:
    print_table(("quantity", "value>", "unit", ""), result.rows())
    console.print("")
    print_table(("double traverses ago>", "mm beside>", ""), result.displacements())
    for text in result.sentences():
        console.print("")
        console.print(text)
    if not patterns:
        return
    console.print("")
    if not recommended:
        console.print("The controller takes none of the settings in this band.")
        return
    if result.evenness.std_mm <= recommended[0].evenness.std_mm:
        console.print("Nothing in this band is more even than the set as it is.")
    print_table(
        ("uneven>", "near by>", "highest>", "low>", "wind ratio>", "ribbons", "to set it"),
        report.recommended_rows(recommended),
    )
    console.print("")
    console.print(
        "Millimetres of a rigid rope: compare settings by them. near by: with a little more or "
        "less dwell, as a trim by hand does it. Then `levelwind apply`, `save`, `index`."
    )
