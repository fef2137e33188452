# SPDX-License-Identifier: Apache-2.0
"""Bytes on a serial line: what is sent is what the case says, right or wrong."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from levelwind.errors import ToolError
from levelwind.line.port import PORT_ERRORS, Line, is_pseudo_terminal, open_port

FRAME_MAX = 256
QUIET_S = 0.003
"""Silence behind a complete answer, so that bytes too many are seen."""
INCOMPLETE_S = 0.05
"""Silence that ends any other one: drivers and USB adapters hand bytes over in lots."""
COARSE_S = 0.01
"""Pauses longer than this need no exact time."""
ENDLESS_S = 2.0
"""Bytes that come for longer than any frame takes are no answer, and will not end."""


@dataclass(frozen=True)
class Received:
    """What came back, and when."""

    frame: bytes
    latency_s: float = 0.0  # from the end of the request to the first byte
    pause_s: float = 0.0  # longest pause between two pieces of the request


class RawLine(Protocol):
    """Something that carries bytes to a slave and back."""

    character_s: float
    """Time of one character; 0 where characters take none (a pseudo terminal)."""

    def exchange(self, pieces: Sequence[bytes], pause_s: float, wait_s: float) -> Received:
        """Send the pieces with a pause between them, and wait for the first byte of an answer."""
        ...


class SerialLine:
    """A serial port."""

    def __init__(self, line: Line) -> None:
        self.character_s = 0.0 if is_pseudo_terminal(line.port) else line.character_s
        self._port = open_port(line)
        self._echoes: bool | None = None

    def close(self) -> None:
        """Give the port back."""
        self._port.close()

    def exchange(self, pieces: Sequence[bytes], pause_s: float, wait_s: float) -> Received:
        """Send the pieces with a pause between them, and wait for the first byte of an answer.

        An adapter that returns what is sent is noticed at the first answer, and its echo dropped.
        """
        try:
            self._port.reset_input_buffer()
            longest_s = self._send(pieces, pause_s)
            return self._answer(b"".join(pieces), longest_s, wait_s)
        except PORT_ERRORS as error:
            raise ToolError(f"The port {self._port.port} has gone away: {error}.") from error

    def _send(self, pieces: Sequence[bytes], pause_s: float) -> float:
        longest_s = 0.0
        sent = time.monotonic()
        for index, piece in enumerate(pieces):
            if index:
                # Sleeping is too coarse for parts of a character.
                while time.monotonic() - sent < pause_s:
                    if pause_s > COARSE_S:
                        time.sleep(pause_s / 20)
                longest_s = max(longest_s, time.monotonic() - sent)
            self._port.write(piece)
            self._port.flush()
            sent = time.monotonic()
        return longest_s

    def _answer(self, sent: bytes, longest_s: float, wait_s: float) -> Received:
        began = time.monotonic()
        if self._echoes:
            self._port.timeout = wait_s + len(sent) * self.character_s
            echo = self._port.read(len(sent))
            frame, latency_s = self._frame(began, wait_s)
            if echo != sent:
                frame = echo + frame
        else:
            frame, latency_s = self._frame(began, wait_s)
            if self._echoes is None and frame.startswith(sent):
                self._echoes = True
                frame = frame[len(sent) :]
                if not frame:
                    frame, latency_s = self._frame(began, wait_s)
            elif self._echoes is None and frame:
                self._echoes = False
        return Received(frame, latency_s, longest_s)

    def _frame(self, began: float, wait_s: float) -> tuple[bytes, float]:
        """Bytes up to a silence, the first FRAME_MAX and some of them; when the first one came."""
        self._port.timeout = wait_s
        frame = self._port.read(1)
        first = time.monotonic()
        while frame:
            complete = len(frame) >= 4 and crc16(frame) == 0
            self._port.timeout = 4 * self.character_s + (QUIET_S if complete else INCOMPLETE_S)
            more = self._port.read(max(1, self._port.in_waiting))
            if not more:
                break
            frame = (frame + more)[: 2 * FRAME_MAX + 1]
            if time.monotonic() - first > ENDLESS_S + 2 * FRAME_MAX * self.character_s:
                raise ToolError(
                    f"Bytes come from {self._port.port} that do not end. Does something else "
                    "send? Check --baud and --line, and the wiring."
                )
        return frame, first - began


def crc16(frame: bytes) -> int:
    """The CRC of Modbus RTU; 0 over a frame with its CRC (SL 2.5.1.2)."""
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def sealed(frame: bytes) -> bytes:
    """A frame with its CRC."""
    return frame + crc16(frame).to_bytes(2, "little")
