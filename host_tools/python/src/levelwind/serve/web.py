# SPDX-License-Identifier: Apache-2.0
"""The page and what it asks for: HTTP and one WebSocket."""

import asyncio
import contextlib
import functools
import json
import time
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from levelwind.errors import ToolError
from levelwind.serve.guard import Guard, Sessions
from levelwind.serve.lay import Growth
from levelwind.serve.metrics import exposition
from levelwind.serve.operate import Jog, Operator
from levelwind.serve.owner import PortOwner
from levelwind.serve.recorder import Launches, Recorder
from levelwind.serve.view import Seen, log_rows, view
from levelwind.serve.watcher import Watcher
from levelwind.show.status import status_json

if TYPE_CHECKING:
    from levelwind.serve.commissioning import Commissioning

PAGE = Path(__file__).parent / "page"
SEND_EVERY_S = 0.1
LAY_EVERY_S = 2.0
TREND_EVERY_S = 0.2
TREND_S = 300
OLD_S = 1.0
SOCKETS_MAX = 32
BESIDE_COMMISSIONING = ("stop", "trim_early", "trim_late")
"""What else the operator's page may do while a commissioning is under way: its last step trims."""
REPORT_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; "
    "base-uri 'none'; form-action 'none'"
)
"""The report has its pictures and its style within."""


@dataclass
class Served:
    """All that the page looks at."""

    owner: PortOwner
    watcher: Watcher
    recorder: Recorder | None
    sessions: Sessions | None
    """None: nobody may give commands."""
    commissioning: "Commissioning | None" = None
    gateway_clients: Callable[[], int] = lambda: 0
    loopback: bool = True
    names: frozenset[str] = frozenset()
    on_start: Callable[[], Any] = lambda: None
    growth: Growth = field(default_factory=Growth)
    trend: deque[list[float]] = field(
        default_factory=lambda: deque(maxlen=int(TREND_S / TREND_EVERY_S))
    )

    def see(self, seen: Seen) -> None:
        """A look at the controller: keep what the page draws of the past."""
        self.growth.see(seen, self.watcher.parameters)
        if not self.trend or seen.stamp_s - self.trend[-1][0] >= TREND_EVERY_S:
            status, latest = seen.status, self.owner.counts.line_s
            self.trend.append(
                [
                    round(seen.stamp_s, 3),
                    status["rope_speed_mm_per_s"] / 1000,
                    status["position_um"] / 1000,
                    round(1000 * latest[-1], 2) if latest else 0.0,
                ]
            )


class Page:
    """The routes."""

    def __init__(self, served: Served) -> None:
        self.served = served
        self.operator = Operator(served.owner)
        self.jog = Jog(self.operator) if served.sessions is not None else None
        self._sockets: set[WebSocket] = set()
        # One at a time: many at once would take the processor, or the line, from the live values.
        self._records = asyncio.Semaphore()
        self._parameters = asyncio.Semaphore()

    # ---- looking -------------------------------------------------------------------------------

    async def live(self, socket: WebSocket) -> None:
        """What happens, ten times a second; from the page only that a key is held."""
        await self._attend(socket, self._send, self._hear, self._let_go)

    async def _attend(
        self,
        socket: WebSocket,
        send: Callable[[WebSocket], Awaitable[None]],
        hear: Callable[[WebSocket, str], str],
        gone: Callable[[WebSocket], None],
    ) -> None:
        """A page's connection to its end: `send` goes on beside `hear`, which may refuse."""
        if len(self._sockets) >= SOCKETS_MAX:
            await socket.close(1013, "Too many pages are open.")
            return
        await socket.accept()
        self._sockets.add(socket)
        sender = asyncio.ensure_future(send(socket))
        try:
            while True:
                refused = hear(socket, await socket.receive_text())
                if refused:
                    await socket.send_json({"refused": refused})
        except (WebSocketDisconnect, RuntimeError):
            pass
        finally:
            gone(socket)
            self._sockets.discard(socket)
            sender.cancel()
            with contextlib.suppress(asyncio.CancelledError, Exception):
                await sender

    def _let_go(self, socket: WebSocket) -> None:
        if self.jog is not None:
            self.jog.let_go(socket)

    def _hear(self, socket: WebSocket, text: str) -> str:
        try:
            direction = int(json.loads(text)["jog"])
        except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
            return ""
        if self.jog is None or not self._may_command(socket) or self._is_commissioned():
            return ""
        if direction in (-1, 1):
            self.jog.hold(socket, direction)
        else:
            self.jog.let_go(socket)
        return ""

    async def _send(self, socket: WebSocket) -> None:
        served = self.served
        await socket.send_json({"trend": list(served.trend), "now": time.monotonic()})
        told_log: object = None
        told_lay = 0.0
        number = 0
        while True:
            number += 1
            seen = served.watcher.seen
            document: dict[str, object] = {
                "number": number,
                "now": time.monotonic(),
                "stamp": seen.stamp_s if seen else None,
                "problem": served.watcher.problem,
                "commands": self.jog is not None,
                "open": self._may_command(socket),
                "jog_problem": self.jog.problem if self.jog else "",
                "recorder": served.recorder.state() if served.recorder else None,
                "clients": served.gateway_clients(),
                "commissioning": self._commissioning_word(),
            }
            if seen is not None:
                document["view"] = view(seen)
                document["trend_row"] = served.trend[-1] if served.trend else None
                if seen.log is not told_log:
                    told_log = seen.log
                    document["log"] = log_rows(seen.log)
            if time.monotonic() - told_lay > LAY_EVERY_S:
                told_lay = time.monotonic()
                document["lay"] = await run_in_threadpool(served.growth.picture)
            await socket.send_json(document)
            await asyncio.sleep(SEND_EVERY_S)

    async def status(self, _: Request) -> Response:
        """The status for programs, with its age."""
        seen = self.served.watcher.seen
        if seen is None:
            return JSONResponse({"problem": self.served.watcher.problem}, 503)
        age_s = round(time.monotonic() - seen.stamp_s, 3)
        return JSONResponse(
            {"age_s": age_s, "problem": self.served.watcher.problem, **status_json(seen.status)}
        )

    async def metrics(self, _: Request) -> Response:
        """For Prometheus."""
        body, kind = exposition(self.served.owner, self.served.watcher, self.served.recorder)
        return Response(body, media_type=kind)

    async def parameters(self, _: Request) -> Response:
        """The three copies."""
        async with self._parameters:
            return await self._told(self.operator.parameters)

    # ---- launches ------------------------------------------------------------------------------

    def _launches(self) -> Launches:
        if self.served.recorder is None:
            raise ToolError("Nothing is recorded: `levelwind serve --record FILE.sqlite`.")
        return Launches(self.served.recorder.path)

    async def launches(self, _: Request) -> Response:
        """The newest."""
        async with self._records:
            return await self._told(lambda: self._launches().list(50))

    async def launch_picture(self, request: Request) -> Response:
        """One as a picture."""
        number = request.path_params["number"]
        return await self._of_launch(lambda: self._launches().picture(number), "image/png")

    async def launch_csv(self, request: Request) -> Response:
        """One as a table."""
        number = request.path_params["number"]
        return await self._of_launch(lambda: self._launches().csv(number), "text/csv")

    async def _of_launch(self, do: Callable[[], bytes | str], kind: str) -> Response:
        try:
            async with self._records:
                return Response(await run_in_threadpool(do), media_type=kind)
        except ToolError as error:
            return PlainTextResponse(str(error), 404)

    # ---- commands ------------------------------------------------------------------------------

    def _may_command(self, connection: Request | WebSocket) -> bool:
        sessions = self.served.sessions
        return sessions is not None and sessions.is_open(
            connection.cookies.get(_cookie(connection))
        )

    async def pin(self, request: Request) -> Response:
        """The PIN: opens commands in this browser for a while."""
        sessions = self.served.sessions
        if sessions is None:
            return _refused("This page can only look: the server was started without commands.")
        given = (await _json(request)).get("pin")
        if not isinstance(given, str):
            return _refused("Give the PIN.")
        wait_s = sessions.wait_s()
        if wait_s > 0:
            return _refused(f"Too many wrong PINs: wait {wait_s:.0f} s.", 429)
        sessions.count_try()
        if not await run_in_threadpool(sessions.pin.fits, given):
            return _refused("Wrong PIN.")
        answer = JSONResponse({"text": "Commands are open."})
        answer.set_cookie(_cookie(request), sessions.open(), httponly=True, samesite="strict")
        return answer

    async def leave(self, request: Request) -> Response:
        """No more commands from this browser."""
        if self.served.sessions is not None:
            self.served.sessions.close(request.cookies.get(_cookie(request)))
        return JSONResponse({"text": "Commands are closed."})

    async def act(self, request: Request) -> Response:
        """A command."""
        if not self._may_command(request):
            return _refused("Give the PIN first.")
        given = await _json(request)
        name = str(given.get("name"))
        if self._is_commissioned() and name not in BESIDE_COMMISSIONING:
            return _refused("A commissioning is under way: only Stop carriage and trims.", 409)
        if name == "stop" and self.served.commissioning is not None:
            self.served.commissioning.stop("Stop carriage was pressed.")
        if name == "set_rope":
            return await self._told(lambda: self.operator.set_rope(given.get("metres")))
        if name == "stage":
            values = given.get("values")
            return await self._told(
                lambda: self.operator.stage(values if isinstance(values, dict) else {})
            )
        return await self._told(lambda: self.operator.act(name))

    # ---- commissioning -------------------------------------------------------------------------

    def _is_commissioned(self) -> bool:
        return self.served.commissioning is not None and self.served.commissioning.is_running

    def _commissioning_word(self) -> str | None:
        """For the operator's page; None: none is offered."""
        if self.served.commissioning is None:
            return None
        return "Commissioning is under way" if self._is_commissioned() else "Commissioning"

    async def commission(self, socket: WebSocket) -> None:
        """The dialogue: what it says and asks; from the page the beginning, and answers."""
        commissioning = self.served.commissioning
        assert commissioning is not None, "else there is no such route"
        await self._attend(
            socket,
            functools.partial(self._send_commissioning, commissioning),
            functools.partial(self._hear_commissioning, commissioning),
            commissioning.leave,
        )

    def _hear_commissioning(
        self, commissioning: "Commissioning", socket: WebSocket, text: str
    ) -> str:
        """What the page asks for; why it was refused, or nothing."""
        try:
            said = json.loads(text)
        except (ValueError, RecursionError):
            return "Not understood."
        if not isinstance(said, dict):
            return "Not understood."
        if not self._may_command(socket):
            return "Give the PIN first."
        try:
            if said.get("begin") is True:
                commissioning.begin(socket)
            elif "answer" in said:
                commissioning.answer(socket, said.get("number"), str(said["answer"]))
        except ToolError as error:
            return str(error)
        return ""

    async def _send_commissioning(self, commissioning: "Commissioning", socket: WebSocket) -> None:
        await run_in_threadpool(commissioning.look)
        version = -1
        while True:
            is_open = self._may_command(socket)
            if not is_open and commissioning.leads(socket):
                commissioning.stop("Commands were closed.")
            seen = self.served.watcher.seen
            version, picture = commissioning.picture(socket, version)
            old = seen is None or time.monotonic() - seen.stamp_s > OLD_S
            document: dict[str, object] = {
                "open": is_open,
                "problem": (self.served.watcher.problem or "No data.") if old else "",
            }
            if seen is not None:
                document["view"] = view(seen)
            if picture is not None:
                document["dialogue"] = picture
            await socket.send_json(document)
            await asyncio.sleep(SEND_EVERY_S)

    async def report(self, request: Request) -> Response:
        """A file of the report, by one of its names."""
        commissioning = self.served.commissioning
        path = commissioning.report(request.path_params["name"]) if commissioning else None
        if path is None:
            return PlainTextResponse("There is no such report.", 404)
        return FileResponse(path, headers={"Content-Security-Policy": REPORT_POLICY})

    async def _told(self, do: Callable[[], object]) -> Response:
        """What it returns, or why it was refused."""
        try:
            result = await run_in_threadpool(do)
        except ToolError as error:
            return JSONResponse({"text": str(error)}, 409)
        finally:
            self.served.watcher.look_again()
        return JSONResponse({"text": result} if isinstance(result, str) else result)


def _cookie(connection: Request | WebSocket) -> str:
    """Its name. A browser keeps one of a name for all ports of a host: two drums have two pages."""
    return f"levelwind_{connection.scope['server'][1]}"


def _refused(text: str, status: int = 403) -> Response:
    return JSONResponse({"text": text}, status)


async def _json(request: Request) -> dict[str, object]:
    try:
        given = json.loads(await request.body())
        json.dumps(given, ensure_ascii=False).encode()  # half a surrogate pair is no text
    except (ValueError, RecursionError):
        return {}
    return given if isinstance(given, dict) else {}


def _file(name: str) -> Callable[[Request], Any]:
    async def send(_: Request) -> Response:
        return FileResponse(PAGE / name)

    return send


def application(served: Served) -> Starlette:
    """The whole of it."""
    page = Page(served)

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        started = served.on_start()
        if asyncio.iscoroutine(started):
            await started
        yield
        if served.commissioning is not None:
            await run_in_threadpool(served.commissioning.close)
        if page.jog is not None:
            await run_in_threadpool(page.jog.close)

    offered = []
    if served.commissioning is not None:
        offered = [
            Route("/commission", _file("commission.html")),
            Route("/commission.js", _file("commission.js")),
            Route("/commission/report/{name}", page.report),
            WebSocketRoute("/commission/live", page.commission),
        ]

    return Starlette(
        routes=[
            *offered,
            Route("/", _file("index.html")),
            Route("/page.css", _file("page.css")),
            Route("/common.js", _file("common.js")),
            Route("/page.js", _file("page.js")),
            Route("/icon.svg", _file("icon.svg")),
            WebSocketRoute("/live", page.live),
            Route("/metrics", page.metrics),
            Route("/api/status", page.status),
            Route("/api/parameters", page.parameters),
            Route("/api/launches", page.launches),
            Route("/api/launches/{number:int}/picture.png", page.launch_picture),
            Route("/api/launches/{number:int}/samples.csv", page.launch_csv),
            Route("/api/pin", page.pin, methods=["POST"]),
            Route("/api/leave", page.leave, methods=["POST"]),
            Route("/api/act", page.act, methods=["POST"]),
        ],
        middleware=[Middleware(Guard, loopback=served.loopback, names=served.names)],
        lifespan=lifespan,
    )
