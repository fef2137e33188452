# SPDX-License-Identifier: Apache-2.0
"""Whatever hangs, a thread or an interrupt: the board restarts, tells it, and nothing moves.

What there is to hang is asked of the image, so that a thread or an interrupt that is new is tried
without a word here.
"""

from collections.abc import Callable

import pytest
from levelwind.map_table import Command, Mode, State

from board.machine import IRQ0, PC, READ_STATE, Board, available, frame
from board.ready import indexed

pytestmark = pytest.mark.skipif(bool(available()), reason=available())
pytest.importorskip("elftools.elf.elffile", reason="pyelftools is not installed")

from board.image import symbol  # noqa: E402

HANG = 0xE7FDBF30  # wfi, b to it; in RAM that nothing uses
HANG_AT = 0x2001F000
ENABLED = 0xE000E100  # NVIC_ISER0
ICSR = 0xE000ED04
IRQS = 97
CURRENT = 8  # in the kernel's first processor: the thread that runs
# In the order of enum watch_thread: missed so long after the last report. An erasure takes seconds.
WATCHED = {"supervisor": 1.2, "limits": 1.2, "modbus": 1.2, "storage": 5.2}
ALONE_UM = 6_000  # 50 ms of the index rate, and coasting
DRUM_STOPS_UM = 20_000  # while the drum slows down from 48,000 edges/s
HARDWARE_S = 10.0  # what task_wdt cannot see: 6.3 s of an LSI at 32 kHz, and a start
COMES_S = 1.0  # a traverse: the carriage passes a switch


def launched() -> Board:
    """In a launch, with a master that polls: whatever may interrupt does."""
    board = indexed(baud=115_200)
    board.drum(48_000, 480_000)
    board.run(0.3)
    return board


def begin_indexing(board: Board) -> None:
    """The carriage moves by itself toward a switch."""
    board.stop_drum()
    board.run(0.5)
    board.write(command=Command.INDEX)
    board.run_until(lambda: board.state == State.SEEKING, step_s=0.01)


def hang(board: Board) -> None:
    """Here, for ever."""
    board.poke(HANG_AT, HANG)
    board.set_register(15, HANG_AT | 1)


def check_restarted(board: Board, before: dict[str, int]) -> None:
    """Once, told, without current, and it does not move."""
    board.stop_drum()
    board.run(0.6)
    after = board.read("boots", "watchdog_resets")
    assert board.seen.resets_software + board.seen.resets_watchdog == 1
    assert after["boots"] == before["boots"] + 1
    assert after["watchdog_resets"] == before["watchdog_resets"] + 1
    assert "watchdog_reset" in board.flags
    assert board.state in (State.UNINDEXED, State.FAULT)
    assert not board.permit


@pytest.mark.parametrize(("thread", "limit_s"), WATCHED.items())
def test_a_thread_that_hangs_is_missed(thread: str, limit_s: float):
    board = launched()
    before = board.read("boots", "watchdog_resets")
    at = board.peek(symbol("threads") + 4 * list(WATCHED).index(thread))
    kernel = symbol("_kernel")

    def runs() -> bool:
        in_thread = board.peek(ICSR) & 0x1FF == 0 and not board.masked
        return in_thread and board.peek(kernel + CURRENT) == at

    if thread == "storage":  # it works only where something is to be stored
        board.stop_drum()
        board.mode(Mode.OFF)
        board.run(0.5)
        board.send(frame(command=Command.SAVE))
    elif thread == "modbus":
        board.send(READ_STATE)
    board.run_until(runs, step_s=2e-6, limit_s=COMES_S)
    board.clear_seen()
    hang(board)
    board.run_until(lambda: board.seen.resets_software > 0, step_s=0.05, limit_s=limit_s)
    check_restarted(board, before)


def interrupts() -> list[int]:
    """Of the image: those that it enables."""
    if available():
        return []
    board = launched()
    words = [board.peek(ENABLED + 4 * word) for word in range((IRQS + 31) // 32)]
    return [irq for irq in range(IRQS) if words[irq // 32] >> irq % 32 & 1]


STIMULI: dict[str, Callable[[Board], None]] = {
    "a launch": lambda board: None,
    "a request": lambda board: board.send(READ_STATE),
    "the button": lambda board: board.drive((PC, 13), 0),
    "an indexing": begin_indexing,
}


@pytest.mark.parametrize("stimulus", STIMULI)
def test_an_interrupt_that_hangs_ends_in_a_restart_and_the_carriage_hits_nothing(stimulus: str):
    board = launched()
    before = board.read("boots", "watchdog_resets")
    STIMULI[stimulus](board)
    state = board.save()
    hung = []
    for irq in interrupts():
        board.restore(state)
        if not board.run_to_exception(IRQ0 + irq, COMES_S):
            continue
        hung.append(irq)
        board.clear_seen()
        from_um = board.truth.carriage_um
        board.hang_handler()
        board.drum(0, 480_000)
        board.run(HARDWARE_S)
        by_um = abs(board.truth.carriage_um - from_um)
        assert by_um < (ALONE_UM if stimulus == "an indexing" else DRUM_STOPS_UM), irq
        check_restarted(board, before)
    print(f"{stimulus}: hung {hung}")
    assert len(hung) >= 2
