# SPDX-License-Identifier: Apache-2.0
"""`levelwind serve` as a process, a simulated winch behind it, and ways to ask both."""

import itertools
import json
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Mapping
from pathlib import Path

from levelwind.line.device import Device
from levelwind.line.points import REGISTERS_PER_READ, runs
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command, Flag
from levelwind.serve.guard import PinFile
from levelwind.simulate import simulator

PIN = "2468"
TOOL = Path(sys.executable).parent / "levelwind"


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def wait(condition: Callable[[], object], limit_s: float = 10.0, what: str = "") -> None:
    """Until it holds: what is waited for lives in another process."""
    end = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end, f"not within {limit_s:g} s: {what}"
        time.sleep(0.01)


class Served:
    """A simulator and a server; both can be ended and begun again at the same addresses."""

    def __init__(
        self,
        folder: Path,
        *options: str,
        write: bool = True,
        speed: str = "1",
        storage: Path | None = None,
        by_tcp: bool = False,
    ) -> None:
        self.folder = folder
        self.storage = storage or folder / "parameters"
        self.web, self.gate = free_port(), free_port()
        self.simulator_tcp = f"127.0.0.1:{free_port()}" if by_tcp else None
        self.port = f"tcp://{self.simulator_tcp}" if by_tcp else folder / "port"
        self.pin_file = folder / "pin.json"
        PinFile(self.pin_file).set(PIN)
        self.speed = speed
        writing = ("--write-from", "127.0.0.1") if write else ()
        self.options = [*writing, "--pin-file", str(self.pin_file), *options]
        self.simulator: simulator.Simulator | None = None
        self.process: subprocess.Popen[str] | None = None
        self.start_simulator()
        self.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.web}/"

    def start_simulator(self) -> None:
        line = simulator.arguments(
            None if self.simulator_tcp else str(self.port),
            tcp=self.simulator_tcp,
            speed=self.speed,
            storage=self.storage,
        )
        self.simulator = simulator.Simulator(line)

    def start(self) -> None:
        self.process = subprocess.Popen(
            [
                *(str(TOOL), "serve", "--port", str(self.port)),
                *("--listen", f"127.0.0.1:{self.web}", "--modbus-tcp", f"127.0.0.1:{self.gate}"),
                *self.options,
            ],
            stdout=subprocess.PIPE,
            stderr=(self.folder / "stderr").open("w"),
            text=True,
        )
        assert self.process.stdout is not None
        said = self.process.stdout.readline()
        assert said == f"ready {self.url}\n", said + (self.folder / "stderr").read_text()

    def kill(self) -> None:
        assert self.process is not None
        self.process.kill()
        self.process.wait()

    def signal(self, number: int) -> None:
        assert self.process is not None
        self.process.send_signal(number)

    def stop(self) -> int:
        assert self.process is not None
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(10)

    def close(self) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.kill()
        if self.simulator is not None:
            self.simulator.end()

    def device(self) -> Device:
        """Through the gateway, as `levelwind --port tcp://` does."""
        return Device(Line(f"tcp://127.0.0.1:{self.gate}"))

    def index(self, permitted: bool = True) -> None:
        """Index; until the server has seen the permit that comes of it."""
        with self.device() as device:
            device.command(Command.INDEX, limit_s=60)
        if permitted:
            wait(lambda: self.sees() and self.status()["launch_permit"], what="the server sees it")

    def turn_back(self) -> None:
        """A little, and come to rest: counts and places that are negative."""
        with self.device() as device:
            device.write({"bench_drum_speed_millirpm": -60_000})
            wait(lambda: device.value("net_edges") < -10_000)
            device.write({"bench_drum_speed_millirpm": 0})
            wait(lambda: device.value("drum_at_rest"))

    def compare(self, read: Callable[[], Mapping[str, object]]) -> set[str]:
        """What somebody else reads is what the controller says; the names of what stood still.

        With some of every type, also what a wrong sign or a wrong order of words would change.
        """

        def by_line() -> dict[str, int]:
            points = [p for p in POINTS.values() if p.space == "input" and p.address < 1000]
            said: dict[str, int] = {}
            with self.device() as device:
                for run in runs(points, REGISTERS_PER_READ):
                    said |= device.read(run.points)
            flags = said["flags"] | said["flags_2"] << 32
            return said | {bit.label: flags >> bit & 1 for bit in Flag}

        before, told, after = by_line(), read(), by_line()
        still = {name for name in told if before[name] == after[name]}
        wrong = {name: (told[name], before[name]) for name in still if told[name] != before[name]}
        assert not wrong, wrong
        types = {(POINTS[n].type, before[n] < 0) for n in still if n in POINTS and before[n]}
        wanted = {(t, False) for t in ("u16", "u32", "i32")} | {("i32", True)}
        assert types >= wanted, types
        assert len(still) > 0.9 * len(told)
        assert {flag.label for flag in Flag} <= told.keys()
        return still

    def get(self, path: str, headers: dict[str, str] | None = None) -> bytes:
        request = urllib.request.Request(self.url + path, headers=headers or {})
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.read()

    def sees(self) -> bool:
        """Has the controller answered the server?"""
        try:
            return self.status()["age_s"] < 1
        except urllib.error.HTTPError:
            return False

    def status(self) -> dict:
        return json.loads(self.get("api/status"))


class RawTcp:
    """Modbus TCP by hand."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), 5)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._numbers = itertools.count(1)

    def send(self, pdu: bytes, unit: int = 1, transaction: int | None = None) -> int:
        number = next(self._numbers) & 0xFFFF if transaction is None else transaction
        self.socket.sendall(struct.pack(">HHHB", number, 0, len(pdu) + 1, unit) + pdu)
        return number

    def receive(self) -> tuple[int, int, bytes]:
        """Transaction, unit, PDU; EOFError where the other side hangs up."""
        head = self._exactly(7)
        number, protocol, length, unit = struct.unpack(">HHHB", head)
        assert protocol == 0
        assert 2 <= length <= 254
        return number, unit, self._exactly(length - 1)

    def _exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            piece = self.socket.recv(count - len(data))
            if not piece:
                raise EOFError
            data += piece
        return data

    def request(self, pdu: bytes, unit: int = 1) -> bytes:
        sent = self.send(pdu, unit)
        number, answered, answer = self.receive()
        assert (number, answered) == (sent, unit)
        return answer

    def close(self) -> None:
        self.socket.close()
