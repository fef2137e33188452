# SPDX-License-Identifier: Apache-2.0
"""Who may speak to the server: Host, Origin, size of a body; and the PIN that commands need."""

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
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from levelwind import whole_file
from levelwind.errors import ToolError

BODY_MAX = 16 * 1024
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


class Guard:
    """Refuses what no page of ours has sent.

    A page of somebody else's, in the operator's browser, comes with its own Origin, or by a name
    that it has made to mean this machine. A name is therefore taken only if it is known; an address
    says by itself what it means.
    """

    def __init__(self, app: ASGIApp, loopback: bool, names: frozenset[str]) -> None:
        self.app, self.loopback = app, loopback
        self.names = names | {"localhost"} | (frozenset() if loopback else {socket.gethostname()})

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
                return {"type": "http.disconnect"}
            return message

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)  # a report brings a policy of its own
            await send(message)

        await self.app(scope, limited, sealed)

    def _refusal(self, headers: Headers) -> tuple[int, str]:
        host = headers.get("host", "")
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            name = ""
        if not self._is_ours(name):
            return 421, f"Host {host!r} is not served here. `--name` lets a name in."
        origin = headers.get("origin")
        if origin is not None and urlsplit(origin).netloc != host:
            return 403, "This request comes from another site."
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > BODY_MAX:
            return 413, f"At most {BODY_MAX} bytes."
        return 200, ""

    def _is_ours(self, name: str) -> bool:
        if name in self.names:
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
        whole_file.write(self.path, json.dumps({"salt": salt.hex(), "scrypt": digest.hex()}) + "\n")
        self.path.chmod(0o600)

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
