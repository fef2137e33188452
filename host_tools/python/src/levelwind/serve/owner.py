# SPDX-License-Identifier: Apache-2.0
"""The one owner of the port: requests of all clients, one after the other, in a fair order.

Clients take turns, a request each. The page and the recorder come when no client waits, or when
they have waited for PAGE_WAITS_TURNS requests or PAGE_PATIENCE_S: so they are never forgotten, and
a client never waits for more than one request of theirs.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field
from enum import Enum

from levelwind.errors import ToolError
from levelwind.line.device import SETTLE_S
from levelwind.line.port import Line, is_modbus_tcp
from levelwind.line.rtu import Heard, RtuClient, sealed
from levelwind.line.tcp import TcpClient

PAGE_WAITS_TURNS = 8
PAGE_PATIENCE_S = 0.15
REOPEN_AFTER_S = 0.5
LATENCIES_KEPT = 1024
UNIT_MAX = 247
PROBE_EVERY_S = 5.0


class Outcome(Enum):
    """How a request has ended."""

    ANSWERED = "answered"
    NO_ANSWER = "no answer"
    NO_PATH = "no path"


@dataclass(frozen=True)
class Answer:
    """The PDU of an answer; without one, why."""

    outcome: Outcome
    pdu: bytes = b""
    problem: str = ""


@dataclass
class _Job:
    unit: int
    pdu: bytes
    done: Callable[[Answer], None]
    is_page: bool
    came_s: float = field(default_factory=time.monotonic)


@dataclass
class Counts:
    """What the line has done since the start."""

    requests: int = 0
    page_requests: int = 0
    no_answer: int = 0
    no_path: int = 0
    line_s: deque[float] = field(default_factory=lambda: deque(maxlen=LATENCIES_KEPT))
    """Of the last requests: from the sending to the answer."""


class PortOwner:
    """A thread that has the port. Whoever asks is called back from that thread."""

    def __init__(self, line: Line) -> None:
        """Does not open the port yet: ToolError only where it is no port at all."""
        self.line = line
        self.counts = Counts()
        self.problem = ""
        """Why the port cannot be used, in words; empty while it can."""
        self._client = (TcpClient if is_modbus_tcp(line.port) else RtuClient)(line)
        self._clients: dict[Hashable, deque[_Job]] = {}
        self._page: deque[_Job] = deque()
        self._wake = threading.Condition()
        self._turns = 0  # of clients since the page's last
        self._ended = False
        self._reopen_s = self._probe_s = 0.0
        self._known: set[int] = set()
        self._thread = threading.Thread(target=self._run, name="port owner", daemon=True)

    def open(self) -> None:
        """Open the port now; ToolError says why it cannot be."""
        self._client.connect()

    def start(self) -> None:
        """Begin to serve."""
        self._thread.start()

    def close(self) -> None:
        """Let go of the port, after the request that is under way."""
        with self._wake:
            self._ended = True
            self._wake.notify()
        self._thread.join(self.line.timeout_s + 1.0)
        self._client.close()

    def submit(
        self, client: Hashable | None, unit: int, pdu: bytes, done: Callable[[Answer], None]
    ) -> None:
        """Queue a request; None: the page's. `done` is called once, from the owner's thread."""
        job = _Job(unit, pdu, done, is_page=client is None)
        with self._wake:
            queue = self._page if client is None else self._clients.setdefault(client, deque())
            queue.append(job)
            self._wake.notify()

    def forget(self, client: Hashable) -> None:
        """What a client has asked for and has not been sent is not sent any more."""
        with self._wake:
            self._clients.pop(client, None)

    def exchange(self, unit: int, pdu: bytes) -> Answer:
        """A request of the page: wait for its answer."""
        answer: Future[Answer] = Future()
        self.submit(None, unit, pdu, answer.set_result)
        return answer.result()

    def _next(self) -> _Job | None:
        with self._wake:
            while True:
                if self._ended:
                    return None
                waits_s = time.monotonic() - self._page[0].came_s if self._page else 0.0
                may = self._turns >= PAGE_WAITS_TURNS or waits_s > PAGE_PATIENCE_S
                if self._page and (may or not self._clients):
                    self._turns = 0
                    return self._page.popleft()
                if self._clients:
                    client = next(iter(self._clients))
                    queue = self._clients.pop(client)
                    job = queue.popleft()
                    self._turns += 1
                    if queue:
                        self._clients[client] = queue  # behind all others
                    return job
                self._wake.wait()

    def _run(self) -> None:
        while (job := self._next()) is not None:
            answer = self._answer(job)
            with suppress(Exception):  # who asked has gone; nobody else must suffer for it
                job.done(answer)
        with self._wake:
            left = [*self._page, *(job for queue in self._clients.values() for job in queue)]
            self._page.clear()
            self._clients.clear()
        for job in left:
            with suppress(Exception):
                job.done(Answer(Outcome.NO_PATH, problem="the server ends"))

    def _answer(self, job: _Job) -> Answer:
        if job.unit > UNIT_MAX:
            return Answer(Outcome.NO_PATH, problem=f"unit {job.unit}: 1 to {UNIT_MAX}")
        if self.problem and time.monotonic() < self._reopen_s:
            self.counts.no_path += 1
            return Answer(Outcome.NO_PATH, problem=self.problem)
        if self._is_stranger(job.unit) and time.monotonic() < self._probe_s:
            return Answer(Outcome.NO_ANSWER)
        began = time.monotonic()
        try:
            pdu = self._client.exchange(job.unit, job.pdu)
        except (ToolError, OSError) as error:
            self.problem = str(error)
            self._reopen_s = time.monotonic() + REOPEN_AFTER_S
            self.counts.no_path += 1
            return Answer(Outcome.NO_PATH, problem=self.problem)
        self.problem = ""
        self.counts.requests += 1
        self.counts.page_requests += job.is_page
        if pdu:
            self._known.add(job.unit)
            self.counts.line_s.append(time.monotonic() - began)
            return Answer(Outcome.ANSWERED, pdu)
        if job.unit != 0:
            self.counts.no_answer += 1
            self._known.discard(job.unit)
            if self._is_stranger(job.unit):
                self._probe_s = time.monotonic() + PROBE_EVERY_S
            time.sleep(SETTLE_S)  # a late answer goes by: it must not be taken for the next one
        return Answer(Outcome.NO_ANSWER)

    def _is_stranger(self, unit: int) -> bool:
        """A unit that may not be there: all of them together cost a time-out now and then."""
        return unit not in (0, self.line.unit) and unit not in self._known


class QueuedClient(RtuClient):
    """The way of the page's own requests to the line: through the owner's queue."""

    def __init__(self, owner: PortOwner) -> None:
        super().__init__(owner.line)
        self.line_echoes = False
        self._owner = owner
        self._request = b""

    def connect(self) -> bool:
        """There is nothing to open."""
        return True

    def close(self) -> None:
        """Nor to close."""

    def send(self, request: bytes, addr: tuple[object, ...] | None = None) -> int:
        """Keep it; recv() sends it and waits."""
        del addr
        self._request = bytes(request)
        return len(request)

    def recv(self, size: int | None) -> bytes:
        """The answer; nothing if there was none. ToolError where there is no port."""
        del size
        answer = self._owner.exchange(self._request[0], self._request[1:-2])
        if answer.outcome is Outcome.NO_PATH:
            raise ToolError(answer.problem)
        self.heard = Heard.OTHER_ANSWER if answer.pdu else Heard.NOTHING
        return sealed(self._request[:1] + answer.pdu) if answer.pdu else b""
