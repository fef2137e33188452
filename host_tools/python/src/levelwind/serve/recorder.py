# SPDX-License-Identifier: Apache-2.0
"""Every launch, from leaving rest to rest, in a file of SQLite.

A thread writes what has come, every COMMIT_EVERY_S in one transaction, to the disk. What cannot be
written (a full disk) is kept in memory and tried again. After a kill, what was committed is there.
"""

import csv
import hashlib
import io
import json
import sqlite3
import threading
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import closing, suppress
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from levelwind.errors import ToolError
from levelwind.line.event_log import LogRecord
from levelwind.line.live import all_flags, flag
from levelwind.line.points import enum_label, enum_text, flag_names
from levelwind.map_table import Fault, Flag, State
from levelwind.serve.lay import Growth
from levelwind.serve.view import Seen
from levelwind.serve.watcher import Watcher
from levelwind.show.status import los_lines

COMMIT_EVERY_S = 0.4
WAITING_MAX = 40_000
"""Samples that wait for the disk: half an hour."""
BEFORE_S = 1.0
"""So much of the rest before a launch belongs to it."""
KEEP = 1000
NUMBER_MAX = (1 << 63) - 1
CLOCK_MS = 1 << 32
"""The controller's uptime begins anew then."""
COLUMNS = (
    *("state", "fault", "launch_inhibit", "position_um", "rope_speed_mm_per_s"),
    *("drum_speed_edges_per_s", "rope_mm", "rope_out_mm", "rope_layer", "net_edges"),
    *("pattern_edges", "los_recoveries", "uptime_ms"),
)
SCHEMA = f"""
CREATE TABLE IF NOT EXISTS launches (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    began TEXT NOT NULL, ended TEXT, firmware TEXT NOT NULL,
    parameters_sha256 TEXT NOT NULL, parameters TEXT NOT NULL, result TEXT, lay TEXT
);
CREATE TABLE IF NOT EXISTS samples (
    launch INTEGER NOT NULL REFERENCES launches(id) ON DELETE CASCADE,
    time_s REAL NOT NULL, flags INTEGER NOT NULL,
    {", ".join(f"{name} INTEGER NOT NULL" for name in COLUMNS)}
);
CREATE INDEX IF NOT EXISTS samples_of_launch ON samples(launch, time_s);
CREATE TABLE IF NOT EXISTS events (
    launch INTEGER NOT NULL REFERENCES launches(id) ON DELETE CASCADE,
    boot INTEGER NOT NULL, time_ms INTEGER NOT NULL, sequence INTEGER NOT NULL,
    event TEXT NOT NULL, detail TEXT NOT NULL, position_um INTEGER NOT NULL, state TEXT NOT NULL,
    UNIQUE (launch, sequence)
);
"""
VERSION = 1
SQL_TIME = "%Y-%m-%dT%H:%M:%f+00:00"
INSERT_SAMPLE = f"INSERT INTO samples VALUES ({', '.join('?' * (3 + len(COLUMNS)))})"


@dataclass
class _Launch:
    began_s: float
    began: str
    firmware: str
    parameters: Mapping[str, int]
    began_ms: int
    """By the controller's clock, as the events are."""
    ended_ms: int | None = None
    id: int | None = None
    told: set[int] = field(default_factory=set)
    """Events that are written or wait for it, by their sequence."""
    permit: str = "kept"
    max_speed: int = 0
    min_speed: int = 0
    rope_before_mm: int = 0
    los: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="milliseconds")


def fingerprint(parameters: Mapping[str, int]) -> str:
    """The same for the same parameters."""
    return hashlib.sha256(json.dumps(dict(parameters), sort_keys=True).encode()).hexdigest()


def _tables(base: sqlite3.Connection) -> dict[str, list[str]]:
    """Their columns. An error of SQLite where it is no database, or in use."""
    asked = "SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c"
    found: dict[str, list[str]] = {}
    for table, column in base.execute(f"{asked} WHERE m.type = 'table' ORDER BY c.cid"):
        found.setdefault(table, []).append(column)
    return found


def _misfit(base: sqlite3.Connection) -> str:
    """Why this database is none of ours; it is then not touched. Empty where it is one."""
    with closing(sqlite3.connect(":memory:")) as ours:
        ours.executescript(SCHEMA)
        wanted, found = _tables(ours), _tables(base)
    version = base.execute("PRAGMA user_version").fetchone()[0]
    if "launches" in found and "samples" in found and version > VERSION:
        return "written by a newer version of the tool"
    if version != VERSION or any(found.get(name) != wanted[name] for name in wanted):
        return "a database of another program, or no record of this version; give another file"
    return ""


class Recorder:
    """Listens to a watcher; a thread of its own writes."""

    def __init__(self, path: Path, watcher: Watcher, growth: Growth, keep: int = KEEP) -> None:
        """Opens the file; ToolError says why it cannot be."""
        self.path = path
        self.lost = 0
        """Samples that found no room, in memory neither."""
        self.problem = ""
        self._watcher, self._growth, self._keep = watcher, growth, keep
        self._launch: _Launch | None = None
        self._ending: list[tuple[_Launch, float, str]] = []
        """At rest, seen then, and called ended then: the log is still to be read."""
        self._before: deque[tuple[float, Seen]] = deque()
        self._waiting: deque[tuple[str, _Launch, Any]] = deque()
        self._lock = threading.Lock()
        self._ended = threading.Event()
        try:
            self._base = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
            is_new = _tables(self._base) == {}
            if not is_new and (why := _misfit(self._base)):
                raise ToolError(f"--record {path}: {why}.")
            if is_new:
                self._base.execute("PRAGMA auto_vacuum = INCREMENTAL")
            self._base.execute("PRAGMA journal_mode = WAL")
            self._base.execute("PRAGMA synchronous = FULL")
            self._base.execute("PRAGMA foreign_keys = ON")
            if is_new:
                self._base.executescript(f"BEGIN; {SCHEMA} PRAGMA user_version = {VERSION}; COMMIT")
            self._close_cut_launches()
        except sqlite3.Error as error:
            raise ToolError(f"--record {path}: {error}.") from error
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)

    def start(self) -> None:
        """Begin to record."""
        self._watcher.listeners.append(self.see)
        self._watcher.ticks.append(self._look_whether_gone)
        self._thread.start()

    def close(self) -> str:
        """Write what is there, and end; what was lost, in words.

        A launch that is under way ends here.
        """
        if self._launch is not None and self._watcher.seen is not None:
            self._cut(self._launch, self._watcher.seen, "The server was ended.")
        self._finish(None)
        self._ended.set()
        self._thread.join(5.0)
        self._write()
        self._base.close()
        lost = {launch.began for _, launch, _ in self._waiting}
        return (
            f"{self.problem}. Not on the disk: launches of {', '.join(sorted(lost))}"
            if lost
            else ""
        )

    def state(self) -> dict[str, object]:
        """For the page."""
        return {
            "recording": self._launch is not None,
            "problem": self.problem and f"{self.problem}. What comes is kept in memory",
            "waiting": len(self._waiting),
            "lost": self.lost,
        }

    # ---- what happens --------------------------------------------------------------------------

    def see(self, seen: Seen) -> None:
        """A look at the controller."""
        self._finish(seen)
        resting = flag(seen.status, Flag.DRUM_AT_REST)
        if self._launch is None:
            self._before.append((seen.stamp_s, seen))
            while seen.stamp_s - self._before[0][0] > BEFORE_S:
                self._before.popleft()
            if not resting:
                self._begin(seen)
            return
        self._take(self._launch, seen)
        if resting:
            self._end(self._launch, seen)

    def _begin(self, seen: Seen) -> None:
        began_s, first = self._before[0]
        launch = _Launch(
            *(began_s, _now(), self._watcher.firmware, dict(self._watcher.parameters)),
            began_ms=first.status["uptime_ms"],
        )
        launch.rope_before_mm = seen.status["rope_mm"]
        resting = [one for _, one in self._before if flag(one.status, Flag.DRUM_AT_REST)] or [seen]
        if not flag(resting[-1].status, Flag.LAUNCH_PERMIT):
            launch.permit = "never given"
        self._launch = launch
        self._put("begin", launch, None)
        for _, earlier in self._before:
            self._keep_sample(launch, earlier)
        self._before.clear()

    def _take(self, launch: _Launch, seen: Seen) -> None:
        status = seen.status
        launch.max_speed = max(launch.max_speed, status["rope_speed_mm_per_s"])
        launch.min_speed = min(launch.min_speed, status["rope_speed_mm_per_s"])
        if launch.permit == "kept" and not flag(status, Flag.LAUNCH_PERMIT):
            launch.permit = "lost"
        launch.los += [line for line in los_lines(status) if line not in launch.los]
        if flag(status, Flag.FAULTED):
            fault = enum_text(Fault, status["fault"])
            launch.faults += [fault] if fault not in launch.faults else []
        self._keep_sample(launch, seen)
        self._keep_events(launch, seen)

    def _keep_events(self, launch: _Launch, seen: Seen) -> None:
        """As soon as they are read: a kill may come, and the controller forgets the oldest."""
        if seen.log_s < launch.began_s:
            return
        last_ms = seen.status["uptime_ms"] if launch.ended_ms is None else launch.ended_ms
        lasted_ms = (last_ms - launch.began_ms) % CLOCK_MS
        boot = max((record.boot for record in seen.log), default=0)
        for record in seen.log:
            if record.sequence in launch.told or record.boot != boot:
                continue
            if (record.time_ms - launch.began_ms) % CLOCK_MS <= lasted_ms:
                launch.told.add(record.sequence)
                self._put("event", launch, _event(record))

    def _keep_sample(self, launch: _Launch, seen: Seen) -> None:
        status = seen.status
        # SQLite's integers have a sign.
        row = (round(seen.stamp_s - launch.began_s, 3), all_flags(status) & (1 << 63) - 1)
        self._put("sample", launch, (*row, *(status[name] for name in COLUMNS)))

    def _end(self, launch: _Launch, seen: Seen) -> None:
        self._launch = None
        launch.ended_ms = seen.status["uptime_ms"]
        self._put("rest", launch, self._result(launch, seen))
        self._ending.append((launch, seen.stamp_s, _now()))

    def _finish(self, seen: Seen | None) -> None:
        """Launches whose last events were read since have ended; without a look, all have."""
        for one in list(self._ending):
            launch, rest_s, ended = one
            if seen is None or seen.log_s > rest_s:
                self._ending.remove(one)
                if seen is not None:
                    self._keep_events(launch, seen)
                self._put("end", launch, ended)

    def _result(self, launch: _Launch, seen: Seen) -> dict[str, object]:
        return {
            "launch_permit": launch.permit,
            "los": launch.los,
            "faults": launch.faults,
            "state": enum_label(State, seen.status["state"]),
            "flags": flag_names(all_flags(seen.status)),
            "rope_m": (seen.status["rope_mm"] - launch.rope_before_mm) / 1000,
            "max_rope_speed_m_per_s": launch.max_speed / 1000,
            "min_rope_speed_m_per_s": launch.min_speed / 1000,
        }

    def _look_whether_gone(self) -> None:
        """A controller that has gone ends the launch where it was last seen."""
        launch, seen = self._launch, self._watcher.seen
        if not self._watcher.problem or seen is None:
            return
        if launch is not None:
            self._cut(launch, seen, self._watcher.problem)
        self._finish(None)

    def _cut(self, launch: _Launch, seen: Seen, why: str) -> None:
        self._launch = None
        self._put("rest", launch, {**self._result(launch, seen), "cut": why})
        self._ending.append((launch, seen.stamp_s, _now()))

    # ---- writing -------------------------------------------------------------------------------

    def _put(self, kind: str, launch: _Launch, what: Any) -> None:
        with self._lock:
            if kind == "sample" and len(self._waiting) >= WAITING_MAX:
                self.lost += 1
                return
            self._waiting.append((kind, launch, what))

    def _run(self) -> None:
        while not self._ended.wait(COMMIT_EVERY_S):
            self._write()

    def _write(self) -> None:
        """All that waits, in one transaction; on an error it goes on waiting."""
        with self._lock:
            waiting = list(self._waiting)
        if not waiting:
            return
        ids = {id(launch): launch.id for _, launch, _ in waiting}
        try:
            self._base.execute("BEGIN IMMEDIATE")
            for kind, launch, what in waiting:
                self._write_one(kind, launch, what)
            self._base.execute("COMMIT")
        except sqlite3.Error as error:
            self.problem = f"{self.path}: {error}"
            for _, launch, _ in waiting:
                launch.id = ids[id(launch)]
            if self._base.in_transaction:
                self._base.execute("ROLLBACK")
            return
        self.problem = ""
        with self._lock:
            for _ in waiting:
                self._waiting.popleft()
        if any(kind == "end" for kind, _, _ in waiting):
            # So that the file alone has every launch that has ended, for whoever copies it.
            with suppress(sqlite3.Error):
                self._base.execute("PRAGMA wal_checkpoint(PASSIVE)").fetchall()

    def _write_one(self, kind: str, launch: _Launch, what: Any) -> None:
        run = self._base.execute
        if kind == "begin":
            launch.id = run(
                "INSERT INTO launches (began, firmware, parameters_sha256, parameters)"
                " VALUES (?, ?, ?, ?)",
                (
                    *(launch.began, launch.firmware, fingerprint(launch.parameters)),
                    json.dumps(dict(launch.parameters)),
                ),
            ).lastrowid
        elif kind == "sample":
            run(INSERT_SAMPLE, (launch.id, *what))
        elif kind == "event":
            run("INSERT OR IGNORE INTO events VALUES (?, ?, ?, ?, ?, ?, ?, ?)", (launch.id, *what))
        elif kind == "rest":
            run(
                "UPDATE launches SET result = ?, lay = ? WHERE id = ?",
                (json.dumps(what), json.dumps(self._growth.picture()), launch.id),
            )
        else:
            run("UPDATE launches SET ended = ? WHERE id = ?", (what, launch.id))
            run("DELETE FROM launches WHERE id <= ? - ?", (launch.id, self._keep))
            run("PRAGMA incremental_vacuum(1000)").fetchall()

    def _close_cut_launches(self) -> None:
        """What a kill or a power cut has left open: it lasted as long as it was recorded."""
        lasted = "(SELECT coalesce(max(time_s), 0) FROM samples WHERE launch = id)"
        self._base.execute(
            f"UPDATE launches SET ended = strftime('{SQL_TIME}', began, {lasted} || ' seconds'),"
            " result = coalesce(result, ?) WHERE ended IS NULL",
            (json.dumps({"cut": "The recording was cut: the server has ended."}),),
        )


def _event(record: LogRecord) -> tuple[object, ...]:
    return (
        *(record.boot, record.time_ms, record.sequence, record.event_text),
        *(record.detail_text, record.position_um, record.state_name),
    )


def event_times_s(launch: Mapping[str, Any]) -> Iterator[float]:
    """When its events were, by the clock of its samples: that of a plot begins at 0, too."""
    samples = launch["samples"]
    began_ms = samples[0]["uptime_ms"] - 1000 * samples[0]["time_s"] if samples else 0
    for event in launch["events"]:
        since_ms = (event["time_ms"] - began_ms + CLOCK_MS / 2) % CLOCK_MS - CLOCK_MS / 2
        yield since_ms / 1000


class Launches:
    """Reads what was recorded, also while it is being recorded."""

    def __init__(self, path: Path) -> None:
        """ToolError if there is no such file, or it is no record."""
        self.path = path
        if not path.is_file():
            raise ToolError(f"{path}: there is no such file. `levelwind serve --record` writes it.")
        self._options = "mode=ro"
        try:
            why = self._misfit()
        except sqlite3.OperationalError as error:
            wal = path.with_name(path.name + "-wal")
            if not str(error).startswith("unable to open") or wal.exists():
                raise ToolError(f"{path}: {error}.") from error
            # A disk that nobody can write to has no room for what readers agree by; nor a writer.
            self._options = "mode=ro&immutable=1"
            why = self._misfit()
        except sqlite3.Error as error:
            raise ToolError(f"{path}: {error}.") from error
        if why:
            raise ToolError(f"{path}: {why}.")

    def _open(self) -> sqlite3.Connection:
        return sqlite3.connect(f"{self.path.resolve().as_uri()}?{self._options}", uri=True)

    def _misfit(self) -> str:
        with closing(self._open()) as base:
            return _misfit(base) if _tables(base) else "no launch has been recorded in it"

    def _rows(self, question: str, *values: object) -> Iterator[dict[str, Any]]:
        try:
            with closing(self._open()) as base:
                base.row_factory = sqlite3.Row
                yield from map(dict, base.execute(question, values))
        except sqlite3.Error as error:
            raise ToolError(f"{self.path}: {error}.") from error

    def _read(self, number: int, text: str | None) -> Any:
        try:
            return json.loads(text or "null")
        except (ValueError, TypeError):
            raise ToolError(f"{self.path}: launch {number} is damaged.") from None

    def list(self, count: int | None = None) -> list[dict[str, Any]]:
        """The newest first, without their samples."""
        found = self._rows(
            "SELECT id, began, ended, firmware, parameters_sha256, result,"
            " (SELECT max(time_s) FROM samples WHERE launch = id) AS seconds,"
            " (SELECT count(*) FROM samples WHERE launch = id) AS samples"
            " FROM launches ORDER BY id DESC LIMIT ?",
            -1 if count is None else count,
        )
        return [{**row, "result": self._result(row)} for row in found]

    def _result(self, row: Mapping[str, Any]) -> dict[str, Any]:
        """One that is damaged must not hide the others."""
        try:
            return self._read(row["id"], row["result"]) or {}
        except ToolError:
            return {"cut": "Damaged."}

    def one(self, number: int) -> dict[str, Any]:
        """A launch with its samples and events; ToolError if there is none."""
        rows = self._rows("SELECT * FROM launches WHERE id = ?", min(number, NUMBER_MAX))
        found = next(rows, None)
        if found is None:
            raise ToolError(f"There is no launch {number}. `levelwind launches list` shows them.")
        for name in ("result", "parameters", "lay"):
            found[name] = self._read(number, found[name])
        samples = self._rows("SELECT * FROM samples WHERE launch = ? ORDER BY time_s", number)
        found["samples"] = [
            {**row, "state": enum_label(State, row["state"])} | {"launch": number}
            for row in samples
        ]
        found["events"] = [
            {k: v for k, v in row.items() if k != "launch"}
            for row in self._rows("SELECT * FROM events WHERE launch = ? ORDER BY sequence", number)
        ]
        return found

    def csv(self, number: int) -> str:
        """A line per sample."""
        table = io.StringIO()
        names = ("time_s", "state", *COLUMNS[1:], "flags")
        writer = csv.DictWriter(table, names, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(self.one(number)["samples"])
        return table.getvalue()

    def picture(self, number: int) -> bytes:
        """Position and rope speed over time, as PNG."""
        from levelwind.show.plots import new_figure  # noqa: PLC0415 - matplotlib takes a second
        from levelwind.show.recorder import draw  # noqa: PLC0415

        launch = self.one(number)
        if not launch["samples"]:
            raise ToolError(f"Launch {number} has no samples.")
        figure, picture = new_figure(8, 4.5), io.BytesIO()
        draw(figure, launch["samples"])
        figure.savefig(picture, format="png")
        return picture.getvalue()
