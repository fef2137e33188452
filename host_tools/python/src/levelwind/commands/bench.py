# SPDX-License-Identifier: Apache-2.0
"""Commands for the simulator and its plant."""

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import Progress

from levelwind.files import profiles
from levelwind.line.connection import PORT_DEFAULT, Json, Port, with_device
from levelwind.line.device import Device
from levelwind.line.plant import check_plant
from levelwind.line.points import enum_label
from levelwind.map_table import State
from levelwind.show.output import console, print_json, print_table, warn
from levelwind.simulate import launches, machine, simulator

MachineFile = Annotated[
    Path | None,
    typer.Option("--machine", help="Simulate this machine (doc/machine.md).", metavar="FILE.yaml"),
]
Speed = Annotated[str | None, typer.Option("--speed", help="Factor of real time, or max.")]


def sim(
    port: Port = PORT_DEFAULT,
    speed: Speed = None,
    seed: Annotated[int | None, typer.Option(help="Of everything random in the plant.")] = None,
    storage: Annotated[Path | None, typer.Option(help="Where SAVE keeps parameters.")] = None,
    trace: Annotated[Path | None, typer.Option(help="CSV to write, a line per ms.")] = None,
    unit: Annotated[int | None, typer.Option(help="Modbus unit id.", min=1, max=247)] = None,
    frame_silence_ms: Annotated[
        int | None,
        typer.Option(help="Silence that ends a frame; see its USB adapter.", min=1, max=1000),
    ] = None,
    tcp: Annotated[
        str | None,
        typer.Option(help="Serve Modbus TCP there, and no port.", metavar="ADDRESS:PORT"),
    ] = None,
    machine_file: MachineFile = None,
    as_parameters: Annotated[
        bool,
        typer.Option("--as-parameters", help="Simulate the machine that the stored set describes."),
    ] = False,
) -> None:
    """Run the simulator until Ctrl-C: a Modbus slave and a plant. Prints `ready PATH`."""
    path = None if tcp else port
    winch = machine.read(machine_file) if machine_file else None
    line = simulator.arguments(
        path, speed, seed, storage, trace, unit, frame_silence_ms, tcp, winch, as_parameters
    )
    simulator.become(line)


@with_device
def launch(
    device: Device,
    profile: Annotated[Path, typer.Argument(help="CSV: time_s and one speed column.")],
    motor_per_encoder: Annotated[
        float, typer.Option(help="Motor revs per encoder rev, for motor_rpm.", min=0.001)
    ] = profiles.MOTOR_PER_ENCODER,
    json_output: Json = False,
) -> None:
    """Play a speed profile on the simulated drum. Columns: rope_m_per_s, drum_rpm, motor_rpm or
    edges_per_s. Ctrl-C stops the drum. Exit status 1 if the launch was not in order."""
    check_plant(device)
    points = profiles.read(profile, launches.read_gearing(device, motor_per_encoder))
    launches.upload(device, points)
    state = device.value("state")
    if state != State.TRACKING:
        warn(f"the state is {enum_label(State, state)}: the carriage will not follow the drum.")
    with Progress(
        console=console, transient=True, disable=json_output or not console.is_terminal
    ) as progress:
        task = progress.add_task("launch", total=1.0)
        result = launches.play(device, points, lambda done: progress.update(task, completed=done))
    summary = result.summary() | {"profile_points": len(points)}
    if json_output:
        print_json(summary)
    else:
        rows = [
            (name, ", ".join(value) if isinstance(value, list) else str(value))
            for name, value in summary.items()
        ]
        print_table(("", "value"), rows)
    if result.wrong:
        warn(f"this launch was not in order: {'; '.join(result.wrong)}.")
        raise typer.Exit(1)


def demo(
    stay: Annotated[bool, typer.Option("--stay", help="Keep the simulator running.")] = False,
    speed: Annotated[str, typer.Option(help="Factor of real time, or max.")] = "10",
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("out"),
) -> None:
    """Simulator, setup, indexing, one launch, checks and a picture. Exit status 0 if all held."""
    from levelwind.simulate.demo import run_demo  # noqa: PLC0415 - matplotlib and numpy take a second

    if not run_demo(out, speed, stay):
        raise typer.Exit(1)
