# SPDX-License-Identifier: Apache-2.0
"""No edge is lost, whatever keeps the processor from it: the encoder is counted in hardware."""

import os

import numpy as np
import pytest
from levelwind.map_table import BenchCommand, Fault, Mode, State

from board.jitter import measure
from board.machine import CHANNEL_A, CHANNEL_B, IRQ0, Board, available
from board.ready import indexed

pytestmark = pytest.mark.skipif(bool(available()), reason=available())
pytest.importorskip("elftools.elf.elffile", reason="pyelftools is not installed")

from board.injection import LIVE_COUNT, NC  # noqa: E402
from board.operations import READ_LIVE  # noqa: E402

FLASH = 0x40023C00
KEYS = (0x45670123, 0xCDEF89AB)
FREE_SECTOR = 5  # behind the image, before the storage
EDGES_PER_S = 48_000
SLOW_EDGES_PER_S = 40
TOP_EDGES_PER_S = 1_000_000
TOP_PULSES_PER_REV = 2_500  # at 3,000 rpm of the drum
TOP_S = float(os.environ.get("LEVELWIND_TOP_SPEED_S", "0.5"))
LIVE = ("state", "flags", "m", "u", "pattern_edges", "position_usteps")
LATENCIES = [(1000, 0), (1300, 125)]
ENCODER = IRQ0 + 28
SWITCHES = IRQ0 + 23  # lines 5 to 9: one contact of each switch
REVERSAL_EDGES_PER_S = 400
POLLS, BOUNCES, BOUNCE_S = 20, 250, 20e-6


def erase(board: Board) -> None:
    """As no firmware does while the drum turns: the processor stands for a second."""
    for key in KEYS:
        board.poke(FLASH + 4, key)
    board.poke(FLASH + 0x10, 2 << 8 | FREE_SECTOR << 3 | 2 | 1 << 16)


def lost_edges(board: Board, before: tuple[int, int]) -> int:
    """Edges at the pins less those in the register, since both were as they were."""
    return (board.seen.edges - before[1]) - (board.value("net_edges") - before[0])


def counts(board: Board) -> tuple[int, int]:
    return board.value("net_edges"), board.seen.edges


@pytest.mark.parametrize(("cycles_permille", "phase_error_permille"), LATENCIES)
def test_none_is_lost_at_full_speed_with_an_erasure_in_the_middle(
    cycles_permille: int, phase_error_permille: int
):
    """The carriage cannot make up for a second at once: that is a fault, and told."""
    board = indexed(
        baud=115_200, cycles_permille=cycles_permille, phase_error_permille=phase_error_permille
    )
    before = counts(board)
    board.drum(EDGES_PER_S, 480_000)
    board.run(0.3)
    for _ in range(20):
        board.read(*LIVE)
    assert board.state == State.TRACKING
    erase(board)
    board.run(1.2)
    assert board.seen.stall_max_ns > 0.9e9
    for _ in range(20):
        board.read(*LIVE)
    board.stop_drum()
    assert lost_edges(board, before) == 0
    assert board.fault == Fault.STEPPER_ALARM
    assert board.read("missed_edges", "illegal_transitions") == {
        "missed_edges": 0,
        "illegal_transitions": 0,
    }


@pytest.mark.parametrize(("cycles_permille", "phase_error_permille"), LATENCIES)
def test_none_is_lost_at_full_speed_while_switches_bounce_and_modbus_is_polled(
    cycles_permille: int, phase_error_permille: int
):
    """A loose contact of either limit switch interrupts as often as every other edge."""
    board = indexed(
        baud=115_200, cycles_permille=cycles_permille, phase_error_permille=phase_error_permille
    )
    orbit = board.orbit()
    before = counts(board)
    board.drum(EDGES_PER_S, 480_000)
    board.run(0.3)
    answers = b""
    for poll in range(POLLS):
        board.send(READ_LIVE)
        for _ in range(BOUNCES):
            board.drive(NC[poll % 2], None)
            board.run(BOUNCE_S)
            board.drive(NC[poll % 2], 0)
            board.run(BOUNCE_S)
        answers += bytes(byte.value for byte in board.heard())
    assert len(answers) == POLLS * (5 + 2 * LIVE_COUNT)
    assert board.costs()[SWITCHES].count > POLLS * BOUNCES
    board.stop_drum()
    assert lost_edges(board, before) == 0
    board.check_follows(orbit)
    assert board.state == State.TRACKING


def test_a_drum_that_is_slow_enough_is_followed_through_an_erasure():
    board = indexed()
    orbit = board.orbit()
    board.drum(SLOW_EDGES_PER_S, 480_000)
    board.run(0.2)
    erase(board)
    board.run(1.5)
    assert board.seen.stall_max_ns > 0.9e9
    board.stop_drum()
    assert board.state == State.TRACKING
    board.check_follows(orbit)
    assert board.seen.edges > SLOW_EDGES_PER_S


@pytest.mark.parametrize(("cycles_permille", "phase_error_permille"), LATENCIES)
def test_none_is_lost_at_a_million_edges_per_second(
    cycles_permille: int, phase_error_permille: int
):
    """For half a second, or LEVELWIND_TOP_SPEED_S; twenty times what is allowed, so it trips."""
    board = indexed(
        baud=115_200,
        cycles_permille=cycles_permille,
        phase_error_permille=phase_error_permille,
        encoder_pulses_per_rev=TOP_PULSES_PER_REV,
    )
    before = counts(board)
    usual = 360 / TOP_PULSES_PER_REV  # drum() speaks of the usual encoder's edges
    board.drum(TOP_EDGES_PER_S * usual, 10 * TOP_EDGES_PER_S * usual)
    board.run(0.1)
    edges = board.seen.edges
    board.run(TOP_S)
    assert board.seen.edges - edges > 0.99 * TOP_EDGES_PER_S * TOP_S
    board.drum(0, 10 * TOP_EDGES_PER_S * usual)
    board.run(0.5)
    assert lost_edges(board, before) == 0
    assert board.state == State.FAULT
    assert board.value("missed_edges") == 0
    assert board.seen.resets_software + board.seen.resets_watchdog == 0


def test_a_step_waits_for_no_other_edge():
    """Edge to pulse, at any speed: the interrupt comes with the edge of the step."""
    for speed in (500, 3_000, 20_000):
        board = indexed()
        board.drum(speed, 480_000)
        board.run(0.2)
        board.clear_seen()
        board.run(1.0)
        assert board.seen.pulses > 0.1 * speed
        assert board.seen.edge_to_step_max_ns < 5_000, speed


def test_pulses_come_with_their_edges_and_edges_with_the_ideal_screw():
    jitter = measure(EDGES_PER_S)
    assert len(jitter.total_us) > 1_000
    assert jitter.edge_us.max() < 1e6 / EDGES_PER_S + 0.2
    assert jitter.interrupt_us.max() < 5
    assert np.percentile(jitter.interrupt_us, 90) - jitter.interrupt_us.min() < 0.2


def test_a_fast_drum_interrupts_once_a_step_and_a_slow_one_with_every_transition():
    board = indexed()
    for speed, least, most in ((20_000, 0.3, 0.6), (REVERSAL_EDGES_PER_S, 1.9, 2.1)):
        board.drum(speed, 480_000)
        board.run(0.2)
        board.clear_seen()
        board.run(0.5)
        count = board.costs()[ENCODER].count
        assert least < count / board.seen.edges < most, speed


@pytest.mark.parametrize("channel", [CHANNEL_A, CHANNEL_B], ids="AB")
def test_each_change_of_a_channel_that_changes_alone_is_seen(channel: tuple[int, int]):
    """The drum watch needs them: it is a drum that rocks, or a channel that is dead."""
    board = indexed()
    before = board.read("net_edges", "encoder_doubts")
    board.mode(Mode.OFF)
    for _ in range(2000):
        board.drive(channel, int(not board.level(channel)))
        board.run(20.8e-6)
    assert board.value("net_edges") - before["net_edges"] in (-1, 0, 1)
    assert board.value("encoder_doubts") == before["encoder_doubts"] + 1


@pytest.mark.parametrize("mode", [Mode.TRACK, Mode.OFF], ids=lambda mode: mode.name.lower())
@pytest.mark.parametrize("speed", [6_000, EDGES_PER_S])
def test_lost_pulses_are_found_by_the_next_index_pulse(speed: int, mode: Mode):
    """However many transitions are still to be taken when it comes."""
    board = indexed()
    board.mode(mode)
    board.drum(speed, 480_000)
    board.run(0.5)
    for losses in range(1, 9):
        board.write(bench_argument=3, bench_command=BenchCommand.LOSE_PULSES)
        board.run(720 / speed + 0.01)
        assert board.value("missed_edges") == losses * 3 * 2  # two edges per pulse


@pytest.mark.parametrize("channel", [CHANNEL_A, CHANNEL_B], ids="AB")
def test_a_wire_that_breaks_on_a_fast_drum_is_told(channel: tuple[int, int]):
    board = indexed()
    board.drum(EDGES_PER_S, 480_000)
    board.run(0.3)
    assert board.state == State.TRACKING
    level = int(board.level(channel))
    for _ in range(20_000):
        board.drive(channel, level)
        board.run(5e-6)
    assert "encoder_fault" in board.flags, board.flags
