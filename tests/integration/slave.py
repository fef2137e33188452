# SPDX-License-Identifier: Apache-2.0
"""What the integration tests drive: a simulator process, a slave by register names, a bare line."""

import atexit
import os
import select
import signal
import subprocess
import sys
import threading
import tty
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import serial
from levelwind.map_table import POINTS, Command, Flag, Mode, Point, Result, State
from pymodbus.client import ModbusSerialClient
from pymodbus.exceptions import ModbusIOException
from pymodbus.pdu import ModbusPDU

UNIT = 1
NATIVE_DIR = Path(os.environ.get("LEVELWIND_NATIVE_DIR", "build/host"))
NATIVE_SIM = Path(os.environ.get("LEVELWIND_NATIVE_SIM", "build/native_sim/zephyr/zephyr.exe"))
QEMU_IMAGE = Path(os.environ.get("LEVELWIND_QEMU_IMAGE", "build/mps2_an385/zephyr/zephyr.elf"))
TEST_DIR = Path(os.environ.get("LEVELWIND_TEST_DIR", "build/san"))


@dataclass
class Simulator:
    """A running program with a controller and a simulated machine in it."""

    port: Path
    process: subprocess.Popen[str]

    def __post_init__(self) -> None:
        atexit.register(self.process.kill)  # after a test that failed half-way

    def stop(self, with_signal: int = signal.SIGTERM) -> int:
        self.process.send_signal(with_signal)
        return self.process.wait(timeout=10)


def start(
    target: str, folder: Path, storage: Path, *, fast: bool = False, options: Sequence[str] = ()
) -> Simulator:
    """Start the program of a target and wait until it answers.

    `storage` is the file that keeps its parameters. `fast` lets its time pass faster than ours.
    `options` are the simulator's.
    """
    if target == "sim":
        return start_simulator(folder, storage, fast, *options)
    starters = {
        "native_sim": start_native_sim,
        "board": start_board,
        "qemu": start_qemu,
    }
    return starters[target](folder, storage, fast)


def start_simulator(folder: Path, storage: Path, fast: bool, *options: str) -> Simulator:
    port = folder / "port"
    process = subprocess.Popen(
        [str(NATIVE_DIR / "lw_sim"), "--port", str(port), "--storage", str(storage), *options]
        + ["--speed", "10"] * fast,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line == f"ready {port}\n", f"the simulator said {line!r}"
    return Simulator(port, process)


def start_board(folder: Path, storage: Path, fast: bool) -> Simulator:
    """Its flash is erased at once: what a request meets that falls into an erasure, tests/board."""
    port = folder / "port"
    process = subprocess.Popen(
        [sys.executable, "-m", "board.serve", "--port", str(port), "--storage", str(storage)]
        + ["--erase-ms", "1"]
        + ["--speed", "4"] * fast,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line == f"ready {port}\n", f"the board said {line!r}"
    return Simulator(port, process)


def start_native_sim(folder: Path, storage: Path, fast: bool) -> Simulator:
    del folder
    return start_native_sim_on(NullModem(), storage, speed=4 if fast else 1)


def start_native_sim_on(line: "NullModem", storage: Path, *, speed: int) -> Simulator:
    """Its time passes `speed` times as fast as ours."""
    process = subprocess.Popen(
        [
            *(str(NATIVE_SIM), f"-modbus-uart_port={line.firmware_end}", f"-flash={storage}"),
            *("-rt", f"-rt-ratio={speed}"),
        ],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    said = []
    while not said or "connected to the serial port" not in said[-1]:
        said.append(process.stdout.readline())
        assert said[-1], f"the firmware said {said!r}"
    return Simulator(line.port, process)


def start_qemu(folder: Path, storage: Path, fast: bool) -> Simulator:
    """The emulator keeps neither parameters nor a clock that could be made faster."""
    del storage, fast
    line = NullModem()
    process = subprocess.Popen(
        [
            *("qemu-system-arm", "-machine", "mps2-an385", "-cpu", "cortex-m3", "-nographic"),
            # 16 ns of virtual time for an instruction, whatever the host is doing.
            *("-icount", "shift=4,align=off,sleep=on"),
            *("-monitor", "none", "-kernel", str(QEMU_IMAGE)),
            *("-serial", f"file:{folder / 'console.log'}"),
            *(
                "-chardev",
                f"serial,id=modbus,path={line.firmware_end}",
                "-serial",
                "chardev:modbus",
            ),
        ],
        stdin=subprocess.DEVNULL,
        text=True,
    )
    return Simulator(line.port, process)


class NullModem:
    """Two pseudo terminals, each the other's far end, that stay whoever opens and closes them."""

    def __init__(self) -> None:
        self._masters = []
        self._slaves = []
        for _ in range(2):
            master, slave = os.openpty()
            tty.setraw(slave)  # and kept open, or the master would see a hang-up
            self._masters.append(master)
            self._slaves.append(slave)
        self.firmware_end, self.port = (Path(os.ttyname(slave)) for slave in self._slaves)
        self._stopped, self._stop = os.pipe()
        threading.Thread(target=self._copy, daemon=True).start()

    def close(self) -> None:
        """Take it away, with all that is still in it."""
        os.close(self._stop)

    def _copy(self) -> None:
        ready: list[int] = []
        while self._stopped not in ready:
            for master in ready:
                os.write(self._masters[1 - self._masters.index(master)], os.read(master, 4096))
            ready = select.select([*self._masters, self._stopped], [], [])[0]
        for file in (*self._masters, *self._slaves, self._stopped):
            os.close(file)


def decode(point: Point, registers: list[int]) -> int:
    """The value in the registers of a point, high word first."""
    words = registers[: point.words]
    value = int.from_bytes(b"".join(word.to_bytes(2, "big") for word in words), "big")
    bits = 16 * point.words
    return value - (1 << bits) if point.type.startswith("i") and value >> (bits - 1) else value


class Slave:
    """Registers by name, through pymodbus. Knows the map, nothing of the tool's code.

    A request that the slave says it has dropped, since a busy computer let its program stand still,
    is given again: it has done nothing.
    """

    _late: ClassVar[dict[str, int]] = {}
    """By port: the requests that came to a program that stood still."""

    def __init__(self, port: str) -> None:
        self.port = port
        self.client = ModbusSerialClient(
            port=port, baudrate=19200, parity="N", stopbits=1, timeout=2, retries=0
        )
        assert self.client.connect(), f"cannot open {port}"

    def close(self) -> None:
        self.client.close()

    def _ask(self, request: Callable[..., ModbusPDU], *arguments: Any, **options: Any) -> ModbusPDU:
        try:
            return request(*arguments, **options, device_id=UNIT)
        except ModbusIOException:
            late = POINTS["late_requests"]
            told = self.client.read_input_registers(late.address, count=late.words, device_id=UNIT)
            if told.isError() or len(told.registers) != late.words:
                raise
            before, now = self._late.get(self.port, 0), decode(late, told.registers)
            self._late[self.port] = now
            if now in (0, before):
                raise
            return self._ask(request, *arguments, **options)

    def read_run(self, *names: str) -> dict[str, int]:
        """Input registers that lie close together, in one request."""
        points = [POINTS[name] for name in names]
        first = min(point.address for point in points)
        count = max(point.address + point.words for point in points) - first
        answer = self._ask(self.client.read_input_registers, first, count=count)
        assert not answer.isError(), f"{names}: {answer}"
        return {p.name: decode(p, answer.registers[p.address - first :]) for p in points}

    def read(self, name: str, offset: int = 0) -> int:
        """One register value; `offset` 1000 and 2000 reach the active and the stored set."""
        point = POINTS[name]
        space = "input" if offset else point.space
        function = {
            "input": self.client.read_input_registers,
            "holding": self.client.read_holding_registers,
        }[space]
        answer = self._ask(function, point.address + offset, count=point.words)
        assert not answer.isError(), f"{name}: {answer}"
        return decode(point, answer.registers)

    def write(self, name: str, value: int, *, function: int | None = None) -> int:
        """Write one value; the exception code, 0 if it was taken."""
        point = POINTS[name]
        words = [(value >> (16 * (point.words - 1 - i))) & 0xFFFF for i in range(point.words)]
        if function == 6 or (function is None and point.words == 1):
            answer = self._ask(self.client.write_register, point.address, words[0])
        else:
            answer = self._ask(self.client.write_registers, point.address, words)
        return answer.exception_code if answer.isError() else 0

    def command(self, command: Command) -> Result:
        """Run a command and wait for its end; the answer to a refused request counts as refused."""
        before = self.read("command_sequence")
        exception = self.write("command", command)
        assert self.read("command_sequence") == (before + 1) & 0xFFFF
        if exception:
            assert exception == 6
            return Result.REFUSED
        self.wait(lambda: self.read("command_result") != Result.IN_PROGRESS)
        return Result(self.read("command_result"))

    def flag(self, flag: Flag) -> bool:
        answer = self._ask(self.client.read_discrete_inputs, int(flag), count=1)
        assert not answer.isError()
        return answer.bits[0]

    def wait(self, until: Callable[[], bool], timeout_ms: int = 60_000) -> None:
        """Poll until something holds; the time limit is the slave's own time."""
        start_ms = self.read("uptime_ms")
        while not until():
            assert self.read("uptime_ms") - start_ms < timeout_ms, "waited too long"

    def settle(self, duration_ms: int) -> None:
        """Let the slave's time pass."""
        start_ms = self.read("uptime_ms")
        self.wait(lambda: self.read("uptime_ms") - start_ms >= duration_ms, 10 * duration_ms)


def bring_to_rest(slave: Slave) -> None:
    """Drum at rest, no fault injected, factory parameters, position unknown, mode track."""
    slave.write("bench_drum_acceleration_millirpm_per_s", 100_000_000)
    slave.write("bench_drum_speed_millirpm", 0)
    for name in (
        "bench_stall",
        "bench_side_load_mm_per_s2",
        "bench_direction_reversed",
        "bench_stepper_alarm",
    ):
        slave.write(name, 0)
    slave.write("mode", Mode.OFF)
    slave.wait(lambda: slave.read("state") == State.OFF and slave.flag(Flag.DRUM_AT_REST))
    assert slave.command(Command.FACTORY_ALL) == Result.DONE
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.command(Command.CLEAR_FAULT) == Result.DONE
    if slave.flag(Flag.SET_UNCONFIRMED):
        assert slave.command(Command.SAVE) == Result.DONE
    slave.write("trim_plus_um", 0)
    slave.write("trim_minus_um", 0)
    slave.write("mode", Mode.TRACK)
    if slave.flag(Flag.ROPE_LAID_STANDING):
        assert slave.command(Command.INDEX) == Result.DONE
        assert slave.command(Command.ACKNOWLEDGE_ROPE) == Result.DONE
        slave.write("mode", Mode.OFF)
        slave.wait(lambda: slave.read("state") == State.OFF)
        slave.write("mode", Mode.TRACK)
    slave.wait(lambda: slave.read("state") == State.UNINDEXED)


class RawLine:
    """Bytes on the line, for what no library sends."""

    def __init__(self, port: str) -> None:
        self.line = serial.Serial(port, 19200, timeout=0.3)

    def close(self) -> None:
        self.line.close()

    def exchange(self, frame: bytes) -> bytes:
        """Send bytes, and read until the line has been silent for the time-out."""
        self.line.reset_input_buffer()
        self.line.write(frame)
        answer = b""
        while piece := self.line.read(max(1, self.line.in_waiting)):
            answer += piece
            if answer and crc16(answer) == 0 and len(answer) >= 5:
                break
        return answer

    def request(self, pdu: bytes, unit: int = UNIT) -> bytes:
        """A request with the right CRC; the answer's PDU, empty if there is none."""
        answer = self.exchange(sealed(bytes([unit]) + pdu))
        assert not answer or crc16(answer) == 0, answer.hex(" ")
        return answer[1:-2]


def crc16(frame: bytes) -> int:
    """The CRC of Modbus RTU; 0 over a frame with its CRC."""
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def sealed(frame: bytes) -> bytes:
    return frame + crc16(frame).to_bytes(2, "little")
