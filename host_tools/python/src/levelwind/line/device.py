# SPDX-License-Identifier: Apache-2.0
"""A controller on a serial line: whole values in, whole values out, refusals in words."""

import contextlib
import logging
import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU
from pymodbus.pdu.file_message import FileRecord

from levelwind.errors import NoAnswerError, RefusedError, ToolError, UnknownOutcomeError
from levelwind.line.points import (
    REGISTERS_PER_READ,
    REGISTERS_PER_WRITE,
    Run,
    decode,
    encode,
    enum_label,
    enum_text,
    refusal,
    runs,
)
from levelwind.line.port import Line, is_modbus_tcp
from levelwind.line.rtu import Heard, RtuClient
from levelwind.line.tcp import TcpClient
from levelwind.map_table import POINTS, Command, Fault, Point, Reason, Result

READ_ATTEMPTS = 3  # a disturbed frame is asked for again; a write never is
COMMAND_POLL_S = 0.05
SETTLE_S = 0.2
"""Later than this after a time-out no answer comes: what waited longer the controller drops."""
NAMES_SHOWN = 4
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
SET_COMMANDS = (
    Command.APPLY,
    Command.REVERT,
    Command.SAVE,
    Command.FACTORY_MOTION,
    Command.FACTORY_LINE,
    Command.FACTORY_ALL,
)
# Requests of the laptop are many and short; pymodbus would log every time-out on the terminal.
logging.getLogger("pymodbus").setLevel(logging.CRITICAL)


class Device:
    """An open connection. Every method raises ToolError with the reason in words."""

    def __init__(self, line: Line, client: RtuClient | None = None) -> None:
        """`client`: another way to the line than a port of its own."""
        self.line = line
        self.requests = 0
        self.worst_latency_s = 0.0
        self._done: dict[str, None] = {}  # what has been written, for the text of a lost answer
        self._client = client or (TcpClient if is_modbus_tcp(line.port) else RtuClient)(line)
        self._client.connect()

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
                answer = self._read_run(space, run.address, run.count)
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
        answer = self._read_request(
            lambda: self._client.read_file_record([wanted], device_id=self.line.unit)
        )
        return answer.records[0].record_data

    # ---- writing -------------------------------------------------------------------------------

    def write_file(self, number: int, first: int, data: bytes) -> None:
        """Write records of a file (FC21), two bytes each, all or nothing.

        The answer is the same bytes as the request. Where it cannot be told from an echo, or is
        lost, the records are read back.
        """
        records = FileRecord(file_number=number, record_number=first, record_data=data)
        what = f"file {number}, records {first} to {first + len(data) // 2 - 1}"
        if self._client.line_echoes is None:
            self.value("self_test")  # shows whether the line echoes
        try:
            self._write_request(
                what,
                "Read it back.",
                lambda: self._client.write_file_record(
                    [records], device_id=self.line.unit, no_response_expected=False
                ),
            )
        except UnknownOutcomeError as lost:
            try:
                held = self.read_file(number, first, len(data) // 2)
            except ToolError:
                raise lost from None
            if held != data:
                raise ToolError(
                    f"{what}: not written, as reading back has shown. Give the command again."
                ) from None
        self._done[what] = None

    def write(self, values: Mapping[str, int]) -> None:
        """Write holding registers, all or nothing.

        Values that follow each other go out in one request, which the controller takes whole or
        not at all. If a later request is refused, the earlier values are written back. If the
        answer to one is lost, the error says which values were written, and which may have been.
        """
        groups = runs([POINTS[name] for name in values], REGISTERS_PER_WRITE)
        before = self.read([p for g in groups[:-1] for p in g.points]) if groups[1:] else {}
        for index, group in enumerate(groups):
            try:
                self._write_group(group.points, values)
            except RefusedError as refused:
                self._put_back(groups[:index], before, refused)
                raise
            except UnknownOutcomeError as lost:
                raise UnknownOutcomeError(
                    f"{lost}{_halves(groups[:index], groups[index + 1 :])}"
                ) from None
            except KeyboardInterrupt:
                if not groups[1:]:
                    raise
                points = list(group.points)
                stopped = self._unknown(_names(points), "Interrupted.", _look_at(points))
                raise UnknownOutcomeError(
                    f"{stopped}{_halves(groups[:index], groups[index + 1 :])}"
                ) from None
            self._done[_names(list(group.points))] = None

    def _put_back(
        self, groups: list[Run], before: Mapping[str, int], refused: RefusedError
    ) -> None:
        for index, group in enumerate(groups):
            try:
                self._write_group(group.points, before)
            except ToolError as second:
                points = [point for later in groups[index:] for point in later.points]
                raise UnknownOutcomeError(
                    f"{refused}\nPutting back {_names(points)} failed: "
                    f"{str(second).splitlines()[0]} {_look_at(points)}"
                ) from None

    def write_registers(self, address: int, registers: list[int], what: str, look: str) -> None:
        """One FC16 request. `what` names it, `look` says where to see whether it was done."""
        self._write_request(
            what,
            look,
            lambda: self._client.write_registers(
                address, registers, device_id=self.line.unit, no_response_expected=False
            ),
        )

    def _write_group(self, points: Iterable[Point], values: Mapping[str, int]) -> None:
        points = list(points)
        registers = [word for point in points for word in encode(point, values[point.name])]
        if points[0].name == "command" and values["command"] in list(Command):
            command = Command(values["command"])
            what, look = command.label, _look_at_command(command)
        else:
            what, look = _names(points), _look_at(points)
        self.write_registers(points[0].address, registers, what, look)

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
        self._write_group([POINTS["command"]], {"command": int(command)})
        deadline = time.monotonic() + limit_s
        try:
            while True:
                status = self.read(COMMAND_STATUS)
                fresh = status["command_sequence"] != before
                if fresh and status["command_result"] != Result.IN_PROGRESS:
                    break
                if time.monotonic() > deadline:
                    raise ToolError(
                        f"{command.label} has not ended after {limit_s:g} s.\n"
                        f"{_look_at_command(command)}"
                    )
                watch()
                time.sleep(poll_s)
        except NoAnswerError as lost:
            reason = str(lost).splitlines()[0]
            raise self._unknown(command.label, reason, _look_at_command(command)) from None
        if status["command_code"] != command:
            other = enum_label(Command, status["command_code"])
            raise ToolError(f"{command.label} was overtaken by {other} from another master.")
        if status["command_result"] != Result.DONE:
            raise self._command_refusal(command, status)
        self._done[command.label] = None

    def _command_refusal(self, command: Command, status: Mapping[str, int]) -> RefusedError:
        said = f"{command.label} {enum_label(Result, status['command_result'])}: "
        reason, address, value, limit = (
            status[f"command_{part}"] for part in ("reason", "address", "value", "limit")
        )
        refused = refusal(reason, address, value, limit, said)
        if status["command_reason"] == Reason.FAULTED:
            with contextlib.suppress(NoAnswerError):  # then the general text has to do
                return refused.saying(f"{said}{enum_text(Fault, self.value('fault'))}")
        return refused

    # ---- requests ------------------------------------------------------------------------------

    def _read_run(self, space: str, address: int, count: int) -> Any:
        function = {
            "coil": self._client.read_coils,
            "discrete": self._client.read_discrete_inputs,
            "holding": self._client.read_holding_registers,
            "input": self._client.read_input_registers,
        }[space]
        return self._read_request(lambda: function(address, count=count, device_id=self.line.unit))

    def _read_request(self, send: Callable[[], ModbusPDU]) -> Any:
        """A reading; what is lost is asked for again."""
        heard = Heard.NOTHING
        for _ in range(READ_ATTEMPTS):
            answer = self._send(send)
            if answer is None:
                heard = max(heard, self._client.heard)
            elif answer.isError():
                refused = self._explain(answer)
                raise refused.saying(f"{refused}{self._done_before()}")
            else:
                return answer
        raise NoAnswerError(f"{self._reason(heard)}\n{self._hint(heard)}{self._done_before()}")

    def _write_request(self, what: str, look: str, send: Callable[[], ModbusPDU]) -> None:
        """Anything else: sent once. Without an answer it may have been done, or not."""
        answer = self._send(send)
        if answer is None:
            reason = self._reason(self._client.heard)
            raise self._unknown(what, reason, look)
        if answer.isError():
            raise self._explain(answer)

    def _send(self, send: Callable[[], ModbusPDU]) -> Any:
        """One request; its answer, or None if there was none."""
        began = time.monotonic()
        try:
            answer = send()
        except ModbusException:
            time.sleep(SETTLE_S)  # a late answer goes by: it must not be taken for the next one
            return None
        except KeyboardInterrupt:
            time.sleep(SETTLE_S)
            raise
        self.requests += 1
        self.worst_latency_s = max(self.worst_latency_s, time.monotonic() - began)
        return answer

    def _unknown(self, what: str, reason: str, look: str) -> UnknownOutcomeError:
        return UnknownOutcomeError(
            f"{what}: sent, may have been done. {reason}\n{look}{self._done_before()}"
        )

    def _done_before(self) -> str:
        """What this program has done before the line failed, for the end of an error."""
        done = list(self._done)[-NAMES_SHOWN:]
        return f"\nBefore that was done: {', '.join(done)}." if done else ""

    def _reason(self, heard: Heard) -> str:
        units = ", ".join(map(str, sorted(self._client.other_units)))
        return {
            Heard.NOTHING: f"No answer from {self.line} within {self.line.timeout_s:g} s.",
            Heard.ECHO: f"No answer from {self.line}: only what was sent came back (echo).",
            Heard.NO_FRAME: f"Bytes came, no whole frame, from {self.line}.",
            Heard.OTHER_UNIT: f"No answer from {self.line}: frames of unit {units} came.",
            Heard.OTHER_ANSWER: f"{self.line} answers something else than was asked.",
            Heard.GATEWAY: f"The gateway {self.line} gets no answer from the controller.",
        }[heard]

    def _hint(self, heard: Heard) -> str:
        return {
            Heard.NOTHING: "Check power and wiring (A/B swapped?), --unit, --baud and --line. "
            "In listen only mode (FC08/04) it is mute until it is switched off and on.",
            Heard.ECHO: "The adapter works and returns every request. Check the controller's "
            "power and wiring, --unit, --baud and --line.",
            Heard.NO_FRAME: "Check --baud and --line, the wiring and its termination; "
            "does something else send?",
            Heard.OTHER_UNIT: "Check --unit.",
            Heard.OTHER_ANSWER: "Is a second master on the line, or another program at the port?",
            Heard.GATEWAY: "Check the controller's power, its line to the gateway, and --unit.",
        }[heard]

    def _explain(self, answer: ModbusPDU) -> RefusedError:
        """A Modbus exception in words, by what the controller says in last_error_*."""
        code = answer.exception_code
        name = f"Modbus exception {code:02d} ({EXCEPTION_NAMES.get(code, 'unknown')})"
        run = runs(LAST_ERROR, REGISTERS_PER_READ)[0]
        for _ in range(READ_ATTEMPTS):
            details = self._send(
                lambda: self._client.read_input_registers(
                    run.address, count=run.count, device_id=self.line.unit
                )
            )
            if details is not None:
                break
        else:
            return RefusedError(f"{name}. The reason could not be read: no answer.")
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
        why = refusal(error["reason"], error["address"], error["value"], error["limit"])
        if code == ILLEGAL_ADDRESS:
            return why.saying(f"{why} (function {error['function']}, address {error['address']})")
        return why


def _names(points: list[Point]) -> str:
    """Names for a sentence; of many the first and the last."""
    names = [point.name for point in points]
    if len(names) <= NAMES_SHOWN:
        return ", ".join(names)
    return f"{len(names)} values ({names[0]} to {names[-1]})"


def _halves(written: list[Run], unsent: list[Run]) -> str:
    """Which half of the values is surely there, and which surely not."""
    return "".join(
        f" {word}: {_names([point for run in half for point in run.points])}."
        for word, half in (("Written", written), ("Not sent", unsent))
        if half
    )


def _look_at(points: list[Point]) -> str:
    """Where to see whether these values were written."""
    if any(point.mirrors for point in points):
        return "`levelwind diff` shows what is staged, `levelwind revert` drops it."
    if points[0].name == "jog":
        return "The carriage stops by itself after jog_hold_ms; `levelwind status` shows it."
    if points[0].name in ("mode", "unlock"):
        return "`levelwind status` shows it."
    return f"`levelwind get {points[0].name}` shows it."


def _look_at_command(command: Command) -> str:
    """Where to see whether a command was done."""
    if command == Command.INDEX:
        return "The carriage may be moving: `levelwind status` shows it, `levelwind stop` stops it."
    if command.label.startswith("cam_"):
        return "`levelwind get cam_bank` shows the banks."
    if command in SET_COMMANDS:
        return "`levelwind diff` shows which parameters are staged, active and stored."
    return "`levelwind status` shows it."
