# SPDX-License-Identifier: Apache-2.0
"""Hand-overs between threads and interrupts, each up to the moment in which it begins."""

import functools
from collections.abc import Callable
from typing import NamedTuple

from levelwind.cam.table import Table, words
from levelwind.map_table import Command, Mode, Result, State
from slave import sealed

from board.image import member, symbol
from board.injection import (
    ARR,
    EGR,
    LIVE_COUNT,
    LIVE_FIRST,
    MINUS,
    NC,
    NO,
    OVERTRAVEL,
    PLUS,
    SLOWLY,
)
from board.machine import Board, frame
from board.ready import indexed

BEFORE_S = 0.0016  # of the silence that ends a frame, 1.75 ms
REQUEST_S = 0.0014  # the rest of it, the request, a tick behind it
PIN_S = 0.0022  # its interrupt, the thread behind it, a tick or two
WRITE_S = 0.004  # of the flash, too
BAUD = 115_200
SLOW_EDGES_PER_S = 100
HILL = Table(((0, 0), (1000, 1500), (3000, -500), (4000, 0)), name="hill", version=1)
OTHER = Table(((0, 0), (500, -900), (1500, 0)), name="other", version=2)
CAM_FILES = (2, 3)
WORDS_MAX = 100
READ_LIVE = sealed(bytes([1, 4, 0, LIVE_FIRST, 0, LIVE_COUNT]))


class Operation(NamedTuple):
    """What is interrupted."""

    prepare: Callable[[], Board]  # a board that stands, with nothing under way
    begin: Callable[[Board], None]
    window_s: float = REQUEST_S
    timer: bool = False  # the edge timer runs, or begins to
    side: int = PLUS  # of the limit switch that is injected


def sends(data: bytes) -> Callable[[Board], None]:
    """A request, up to shortly before it is taken."""

    def send(board: Board) -> None:
        board.heard()
        board.send(data)
        board.run_ns(len(data) * board.char_ns)
        board.run(BEFORE_S)

    return send


def kept(prepare: Callable[[], Board]) -> Callable[[], Board]:
    """Made once."""

    @functools.cache
    def made() -> tuple[Board, int]:
        board = prepare()
        board.run(0.02)
        return board, board.save()

    def again() -> Board:
        board, state = made()
        return board.restore(state)

    return again


# ---- following the drum --------------------------------------------------------------------------


def follow() -> Board:
    """In a sweep toward plus, the drum at rest."""
    board = indexed(baud=BAUD)
    board.drum(24_000, 240_000)
    board.run_until(lambda: board.value("pattern_edges") > 20_000)
    board.stop_drum()
    for _ in range(20):
        if board.in_sweep() and board.value("u") > 0:
            break
        board.drum(6_000, 240_000)
        board.run(0.3)
        board.stop_drum()
    assert board.in_sweep() and board.value("u") > 0
    assert board.state == State.TRACKING
    return board


@kept
def following() -> Board:
    return follow()


def trip(board: Board, side: int) -> None:
    """A limit switch actuates: its pair of contacts changes over."""
    board.drive(NC[side], None)
    board.run(0.0002)
    board.drive(NO[side], 0)


def release(board: Board, side: int) -> None:
    board.drive(NO[side], None)
    board.run(0.0002)
    board.drive(NC[side], 0)
    board.run(0.002)


def closes(side: int) -> Callable[[Board], None]:
    """The second contact of a pair, which is the trigger."""

    def close(board: Board) -> None:
        board.drive(NO[side], 0)

    return close


@kept
def trimmed() -> Board:
    """A window waits for the next edge."""
    board = following()
    board.write(trim_plus_um=-500)
    return board


@kept
def in_transit() -> Board:
    """One contact of the switch ahead has opened, the other is about to close."""
    board = following()
    board.run(0.0003)
    return board


def opens_and_closes(side: int) -> Callable[[Board], None]:
    """Both contacts, one after the other, within one injected window."""

    def change(board: Board) -> None:
        board.drive(NC[side], None)
        board.run(0.0004)
        board.drive(NO[side], 0)

    return change


@kept
def corrected() -> Board:
    """A LOS has been told, its correction waits for the next edge."""
    board = following()
    trip(board, PLUS)
    board.run(0.005)
    release(board, PLUS)
    assert "correction_pending" in board.flags
    return board


@kept
def half_corrected() -> Board:
    """As corrected(), by half: the next trigger changes what waits."""
    board = corrected()
    path = "controller.motion.request_correction_usteps"
    waiting = symbol("app_device") + member("lw_device", path).offset
    board.poke(waiting, board.peek(waiting) // 2)
    return board


@kept
def held() -> Board:
    """Ready, and held there."""
    board = following()
    board.write(command=Command.STOP)
    assert board.state == State.READY
    return board


def move_slowly(board: Board) -> Board:
    """What is to move will do so at 100 edges/s: none comes but those that are injected."""
    for copy in ("active", "set_copy.params"):
        path = f"{copy}.index_rate_edges_per_s"
        board.poke(symbol("app_device") + member("lw_device", path).offset, SLOW_EDGES_PER_S)
    return board


@kept
def following_slowly() -> Board:
    return move_slowly(following())


@kept
def held_slowly() -> Board:
    return move_slowly(held())


@kept
def to_apply() -> Board:
    """Ready, with another set staged."""
    board = held()
    board.write(reversal_plus_um=board.value("reversal_plus_um") - 100)
    return board


def write_table(board: Board, file: int, table: Table) -> None:
    data = words(table)
    for at in range(0, len(data), WORDS_MAX):
        part = data[at : at + WORDS_MAX]
        head = [file, at, len(part), *part]
        group = b"\6" + b"".join(word.to_bytes(2, "big") for word in head)
        answer = board.request(bytes([21, len(group)]) + group)
        assert answer[0] == 21, answer


@kept
def by_cam() -> Board:
    """Following a table, another one checked."""
    board = Board()
    board.apply(park_at=1, park_position_um=0, baud_rate=BAUD)
    assert board.command(Command.SAVE) == Result.DONE
    board.line_settings(BAUD, "E")
    board.power_cycle()
    for file, table in zip(CAM_FILES, (HILL, OTHER), strict=True):
        write_table(board, file, table)
        assert board.command(Command.CAM_CHECK) == Result.DONE
        if table is HILL:
            assert board.command(Command.CAM_ACTIVATE) == Result.DONE
            board.apply(motion_profile=1)
    board.index()
    board.run_until(lambda: board.state == State.TRACKING, step_s=0.05)
    board.drum(8_000, 240_000)
    board.run(0.2)
    board.stop_drum()
    return board


# ---- moved by the edge timer ---------------------------------------------------------------------


def slowly(board: Board) -> Board:
    """The timer's edges are held up, but for those that are injected."""
    board.poke(ARR, SLOWLY)
    board.poke(EGR, 1)
    board.run(0.0015)
    return board


def index_until(board: Board, state: State) -> Board:
    board.write(command=Command.INDEX)
    board.run_until(lambda: board.state == state, step_s=0.002)
    return board


@kept
def seeking() -> Board:
    """On the way to the indexing switch, off the ramp."""
    board = index_until(held(), State.SEEKING)
    board.run(0.3)
    board.drive(NC[PLUS], None)
    return slowly(board)


@kept
def leaving() -> Board:
    """Off a switch that was actuated."""
    board = held()
    trip(board, PLUS)
    board.run(0.005)
    index_until(board, State.BACKING_OFF)
    board.run(0.2)
    board.drive(NO[PLUS], None)
    return slowly(board)


@kept
def span() -> Board:
    """Near the other switch, which is about to trigger where it should."""
    board = index_until(held(), State.SPAN_CHECK)
    tolerance = board.read("switch_minus_um", "span_tolerance_um")
    near_um = tolerance["switch_minus_um"] + tolerance["span_tolerance_um"] * 3 // 4
    board.run_until(lambda: board.value("position_um") < near_um, step_s=0.001)
    board.drive(NC[MINUS], None)
    return slowly(board)


@kept
def jogging() -> Board:
    """By hand, toward minus."""
    board = held()
    board.apply(jog_hold_ms=5000)
    board.write(jog=-1)
    board.run(0.3)
    assert board.state == State.JOGGING
    return slowly(board)


OPERATIONS: dict[str, Operation] = {
    "trim": Operation(following, sends(frame(trim_plus_um=-300))),
    "trim while a window waits": Operation(
        trimmed, sends(frame(trim_plus_um=-300, trim_minus_um=400))
    ),
    "limit switch, and its correction": Operation(
        following, opens_and_closes(PLUS), PIN_S, side=MINUS
    ),
    "limit switch while a correction waits": Operation(
        corrected, opens_and_closes(PLUS), PIN_S, side=MINUS
    ),
    "limit switch that changes a waiting correction": Operation(
        half_corrected, opens_and_closes(PLUS), PIN_S, side=MINUS
    ),
    "stop": Operation(following, sends(frame(command=Command.STOP))),
    "stop while a correction waits": Operation(corrected, sends(frame(command=Command.STOP))),
    "mode off": Operation(following, sends(frame(mode=Mode.OFF))),
    "mode centre": Operation(following_slowly, sends(frame(mode=Mode.CENTRE)), timer=True),
    "hand-over to the drum": Operation(held, sends(frame(mode=Mode.TRACK))),
    "overtravel": Operation(following, lambda board: board.drive(OVERTRAVEL[PLUS], None), PIN_S),
    "clear fault": Operation(following, sends(frame(command=Command.CLEAR_FAULT))),
    "save": Operation(held, sends(frame(command=Command.SAVE)), WRITE_S),
    "apply": Operation(to_apply, sends(frame(command=Command.APPLY))),
    "status": Operation(following, sends(READ_LIVE)),
    "status while a window waits": Operation(trimmed, sends(READ_LIVE)),
    "cam bank": Operation(by_cam, sends(frame(command=Command.CAM_ACTIVATE))),
    "index begins": Operation(held_slowly, sends(frame(command=Command.INDEX)), timer=True),
    "index: trigger, rebase": Operation(seeking, closes(PLUS), PIN_S, timer=True, side=MINUS),
    "index: released, swap": Operation(
        leaving, lambda board: board.drive(NC[PLUS], 0), PIN_S, timer=True, side=MINUS
    ),
    "index: span, window": Operation(span, closes(MINUS), PIN_S, timer=True),
    "index: stop": Operation(seeking, sends(frame(command=Command.STOP)), timer=True),
    "index: overtravel": Operation(
        seeking, lambda board: board.drive(OVERTRAVEL[PLUS], None), PIN_S, timer=True
    ),
    "jog ends": Operation(jogging, sends(frame(jog=0)), timer=True),
}
