"""Commands about cam tables."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Literal

import typer

from levelwind import cam_files, cam_levelwind, cam_report, planning
from levelwind.cam import Cam, Limits, Scale, Table, check
from levelwind.connection import Json
from levelwind.errors import ToolError
from levelwind.map_table import CamInterpolation
from levelwind.output import print_json, print_table, warn
from levelwind.points import parse_assignments

app = typer.Typer(
    no_args_is_help=True, help="Cam tables: the carriage follows rows of (master, slave)."
)

File = Annotated[Path, typer.Argument(help="Text or CSV with columns master, slave; or XLSX.")]
Interpolation = Annotated[
    Literal["linear", "trapezoid"], typer.Option("--interp", help="How to go from row to row.")
]
Advancing = Annotated[
    bool,
    typer.Option("--advancing", help="Each cycle begins where the last ended (else cyclic)."),
]
Master = Annotated[
    str, typer.Option("--master", help="Encoder edges to master units.", metavar="EDGES/UNITS")
]
Slave = Annotated[
    str, typer.Option("--slave", help="Microsteps to slave units.", metavar="USTEPS/UNITS")
]
Ramp = Annotated[
    int, typer.Option("--ramp", help="Trapezoid: a ramp is 1/N of its row.", min=2, max=100)
]
TopRate = Annotated[
    int, typer.Option("--top-rate", help="Fastest master, edges/s.", min=1, max=1_000_000)
]
StepRate = Annotated[
    int, typer.Option("--step-rate", help="Fastest step pulses, per second.", min=1)
]
FRACTION_MAX = 10_000
TOP_RATE = 60_000
STEP_RATE = 200_000


def _fraction(option: str, text: str) -> tuple[int, int]:
    try:
        numerator, denominator = (int(part) for part in text.split("/"))
    except ValueError:
        raise ToolError(f"{option}: {text!r} is no fraction; write it as 25/4.") from None
    for part in (numerator, denominator):
        if not 1 <= part <= FRACTION_MAX:
            raise ToolError(f"{option}: {part} is out of range, limits 1 to {FRACTION_MAX}.")
    return numerator, denominator


def scale_of(master: str, slave: str, ramp: int) -> Scale:
    """The scale that the options ask for."""
    return Scale(*_fraction("--master", master), *_fraction("--slave", slave), ramp)


def load(path: Path, interpolation: str, advancing: bool, name: str = "") -> Table:
    """The table in a file. What it advances by is what its rows say."""
    rows = cam_files.read(path)
    return Table(
        rows,
        CamInterpolation[interpolation.upper()],
        rows[-1][1] - rows[0][1] if advancing else 0,
        name or path.stem,
    )


@app.command("check")
def check_(
    file: File,
    interpolation: Interpolation = "linear",
    advancing: Advancing = False,
    master: Master = "1/1",
    slave: Slave = "1/1",
    ramp: Ramp = 10,
    top_rate: TopRate = TOP_RATE,
    step_rate: StepRate = STEP_RATE,
    json_output: Json = False,
) -> None:
    """Check a table by the controller's own rules; say what it asks of the machine."""
    table = load(file, interpolation, advancing)
    result = cam_report.report(table, scale_of(master, slave, ramp), Limits(top_rate, step_rate))
    if json_output:
        print_json(result.document())
        return
    print_table(("", "value>", "unit", ""), result.lines())
    for text in result.warnings:
        warn(text)


@app.command()
def plot(
    file: File,
    picture: Annotated[Path, typer.Argument(help="Picture to write.")],
    interpolation: Interpolation = "linear",
    advancing: Advancing = False,
    master: Master = "1/1",
    slave: Slave = "1/1",
    ramp: Ramp = 10,
    top_rate: TopRate = TOP_RATE,
    step_rate: StepRate = STEP_RATE,
) -> None:
    """Draw slave position, gear ratio and acceleration over a cycle, with the limits."""
    table = load(file, interpolation, advancing)
    result = cam_report.report(table, scale_of(master, slave, ramp), Limits(top_rate, step_rate))
    cam_report.plot(result, picture)
    for text in result.warnings:
        warn(text)


@app.command("from-levelwind")
def from_levelwind(
    file: Annotated[Path, typer.Argument(help="Table to write: .txt, .csv or .xlsx.")],
    assignments: Annotated[
        list[str] | None, typer.Option("--set", help="Any parameter.", metavar="NAME=VALUE")
    ] = None,
) -> None:
    """Write the level-wind law of a parameter set as a cam table, for linear rows."""
    screw = planning.plan(planning.check(parse_assignments(assignments or [])), 1.0).screw
    rows = cam_levelwind.rows(screw)
    cam_files.write(
        file,
        rows,
        [
            f"level wind: Ka {screw.ka}, Nr {screw.nr}, L+ {screw.reversal_plus_usteps}, "
            f"L- {screw.reversal_minus_usteps}; master in edges, slave in microsteps"
        ],
    )
    print_table(
        ("", "value>", "unit"),
        [("rows", str(len(rows)), ""), ("cycle", str(rows[-1][0]), "edges")],
    )


def replay(
    table: Table, scale: Scale, runs: list[int], trace_points: int
) -> tuple[dict[str, int], list[int], int]:
    """The compiled cam over runs of edges: result for --json, trace and its stride."""
    check(table, scale, Limits(1, 4))  # the machine's speed is not asked for
    result, trace, stride = Cam(table, scale).run(runs, trace_points)
    return asdict(result), trace.tolist(), stride
