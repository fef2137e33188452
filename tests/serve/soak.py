# SPDX-License-Identifier: Apache-2.0
"""The server for a day of the winch: page, two Modbus TCP clients, recorder, launch after launch.

Judged: nothing of the server or the simulator grows; no data is older than a second, as a browser
counts it; no answer to a client is wrong; every launch is recorded whole, each of its rows fits
what the clients have read meanwhile, and each event of the controller is there once.
./dev soak [--hours H] [--speed X]: a day of the winch is 6 hours at 4x.
"""

import argparse
import bisect
import itertools
import json
import os
import queue
import struct
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

from levelwind.line import event_log
from levelwind.line.live import read_live
from levelwind.map_table import Command, Event, Flag
from levelwind.serve.demonstration import ALL_ROPE_MM, ROPE
from levelwind.serve.lay import GAP_TURNS_MAX
from levelwind.serve.recorder import BEFORE_S, Launches
from served import RawTcp, Served
from websockets.sync.client import connect

DRUM_MILLIRPM = 300_000
HAUL_S, PAUSE_S = 20.0, 8.0
"""Out, and at rest: of the winch's time."""
ROPE_MM_PER_S, TURN_ROUND_S = 12_000, 3.0
"""How fast it comes in, and how much longer it takes for the drum's acceleration."""
REST_MIN_S = 0.5
"""Between two launches, whatever the speed: the server has to see that the drum rests."""
WARNING_EDGES_PER_S = 14_000
"""A launch passes it: an event each."""
MEMORY = Path("/dev/shm") if Path("/dev/shm").is_dir() else None
"""Where the simulator's storage is: it stands while a busy disk writes, and is not judged."""
EDGES_PER_REV, PITCH_UM, EDGES_PER_S2 = 2880, 12_000, 9600
"""Of the simulated winch; how fast its drum changes its speed."""
KEEP = 100
PICTURE_EVERY = 10
LOOK_S = 2.0
SHOW_EVERY = 60
"""Looks."""
GROWTH_MAX = 1.05
"""Of the last quarter over the second."""
LOG_MAX_KIB = 4400
"""Up to here the write-ahead log may come and go: SQLite's 1,000 pages, and what is under way."""
COUNT_MORE = 4
"""Descriptors and threads: of the requests that are under way at a look."""
AGE_MAX_S = GAP_MAX_S = ANSWER_MAX_S = 1.0
END_MAX_S = 15.0
PAGE_FAILS_S = 10.0
LIVE_FIRST, LIVE_COUNT = 100, 40
READ_LIVE = struct.pack(">BHH", 4, LIVE_FIRST, LIVE_COUNT)
READ_PARAMETERS = struct.pack(">BHH", 3, 100, 9)
# position, rope, edges, uptime of the live registers: modbus_map/registers.yaml
PLACES = (("position_um", 106, ">i"), ("rope_mm", 117, ">i"))
PLACES += (("net_edges", 119, ">q"), ("uptime_ms", 127, ">I"))
COMPARED = [name for name, _, _ in PLACES[:-1]]


@dataclass
class Size:
    """What may not grow, at one time."""

    server_kib: int
    simulator_kib: int
    server_files: int
    server_threads: int
    simulator_files: int
    record_kib: int
    log_kib: int
    """Of the record's write-ahead log."""

    COUNTS = ("server_files", "server_threads", "simulator_files")


def _number(pid: int, name: str) -> int:
    text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    return int(text.partition(f"{name}:")[2].split()[0])


def _files(pid: int) -> int:
    return sum(1 for _ in Path(f"/proc/{pid}/fd").iterdir())


def cpu_s(pid: int) -> float:
    """The processor's time that it has had."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def size(served: Served, record: Path) -> Size:
    """Now."""
    server, simulator = served.process.pid, served.simulator.pid
    log = record.with_name(record.name + "-wal")
    return Size(
        *(_number(server, "VmRSS"), _number(simulator, "VmRSS"), _files(server)),
        *(_number(server, "Threads"), _files(simulator)),
        *(record.stat().st_size // 1024, log.stat().st_size // 1024 if log.exists() else 0),
    )


@dataclass
class Launch:
    """What the record must say: the live status before and after."""

    number: int
    before: dict[str, int]
    after: dict[str, int] = field(default_factory=dict)


class Soak:
    """What runs beside each other, and what went wrong."""

    def __init__(self, served: Served, record: Path, speed: float) -> None:
        self.served, self.record, self.speed = served, record, speed
        self.last = threading.Event()
        """No launch after this one."""
        self.ended = threading.Event()
        self.wrong: list[str] = []
        self.requests = self.launches = self.judged = self.messages = self.compared = 0
        self.oldest_s = self.slowest_s = self.widest_s = self.still_s = 0.0
        self.winch_ms = 0
        self._wound: queue.Queue[Launch | None] = queue.Queue()
        self._readings: list[dict[str, int]] = []
        self._lock = threading.Lock()
        self._sequence = 0
        """Of the last event that was found in the record."""

    def winch_wait(self, seconds: float) -> None:
        """So long by the winch's time; to its end, for a launch is whole."""
        time.sleep(seconds / self.speed)

    def _ask(self, raw: RawTcp, pdu: bytes) -> bytes:
        began = time.monotonic()
        answer = raw.request(pdu)
        self.slowest_s = max(self.slowest_s, time.monotonic() - began)
        self.requests += 1
        return answer

    def panel(self) -> None:
        """A client that reads the live values; the clock of the controller goes on from each."""
        raw, before_ms = RawTcp(self.served.gate), 0
        while not self.ended.wait(0.05):
            answer = self._ask(raw, READ_LIVE)
            if answer[:2] != bytes([4, 2 * LIVE_COUNT]) or len(answer) != 2 + 2 * LIVE_COUNT:
                self.wrong.append(f"the panel got {answer.hex()}")
                continue
            reading = {
                name: struct.unpack_from(form, answer, 2 + 2 * (address - LIVE_FIRST))[0]
                for name, address, form in PLACES
            }
            if reading["uptime_ms"] <= before_ms:
                self.wrong.append(f"the panel got an answer again: {answer.hex()}")
            before_ms = reading["uptime_ms"]
            with self._lock:
                self._readings.append(reading)
        raw.close()

    def checker(self) -> None:
        """A client whose answer is the same each time, and never the other's."""
        raw = RawTcp(self.served.gate)
        first = self._ask(raw, READ_PARAMETERS)
        assert first[0] == 3, first.hex()
        while not self.ended.wait(0.05):
            answer = self._ask(raw, READ_PARAMETERS)
            if answer != first:
                self.wrong.append(f"the checker got {answer.hex()}")
        raw.close()

    def stand_still(self) -> None:
        """How long this computer keeps a program waiting that needs next to nothing."""
        before_s = time.monotonic()
        while not self.ended.wait(0.02):
            now_s = time.monotonic()
            self.still_s = max(self.still_s, now_s - before_s)
            before_s = now_s

    def page(self) -> None:
        """What the browser gets, and how old it becomes until the next comes."""
        with connect(f"ws://127.0.0.1:{self.served.web}/live", max_size=None) as live:
            age_s, came_s, number = 0.0, time.monotonic(), 0
            while not self.ended.is_set():
                said = json.loads(live.recv(PAGE_FAILS_S))
                now_s = time.monotonic()
                self.oldest_s = max(self.oldest_s, age_s + now_s - came_s)
                if "number" not in said:
                    continue
                if said["number"] != number + 1:
                    self.wrong.append(f"message {said['number']} to the page after {number}")
                age_s, came_s, number = said["now"] - said["stamp"], now_s, said["number"]
                self.oldest_s = max(self.oldest_s, age_s)
                self.messages += 1

    def wind(self) -> None:
        """Launches, out and in, until the end."""
        with self.served.device() as device:
            began_ms = read_live(device)["uptime_ms"]
            while not self.last.is_set():
                launch = Launch(self.launches + 1, read_live(device))
                device.write({"bench_drum_speed_millirpm": -DRUM_MILLIRPM})
                self.winch_wait(HAUL_S)
                device.write({"bench_drum_speed_millirpm": DRUM_MILLIRPM})
                out_s = device.value("rope_out_mm") / ROPE_MM_PER_S
                self.winch_wait(max(0.0, out_s + TURN_ROUND_S))
                device.write({"bench_drum_speed_millirpm": 0})
                while not _rests(launch.after):
                    launch.after = read_live(device)
                    time.sleep(0.02)
                self.launches += 1
                self.winch_ms = launch.after["uptime_ms"] - began_ms
                self._wound.put(launch)
                time.sleep(max(PAUSE_S / self.speed, REST_MIN_S))
        self._wound.put(None)

    def judge_launches(self) -> None:
        """Each as soon as it has ended: later ones drive it out of the record."""
        while (launch := self._wound.get()) is not None:
            end = time.monotonic() + END_MAX_S
            while not (found := self._find(launch.number)) and time.monotonic() < end:
                time.sleep(0.2)
            if found:
                self.wrong += [f"launch {launch.number}: {w}" for w in self._judge(launch, found)]
            else:
                self.wrong.append(f"launch {launch.number} is not in the record, or not ended")
            self.judged += 1
            if launch.number % PICTURE_EVERY == 0:
                picture = self.served.get(f"api/launches/{launch.number}/picture.png")
                if not picture.startswith(b"\x89PNG"):
                    self.wrong.append(f"launch {launch.number} has no picture")
            self.served.get("metrics")

    def _find(self, number: int) -> dict | None:
        newest = Launches(self.record).list(5)
        if not any(one["id"] == number and one["ended"] for one in newest):
            return None
        return Launches(self.record).one(number)

    def _judge(self, launch: Launch, found: dict) -> list[str]:
        """What the record of a launch does not say as it was."""
        samples, result, wrong = found["samples"], found["result"], []
        if result["launch_permit"] != "kept" or result["los"] or result["faults"]:
            wrong.append(f"result {result}")
        if "cut" in result:
            wrong.append(f"cut: {result}")
        for which, sample, status in (("first", samples[0], launch.before),
                                      ("last", samples[-1], launch.after)):  # fmt: skip
            other = [name for name in COMPARED if sample[name] != status[name]]
            if other or not _rests(sample):
                wrong.append(f"its {which} row {sample} is not {status}")
        pairs = list(itertools.pairwise(samples))
        gap_s = max(b["time_s"] - a["time_s"] for a, b in pairs)
        self.widest_s = max(self.widest_s, gap_s)
        if gap_s > GAP_MAX_S:
            wrong.append(f"{gap_s:.2f} s without a row")
        turns = DRUM_MILLIRPM / 60_000 * gap_s * self.speed
        if turns < GAP_TURNS_MAX and not found["lay"].get("cells"):
            wrong.append(f"no lay: {found['lay']}")
        if any(b["uptime_ms"] <= a["uptime_ms"] or b["time_s"] <= a["time_s"] for a, b in pairs):
            wrong.append("rows that do not follow each other")
        return wrong + self._judge_rows(samples) + self._judge_events(found["events"])

    def _judge_rows(self, samples: list[dict]) -> list[str]:
        """What the panel has read between two rows lies between them."""
        last_ms = samples[-1]["uptime_ms"]
        with self._lock:
            count = bisect.bisect(self._readings, last_ms, key=lambda one: one["uptime_ms"])
            readings = self._readings[:count]
            del self._readings[:count]
        times, wrong = [one["uptime_ms"] for one in samples], []
        for reading in readings:
            place = bisect.bisect(times, reading["uptime_ms"])
            if place in (0, len(times)):
                continue
            a, b = samples[place - 1], samples[place]
            self.compared += 1
            over = 8 + EDGES_PER_S2 * ((b["uptime_ms"] - a["uptime_ms"]) / 1000) ** 2 / 8
            turns = (abs(b["net_edges"] - a["net_edges"]) + 2 * over) / EDGES_PER_REV
            near_um = PITCH_UM * turns * 1.1 + 100
            low, high = sorted((a["net_edges"], b["net_edges"]))
            if not low - over <= reading["net_edges"] <= high + over:
                wrong.append(f"edges of {reading} are not between {a} and {b}")
            if abs(reading["position_um"] - a["position_um"]) > near_um:
                wrong.append(f"position of {reading} is not beside {a}")
        if not readings:
            wrong.append("nothing was read beside it")
        return wrong

    def _judge_events(self, events: list[dict]) -> list[str]:
        """One warning in each launch, and no number left out."""
        names = [one["event"] for one in events]
        numbers = [one["sequence"] for one in events]
        expected = [self._sequence + 1] if self._sequence else numbers[:1]
        if names != [event_text(Event.OVERSPEED_WARNING)] or numbers != expected:
            return [f"events {events} after {self._sequence}"]
        self._sequence = numbers[0]
        return []

    def judge_log(self) -> list[str]:
        """The controller's own log ends with the event of the last launch."""
        with self.served.device() as device:
            newest = event_log.read(device)[-1].sequence
        return [] if newest == self._sequence else [f"event {newest}, recorded {self._sequence}"]

    def guarded(self, work: str) -> None:
        """A thread that dies is a failure."""
        try:
            getattr(self, work)()
        except Exception as error:  # whatever it is, the run has failed
            self.wrong.append(f"{work}: {type(error).__name__}: {error}")


def event_text(event: Event) -> str:
    """As the record has it."""
    return event.text.partition(". Detail:")[0]


def _rests(status: dict[str, int]) -> bool:
    return bool(status.get("flags", 0) >> Flag.DRUM_AT_REST & 1)


def grown(sizes: list[Size]) -> list[str]:
    """What has become larger from the second quarter to the last."""
    quarter, wrong = len(sizes) // 4, []
    for name in Size.__dataclass_fields__:
        early = max(getattr(one, name) for one in sizes[quarter : 2 * quarter] or sizes[:1])
        late = max(getattr(one, name) for one in sizes[-quarter:])
        limit = early + COUNT_MORE if name in Size.COUNTS else GROWTH_MAX * early
        if late > max(limit, LOG_MAX_KIB if name == "log_kib" else 0):
            wrong.append(f"{name} has grown from {early} to {late}")
    return wrong


def set_up(served: Served) -> None:
    """The rope described, for its lay; a warning that a launch reaches."""
    with served.device() as device:
        device.write({**ROPE, "overspeed_warning_edges_per_s": WARNING_EDGES_PER_S})
        device.command(Command.APPLY)
    served.index()
    with served.device() as device:
        device.write({"set_rope_mm": ALL_ROPE_MM})
        device.command(Command.SET_ROPE)
    time.sleep(1.5 * BEFORE_S)  # what comes later belongs to the first launch


def run(hours: float, speed: float, by_tcp: bool, folder: Path, storage: Path) -> int:
    """Exit status. `storage`: of the simulator."""
    record = folder / "launches.sqlite"
    served = Served(
        *(folder, "--record", str(record), "--keep", str(KEEP)),
        speed=f"{speed:g}",
        storage=storage,
        by_tcp=by_tcp,
    )
    try:
        set_up(served)
        soak = Soak(served, record, speed)
        works = ("panel", "checker", "page", "stand_still", "wind", "judge_launches")
        threads = [threading.Thread(target=soak.guarded, args=(w,), daemon=True) for w in works]
        began_s = time.monotonic()
        used = [-cpu_s(served.process.pid), -cpu_s(served.simulator.pid)]
        for thread in threads:
            thread.start()
        sizes = []
        while soak.winch_ms < 3_600_000 * hours and not soak.wrong:
            time.sleep(LOOK_S)
            sizes.append(size(served, record))
            if len(sizes) % SHOW_EVERY == 0:
                print(f"{soak.winch_ms / 3_600_000:.2f} h: {sizes[-1]}", flush=True)
        used[0] += cpu_s(served.process.pid)
        used[1] += cpu_s(served.simulator.pid)
        lasted_s = time.monotonic() - began_s
        soak.last.set()
        for thread in reversed(threads):
            thread.join(2 * END_MAX_S)
            soak.ended.set()  # after the last launch is judged
        wrong = soak.wrong + grown(sizes) + soak.judge_log()
        if soak.oldest_s > AGE_MAX_S:
            wrong.append(f"data was {soak.oldest_s:.2f} s old")
        if soak.slowest_s > ANSWER_MAX_S:
            wrong.append(f"a client waited {soak.slowest_s:.2f} s")
        if soak.judged != soak.launches:
            wrong.append(f"{soak.launches} launches, {soak.judged} judged")
        if b"levelwind_recorder_lost_samples_total 0.0" not in served.get("metrics"):
            wrong.append("the recorder has lost samples")
    finally:
        served.close()
    print(
        f"{soak.winch_ms / 3_600_000:.2f} h of the winch in {lasted_s / 60:.1f} min "
        f"({soak.winch_ms / 1000 / lasted_s:.1f}x): {soak.launches} launches, each event once, "
        f"{soak.compared} readings between their rows (at most {soak.widest_s:.2f} s apart); "
        f"{soak.requests} requests of clients (slowest {soak.slowest_s:.2f} s), {soak.messages} "
        f"messages to the page, data at most {soak.oldest_s:.2f} s old; processor: server "
        f"{used[0] / lasted_s:.0%}, simulator {used[1] / lasted_s:.0%}; this "
        f"program waited at most {soak.still_s:.2f} s for one"
    )
    for title, one in (("a quarter in", sizes[len(sizes) // 4]), ("at the end", sizes[-1])):
        print(f"{title}: {one}")
    for problem in wrong[:20]:
        print(problem, file=sys.stderr)
    return 1 if wrong else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=1, help="of the winch's time")
    parser.add_argument("--speed", type=float, default=4, help="of the winch's time")
    parser.add_argument(
        "--tcp",
        action="store_true",
        help="ask the simulator by Modbus TCP: a pseudo terminal stands still on a busy computer",
    )
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory(dir=MEMORY) as memory:
        return run(given.hours, given.speed, given.tcp, Path(folder), Path(memory) / "parameters")


if __name__ == "__main__":
    sys.exit(main())
