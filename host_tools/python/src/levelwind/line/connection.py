# SPDX-License-Identifier: Apache-2.0
"""The options of every command that talks to a controller."""

import functools
import inspect
from collections.abc import Callable
from typing import Annotated, Any, Literal

import typer

from levelwind.line.device import Device
from levelwind.line.port import Line

PORT_DEFAULT = "/tmp/levelwind"

Port = Annotated[
    str,
    typer.Option(
        "--port",
        envvar="LEVELWIND_PORT",
        help="Serial port, tcp://HOST[:PORT] (Modbus TCP) or rtu+tcp://HOST:PORT.",
        metavar="PATH",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]


def _options(
    port: Port = PORT_DEFAULT,
    baud: Annotated[int, typer.Option("--baud", help="Line speed.")] = 19200,
    line_format: Annotated[
        Literal["8E1", "8O1", "8N1", "8N2"],
        typer.Option("--line", help="Data bits, parity, stop bits."),
    ] = "8E1",
    unit: Annotated[int, typer.Option("--unit", help="Modbus unit id.", min=1, max=247)] = 1,
    timeout: Annotated[
        float, typer.Option("--timeout", help="Seconds to wait for an answer.", min=0.05)
    ] = 1.0,
) -> Line:
    return Line(port, baud, line_format, unit, timeout)


def with_line(function: Callable[..., None]) -> Callable[..., None]:
    """Add the connection options to a command; it gets the line as its first argument."""
    own = list(inspect.signature(function).parameters.values())[1:]
    shared = list(inspect.signature(_options).parameters.values())

    @functools.wraps(function)
    def command(**arguments: Any) -> None:
        line = _options(**{p.name: arguments.pop(p.name) for p in shared})
        function(line, **arguments)

    parameters = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in [*own, *shared]]
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in parameters}
    return command


def with_device(function: Callable[..., None]) -> Callable[..., None]:
    """The same for a command that gets the open device."""

    @functools.wraps(function)
    def opened(line: Line, **arguments: object) -> None:
        with Device(line) as device:
            function(device, **arguments)

    return with_line(opened)
