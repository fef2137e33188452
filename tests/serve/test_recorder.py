# SPDX-License-Identifier: Apache-2.0
"""Launches on the disk: whole, through kills and full disks; and the numbers for Prometheus."""

import csv
import io
import itertools
import json
import re
import resource
import sqlite3
import subprocess
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from datetime import datetime
from pathlib import Path

import pytest
from levelwind.errors import ToolError
from levelwind.line.event_log import LogRecord
from levelwind.line.live import LIVE_POINTS, MORE_POINTS, Travel
from levelwind.line.port import Line
from levelwind.map_table import BenchCommand, Event, Flag
from levelwind.serve import lay
from levelwind.serve.lay import Growth
from levelwind.serve.owner import Outcome, PortOwner
from levelwind.serve.recorder import Launches, Recorder, event_times_s
from levelwind.serve.view import Seen
from prometheus_client.parser import text_string_to_metric_families
from served import TOOL, Served, wait

Start = Callable[..., Served]


def wind(served: Served, seconds: float = 2.0) -> None:
    """A launch: the drum turns so long, then rests."""
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 300_000})
        time.sleep(seconds)  # how long a launch lasts
        device.write({"bench_drum_speed_millirpm": 0})
        wait(lambda: device.value("drum_at_rest"))


def tool(*arguments: str) -> str:
    done = subprocess.run(
        [str(TOOL), *arguments], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def record(tmp_path: Path) -> Path:
    return tmp_path / "launches.sqlite"


def test_a_launch_from_rest_to_rest(start: Start, record: Path, tmp_path: Path) -> None:
    served = start("--record", str(record))
    served.index()
    wind(served)
    wait(lambda: record.exists() and [o for o in Launches(record).list() if o["ended"]])
    launch = Launches(record).one(1)
    assert launch["result"]["launch_permit"] == "kept"
    assert launch["result"]["max_rope_speed_m_per_s"] == pytest.approx(12, rel=0.05)
    assert launch["parameters"]["pitch_um"] == 12_000
    assert launch["firmware"].startswith("0.")
    samples = launch["samples"]
    gaps = [b["time_s"] - a["time_s"] for a, b in itertools.pairwise(samples)]
    assert sorted(gaps)[len(gaps) // 2] == pytest.approx(0.05, abs=0.01)
    rope_m = (samples[-1]["rope_mm"] - samples[0]["rope_mm"]) / 1000
    with served.device() as device:
        assert samples[-1]["net_edges"] == device.value("net_edges")
    assert rope_m == pytest.approx(launch["result"]["rope_m"], abs=0.2)
    # By the command line.
    assert "permit kept" in tool("launches", "list", "--record", str(record))
    picture = tmp_path / "launch.png"
    assert "samples" in tool(
        "launches", "show", "1", "--record", str(record), "--plot", str(picture)
    )
    assert picture.read_bytes().startswith(b"\x89PNG")
    table = tmp_path / "launch.csv"
    tool("launches", "export", "1", "--record", str(record), "--csv", str(table))
    rows = list(csv.DictReader(io.StringIO(table.read_text())))
    assert len(rows) == len(samples)
    assert int(rows[-1]["position_um"]) == samples[-1]["position_um"]
    # By the page.
    assert json.loads(served.get("api/launches"))[0]["id"] == 1
    assert served.get("api/launches/1/picture.png").startswith(b"\x89PNG")
    by_page = served.get("api/launches/1/samples.csv").decode()
    assert by_page.splitlines() == table.read_text().splitlines()


def test_a_kill_loses_less_than_a_second(start: Start, record: Path) -> None:
    served = start("--record", str(record))
    served.index()
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 300_000})
        time.sleep(2.5)
        told_ms = device.value("uptime_ms")
    served.kill()
    samples = Launches(record).one(1)["samples"]
    assert told_ms - samples[-1]["uptime_ms"] < 1000
    served.start()
    wait(lambda: len(Launches(record).list()) == 2, what="it goes on as a launch of its own")
    assert "cut" in Launches(record).one(1)["result"]


def test_a_full_disk_loses_nothing(start: Start, record: Path) -> None:
    served = start("--record", str(record))
    served.index()
    wind(served, 0.5)
    wait(lambda: [o for o in Launches(record).list() if o["ended"]])
    # No file of the server may grow any more: what a full disk does, for this process alone.
    # The log of SQLite (-wal) is the first to need room.
    limit = record.with_name(record.name + "-wal").stat().st_size
    resource.prlimit(served.process.pid, resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 300_000})
        wait(lambda: b"levelwind_recorder_ok 0.0" in served.get("metrics"), 10, "told")
        assert served.status()["age_s"] < 1, "the page goes on"
        device.write({"bench_drum_speed_millirpm": 0})
        wait(lambda: device.value("drum_at_rest"))
    resource.prlimit(
        served.process.pid,
        resource.RLIMIT_FSIZE,
        (resource.RLIM_INFINITY, resource.RLIM_INFINITY),
    )
    wait(lambda: len([o for o in Launches(record).list() if o["ended"]]) == 2, 10, "room again")
    times = [sample["time_s"] for sample in Launches(record).one(2)["samples"]]
    assert max(b - a for a, b in itertools.pairwise(times)) < 0.5
    assert b"levelwind_recorder_lost_samples_total 0.0" in served.get("metrics")


def test_retention(start: Start, record: Path) -> None:
    served = start("--record", str(record), "--keep", "2")
    served.index()
    for number in range(1, 5):
        wind(served, 0.3)
        wait(lambda: Launches(record).list(1)[0]["ended"], 10, "it is whole")
        assert Launches(record).list(1)[0]["id"] == number
    assert [one["id"] for one in Launches(record).list()] == [4, 3]
    with sqlite3.connect(record) as base:
        assert base.execute("SELECT DISTINCT launch FROM samples ORDER BY 1").fetchall() == [
            (3,),
            (4,),
        ]


def test_a_restart_of_the_controller_ends_the_launch(start: Start, record: Path) -> None:
    served = start("--record", str(record))
    served.index()
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 300_000})
        wait(lambda: Launches(record).list())
        device.write({"bench_command": BenchCommand.POWER_CUT})
    wait(
        lambda: (
            "cut" in Launches(record).one(1)["result"] if Launches(record).one(1)["ended"] else 0
        )
    )
    assert Launches(record).one(1)["result"]["launch_permit"] == "kept"


def test_what_is_no_record_is_told(tmp_path: Path) -> None:
    with pytest.raises(ToolError, match="no such file"):
        Launches(tmp_path / "nothing.sqlite")
    text = tmp_path / "text"
    text.write_text("this is no database, however long it may be " * 100)
    with pytest.raises(ToolError, match="not a database"):
        Launches(text).list()
    with pytest.raises(ToolError, match="not a database"):
        Recorder(text, None, Growth())
    with pytest.raises(ToolError, match="unable to open"):
        Recorder(tmp_path / "no" / "folder.sqlite", None, Growth())


def made(record: Path, *changes: str) -> Path:
    """A record with a launch, then changed."""
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False)
    winch.look(resting=True)
    winch.close()
    with closing(sqlite3.connect(record)) as base:
        for change in changes:
            base.execute(change)
        base.commit()
    return record


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (["PRAGMA user_version = 2"], "newer version"),
        (["ALTER TABLE samples RENAME COLUMN rope_mm TO rope_m"], "another program"),
        (["ALTER TABLE launches DROP COLUMN lay"], "another program"),
        (["DROP TABLE events"], "another program"),
        (["PRAGMA user_version = 0"], "another program"),
    ],
)
def test_a_database_that_is_no_record_is_told_and_left_alone(
    record: Path, changes: list[str], said: str
) -> None:
    before = made(record, *changes).read_bytes()
    with pytest.raises(ToolError, match=said):
        Launches(record)
    with pytest.raises(ToolError, match=said):
        Recorder(record, None, Growth())
    assert record.read_bytes() == before


def test_another_programs_database_is_left_alone(record: Path) -> None:
    with closing(sqlite3.connect(record)) as base:
        base.execute("CREATE TABLE bookmarks (url TEXT)")
    before = record.read_bytes()
    with pytest.raises(ToolError, match="another program"):
        Recorder(record, None, Growth())
    assert record.read_bytes() == before


def test_a_damaged_launch_hides_no_other(record: Path) -> None:
    made(record, "INSERT INTO launches SELECT 7, began, ended, '', '', '', '{', '' FROM launches")
    assert [one["id"] for one in Launches(record).list()] == [7, 1]
    assert "Damaged." in tool("launches", "list", "--record", str(record))
    with pytest.raises(ToolError, match="launch 7 is damaged"):
        Launches(record).one(7)
    assert Launches(record).one(1)["samples"]


def test_a_number_that_is_none(record: Path) -> None:
    launches = Launches(made(record))
    for number in (0, 2, -1, 1 << 63, 10**30):
        with pytest.raises(ToolError, match=f"There is no launch {number}"):
            launches.one(number)


def test_an_empty_record(record: Path) -> None:
    record.touch()
    with pytest.raises(ToolError, match="no launch has been recorded"):
        Launches(record)
    Winch(record).close()
    assert Launches(record).list() == []


def test_the_file_alone_has_every_launch_that_has_ended(record: Path, tmp_path: Path) -> None:
    """Somebody copies it while the server runs, and leaves the log of SQLite behind."""
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False)
    winch.look(resting=True)
    winch.read_log()
    winch.look(resting=True)
    winch.recorder._write()
    copy = tmp_path / "copy.sqlite"
    copy.write_bytes(record.read_bytes())
    assert Launches(copy).one(1)["result"]["launch_permit"] == "never given"
    assert len(Launches(copy).one(1)["samples"]) == len(Launches(record).one(1)["samples"]) > 20


def test_a_record_where_nobody_can_write(
    record: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a stick that is locked: SQLite cannot make the file by which readers agree."""
    made(record)
    connect = sqlite3.connect

    def locked(at: object, **options: object) -> sqlite3.Connection:
        if "mode=ro" in str(at) and "immutable" not in str(at):
            at = f"{(tmp_path / 'nothing').as_uri()}?mode=ro"
        return connect(at, **options)

    monkeypatch.setattr(sqlite3, "connect", locked)
    assert Launches(record).one(1)["samples"]
    record.with_name(f"{record.name}-wal").touch()  # what stands in it would be missing
    with pytest.raises(ToolError, match="unable to open"):
        Launches(record)


def test_the_end_of_the_server_ends_a_launch(record: Path) -> None:
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False)
    assert winch.close() == ""
    launch = Launches(record).one(1)
    assert launch["ended"]
    assert launch["result"]["cut"] == "The server was ended."
    assert launch["result"]["rope_m"] == 0


def test_a_kill_does_not_make_a_launch_end_as_it_began(record: Path) -> None:
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False, seconds=3)
    winch.recorder._write()
    Recorder(record, winch, Growth())  # as it begins after a kill
    launch = Launches(record).one(1)
    began, ended = (datetime.fromisoformat(launch[name]) for name in ("began", "ended"))
    assert (ended - began).total_seconds() == pytest.approx(launch["samples"][-1]["time_s"], 0.01)


def test_what_is_lost_at_the_end_is_told(record: Path) -> None:
    """Another program holds the record: nothing can be written."""
    winch = Winch(record)
    winch.recorder._base.execute("PRAGMA busy_timeout = 10")
    winch.look(resting=True)
    winch.look(resting=False)
    with closing(sqlite3.connect(record, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        said = winch.close()
    assert "database is locked. Not on the disk: launches of 20" in said


def test_the_list_tells_the_speed_of_pulling_out_and_nothing_where_nothing_is_known(
    record: Path,
) -> None:
    result = {"launch_permit": "kept", "rope_m": -500, "max_rope_speed_m_per_s": 0}
    result |= {"min_rope_speed_m_per_s": -12.3}
    made(record, f"UPDATE launches SET result = '{json.dumps(result)}'")
    assert re.search(r" 12\.3 +-500\.0 ", tool("launches", "list", "--record", str(record)))
    made(record, "UPDATE launches SET result = NULL WHERE id = 2")
    said = tool("launches", "list", "--record", str(record)).splitlines()[1]
    assert re.search(r" \d\.\d +being recorded, or cut by a kill$", said), said


def test_events_are_told_by_the_clock_of_the_samples(record: Path) -> None:
    """The controller's, which began anew meanwhile, is that of nothing else on the page."""
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False, seconds=1)
    winch.happens()
    winch.look(resting=False, seconds=1)
    winch.read_log()
    winch.look(resting=True)
    winch.close()
    launch = Launches(record).one(1)
    assert list(event_times_s(launch)) == [pytest.approx(1.45, abs=0.06)]
    assert re.search(r"^ *1\.[45]  ", tool("launches", "show", "1", "--record", str(record)), re.M)


def test_page_requests_are_part_of_all(tmp_path: Path) -> None:
    """Also while the port is away: a counter never tells more than the whole."""
    owner = PortOwner(Line(str(tmp_path / "nothing")))
    owner.start()
    for _ in range(3):
        assert owner.exchange(1, b"\x07").outcome is Outcome.NO_PATH
    owner.close()
    assert (owner.counts.requests, owner.counts.page_requests) == (0, 0)
    assert owner.counts.no_path == 3


def test_metrics(start: Start) -> None:
    served = start("--timeout", "0.2")
    served.index()
    wait(served.sees)

    def values() -> dict[str, float]:
        families = text_string_to_metric_families(served.get("metrics").decode())
        return {
            sample.name + "".join(sorted(sample.labels.values())): sample.value
            for family in families
            for sample in family.samples
        }

    wait(lambda: values()["levelwind_flaglaunch_permit"] == 1)
    now = values()
    assert now["levelwind_up"] == 1
    assert now["levelwind_flaglos"] == 0
    assert now["levelwind_line_requests_total"] > now["levelwind_line_page_requests_total"] > 0
    assert 0 < now["levelwind_line_latency_seconds0.5"] < 0.1
    with served.device() as device:
        assert now["levelwind_position_um"] == device.value("position_um")
    served.simulator.end()
    wait(lambda: values()["levelwind_up"] == 0)
    assert not any(re.match("levelwind_(position|flag)", name) for name in values()), "nothing old"


class Winch:
    """What a watcher says, without a controller: a look every 50 ms, the log a second late."""

    firmware, parameters, problem = "0.0.0", {"pitch_um": 12_000}, ""

    def __init__(self, record: Path) -> None:
        self.listeners, self.log = [], []
        self.seen: Seen | None = None
        self.time_s = 1000.0
        self.log_s = self.time_s
        self.recorder = Recorder(record, self, Growth())
        self.listeners.append(self.recorder.see)  # its thread is not started: the test writes

    def look(self, resting: bool, seconds: float = 0.5) -> None:
        for _ in range(round(seconds / 0.05)):
            self.time_s += 0.05
            status = dict.fromkeys((p.name for p in (*LIVE_POINTS, *MORE_POINTS)), 0)
            status |= {"uptime_ms": self.uptime_ms, "flags": resting << Flag.DRUM_AT_REST}
            travel = Travel(-83_000, -80_000, 80_000, 83_000)
            self.seen = Seen(status, travel, self.time_s, 0, list(self.log), self.log_s)
            for listener in self.listeners:
                listener(self.seen)

    @property
    def uptime_ms(self) -> int:
        """Begins anew in the middle of these tests."""
        return round(1000 * (self.time_s - 1001.0)) % (1 << 32)

    def happens(self) -> None:
        """An event that is not read yet."""
        self.log.append(
            LogRecord(len(self.log) + 1, 1, self.uptime_ms, Event.LOS1_PLUS, 0, 1, 0, 0)
        )

    def read_log(self) -> None:
        self.log_s = self.time_s

    def close(self) -> str:
        """As the server ends."""
        self.recorder._thread = threading.Thread()
        self.recorder._thread.start()
        return self.recorder.close()


def events(record: Path, number: int) -> list[int]:
    return [one["sequence"] for one in Launches(record).one(number)["events"]]


def has_ended(record: Path) -> bool:
    return bool(Launches(record).list(1)[0]["ended"])


def test_an_event_belongs_to_the_launch_in_which_it_happened(record: Path) -> None:
    """Also one that is read after the launch; and one that the next launch's log still holds."""
    winch = Winch(record)
    winch.look(resting=True)
    winch.happens()
    winch.look(resting=True, seconds=3)
    winch.look(resting=False)
    winch.happens()
    winch.look(resting=False)
    log, winch.log = winch.log, []
    winch.look(resting=True)
    winch.recorder._write()
    assert not has_ended(record), "its last events are not read yet"
    winch.log = log
    winch.happens()
    winch.read_log()
    winch.look(resting=True)
    winch.recorder._write()
    assert has_ended(record)
    assert events(record, 1) == [2]
    winch.look(resting=True, seconds=2)
    winch.look(resting=False)
    winch.happens()
    winch.read_log()
    winch.look(resting=False)
    winch.recorder._write()
    assert events(record, 2) == [4], "before it has ended: a kill loses no more than a second"
    with closing(sqlite3.connect(record)) as base:
        cut = base.execute("SELECT result FROM launches WHERE ended IS NULL").fetchall()
    assert cut == [(None,)]


def test_a_kill_before_the_last_events_keeps_the_result(record: Path) -> None:
    winch = Winch(record)
    winch.look(resting=True)
    winch.look(resting=False)
    winch.look(resting=True)
    winch.recorder._write()
    assert not has_ended(record)
    Recorder(record, winch, Growth())  # as it begins after a kill
    assert has_ended(record)
    assert Launches(record).one(1)["result"]["launch_permit"] == "never given"


def test_who_asks_while_a_lay_is_drawn_gets_the_new_one(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing, go_on = threading.Event(), threading.Event()

    def draw(*_: object) -> dict[str, object]:
        drawing.set()
        assert go_on.wait(10)
        return {"turns": 1.0}

    monkeypatch.setattr(lay, "_draw", draw)
    growth = Growth()
    with ThreadPoolExecutor() as pool:
        first = pool.submit(growth.picture)
        assert drawing.wait(10)
        second = pool.submit(growth.picture)
        with pytest.raises(TimeoutError):
            second.result(0.05)
        go_on.set()
        assert first.result(10) == second.result(10) == {"turns": 1.0}
