# SPDX-License-Identifier: Apache-2.0
"""Commands about cam tables."""

import struct
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Literal

import typer

from levelwind.cam import levelwind as cam_levelwind
from levelwind.cam import report as cam_report
from levelwind.cam.table import ROWS_MAX, Cam, Limits, Scale, Table, check, from_words, words
from levelwind.errors import RefusedError, ToolError
from levelwind.files import cam_files
from levelwind.line.connection import Json, with_device
from levelwind.line.device import COMMAND_STATUS, Device
from levelwind.line.parameter_sets import read_sets
from levelwind.line.points import parse_assignments
from levelwind.map_table import POINTS, CamBankState, CamInterpolation, Command, MotionProfile
from levelwind.plan import planning
from levelwind.show.output import console, print_json, print_table, warn

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
SCALE_PARAMETERS = (
    "cam_master_edges",
    "cam_master_units",
    "cam_slave_usteps",
    "cam_slave_units",
    "cam_ramp_divisor",
    "overspeed_trip_edges_per_s",
    "cam_steps_per_s_max",
)
TOP_RATE = POINTS["overspeed_trip_edges_per_s"].default or 0
STEP_RATE = POINTS["cam_steps_per_s_max"].default or 0

PROFILE = POINTS["motion_profile"]
CAM_REASON = [POINTS[f"cam_reason{part}"] for part in ("", "_row", "_value", "_limit")]

# A bank as a file (lw/cam/cam_banks.h).
FIRST_BANK_FILE = 2
HEAD_WORDS = 16
ROW_WORDS = 4
FILE_WORDS = 100  # in one request


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
    """Check a table by the controller's own rules, but for the flanges: `upload` asks those."""
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
    console.print(f"Wrote {picture}.")
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


Version = Annotated[int, typer.Option(help="Version of the table, for people.", min=0)]
Name = Annotated[str, typer.Option(help="Name of the table; default: of the file.")]


def _banks(device: Device) -> tuple[int | None, int]:
    """The bank that is in force, if one is, and the one that takes an upload."""
    status = device.read_names("cam_bank_0_state", "cam_bank_1_state")
    states = [status["cam_bank_0_state"], status["cam_bank_1_state"]]
    active = states.index(CamBankState.ACTIVE) if CamBankState.ACTIVE in states else None
    return active, 1 if active == 0 else 0


def _send(device: Device, table: Table) -> None:
    """Write a table into the bank that is not in force, and have it checked."""
    _, bank = _banks(device)
    data = words(table)
    for at in range(0, len(data), FILE_WORDS):
        part = data[at : at + FILE_WORDS]
        device.write_file(FIRST_BANK_FILE + bank, at, struct.pack(f">{len(part)}H", *part))
    _command(device, Command.CAM_CHECK)


def _command(device: Device, command: Command) -> None:
    """Give a command; a refusal of the table names the row, the value and the limit."""
    try:
        device.command(command)
    except RefusedError as error:
        why = device.read([*COMMAND_STATUS, *CAM_REASON])
        if why["cam_reason"] != why["command_reason"] or not why["cam_reason_row"]:
            raise
        value, limit = why["cam_reason_value"], why["cam_reason_limit"]
        raise RefusedError(
            f"Row {why['cam_reason_row']}: {error}: {value}, limit {limit}",
            error.reason,
            value=value,
            limit=limit,
        ) from None


def _table(
    device: Device, file: Path, interpolation: str, advancing: bool, name: str, version: int
) -> Table:
    """The table of a file; warnings of what it asks of this machine. The controller checks it."""
    table = replace(load(file, interpolation, advancing, name), version=version)
    if len(table.rows) > ROWS_MAX:
        raise ToolError(f"{file} has {len(table.rows)} rows, limit {ROWS_MAX}.")
    active = read_sets(device, [POINTS[parameter] for parameter in SCALE_PARAMETERS])["active"]
    numbers = [active[parameter] for parameter in SCALE_PARAMETERS]
    result = cam_report.report(table, Scale(*numbers[:5]), Limits(*numbers[5:]))
    for text in result.warnings:
        warn(text)
    return table


@app.command()
@with_device
def upload(
    device: Device,
    file: File,
    interpolation: Interpolation = "linear",
    advancing: Advancing = False,
    name: Name = "",
    version: Version = 0,
) -> None:
    """Load a table into the bank that is not in force, and have it checked there."""
    table = _table(device, file, interpolation, advancing, name, version)
    _send(device, table)
    console.print(f"{table.name}: {len(table.rows)} rows checked. `levelwind cam activate`.")


@app.command()
@with_device
def activate(
    device: Device,
    file: Annotated[Path | None, typer.Argument(help="Upload this table first.")] = None,
    interpolation: Interpolation = "linear",
    advancing: Advancing = False,
    name: Name = "",
    version: Version = 0,
) -> None:
    """Put the checked table in force: at once, or at the end of the cycle if a cam is running."""
    if file is not None:
        _send(device, _table(device, file, interpolation, advancing, name, version))
    _command(device, Command.CAM_ACTIVATE)
    queued = device.value("cam_queued")
    console.print("Queued for the end of the cycle." if queued else "In force.")
    if read_sets(device, [PROFILE])["active"][PROFILE.name] != MotionProfile.CAM:
        console.print(
            "The carriage follows the screw all the same: "
            "`levelwind set motion_profile=cam`, `levelwind apply`."
        )


@app.command()
@with_device
def discard(device: Device) -> None:
    """Drop the queued table, or else the upload."""
    _command(device, Command.CAM_DISCARD)
    console.print("Discarded.")


@app.command()
@with_device
def download(
    device: Device,
    file: Annotated[Path, typer.Argument(help="Table to write: .txt, .csv or .xlsx.")],
    other: Annotated[bool, typer.Option("--next", help="The bank that is not in force.")] = False,
) -> None:
    """Write the table in force to a file."""
    active, upload_bank = _banks(device)
    bank = upload_bank if other else active
    if bank is None:
        raise ToolError("No table is in force. `--next` reads the one that was uploaded.")
    if device.value(f"cam_bank_{bank}_state") == CamBankState.EMPTY:
        raise ToolError("No table was uploaded.")
    number = FIRST_BANK_FILE + bank
    head = device.read_file(number, 0, HEAD_WORDS)
    count = min(struct.unpack(">16sIHH", head[:24])[3], ROWS_MAX)
    total = HEAD_WORDS + ROW_WORDS * count
    data = head
    for at in range(HEAD_WORDS, total, FILE_WORDS):
        data += device.read_file(number, at, min(FILE_WORDS, total - at))
    table = from_words(struct.unpack(f">{len(data) // 2}H", data))
    cam_files.write(
        file,
        table.rows,
        [
            f"{table.name}, version {table.version}, {table.interpolation.label}, "
            f"advance {table.advance}"
        ],
    )
    console.print(f"{table.name}, version {table.version}: {len(table.rows)} rows.")
