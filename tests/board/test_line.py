# SPDX-License-Identifier: Apache-2.0
"""A line that gives back what the image sends, byte by byte, and one that somebody fills."""

import pytest
from levelwind.map_table import Command, State
from slave import sealed

from board.machine import UNIT, Board, available
from board.ready import indexed

pytestmark = pytest.mark.skipif(bool(available()), reason=available())

RATES = [1_200, 19_200, 115_200]
STOP = bytes.fromhex("06 0000 0002")
READ_SELF_TEST = bytes.fromhex("04 0000 0002")
SELF_TEST_ANSWER = bytes.fromhex("04 04 12345678")
UNKNOWN = b"\x63"
REFUSED = b"\xe3\x01"
JOG_ENDS_S = 2.0
MASTER_TIMEOUT_MS = 1000
QUIET_S = 0.5
BABBLE = 1000


def answer(board: Board, pdu: bytes) -> bytes:
    """The one answer to a request, with silence behind it."""
    whole = board.exchange(sealed(bytes([UNIT]) + pdu))
    board.run(QUIET_S)
    assert board.heard() == [], "the echo was answered, too"
    return whole[1:-2]


@pytest.mark.parametrize("baud", RATES)
def test_what_comes_back_is_no_request_at_any_rate(baud: int):
    """It is the same frame as a write's: it would be done once more."""
    board = indexed(baud=baud, line_echo=1)
    before = board.read("command_sequence", "exceptions", "line_echoes")
    for _ in range(5):
        assert answer(board, STOP) == STOP
    assert answer(board, UNKNOWN) == REFUSED
    assert answer(board, READ_SELF_TEST) == SELF_TEST_ANSWER
    after = board.read("command_sequence", "exceptions", "line_echoes")
    assert after["command_sequence"] == before["command_sequence"] + 5
    assert after["exceptions"] == before["exceptions"] + 1
    assert after["line_echoes"] > before["line_echoes"]
    assert "line_echo" in board.flags


def test_without_an_echo_none_is_told():
    board = indexed()
    assert answer(board, STOP) == STOP
    assert board.value("line_echoes") == 0
    assert "line_echo" not in board.flags


def test_a_jog_ends_though_its_request_comes_back():
    board = indexed(line_echo=1)
    board.write(command=Command.STOP)
    assert board.state == State.READY
    board.write(jog=1)
    board.run_until(lambda: board.state == State.JOGGING, limit_s=0.5)
    board.run_until(lambda: board.state != State.JOGGING, limit_s=JOG_ENDS_S, step_s=0.05)


def test_a_master_that_is_gone_is_missed_though_the_line_gives_back_an_answer():
    board = indexed(line_echo=1)
    board.write(command=Command.STOP)
    board.apply(master_timeout_ms=MASTER_TIMEOUT_MS)
    assert answer(board, STOP) == STOP
    board.run(MASTER_TIMEOUT_MS / 1000)
    assert "master_lost" in board.flags


@pytest.mark.parametrize("noise", [b"\x55", b"\x00", b"\xff"], ids=lambda noise: noise.hex())
def test_babble_that_fills_the_line_does_not_end_a_launch(noise: bytes):
    """Bytes without a gap, at the highest rate: an interrupt for each, and no frame ever ends."""
    board = indexed(baud=115_200)
    orbit = board.orbit()
    board.drum(24_000, 240_000)
    board.run(0.2)
    errors = board.value("crc_errors")
    for _ in range(10):
        board.send(noise * BABBLE)
        board.run_ns(BABBLE * board.char_ns)
    board.run(0.1)
    assert answer(board, READ_SELF_TEST) == SELF_TEST_ANSWER
    assert board.seen.resets_software + board.seen.resets_watchdog == 0
    assert board.value("crc_errors") > errors
    board.stop_drum()
    board.check_follows(orbit)
    assert board.state == State.TRACKING
