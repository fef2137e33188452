# SPDX-License-Identifier: Apache-2.0
"""The example of an operator panel: what it shows, what it asks, and that it comes back after a
cut line.
"""

import os
import re
import select
import subprocess
import threading
import tty
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from levelwind.map_table import POINTS, ChannelFault, Command, Fault, Flag
from slave import NATIVE_DIR, Simulator, Slave

INTEGRATION = Path(__file__).resolve().parents[2] / "doc" / "integration.md"
BITS_PER_CHARACTER = 11
BAUD = 19_200
SILENCE_CHARACTERS = 3.5


class Panel:
    """The running program; what it says is read line by line."""

    def __init__(self, port: str) -> None:
        self.process = subprocess.Popen(
            [str(NATIVE_DIR / "levelwind_panel"), port, "N"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def press(self, key: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(key + "\n")
        self.process.stdin.flush()

    def wait_for(self, *texts: str) -> None:
        """Read until a line contains one of the texts, then the others in any order."""
        missing = set(texts)
        assert self.process.stdout is not None
        for _ in range(80):
            line = self.process.stdout.readline()
            missing -= {text for text in missing if text in line}
            if not missing:
                return
        raise AssertionError(f"the panel never said {missing}")


class WatchedLine:
    """A pseudo terminal before a slave's port that notes each request and how long its answer was.

    A master writes a request at once; what comes back until the next one is its answer.
    """

    def __init__(self, port: str) -> None:
        self.exchanges: list[tuple[bytes, int]] = []
        self._near, far = os.openpty()
        self._slave = os.open(port, os.O_RDWR | os.O_NOCTTY)
        for file in (far, self._slave):
            tty.setraw(file)
        self.port = os.ttyname(far)
        self._stopped, self._stop = os.pipe()
        self._thread = threading.Thread(target=self._copy)
        self._thread.start()

    def close(self) -> None:
        os.close(self._stop)
        self._thread.join()

    def _copy(self) -> None:
        ready: list[int] = []
        while self._stopped not in ready:
            ready = select.select([self._near, self._slave, self._stopped], [], [])[0]
            if self._near in ready:
                request = os.read(self._near, 256)
                self.exchanges.append((request, 0))
                os.write(self._slave, request)
            if self._slave in ready:
                answer = os.read(self._slave, 256)
                request, length = self.exchanges[-1]
                self.exchanges[-1] = (request, length + len(answer))
                os.write(self._near, answer)
        os.close(self._slave)


def line_ms(request: bytes, answer_length: int) -> float:
    """Time on a line of the factory settings, with the silences that end both frames."""
    characters = len(request) + answer_length + 2 * SILENCE_CHARACTERS
    return characters * BITS_PER_CHARACTER / BAUD * 1000


@pytest.fixture
def panels() -> Iterator[Callable[[str], Panel]]:
    running: list[Panel] = []

    def start(port: str) -> Panel:
        running.append(Panel(port))
        return running[-1]

    yield start
    for panel in running:
        panel.process.kill()
        panel.process.wait()


def test_comes_back_after_the_line_was_cut(
    own_simulator: Callable[..., Simulator], panels: Callable[[str], Panel], target: str
) -> None:
    if target != "sim":
        pytest.skip("only the simulator has the same port again")
    simulator = own_simulator()
    panel = panels(str(simulator.port))
    panel.wait_for("Position unknown", "no launch")
    assert simulator.stop() == 0
    panel.wait_for("no data")
    panel.wait_for("no data: cannot open")
    own_simulator()
    panel.wait_for("level wind controller")
    panel.wait_for("Position unknown")


def test_shows_fault_and_loss_of_synchronization(
    slave: Slave, panels: Callable[[str], Panel]
) -> None:
    slave.command(Command.INDEX)
    slave.write("bench_drum_speed_millirpm", 400_000)
    slave.wait(lambda: slave.read("position_um") > 0)
    slave.write("bench_stall", 1)
    slave.wait(lambda: slave.flag(Flag.LOS))
    slave.write("bench_stall", 0)
    slave.write("bench_overtravel_plus", 1)
    slave.wait(lambda: slave.read("fault") == Fault.OVERTRAVEL_PLUS)
    slave.close()
    panel = panels(slave.port)
    panel.wait_for("THE ROPE MAY BE LAID WRONG: LOS type", f"FAULT: {Fault.OVERTRAVEL_PLUS.text}")
    panel.process.kill()
    panel.process.wait()
    after = Slave(slave.port)
    after.write("bench_overtravel_plus", 0)
    after.close()


def test_shows_an_encoder_that_does_not_tell_the_drums_motion(
    slave: Slave, panels: Callable[[str], Panel]
) -> None:
    slave.command(Command.INDEX)
    slave.write("bench_drum_speed_millirpm", 400_000)
    slave.wait(lambda: slave.read("position_um") > 0)
    slave.write("bench_encoder_a_fault", ChannelFault.STUCK_LOW)
    slave.wait(lambda: slave.flag(Flag.ENCODER_FAULT))
    slave.close()
    panel = panels(slave.port)
    panel.wait_for(f"THE ROPE MAY BE LAID WRONG: {Flag.ENCODER_FAULT.text}", "To do: look at")
    panel.process.kill()
    panel.process.wait()
    after = Slave(slave.port)
    after.write("bench_encoder_a_fault", ChannelFault.NONE)
    after.close()


def test_shows_all_by_one_request_that_takes_as_long_as_the_document_says(
    slave: Slave, panels: Callable[[str], Panel]
) -> None:
    slave.close()
    line = WatchedLine(slave.port)
    panel = panels(line.port)
    for _ in range(3):
        panel.wait_for("Position unknown")
    panel.process.kill()
    panel.process.wait()
    line.close()
    # A busy machine may lose one: then the panel opens the line again, and identifies.
    polls = [e for e in line.exchanges if e[0][2:4] != bytes(2) and e[1] > 0]
    assert len(polls) > 5
    assert len(line.exchanges) - len(polls) < 5
    plan = re.search(
        r"the (\d+) registers from (\d+) take about (\d+) ms", INTEGRATION.read_text("utf-8")
    )
    assert plan is not None
    count, first, documented_ms = (int(number) for number in plan.groups())
    assert first == POINTS["state"].address
    for request, answer_length in polls[:-1]:  # the last one may be cut
        assert request[:6] == bytes([1, 4, 0, first, 0, count])
        assert answer_length == 5 + 2 * count
        assert abs(line_ms(request, answer_length) - documented_ms) < 5


def test_indexes_and_stops_by_key_and_shows_on_meanwhile(
    slave: Slave, panels: Callable[[str], Panel]
) -> None:
    slave.close()
    panel = panels(slave.port)
    panel.wait_for("Position unknown")
    panel.press("i")
    panel.wait_for("Indexing: moving toward the indexing switch")
    panel.wait_for("index: done")
    panel.press("r")  # whatever a test before has left
    panel.wait_for("rope looked at: done")
    panel.wait_for("launch permitted")
    panel.press("i")
    panel.wait_for("Indexing: ")
    panel.press("s")
    panel.wait_for("stop: done")
    panel.wait_for("no launch")
    panel.process.kill()
    panel.process.wait()
    after = Slave(slave.port)
    assert after.read("command_code") == Command.STOP
    after.close()
