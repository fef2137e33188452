# SPDX-License-Identifier: Apache-2.0
"""The server's own look at the controller, again and again: live values first, the rest between."""

import threading
import time
from collections.abc import Callable, Iterator

from levelwind.errors import RefusedError, ToolError
from levelwind.line import event_log
from levelwind.line.device import Device
from levelwind.line.live import MORE_POINTS, image_of, read_live, read_travel, version_of
from levelwind.line.parameter_sets import read_set
from levelwind.line.points import REGISTERS_PER_READ, runs
from levelwind.serve.owner import PortOwner, QueuedClient
from levelwind.serve.view import Motion, Seen

PERIOD_S = 0.05
SETTINGS_EVERY_S = 5.0


class Watcher:
    """A thread that keeps `seen` fresh and tells whoever listens of every look."""

    def __init__(self, owner: PortOwner) -> None:
        self.seen: Seen | None = None
        self.problem = "waiting for the first answer"
        """Why there is nothing fresh; empty while there is."""
        self.parameters: dict[str, int] = {}
        self.firmware = ""
        self.listeners: list[Callable[[Seen], None]] = []
        self.ticks: list[Callable[[], None]] = []
        """Called after every round, also where there was no answer."""
        self.device = Device(owner.line, QueuedClient(owner))
        self._settings_s = 0.0
        self._log: list[event_log.LogRecord] = []
        self._log_sequence: int | None = None
        self._log_s = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="watcher", daemon=True)

    def start(self) -> None:
        """Begin to look."""
        self._thread.start()

    def close(self) -> None:
        """End, within a request's time."""
        self._ended.set()
        self._thread.join(5.0)

    def look_again(self) -> None:
        """Parameters may have changed: read them at the next occasion."""
        self._settings_s = 0.0

    def _run(self) -> None:
        while not self._ended.is_set():
            try:
                self._watch()
            except ToolError as error:
                self.problem = str(error)
                for tick in self.ticks:
                    tick()
                self._ended.wait(PERIOD_S)

    def _watch(self) -> None:
        """Until the line fails. Everything but the live values is read a request at a time."""
        device = self.device
        status = read_live(device) | device.read(MORE_POINTS)
        travel = read_travel(device)
        self._log_sequence, self._log_s, self._settings_s = None, 0.0, 0.0
        motion, rest = Motion(), self._rest(status)
        while not self._ended.is_set():
            began = time.monotonic()
            live = read_live(device)
            if live["uptime_ms"] < status["uptime_ms"]:
                raise ToolError("The controller has restarted.")
            status.update(live)
            if next(rest, None) is None:
                rest = self._rest(status)
                travel = self._travel or travel
            seen = Seen(dict(status), travel, began, motion.see(status), self._log, self._log_s)
            self.seen, self.problem = seen, ""
            for listener in self.listeners:
                listener(seen)
            for tick in self.ticks:
                tick()
            self._ended.wait(max(0.0, began + PERIOD_S - time.monotonic()))

    _travel = None

    def _rest(self, status: dict[str, int]) -> Iterator[bool]:
        """One round of what changes rarely; each step is one request."""
        device = self.device
        for run in runs(MORE_POINTS, REGISTERS_PER_READ):
            status.update(device.read(run.points))
            yield True
        self.firmware = f"{version_of(status)} {image_of(status) or ''}".strip()
        asked_s = time.monotonic()
        newest = device.value("log_sequence")
        yield True
        if newest != self._log_sequence:
            raw = b""
            for first in range(0, event_log.RECORDS, event_log.RECORDS_PER_REQUEST):
                try:
                    raw += event_log.read_raw(device, first)
                except RefusedError:
                    break
                yield True
            self._log = event_log.records(raw)
            self._log_sequence = newest
        self._log_s = asked_s
        if time.monotonic() > self._settings_s:
            self._settings_s = time.monotonic() + SETTINGS_EVERY_S
            self._travel = read_travel(device)
            yield True
            self.parameters = read_set(device, "active")
            yield True
