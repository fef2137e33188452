# SPDX-License-Identifier: Apache-2.0
"""The simulator as somebody else's machine, over its port: `levelwind sim --machine`, and
`--as-parameters`."""

import contextlib
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.motion import INDEX_LIMIT_S
from levelwind.line.port import Line
from levelwind.map_table import Command, Flag, Mode
from levelwind.serve import demonstration
from levelwind.simulate import machine, simulator
from served import wait

MINE = """\
encoder_pulses_per_rev: 500
screw_lead_mm: 10
microsteps_per_rev: 1000
switch_plus_mm: 60.5
switch_minus_mm: -58.25
overtravel_mm: 68
end_stop_mm: 72
motor_reversed: true
encoder_channels_swapped: true
start_mm: 12
"""


@pytest.fixture(autouse=True)
def only_the_simulator(target: str):
    if target != "sim":
        pytest.skip("only the simulator can be another machine")


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    path = tmp_path / "mine.yaml"
    path.write_text(MINE, encoding="utf-8")
    return path


@contextlib.contextmanager
def levelwind_sim(folder: Path, *options: str) -> Iterator[Device]:
    """The tool's command, as a person runs it."""
    port = folder / "port"
    arguments = ["sim", "--port", str(port), "--speed", "6", *options]
    process = subprocess.Popen(
        [sys.executable, "-c", "from levelwind.cli import main; main()", *arguments],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == f"ready {port}\n"
        with Device(Line(str(port))) as device:
            yield device
    finally:
        process.send_signal(signal.SIGTERM)
        assert process.wait(10) == 0


def index(device: Device) -> None:
    wait(lambda: device.value("flags") >> Flag.DRUM_AT_REST & 1, what="the drum counts as resting")
    device.write({"mode": Mode.TRACK})
    device.command(Command.INDEX, limit_s=INDEX_LIMIT_S)


def test_a_machine_from_a_file_takes_its_own_parameters_and_no_others(tmp_path: Path, mine: Path):
    parameters = machine.read(mine).parameters()
    with levelwind_sim(tmp_path, "--machine", str(mine)) as device:
        assert device.value("bench_carriage_um") == 12_000
        assert device.value("bench_direction_reversed") == 1
        with pytest.raises(ToolError):
            index(device)  # the factory's: the motor runs the other way, into the wrong switch
        device.command(Command.CLEAR_FAULT)
        device.write(parameters)
        device.command(Command.APPLY)
        index(device)
        at = device.read_names("position_um", "bench_carriage_um")
        assert at["position_um"] == pytest.approx(at["bench_carriage_um"], abs=80)


def test_the_stored_parameters_describe_the_machine(tmp_path: Path, mine: Path):
    storage = ("--storage", str(tmp_path / "winch.bin"))
    with levelwind_sim(tmp_path, *storage) as device:
        device.write(machine.read(mine).parameters())
        device.command(Command.APPLY)
        device.command(Command.SAVE)
        with pytest.raises(ToolError):
            index(device)  # the default machine is another one
    with levelwind_sim(tmp_path, *storage, "--as-parameters") as device:
        index(device)
        assert abs(device.value("span_error_um")) < 80
        assert device.value("bench_direction_reversed") == 1
    fault = tmp_path / "fault.yaml"
    fault.write_text("switch_minus_mm: -55", encoding="utf-8")
    options = (*storage, "--as-parameters", "--machine", str(fault))
    with levelwind_sim(tmp_path, *options) as device, pytest.raises(ToolError):
        index(device)


def test_the_demonstration_runs_on_another_machine(tmp_path: Path, mine: Path):
    winch = machine.read(mine)
    said: list[str] = []
    line = simulator.arguments(str(tmp_path / "port"), speed="6", machine=winch)
    with simulator.Simulator(line) as running, Device(Line(running.port)) as device:
        demonstration.Demonstration(lambda: device, said.append, winch.parameters())._set_up(device)
        assert device.value("flags") >> Flag.LAUNCH_PERMIT & 1
    assert not said


def test_noise_on_the_port_is_seen_as_wrong_frames(tmp_path: Path):
    noisy = tmp_path / "noisy.yaml"
    noisy.write_text("line_errors_ppm: 2000", encoding="utf-8")
    with levelwind_sim(tmp_path, "--machine", str(noisy)) as device:
        for _ in range(200):
            with contextlib.suppress(ToolError):
                device.value("state")
        errors = 0
        while errors == 0:
            with contextlib.suppress(ToolError):
                errors = device.value("crc_errors")
    assert 0 < errors < 40


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--figure=lead=10", "no machine has a figure lead; doc/machine.md"),
        ("--figure=screw_lead_mm", "must be NAME=VALUE"),
        ("--figure=screw_lead_mm=ten", "must be a number"),
        ("--figure=screw_lead_mm=0", "must be a number from 0.1 to 1000"),
        ("--figure=microsteps_per_rev=0.5", "must be a whole number from 50 to 1e+06"),
        ("--figure=start_mm=91", "start_mm: must be between minus and plus end_stop_mm"),
    ],
)
def test_a_bad_figure_is_refused(tmp_path: Path, option: str, said: str):
    line = [str(native.find(native.SIMULATOR)), "--port", str(tmp_path / "port"), option]
    done = subprocess.run(line, check=False, capture_output=True, text=True, timeout=5)
    assert done.returncode == 2
    assert said in done.stderr
