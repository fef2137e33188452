# SPDX-License-Identifier: Apache-2.0
"""The server for hours: page, two Modbus TCP clients and recorder, launch after launch at 4x.

Judged: the server's memory stays flat, no data is older than a second, no request of a client is
wrong or lost, every launch is recorded whole. ./dev soak [--minutes M]; a day is 1440.
"""

import argparse
import itertools
import json
import sys
import tempfile
import threading
import time
from pathlib import Path

from levelwind.line.device import Device
from levelwind.map_table import Flag
from levelwind.serve.recorder import Launches
from served import RawTcp, Served
from websockets.sync.client import connect

SPEED = "4"
DRUM_MILLIRPM = 300_000
GROWTH_MAX = 1.10
AGE_MAX_S = 1.0
GAP_MAX_S = 1.0
READ_LIVE = bytes([4, 0, 100, 0, 40])


def resident_kib(pid: int) -> int:
    text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    return int(text.partition("VmRSS:")[2].split()[0])


class Soak:
    """What runs beside each other, and what went wrong."""

    def __init__(self, served: Served) -> None:
        self.served = served
        self.ended = threading.Event()
        self.wrong: list[str] = []
        self.requests = self.launches = self.messages = 0
        self.oldest_s = 0.0

    def poll(self) -> None:
        """A panel: reads without a pause worth the name."""
        raw = RawTcp(self.served.gate)
        while not self.ended.wait(0.05):
            answer = raw.request(READ_LIVE)
            self.requests += 1
            if answer[:2] != bytes([4, 80]):
                self.wrong.append(f"a client got {answer.hex()}")
        raw.close()

    def page(self) -> None:
        """What the browser gets, and how old it is."""
        with connect(f"ws://127.0.0.1:{self.served.web}/live", max_size=None) as live:
            while not self.ended.is_set():
                said = json.loads(live.recv(10))
                self.messages += 1
                if said.get("stamp") is not None:
                    self.oldest_s = max(self.oldest_s, said["now"] - said["stamp"])

    def wind(self) -> None:
        """Launches, out and in, until the end."""
        with self.served.device() as device:
            while not self.ended.is_set():
                for speed in (DRUM_MILLIRPM, -DRUM_MILLIRPM):
                    device.write({"bench_drum_speed_millirpm": speed})
                    self.ended.wait(5)
                device.write({"bench_drum_speed_millirpm": 0})
                while not _rests(device):
                    time.sleep(0.05)
                self.launches += 1
                self.ended.wait(2)

    def guarded(self, work: str) -> None:
        """A thread that dies is a failure."""
        try:
            getattr(self, work)()
        except Exception as error:  # whatever it is, the run has failed
            self.wrong.append(f"{work}: {type(error).__name__}: {error}")


def _rests(device: Device) -> bool:
    return bool(device.value("flags") >> Flag.DRUM_AT_REST & 1)


def judge(soak: Soak, record: Path, sizes: list[int]) -> list[str]:
    """All that must hold and does not."""
    wrong = list(soak.wrong)
    early, late = sizes[len(sizes) // 4], sizes[-1]
    if late > GROWTH_MAX * early:
        wrong.append(f"memory has grown from {early} to {late} KiB")
    if soak.oldest_s > AGE_MAX_S:
        wrong.append(f"data was {soak.oldest_s:.2f} s old")
    found = Launches(record).list()
    if len(found) != soak.launches or any("cut" in one["result"] for one in found):
        wrong.append(f"{soak.launches} launches, {len(found)} recorded")
    for one in found:
        times = [s["time_s"] for s in Launches(record).one(one["id"])["samples"]]
        gap_s = max((b - a for a, b in itertools.pairwise(times)), default=0.0)
        if gap_s > GAP_MAX_S:
            wrong.append(f"launch {one['id']}: {gap_s:.2f} s without a sample")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10)
    minutes = parser.parse_args().minutes
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "launches.sqlite"
        served = Served(Path(folder), "--record", str(record), "--keep", "100000", speed=SPEED)
        try:
            served.index()
            soak = Soak(served)
            works = ("poll", "poll", "page", "wind")
            threads = [threading.Thread(target=soak.guarded, args=(w,)) for w in works]
            for thread in threads:
                thread.start()
            sizes = []
            end = time.monotonic() + 60 * minutes
            while time.monotonic() < end and not soak.wrong:
                time.sleep(5)
                sizes.append(resident_kib(served.process.pid))
            soak.ended.set()
            for thread in threads:
                thread.join(30)
            time.sleep(2)  # the recorder writes twice a second
            wrong = judge(soak, record, sizes)
        finally:
            served.close()
    print(
        f"{minutes:g} min at {SPEED}x: {soak.launches} launches, {soak.requests} requests of "
        f"clients, {soak.messages} messages to the page, data at most {soak.oldest_s:.2f} s old, "
        f"memory {sizes[len(sizes) // 4]} to {sizes[-1]} KiB"
    )
    for problem in wrong:
        print(problem, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
