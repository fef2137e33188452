# SPDX-License-Identifier: Apache-2.0
"""Modbus TCP: the answer to a request, found by its transaction."""

import socket
import struct
import time

from levelwind.errors import ToolError
from levelwind.line.port import Line, tcp_address
from levelwind.line.rtu import EXCEPTION_BIT, Heard, RtuClient, sealed

HEAD = struct.Struct(">HHHB")
"""Transaction, protocol (0), length of unit and PDU, unit."""
LENGTH_MAX = 254  # unit and PDU
GATEWAY_EXCEPTIONS = (0x0A, 0x0B)
"""Path unavailable, target did not answer: the controller has said nothing."""


class TcpClient(RtuClient):
    """The same client, its transport a connection to a Modbus TCP server or gateway."""

    def __init__(self, line: Line) -> None:
        super().__init__(line)
        self.line_echoes = False
        self._transaction = 0
        self._request = b""
        self._received = bytearray()

    def connect(self) -> bool:
        """Connect, if it is not; ToolError says why it cannot be."""
        if self.socket is None:
            _, host, number = tcp_address(self.line.port) or ("", "", 0)
            try:
                self.socket = socket.create_connection((host, number), self.line.timeout_s)
                self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            except OSError as error:
                why = error.strerror or error
                raise ToolError(f"{self.line.port} cannot be reached: {why}.") from error
            self._received.clear()
        return True

    def send(self, request: bytes, addr: tuple[object, ...] | None = None) -> int:
        """Send a request."""
        del addr
        self._transaction = self._transaction + 1 & 0xFFFF
        self._request = bytes(request[:-2])
        head = HEAD.pack(self._transaction, 0, len(self._request), self._request[0])
        try:
            self.socket.settimeout(self.line.timeout_s)
            self.socket.sendall(head + self._request[1:])
        except OSError:
            self._gone()
        return len(request)

    def recv(self, size: int | None) -> bytes:
        """The answer to the request that was sent, with a CRC; nothing after the time-out."""
        del size
        self.heard = Heard.NOTHING
        deadline = time.monotonic() + self.line.timeout_s
        while (left_s := deadline - time.monotonic()) > 0:
            answer = self._next_frame()
            if answer is None:
                try:
                    self.socket.settimeout(left_s)
                    data = self.socket.recv(4096)
                except TimeoutError:
                    break
                except OSError:
                    data = b""
                if not data:
                    self._gone()
                self._received += data
                continue
            transaction, frame = answer
            if transaction != self._transaction or frame[0] != self._request[0]:
                continue  # late, to a request that nobody waits for any more
            self.heard = Heard.OTHER_ANSWER
            if frame[1] == self._request[1] | EXCEPTION_BIT and frame[2] in GATEWAY_EXCEPTIONS:
                self.heard = Heard.GATEWAY
                return b""
            return sealed(frame)
        return b""

    def _next_frame(self) -> tuple[int, bytes] | None:
        """Transaction, and unit with PDU."""
        if len(self._received) < HEAD.size:
            return None
        transaction, protocol, length, unit = HEAD.unpack_from(self._received)
        if protocol or not 3 <= length <= LENGTH_MAX:
            self.close()
            raise ToolError(f"{self.line.port} is no Modbus TCP server: what came is no frame.")
        end = HEAD.size + length - 1
        if len(self._received) < end:
            return None
        frame = bytes([unit]) + self._received[HEAD.size : end]
        del self._received[:end]
        return transaction, frame
