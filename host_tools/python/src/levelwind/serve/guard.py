# SPDX-License-Identifier: Apache-2.0
"""Who may speak to the server: Host, Origin, size of a body, patience; and the PIN of commands."""

import asyncio
import hashlib
import hmac
import ipaddress
import json
import secrets
import socket
import time
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

from levelwind import whole_file
from levelwind.errors import ToolError

BODY_MAX = 16 * 1024
CONNECTIONS_MAX = 128
REQUEST_S = 10.0
"""A request must be there within this, and what is sent must be taken up within this."""
LOOK_S = 1.0
TOO_MUCH = f"At most {BODY_MAX} bytes."
HEADERS = {
    "Content-Security-Policy": "default-src 'self'; frame-ancestors 'none'; base-uri 'none'; "
    "form-action 'none'",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}
SCRYPT = {"n": 2**14, "r": 8, "p": 1}
PIN_LENGTH = range(4, 65)
TRIES = 5
TRIES_IN_S = 60.0
SESSION_S = 900.0


def is_loopback(host: str) -> bool:
    """Can only this machine reach it?"""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _plain(name: str) -> str:
    """A host's name as it is compared: capitals and the dot at the end say nothing."""
    return name.lower().removesuffix(".")


def is_name(name: str) -> bool:
    """Is it a host's name, without port, path or anything else?"""
    try:
        return urlsplit(f"//{name}").hostname == name.lower()
    except ValueError:
        return False


class _TooMuchError(Exception):
    """A body above BODY_MAX."""


class PatientHttp(H11Protocol):
    """A connection that has to say something soon, and to take up what it is sent.

    Uvicorn waits for ever for a request that never comes whole, and refuses requests but no
    connections: a few programs that say nothing would keep everybody else out.
    """

    _since_s = 0.0
    """Since when it waits for a request, or for something that was sent to be taken up."""
    _unsent = 0
    _looking: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """One more. Where there are too many, the one that has waited longest goes."""
        super().connection_made(transport)
        self._since_s = self.loop.time()
        self._look()
        staying = [c for c in self.connections if not c.transport.is_closing()]
        if len(staying) > CONNECTIONS_MAX:
            idle = [c for c in staying if isinstance(c, PatientHttp) and c._waits()]
            min(idle, key=lambda one: one._since_s).transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """It is over: look no more."""
        if self._looking is not None:
            self._looking.cancel()
        super().connection_lost(exc)

    def _waits(self) -> bool:
        """Is it the other side's turn?"""
        cycle = self.cycle
        return cycle is None or cycle.more_body or cycle.response_complete or self.flow.write_paused

    def _look(self) -> None:
        if self.transport.get_protocol() not in (self, None):
            return  # a WebSocket by now, with pings of its own
        unsent, now_s = self.transport.get_write_buffer_size(), self.loop.time()
        if not self._waits() or unsent < self._unsent:
            self._since_s = now_s
        self._unsent = unsent
        if now_s - self._since_s > REQUEST_S:
            self.transport.abort()
        else:
            self._looking = self.loop.call_later(LOOK_S, self._look)


class Guard:
    """Refuses what no page of ours has sent.

    A page of somebody else's, in the operator's browser, comes with its own Origin, or by a name
    that it has made to mean this machine. A name is therefore taken only if it is known; an address
    says by itself what it means.
    """

    def __init__(self, app: ASGIApp, loopback: bool, names: frozenset[str]) -> None:
        self.app, self.loopback = app, loopback
        known = {"localhost", *names, *(() if loopback else (socket.gethostname(),))}
        self.names = {_plain(name) for name in known}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """As ASGI wants it."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        status, why = self._refusal(headers)
        if why:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 1008, "reason": why})
            else:
                await PlainTextResponse(why, status)(scope, receive, send)
            return
        received = 0

        async def limited() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b"")) if message["type"] == "http.request" else 0
            if received > BODY_MAX:
                raise _TooMuchError
            return message

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)  # a report brings a policy of its own
            await send(message)

        try:
            await self.app(scope, limited, sealed)
        except _TooMuchError:
            await PlainTextResponse(TOO_MUCH, 413, {"Connection": "close"})(scope, receive, sealed)
        except ClientDisconnect:
            pass  # it has hung up in its own request

    def _refusal(self, headers: Headers) -> tuple[int, str]:
        host = headers.get("host", "")
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            name = ""
        if not self._is_ours(name):
            return 421, f"Host {host!r} is not served here. `--name` lets a name in."
        origin = headers.get("origin")
        if origin is not None and origin not in (f"http://{host}", f"https://{host}"):
            return 403, "This request comes from another site."
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > BODY_MAX:
            return 413, TOO_MUCH
        return 200, ""

    def _is_ours(self, name: str) -> bool:
        if _plain(name) in self.names:
            return True
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            return False
        return address.is_loopback or not self.loopback


class PinFile:
    """The PIN, hashed, in a file of its user's."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def exists(self) -> bool:
        """Has a PIN been set?"""
        return self.path.is_file()

    def set(self, pin: str) -> None:
        """Set it; ToolError if it is none."""
        if len(pin) not in PIN_LENGTH:
            raise ToolError(f"A PIN has {PIN_LENGTH[0]} to {PIN_LENGTH[-1]} characters.")
        salt = secrets.token_bytes(16)
        digest = hashlib.scrypt(pin.encode(), salt=salt, **SCRYPT)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ToolError(f"{self.path.parent}: {error.strerror}.") from error
        kept = json.dumps({"salt": salt.hex(), "scrypt": digest.hex()})
        whole_file.write(self.path, kept + "\n", private=True)

    def fits(self, pin: str) -> bool:
        """Is this it? Takes its time, on purpose: not for the event loop."""
        try:
            kept = json.loads(self.path.read_text(encoding="utf-8"))
            salt, digest = bytes.fromhex(kept["salt"]), bytes.fromhex(kept["scrypt"])
        except (OSError, ValueError, KeyError, TypeError):
            return False
        return hmac.compare_digest(hashlib.scrypt(pin.encode(), salt=salt, **SCRYPT), digest)


@dataclass
class Sessions:
    """Who has given the PIN, and how often somebody has tried."""

    pin: PinFile
    tokens: dict[str, float] = field(default_factory=dict)
    tries_s: list[float] = field(default_factory=list)

    def wait_s(self) -> float:
        """How long no PIN is looked at, whoever gives it: too many were wrong."""
        now = time.monotonic()
        self.tries_s = [at for at in self.tries_s if now - at < TRIES_IN_S]
        return TRIES_IN_S - (now - self.tries_s[0]) if len(self.tries_s) >= TRIES else 0.0

    def count_try(self) -> None:
        """Counted before it is looked at: tries side by side are tries."""
        self.tries_s.append(time.monotonic())

    def open(self) -> str:
        """The PIN was right: the token of a new session."""
        self.tries_s.clear()
        token = secrets.token_urlsafe(32)
        self.tokens[token] = time.monotonic() + SESSION_S
        return token

    def is_open(self, token: str | None) -> bool:
        """Does this token open it? Use keeps it open."""
        now = time.monotonic()
        self.tokens = {kept: end for kept, end in self.tokens.items() if end > now}
        if token is None or token not in self.tokens:
            return False
        self.tokens[token] = now + SESSION_S
        return True

    def close(self, token: str | None) -> None:
        """Forget it."""
        if token is not None:
            self.tokens.pop(token, None)
