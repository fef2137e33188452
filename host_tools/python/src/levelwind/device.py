"""A controller on a serial line: whole values in, whole values out, refusals in words."""

import logging
import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pymodbus.client import ModbusSerialClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU
from pymodbus.pdu.file_message import FileRecord

from levelwind.errors import RefusedError, ToolError
from levelwind.map_table import POINTS, Command, Fault, Point, Reason, Result
from levelwind.points import (
    REGISTERS_PER_READ,
    REGISTERS_PER_WRITE,
    decode,
    encode,
    enum_label,
    enum_text,
    refusal_text,
    runs,
)

READ_ATTEMPTS = 3  # a disturbed frame is asked for again; a write never is
COMMAND_POLL_S = 0.05
SETTLE_S = 0.2
EXCEPTION_NAMES = {
    1: "illegal function",
    2: "illegal address",
    3: "illegal value",
    4: "device failure",
    6: "busy",
}
ILLEGAL_ADDRESS = 2
COMMAND_STATUS = [
    POINTS[f"command_{name}"]
    for name in ("sequence", "code", "result", "reason", "address", "value", "limit")
]
LAST_ERROR = [
    POINTS[f"last_error_{name}"]
    for name in ("reason", "function", "exception", "address", "value", "limit")
]
# Requests of the laptop are many and short; pymodbus would log every time-out on the terminal.
logging.getLogger("pymodbus").setLevel(logging.CRITICAL)


@dataclass(frozen=True)
class Line:
    """How to reach a controller."""

    port: str
    baud: int = 19200
    format: str = "8E1"
    unit: int = 1
    timeout_s: float = 1.0

    def __str__(self) -> str:
        return f"{self.port} ({self.baud} baud {self.format}, unit {self.unit})"


class Device:
    """An open connection. Every method raises ToolError with the reason in words."""

    def __init__(self, line: Line) -> None:
        self.line = line
        self.requests = 0
        self.worst_latency_s = 0.0
        self._client = ModbusSerialClient(
            line.port,
            baudrate=line.baud,
            bytesize=int(line.format[0]),
            parity=parity(line),
            stopbits=int(line.format[2]),
            timeout=line.timeout_s,
            retries=0,
        )
        check_port(line.port)
        if not self._client.connect():
            raise ToolError(
                f"{line.port} cannot be opened: is another program using it? "
                f"(`fuser {line.port}` names it.)"
            )

    def __enter__(self) -> "Device":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the port back."""
        self._client.close()

    # ---- reading -------------------------------------------------------------------------------

    def read(self, points: Iterable[Point]) -> dict[str, int]:
        """Values by name. Points that follow each other come from one request: one snapshot."""
        values: dict[str, int] = {}
        by_space: dict[str, list[Point]] = {}
        for point in points:
            by_space.setdefault(point.space, []).append(point)
        for space, members in by_space.items():
            for run in runs(members, REGISTERS_PER_READ):
                answer = self._read_request(space, run.address, run.count)
                for point in run.points:
                    at = point.address - run.address
                    if space in ("coil", "discrete"):
                        values[point.name] = int(answer.bits[at])
                    else:
                        values[point.name] = decode(point, answer.registers[at:])
        return values

    def read_names(self, *names: str) -> dict[str, int]:
        """Values of the map's points of these names."""
        return self.read(POINTS[name] for name in names)

    def value(self, name: str) -> int:
        """One value."""
        return self.read_names(name)[name]

    def read_file(self, number: int, first: int, count: int) -> bytes:
        """Records of a file (FC20), two bytes each."""
        # pymodbus counts bytes here.
        wanted = FileRecord(file_number=number, record_number=first, record_length=2 * count)
        answer = self._request(
            lambda: self._client.read_file_record([wanted], device_id=self.line.unit),
            _answers(
                20, lambda answer: [len(r.record_data) for r in answer.records] == [2 * count]
            ),
            READ_ATTEMPTS,
        )
        return answer.records[0].record_data

    # ---- writing -------------------------------------------------------------------------------

    def write_file(self, number: int, first: int, data: bytes) -> None:
        """Write records of a file (FC21), two bytes each, all or nothing."""
        records = FileRecord(file_number=number, record_number=first, record_data=data)
        self._request(
            lambda: self._client.write_file_record(
                [records], device_id=self.line.unit, no_response_expected=False
            ),
            _answers(21, lambda answer: [r.record_data for r in answer.records] == [data]),
        )

    def write(self, values: Mapping[str, int]) -> None:
        """Write holding registers, all or nothing.

        Values that follow each other go out in one request, which the controller takes whole or
        not at all. If a later request is refused, the earlier values are written back.
        """
        groups = runs([POINTS[name] for name in values], REGISTERS_PER_WRITE)
        before = self.read([p for g in groups[:-1] for p in g.points]) if groups[1:] else {}
        for index, group in enumerate(groups):
            try:
                self._write_group(group.points, values)
            except RefusedError:
                for earlier in groups[:index]:
                    self._write_group(earlier.points, before)
                raise

    def write_registers(self, address: int, registers: list[int]) -> None:
        """One FC16 request."""
        self._request(
            lambda: self._client.write_registers(
                address, registers, device_id=self.line.unit, no_response_expected=False
            ),
            _answers(
                16, lambda answer: (answer.address, answer.count) == (address, len(registers))
            ),
        )

    def _write_group(self, points: Iterable[Point], values: Mapping[str, int]) -> None:
        points = list(points)
        registers = [word for point in points for word in encode(point, values[point.name])]
        self.write_registers(points[0].address, registers)

    # ---- commands ------------------------------------------------------------------------------

    def command(
        self,
        command: Command,
        watch: Callable[[], None] = lambda: None,
        limit_s: float = 30.0,
        poll_s: float = COMMAND_POLL_S,
    ) -> None:
        """Give a command and wait for its result; `watch` is called at every look.

        Raises RefusedError with the reason if it was refused or failed.
        """
        before = self.value("command_sequence")
        self.write({"command": int(command)})
        deadline = time.monotonic() + limit_s
        while True:
            status = self.read(COMMAND_STATUS)
            fresh = status["command_sequence"] != before
            if fresh and status["command_result"] != Result.IN_PROGRESS:
                break
            if time.monotonic() > deadline:
                raise ToolError(f"{command.label} has not ended after {limit_s:g} s.")
            watch()
            time.sleep(poll_s)
        if status["command_code"] != command:
            other = enum_label(Command, status["command_code"])
            raise ToolError(f"{command.label} was overtaken by {other} from another master.")
        if status["command_result"] != Result.DONE:
            raise RefusedError(self._command_refusal(command, status))

    def _command_refusal(self, command: Command, status: Mapping[str, int]) -> str:
        verb = enum_label(Result, status["command_result"])
        why = refusal_text(
            *(status[f"command_{part}"] for part in ("reason", "address", "value", "limit"))
        )
        if status["command_reason"] == Reason.FAULTED:
            why = enum_text(Fault, self.value("fault"))
        return f"{command.label} {verb}: {why}"

    # ---- requests ------------------------------------------------------------------------------

    def _read_request(self, space: str, address: int, count: int) -> Any:
        client = self._client
        code, function = {
            "coil": (1, client.read_coils),
            "discrete": (2, client.read_discrete_inputs),
            "holding": (3, client.read_holding_registers),
            "input": (4, client.read_input_registers),
        }[space]
        if space in ("coil", "discrete"):
            fits = _answers(code, lambda answer: len(answer.bits) == -(-count // 8) * 8)
        else:
            fits = _answers(code, lambda answer: len(answer.registers) == count)
        return self._request(
            lambda: function(address, count=count, device_id=self.line.unit), fits, READ_ATTEMPTS
        )

    def _request(
        self,
        send: Callable[[], ModbusPDU],
        fits: Callable[[Any], bool],
        attempts: int = 1,
    ) -> Any:
        answer = self._send(send, fits, attempts)
        if answer.isError():
            raise self._explain(answer)
        return answer

    def _send(
        self, send: Callable[[], ModbusPDU], fits: Callable[[Any], bool], attempts: int
    ) -> Any:
        foreign = False
        for _ in range(attempts):
            began = time.monotonic()
            try:
                answer = send()
            except (ModbusException, OSError):
                if not self._client.connected or not Path(self.line.port).exists():
                    raise ToolError(
                        f"The port {self.line.port} has gone away: unplugged, or the simulator "
                        "has ended."
                    ) from None
                continue
            except KeyboardInterrupt:
                time.sleep(SETTLE_S)  # let the answer under way go by
                raise
            foreign = not fits(answer)
            if foreign:
                time.sleep(SETTLE_S)  # let ours go by; pymodbus drops what came before it asks
                continue
            self.requests += 1
            self.worst_latency_s = max(self.worst_latency_s, time.monotonic() - began)
            return answer
        if foreign:
            raise ToolError(
                f"{self.line} answers something else than was asked.\n"
                "Is a second master on the line, or another program at the port?"
            )
        raise ToolError(
            f"No answer from {self.line} within {self.line.timeout_s:g} s.\n"
            "Check power and wiring (A/B swapped?), the unit id (--unit), --baud and --line."
        )

    def _explain(self, answer: ModbusPDU) -> RefusedError:
        """A Modbus exception in words, by what the controller says in last_error_*."""
        code = answer.exception_code
        name = f"Modbus exception {code:02d} ({EXCEPTION_NAMES.get(code, 'unknown')})"
        run = runs(LAST_ERROR, REGISTERS_PER_READ)[0]
        details = self._send(
            lambda: self._client.read_input_registers(
                run.address, count=run.count, device_id=self.line.unit
            ),
            _answers(4, lambda answer: len(answer.registers) == run.count),
            READ_ATTEMPTS,
        )
        if details.isError():
            return RefusedError(f"{name}. It gives no reason: is {self.line} a levelwind?")
        error = {
            p.name.removeprefix("last_error_"): decode(
                p, details.registers[p.address - run.address :]
            )
            for p in run.points
        }
        if error["exception"] != code:
            return RefusedError(f"{name}.")
        why = refusal_text(error["reason"], error["address"], error["value"], error["limit"])
        if code == ILLEGAL_ADDRESS:
            why += f" (function {error['function']}, address {error['address']})"
        return RefusedError(f"{name}: {why}")


def _answers(function: int, fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    """Is it the answer, or the exception, to a request of this function that it must fit?"""
    return lambda answer: (
        answer.function_code & 0x7F == function and (answer.isError() or fits(answer))
    )


def is_pseudo_terminal(port: str) -> bool:
    """Or a link to one."""
    return os.path.realpath(port).startswith("/dev/pts/")


def parity(line: Line) -> str:
    """A pseudo terminal has no parity bit, and refuses to be told of one."""
    return "N" if is_pseudo_terminal(line.port) else line.format[1]


def check_port(port: str) -> None:
    """ToolError says why a serial port cannot be opened."""
    if os.name != "posix":
        return
    path = Path(port)
    if not path.exists():
        hint = (
            " Start the simulator (`levelwind sim`), or" if port == "/tmp/levelwind" else " Please"
        )
        raise ToolError(f"There is no port {port}.{hint} name the port with --port.")
    if not path.is_char_device():
        raise ToolError(f"{port} is no serial port.")
    if not os.access(port, os.R_OK | os.W_OK):
        raise ToolError(
            f"No permission to open {port}. On most systems the group dialout may: "
            "`sudo usermod -aG dialout $USER`, then log in again."
        )
