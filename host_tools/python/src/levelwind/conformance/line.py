"""Bytes on a serial line: what is sent is what the case says, right or wrong."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import serial

from levelwind.device import Line, check_port, is_pseudo_terminal, parity
from levelwind.errors import ToolError

FRAME_MAX = 256
CHARACTER_BITS = 11
QUIET_S = 0.003
"""Silence behind a complete answer, so that bytes too many are seen."""
INCOMPLETE_S = 0.05
"""Silence that ends any other one: drivers and USB adapters hand bytes over in lots."""
COARSE_S = 0.01
"""Pauses longer than this need no exact time."""


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
        check_port(line.port)
        self.character_s = 0.0 if is_pseudo_terminal(line.port) else CHARACTER_BITS / line.baud
        try:
            self._port = serial.Serial(
                line.port,
                line.baud,
                bytesize=int(line.format[0]),
                parity=parity(line),
                stopbits=int(line.format[2]),
            )
        except serial.SerialException as error:
            raise ToolError(f"{line.port} cannot be opened: {error}.") from error

    def close(self) -> None:
        """Give the port back."""
        self._port.close()

    def exchange(self, pieces: Sequence[bytes], pause_s: float, wait_s: float) -> Received:
        """Send the pieces with a pause between them, and wait for the first byte of an answer."""
        try:
            return self._exchange(pieces, pause_s, wait_s)
        except (serial.SerialException, OSError) as error:
            raise ToolError(f"The port {self._port.port} has gone away: {error}.") from error

    def _exchange(self, pieces: Sequence[bytes], pause_s: float, wait_s: float) -> Received:
        self._port.reset_input_buffer()
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
        self._port.timeout = wait_s
        frame = self._port.read(1)
        latency_s = time.monotonic() - sent
        while len(frame) <= 2 * FRAME_MAX:
            complete = len(frame) >= 4 and crc16(frame) == 0
            self._port.timeout = 4 * self.character_s + (QUIET_S if complete else INCOMPLETE_S)
            more = self._port.read(max(1, self._port.in_waiting)) if frame else b""
            if not more:
                break
            frame += more
        return Received(frame, latency_s, longest_s)


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
