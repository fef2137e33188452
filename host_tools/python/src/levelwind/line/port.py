# SPDX-License-Identifier: Apache-2.0
"""Ports: how a line is named, and the one place where the tool opens a serial one."""

import os
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import serial

from levelwind.errors import ToolError

try:
    from termios import error as _termios_error
except ImportError:  # not POSIX
    PORT_ERRORS: tuple[type[Exception], ...] = (OSError,)
else:
    PORT_ERRORS = (OSError, _termios_error)
"""What pyserial raises when a port goes away."""
OPEN_ERRORS: tuple[type[Exception], ...] = (*PORT_ERRORS, ValueError)
MODBUS_TCP, SERIAL_GATEWAY = "tcp", "rtu+tcp"
MODBUS_TCP_PORT = 502
CHARACTER_BITS = 11  # start, eight data, parity or a second stop, stop


@dataclass(frozen=True)
class Line:
    """How to reach a controller."""

    port: str
    baud: int = 19200
    format: str = "8E1"
    unit: int = 1
    timeout_s: float = 1.0

    @property
    def character_s(self) -> float:
        """Time of one character on the wire."""
        return CHARACTER_BITS / self.baud

    def __str__(self) -> str:
        if "://" in self.port:
            return f"{self.port} (unit {self.unit})"
        return f"{self.port} ({self.baud} baud {self.format}, unit {self.unit})"


def tcp_address(port: str) -> tuple[str, str, int] | None:
    """Scheme, host and TCP port of tcp://HOST[:PORT] or rtu+tcp://HOST:PORT; None: a path.

    ToolError where it is neither.
    """
    scheme, separator, _ = port.partition("://")
    if not separator:
        return None
    try:
        parts = urlsplit(port)
        number = parts.port
    except ValueError as error:
        raise ToolError(f"--port {port}: {error}.") from None
    if scheme not in (MODBUS_TCP, SERIAL_GATEWAY):
        raise ToolError(f"--port {port}: give a path, tcp://HOST[:PORT] or rtu+tcp://HOST:PORT.")
    if scheme == MODBUS_TCP:
        number = MODBUS_TCP_PORT if number is None else number
    if not parts.hostname or not number or parts.path.strip("/") or parts.username:
        raise ToolError(f"--port {port}: give {scheme}://HOST:PORT, and nothing else.")
    return scheme, parts.hostname, number


def is_modbus_tcp(port: str) -> bool:
    """Does this name a Modbus TCP server, not a line of bytes?"""
    address = tcp_address(port)
    return address is not None and address[0] == MODBUS_TCP


def open_port(line: Line) -> serial.SerialBase:
    """The port of a line, for this program alone; ToolError says why not.

    Two programs at one port take each other's answers.
    """
    address = tcp_address(line.port)
    if address is not None:
        return _open_gateway(line, *address)
    check_port(line.port)
    try:
        return serial.Serial(
            line.port,
            line.baud,
            bytesize=int(line.format[0]),
            parity=parity(line),
            stopbits=int(line.format[2]),
            write_timeout=line.timeout_s,
            exclusive=True,
        )
    except OPEN_ERRORS as error:
        if "exclusively" in str(error):
            raise ToolError(
                f"{line.port} is in use by another program: end it first "
                f"(`fuser {line.port}` names it)."
            ) from error
        raise ToolError(f"{line.port} cannot be opened: {error}.") from error


def _open_gateway(line: Line, scheme: str, host: str, number: int) -> serial.SerialBase:
    """A serial gateway that hands bytes on."""
    if scheme == MODBUS_TCP:
        raise ToolError(f"{line.port}: this needs a line of bytes: a serial port, or rtu+tcp://.")
    try:
        name = f"[{host}]" if ":" in host else host
        opened = serial.serial_for_url(f"socket://{name}:{number}")
        opened.write_timeout = line.timeout_s
        return opened
    except OPEN_ERRORS as error:
        raise ToolError(f"{line.port} cannot be reached: {error}.") from error


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
