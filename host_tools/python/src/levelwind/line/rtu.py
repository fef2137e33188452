# SPDX-License-Identifier: Apache-2.0
"""Modbus RTU on a line that is not clean: the answer to a request, found in whatever bytes come.

An adapter may return every request before the answer (echo). A driver that switches on or off
leaves bytes of 00 or FF on the line. Other units answer other masters. pymodbus takes the first
byte that comes for the beginning of the answer; here the answer is looked for by all that the
request says of it: unit, function, length, what else must stand in it, and its CRC.
"""

import time
from collections.abc import Iterator
from enum import IntEnum

import serial
from pymodbus.client import ModbusSerialClient
from pymodbus.framer import FramerRTU

from levelwind.errors import ToolError
from levelwind.line.port import PORT_ERRORS, Line, open_port

FRAME_MAX = 256
EXCEPTION_SIZE = 5
EXCEPTION_BIT = 0x80
IDENTIFICATION = bytes([43, 14])
TURNAROUND_S = 0.1
"""After a broadcast, which nobody answers: what slaves need to take it."""
ECHO_MIN = 5
"""From so many bytes on, the beginning of an echo could hold what looks like an answer."""
KEPT = 4 * FRAME_MAX
"""Of bytes that do not end, the last ones are looked at."""


class Heard(IntEnum):
    """What came instead of an answer; the later ones tell more."""

    NOTHING = 0
    ECHO = 1
    NO_FRAME = 2
    OTHER_UNIT = 3
    OTHER_ANSWER = 4
    GATEWAY = 5


class AnswerSearch:
    """Looks for the answer to one request."""

    def __init__(self, request: bytes, line_echoes: bool | None) -> None:
        """`line_echoes`: what earlier requests have shown; None: not known yet."""
        self.echoed = False
        self.other_units: set[int] = set()
        self.request = request
        self._line_echoes = line_echoes
        self._head, self._size = _answer_form(request)
        exception = bytes([request[0], request[1] | EXCEPTION_BIT])
        self._forms = ((self._head, self._size), (exception, EXCEPTION_SIZE))
        self._buffer = bytearray()
        self._came = False

    @property
    def size_max(self) -> int:
        """Bytes that the answer can have."""
        return min(self._size or FRAME_MAX, FRAME_MAX)

    def add(self, data: bytes) -> bytes:
        """More bytes; the answer as soon as it is certain, else nothing."""
        self._came = self._came or bool(data)
        self._buffer += data
        if not self.echoed:
            at = self._buffer.find(self.request)
            if at >= 0 and self._is_answer(self.request) and self._line_echoes is False:
                return self.request
            if at >= 0:
                self.echoed = True
                del self._buffer[: at + len(self.request)]
            elif self._echo_has_begun():
                return b""
        frame = self._find(may_wait=True)
        del self._buffer[:-KEPT]
        return frame

    def end(self) -> bytes:
        """Nothing more comes: the answer, where waiting for more has hidden it."""
        return self._find(may_wait=False)

    def heard(self) -> Heard:
        """What came, if it was no answer."""
        units = {self._buffer[at] for at in _whole_frames(self._buffer)}
        if self.request[0] in units:
            return Heard.OTHER_ANSWER
        self.other_units = units
        if units:
            return Heard.OTHER_UNIT
        if self.echoed and not self._buffer:
            return Heard.ECHO
        return Heard.NO_FRAME if self._came else Heard.NOTHING

    def _is_answer(self, frame: bytes) -> bool:
        return len(frame) == self._size and frame.startswith(self._head)

    def _echo_has_begun(self) -> bool:
        """Do the last bytes look like the beginning of the echo?"""
        size = len(self._buffer)
        first = max(0, size - len(self.request) + 1)
        return any(
            self.request.startswith(self._buffer[at:]) for at in range(first, size - ECHO_MIN + 1)
        )

    def _find(self, may_wait: bool) -> bytes:
        buffer = self._buffer
        for at in range(len(buffer) - EXCEPTION_SIZE + 1):
            for head, known in self._forms:
                if not buffer.startswith(head, at):
                    continue
                size = known or _size_said(buffer, at) or len(buffer) - at + may_wait
                frame = bytes(buffer[at : at + size])
                if len(frame) < size:
                    if may_wait:  # what stands further on may be a part of this one
                        return b""
                elif _crc_fits(frame):
                    return frame
        return b""


def _answer_form(request: bytes) -> tuple[bytes, int | None]:
    """How the answer to a request begins, and its whole size; None: the answer says it itself."""
    unit, function = request[:2]
    count = int.from_bytes(request[4:6], "big")
    if function in (1, 2):
        data = -(-count // 8)
        return bytes([unit, function, data & 0xFF]), 5 + data
    if function in (3, 4, 23):
        return bytes([unit, function, 2 * count & 0xFF]), 5 + 2 * count
    if function in (15, 16):
        return request[:6], 8
    if function == 20 and request[2] == 7:  # one group of records
        data = 2 * int.from_bytes(request[8:10], "big")
        return bytes([unit, function, data + 2 & 0xFF, data + 1 & 0xFF, 6]), 7 + data
    # The rest: what comes back, or how it begins.
    if function in (5, 6, 21, 22) or request[1:4] == bytes([8, 0, 0]):
        return request[:-2], len(request)
    head = request[:4] if function == 8 else request[:2]
    return head, {7: 5, 8: 8, 11: 8}.get(function)


def _size_said(buffer: bytes | bytearray, at: int) -> int | None:
    """The size of a frame that says it itself; None: not yet, or by its end alone."""
    frame = bytes(buffer[at : at + FRAME_MAX])
    if len(frame) < 4:
        return None
    if frame[1] in (12, 17, 20):
        return 5 + frame[2]
    if frame[1] == 24:
        return 6 + int.from_bytes(frame[2:4], "big")
    if frame[1:3] == IDENTIFICATION and len(frame) > 7:
        size = 8
        for _ in range(frame[7]):
            if len(frame) < size + 2:
                return None
            size += 2 + frame[size + 1]
        return size + 2
    return None


def _whole_frames(buffer: bytes | bytearray) -> Iterator[int]:
    """Where frames with a right CRC begin."""
    for at in range(len(buffer) - EXCEPTION_SIZE + 1):
        function = buffer[at + 1]
        if function & EXCEPTION_BIT:
            size = EXCEPTION_SIZE
        elif function in (1, 2, 3, 4, 17, 20, 21, 23):
            size = 5 + buffer[at + 2]
        elif function in (5, 6, 8, 15, 16):
            size = 8
        else:
            continue
        frame = bytes(buffer[at : at + size])
        if len(frame) == size and _crc_fits(frame):
            yield at


def _crc_fits(frame: bytes) -> bool:
    return FramerRTU.check_CRC(frame[:-2], int.from_bytes(frame[-2:], "big"))


def sealed(frame: bytes) -> bytes:
    """Unit and PDU with their CRC."""
    return frame + FramerRTU.compute_CRC(frame).to_bytes(2, "big")


class RtuClient(ModbusSerialClient):
    """pymodbus's client, with its transport replaced: it is handed the answer and nothing else."""

    def __init__(self, line: Line) -> None:
        super().__init__(line.port, baudrate=line.baud, timeout=line.timeout_s, retries=0)
        self.line = line
        self.line_echoes: bool | None = None
        self.heard = Heard.NOTHING
        self.other_units: set[int] = set()
        self._search: AnswerSearch | None = None

    def connect(self) -> bool:
        """Open the port, if it is not; ToolError says why it cannot be."""
        if self.socket is None:
            self.socket = open_port(self.line)
        return True

    def send(self, request: bytes, addr: tuple[object, ...] | None = None) -> int:
        """Send a request, and forget what came before it."""
        del addr
        self._search = AnswerSearch(bytes(request), self.line_echoes)
        try:
            self.socket.reset_input_buffer()
            self.socket.write(request)
        except serial.SerialTimeoutException:
            raise ToolError(
                f"{self.line.port} takes no bytes: flow control, or a program that stands still."
            ) from None
        except PORT_ERRORS:
            self._gone()
        return len(request)

    def recv(self, size: int | None) -> bytes:
        """The answer to the request that was sent; nothing after the time-out."""
        del size
        search = self._search
        on_the_wire = len(search.request) * 2 + search.size_max  # the echo, too
        deadline = time.monotonic() + self.line.timeout_s + on_the_wire * self.line.character_s
        answer = b""
        try:
            while not answer and (left_s := deadline - time.monotonic()) > 0:
                self.socket.timeout = left_s
                data = self.socket.read(1)
                if data:
                    answer = search.add(data + self.socket.read(self.socket.in_waiting))
        except PORT_ERRORS:
            self._gone()
        answer = answer or search.end()
        if search.echoed:
            self.line_echoes = True
        elif answer and self.line_echoes is None:
            self.line_echoes = False
        # If pymodbus cannot make anything of the answer, it is another one.
        self.heard = Heard.OTHER_ANSWER if answer else search.heard()
        self.other_units = search.other_units
        return answer

    def exchange(self, unit: int, pdu: bytes) -> bytes:
        """One request, whatever its function; the PDU of the answer, empty if there is none.

        ToolError says why the port cannot be used.
        """
        self.connect()
        self.send(sealed(bytes([unit]) + pdu))
        if unit == 0:
            time.sleep(TURNAROUND_S)
            return b""
        return self.recv(None)[1:-2]

    def _gone(self) -> None:
        self.close()
        raise ToolError(
            f"The port {self.line.port} has gone away: unplugged, or the simulator has ended."
        ) from None
