# SPDX-License-Identifier: Apache-2.0
"""The command `levelwind` over a port that echoes, adds bytes and cuts frames in pieces."""

import json
import os
import random
import select
import signal
import subprocess
import threading
import time
import tty
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from slave import Slave
from test_tool import LEVELWIND, environment, output, refusal

FRAME_GAP_S = 0.005
LISTEN_ONLY = bytes.fromhex("01 08 00 04")


class BadLine:
    """A pseudo terminal in front of a slave's port."""

    def __init__(self, slave: str) -> None:
        self._random = random.Random(1)
        self.echo = False
        self.noise = b""
        self.cut = False
        self.heard: Callable[[bytes], None] = lambda frame: None
        self._master, self._near = os.openpty()
        tty.setraw(self._near)
        self.port = os.ttyname(self._near)
        self._slave = os.open(slave, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self._slave)
        self._stopped, self._stop = os.pipe()
        self._thread = threading.Thread(target=self._carry, daemon=True)
        self._thread.start()

    def close(self) -> None:
        os.close(self._stop)
        self._thread.join(10)
        for file in (self._master, self._near, self._slave, self._stopped):
            os.close(file)

    def _carry(self) -> None:
        while True:
            ready = select.select([self._master, self._slave, self._stopped], [], [])[0]
            if self._stopped in ready:
                return
            for source in ready:
                frame = self._frame(source)
                if source == self._master:
                    self.heard(frame)
                    if self.echo:
                        self._to_the_tool(frame)
                    os.write(self._slave, frame)
                else:
                    self._to_the_tool(self.noise + frame)

    def _frame(self, source: int) -> bytes:
        frame = os.read(source, 4096)
        while select.select([source], [], [], FRAME_GAP_S)[0]:
            frame += os.read(source, 4096)
        return frame

    def _to_the_tool(self, frame: bytes) -> None:
        while frame:
            size = self._random.randint(1, len(frame)) if self.cut else len(frame)
            os.write(self._master, frame[:size])
            frame = frame[size:]
            if frame:
                time.sleep(self._random.uniform(0.001, 0.02))  # the line's own time


@pytest.fixture
def bad(slave: Slave, target: str) -> Iterator[BadLine]:
    slave.close()
    if target.startswith("serial:"):
        pytest.skip("the settings of a real port are the tool's")
    line = BadLine(slave.port)
    yield line
    line.close()


@pytest.mark.parametrize(
    ("echo", "noise"), [(False, b"\xff"), (True, b""), (True, b"\x00\x00\xff")]
)
def test_the_tool_on_a_line_that_echoes_glitches_and_cuts(
    bad: BadLine, tmp_path: Path, echo: bool, noise: bytes
):
    bad.echo, bad.noise, bad.cut = echo, noise, True
    output(bad.port, "set", "pitch_um=11111")
    row = json.loads(output(bad.port, "get", "pitch_um", "--json"))["pitch_um"]
    assert row["staged"] == 11_111
    assert "UNINDEXED" in output(bad.port, "status")
    events = json.loads(output(bad.port, "log", "--json"))["events"]
    assert len({event["sequence"] for event in events}) == len(events)
    table = tmp_path / "table.txt"
    table.write_text("0 0\n1440 3000\n2880 0\n")
    assert "3 rows checked" in output(bad.port, "cam", "upload", str(table))


def test_ctrl_c_in_listen_only_mode_does_not_leave_the_slave_mute(bad: BadLine):
    in_the_mode = threading.Event()
    bad.heard = lambda frame: frame.startswith(LISTEN_ONLY) and in_the_mode.set()
    process = subprocess.Popen(
        [*LEVELWIND, "conformance", "--case", "listen only"], env=environment(bad.port)
    )
    try:
        assert in_the_mode.wait(60)
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 130
    finally:
        process.kill()
    assert "UNINDEXED" in output(bad.port, "status")


def test_a_second_program_is_kept_from_the_port(bad: BadLine):
    begun = threading.Event()
    bad.heard = lambda frame: begun.set()
    first = subprocess.Popen(
        [*LEVELWIND, "conformance"], env=environment(bad.port), stdout=subprocess.DEVNULL
    )
    try:
        assert begun.wait(60)
        assert "in use by another program" in refusal(bad.port, "status")
        assert "in use by another program" in refusal(bad.port, "conformance")
    finally:
        first.send_signal(signal.SIGINT)
        first.wait(60)
