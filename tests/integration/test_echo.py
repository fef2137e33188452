# SPDX-License-Identifier: Apache-2.0
"""A line that gives back what the slave sends on it."""

import termios
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from levelwind.map_table import Command, Flag, Result, State
from slave import RawLine, Slave

# A pseudo terminal gives the echo back at once, but a busy computer reads it some milliseconds
# late; what comes a frame's silence late is no echo.
SIMULATOR_OPTIONS = ("--frame-silence-ms", "20")
STOP = bytes.fromhex("06 0000 0002")
READ_SELF_TEST = bytes.fromhex("04 0000 0002")
SELF_TEST_ANSWER = bytes.fromhex("04 04 12345678")


@pytest.fixture(autouse=True)
def an_echo_in_time(target: str) -> None:
    if target == "board":
        pytest.skip("a terminal's echo comes later than a wire's; the wire's: tests/board")


@contextmanager
def echo(slave: Slave) -> Iterator[None]:
    """Whatever the slave sends comes back to it: the pseudo terminal's own echo."""
    with Path(slave.port).open("rb", buffering=0) as terminal:
        before = termios.tcgetattr(terminal)
        echoing = termios.tcgetattr(terminal)
        echoing[3] = echoing[3] & ~termios.ECHOCTL | termios.ECHO
        termios.tcsetattr(terminal, termios.TCSANOW, echoing)
        yield
        termios.tcsetattr(terminal, termios.TCSANOW, before)


def test_a_command_runs_once(slave: Slave, raw: RawLine) -> None:
    sequence = slave.read("command_sequence")
    with echo(slave):
        for runs in range(1, 6):
            assert raw.request(STOP) == STOP
            slave.settle(500)
            assert slave.read("command_sequence") == (sequence + runs) & 0xFFFF
        exceptions = slave.read("exceptions")
        assert raw.request(b"\x63") == b"\xe3\x01"
        assert slave.read("exceptions") == exceptions + 1
    assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER


def test_a_jog_ends_by_itself(slave: Slave, raw: RawLine) -> None:
    with echo(slave):
        jog = bytes.fromhex("06 0002 0001")
        assert raw.request(jog) == jog
        slave.wait(lambda: slave.read("state") == State.JOGGING)
        slave.wait(lambda: slave.read("state") != State.JOGGING, 2000)


def test_the_master_is_missed(slave: Slave, raw: RawLine) -> None:
    assert slave.write("master_timeout_ms", 1000) == 0
    assert slave.command(Command.APPLY) == Result.DONE
    with echo(slave):
        assert raw.request(STOP) == STOP
        time.sleep(1.5)
        assert slave.flag(Flag.MASTER_LOST)
