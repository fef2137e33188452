# SPDX-License-Identifier: Apache-2.0
"""Line settings on trial, over a real line: confirmed and saved, or back to the old ones."""

import os
import select
import subprocess
import termios
import threading
import tty
from collections.abc import Callable, Iterator

import pytest
from levelwind.cli import app
from levelwind.map_table import POINTS, Command, Flag, LineFormat, Reason, Result
from slave import NATIVE_DIR, RawLine, Simulator, Slave, sealed
from typer.testing import CliRunner

NEW_UNIT = 9
READ_SELF_TEST = bytes.fromhex("04 0000 0002")
SELF_TEST_ANSWER = bytes.fromhex("04 04 12345678")


def request_to(unit: int, port: str) -> bytes:
    line = RawLine(port)
    answer = line.request(READ_SELF_TEST, unit)
    line.close()
    return answer


def test_the_old_settings_come_back_if_nobody_asks(slave: Slave) -> None:
    slave.write("line_confirm_s", 15)
    slave.write("unit_id", NEW_UNIT)
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.flag(Flag.RESTART_NEEDED)
    assert slave.write("command", Command.TRY_LINE) == 0
    assert request_to(1, slave.port) == b""
    while request_to(1, slave.port) != SELF_TEST_ANSWER:
        pass
    assert slave.read("command_result") == Result.FAILED
    assert slave.read("command_reason") == Reason.LINE_NOT_CONFIRMED
    assert slave.read("unit_id", 1000) == 1
    assert not slave.flag(Flag.RESTART_NEEDED)
    assert request_to(NEW_UNIT, slave.port) == b""


def run_tool(*arguments: str) -> str:
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 0, result.output
    return result.output


def test_the_tool_changes_the_unit_id(own_simulator: Callable[..., Simulator], target: str) -> None:
    simulator = own_simulator()
    port = str(simulator.port)
    output = run_tool("line", "--port", port, "--new-unit", str(NEW_UNIT))
    assert "Saved" in output
    assert request_to(1, port) == b""
    assert request_to(NEW_UNIT, port) == SELF_TEST_ANSWER
    if target == "qemu":
        return  # the emulator keeps no parameters
    assert simulator.stop() == 0
    again = str(own_simulator().port)
    assert request_to(1, again) == b""
    assert request_to(NEW_UNIT, again) == SELF_TEST_ANSWER


@pytest.fixture
def serial_line(target: str) -> Iterator[int]:
    """The master's end of a line that the simulator takes for a serial port."""
    if target != "sim":
        pytest.skip("the line of this target has no speed")
    master, slave = os.openpty()
    tty.setraw(master)
    process = subprocess.Popen(
        [str(NATIVE_DIR / "lw_sim"), "--port", os.ttyname(slave)],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline().startswith("ready")
    yield master
    process.kill()
    process.wait()
    os.close(master)
    os.close(slave)


@pytest.fixture
def half_deaf_port(serial_line: int) -> Iterator[str]:
    """A line on which nothing reaches the new unit id."""
    master, slave = os.openpty()
    tty.setraw(slave)
    stop, stopper = os.pipe()
    ends = {master: serial_line, serial_line: master}

    def copy() -> None:
        while stop not in (ready := select.select([*ends, stop], [], [])[0]):
            for end in ready:
                data = os.read(end, 256)
                if end != master or data[0] != NEW_UNIT:
                    os.write(ends[end], data)

    copier = threading.Thread(target=copy)
    copier.start()
    yield os.ttyname(slave)
    os.write(stopper, b"x")
    copier.join()


def test_the_tool_goes_back(half_deaf_port: str) -> None:
    line = ["--port", half_deaf_port]
    run_tool("set", *line, "line_confirm_s=2")
    run_tool("apply", *line)
    run_tool("save", *line)
    failed = CliRunner().invoke(app, ["line", *line, "--new-unit", str(NEW_UNIT)])
    assert failed.exit_code == 1
    assert "staged, active and stored parameters are equal" in run_tool("diff", *line).lower()
    assert "unit_id" in run_tool("get", *line, "unit_id")


def write_frame(address: int, value: int, unit: int = 1) -> bytes:
    return sealed(bytes([unit, 6]) + address.to_bytes(2, "big") + value.to_bytes(2, "big"))


def test_the_serial_port_changes_its_speed(serial_line: int) -> None:
    def exchange(frame: bytes) -> None:
        os.write(serial_line, frame)
        answer = b""
        while len(answer) < 8:
            answer += os.read(serial_line, 8 - len(answer))
        assert answer[:6] == frame[:6]

    def speed() -> int:
        return termios.tcgetattr(serial_line)[5]

    assert speed() == termios.B19200
    baud = POINTS["baud_rate"].address
    exchange(sealed(bytes([1, 16, 0, baud, 0, 2, 4, 0, 0, 0x25, 0x80])))  # 9600
    exchange(write_frame(POINTS["line_confirm_s"].address, 2))
    exchange(write_frame(POINTS["line_format"].address, LineFormat.FORMAT_8N2))
    exchange(write_frame(POINTS["command"].address, Command.APPLY))
    assert speed() == termios.B19200
    exchange(write_frame(POINTS["command"].address, Command.TRY_LINE))
    while speed() == termios.B19200:
        pass
    assert speed() == termios.B9600
    while speed() == termios.B9600:  # nobody asks: back after two seconds
        pass
    assert speed() == termios.B19200
    exchange(write_frame(POINTS["command"].address, Command.STOP))
