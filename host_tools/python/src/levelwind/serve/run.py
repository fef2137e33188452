# SPDX-License-Identifier: Apache-2.0
"""Everything of the server together: who listens where, and in which order it begins and ends."""

import asyncio
import contextlib
import socket
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import uvicorn

from levelwind.errors import ToolError
from levelwind.line.port import Line
from levelwind.serve.commissioning import Commissioning
from levelwind.serve.demonstration import Demonstration
from levelwind.serve.gateway import Gateway, Network
from levelwind.serve.guard import CONNECTIONS_MAX, PatientHttp, PinFile, Sessions, is_loopback
from levelwind.serve.operate import Operator
from levelwind.serve.owner import PortOwner
from levelwind.serve.recorder import Recorder
from levelwind.serve.watcher import Watcher
from levelwind.serve.web import Served, application


@dataclass(frozen=True)
class Setting:
    """What to serve, and to whom."""

    line: Line
    listen: str
    modbus_tcp: str | None = None
    record: Path | None = None
    keep: int = 1000
    pin: PinFile | None = None
    """None: nobody may give commands."""
    write_from: tuple[Network, ...] = ()
    names: frozenset[str] = frozenset()
    commission: Path | None = None
    """The folder of a commissioning; None: the page offers none."""
    demonstrate: bool = False
    parameters: Mapping[str, int] | None = None
    """The demonstration's, where its machine is not the default one."""


def address(option: str, given: str) -> tuple[str, int]:
    """HOST:PORT; ToolError if it is none."""
    try:
        parts = urlsplit(f"//{given}")
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or port is None or parts.path:
        raise ToolError(f"{option} {given}: give HOST:PORT, for example 127.0.0.1:8080.")
    return host, port


def _listen(option: str, host: str, port: int) -> socket.socket:
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        family, _, _, _, where = found[0]
        listening = socket.socket(family, socket.SOCK_STREAM)
        try:
            if hasattr(socket, "SO_REUSEADDR"):
                listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listening.bind(where)
            listening.listen(CONNECTIONS_MAX)
        except OSError:
            listening.close()
            raise
    except (OSError, OverflowError) as error:
        why = getattr(error, "strerror", None) or error
        raise ToolError(f"{option} {host}:{port}: {why}.") from error
    return listening


def warnings(setting: Setting) -> list[str]:
    """What whoever starts it should know, in words."""
    said = []
    page, _ = address("--listen", setting.listen)
    if not is_loopback(page):
        what = "with the PIN also command it" if setting.pin else "not change anything"
        said.append(
            f"--listen {setting.listen}: whoever reaches this machine can see the page, and "
            f"{what}. Nothing is encrypted: use it in a network of your own only."
        )
    if setting.modbus_tcp is not None:
        gate, _ = address("--modbus-tcp", setting.modbus_tcp)
        if not is_loopback(gate):
            said.append(
                f"--modbus-tcp {setting.modbus_tcp}: whoever reaches this machine can read the "
                "controller. Modbus knows no password."
            )
    if setting.write_from:
        nets = ", ".join(map(str, setting.write_from))
        said.append(f"--write-from: every program at {nets} can move the carriage.")
    return said


def _end(recorder: Recorder, warn: Callable[[str], None]) -> None:
    lost = recorder.close()
    if lost:
        warn(f"--record {lost}.")


def run(setting: Setting, ready: Callable[[str], None], warn: Callable[[str], None]) -> None:
    """Serve until a signal; ToolError says why it cannot begin. `ready` is told the page's URL."""
    host, port = address("--listen", setting.listen)
    gate = address("--modbus-tcp", setting.modbus_tcp) if setting.modbus_tcp is not None else None
    for warning in warnings(setting):
        warn(warning)
    with ExitStack() as stack:
        owner = PortOwner(setting.line)
        owner.open()
        owner.start()
        stack.callback(owner.close)
        listening = stack.enter_context(_listen("--listen", host, port))
        watcher = Watcher(owner)
        gateway = Gateway(owner, list(setting.write_from))
        sessions = Sessions(setting.pin) if setting.pin is not None else None
        served = Served(owner, watcher, None, sessions)
        served.gateway_clients = lambda: gateway.clients
        served.loopback, served.names = is_loopback(host), setting.names
        watcher.listeners.append(served.see)
        if setting.record is not None:
            served.recorder = Recorder(setting.record, watcher, served.growth, setting.keep)
            stack.callback(_end, served.recorder, warn)
            served.recorder.start()
        if setting.commission is not None:
            served.commissioning = Commissioning(owner, setting.commission)
        shown = f"[{host}]" if ":" in host else host
        url = f"http://{shown}:{listening.getsockname()[1]}/"

        failed: list[ToolError | OSError] = []

        async def begin() -> None:
            try:
                if gate is not None:
                    await gateway.start(*gate)
                ready(url)  # nobody may be there to read it
            except (ToolError, OSError) as error:
                failed.append(error)
                server.should_exit = True

        served.on_start = begin
        server = uvicorn.Server(
            uvicorn.Config(
                application(served),
                log_level="error",
                access_log=False,
                server_header=False,
                lifespan="on",
                http=PatientHttp,
                timeout_graceful_shutdown=1,
                ws="websockets-sansio",
                ws_max_size=4096,
                ws_max_queue=4,
                ws_ping_interval=5.0,
                ws_ping_timeout=5.0,
            )
        )

        async def serve() -> None:
            await server.serve(sockets=[listening])
            await gateway.close()

        watcher.start()
        stack.callback(watcher.close)
        if setting.demonstrate:
            demonstration = Demonstration(Operator(owner).device, warn, setting.parameters)
            stack.callback(demonstration.close)
            demonstration.start()
        with contextlib.suppress(asyncio.CancelledError, KeyboardInterrupt):
            asyncio.run(serve())
        if failed:
            raise failed[0]
