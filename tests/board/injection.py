# SPDX-License-Identifier: Apache-2.0
"""One interrupt at every instruction of an operation, and what it makes of the controller.

A walk goes from a kept board on, instruction by instruction, for as long as the operation may take.
At each place it keeps the board, lets the interrupt come before the very next instruction, plays a
few more edges to the end, looks at the controller's memory, and goes back.

The judge knows nothing of the code: where the processor sleeps, nothing is under way, so what an
interrupt makes of the controller there is right by definition. Between two sleeps the interrupt has
to make one of the two things that it makes in the sleeps before and behind: what is between them
has then been done before the interrupt or after it, to the last bit of every member.
"""

import os
import re
from collections.abc import Callable
from typing import NamedTuple

from levelwind.map_table import POINTS

from board.image import ELF, members, symbol
from board.machine import CHANNEL_A, CHANNEL_B, PA, PB, Board

STRIDE = int(os.environ.get("LEVELWIND_INJECTION_STRIDE", "211"))
SETTLE_S = 0.003  # what the interrupt has begun: threads, ticks, pulses
EDGE_S, TIMER_EDGE_S = 0.0001, 0.0003
END_S = 0.0015
MORE_EDGES = 3
STEP_MAX = 5  # an IT and what it covers, where no interrupt is injected

TIM4 = 0x40000800  # the edge timer: control, events, count, period
CR1, EGR, CNT, ARR = TIM4, TIM4 + 0x14, TIM4 + 0x24, TIM4 + 0x2C
SLOWLY = 0xFFFF  # 16 ms of its 4 MHz: no edge comes by itself while one is injected
NO, NC = ((PB, 4), (PB, 10)), ((PB, 5), (PA, 7))  # contacts of the limit switches, by side
OVERTRAVEL = ((PB, 8), (PB, 9))
PLUS, MINUS = 0, 1

# Of struct lw_device: what the state is. Not: times, and what is measured from tick to tick.
WHOLE = re.compile(r"controller\.|command\.(code|result|why)|line\.|write_watch\.begin|active\.")
TIMES = re.compile(
    r"_us\b|\.time_ms$|\.speed\.|\.drum_watch\.(?!doubtful|fault)|\.timer_edges_left$"
    r"|\.rope\.(\w*edges|last_q16)$|\.resume\.stand_usteps$"
)
# A reading of the live status, and what in it is measured from tick to tick.
LIVE_FIRST, LIVE_COUNT = 100, 31
LIVE_MEASURED = ("drum_speed_edges_per_s", "rope_speed_mm_per_s")
# Which of the two buffers a window is in is no state: its content is compared.
BUFFERS = re.compile(r"controller\.(windows\[|motion\.(request_)?window$)")
REQUESTS, WITH_WINDOW = "controller.motion.requests", 0b1101


class Outcome(NamedTuple):
    """What is compared."""

    memory: bytes  # of the controller's state, times blanked
    windows: tuple[bytes, ...]  # in force, and waiting
    steps: int  # pulses at the pin, with their direction
    answer: bytes  # on the line


def without_measures(answer: bytes) -> bytes:
    """An answer without what is measured from tick to tick, and the CRC over it."""
    if answer[1:3] != bytes([4, 2 * LIVE_COUNT]):
        return answer
    kept = bytearray(answer[:-2])
    for name in LIVE_MEASURED:
        at = 3 + 2 * (POINTS[name].address - LIVE_FIRST)
        kept[at : at + 4] = bytes(4)
    return bytes(kept)


class Place(NamedTuple):
    """One injection."""

    instruction: int
    asleep: bool  # nothing was under way
    address: int  # of the instruction that came next
    outcome: Outcome


class TornError(AssertionError):
    """An interrupt has made what it makes neither before nor after the operation."""


class Walk(NamedTuple):
    """All injections into one operation."""

    places: list[Place]
    none: Outcome  # without an interrupt

    def check(self, may_be_left_out: bool = False) -> None:
        """Each between two sleeps has the outcome of one of them.

        `may_be_left_out`: or that of no interrupt at all, as with an edge of the edge timer, which
        is no more than a moment in which the carriage may move.
        """
        before = None
        waiting: list[Place] = []
        for place in self.places:
            if not place.asleep:
                waiting.append(place)
                continue
            for one in waiting:
                whole = [end.outcome for end in (before, place) if end is not None]
                whole += [self.none] if may_be_left_out else []
                if one.outcome not in whole:
                    raise TornError(told(one, whole))
            before, waiting = place, []

    @property
    def outcomes(self) -> int:
        """How many different ones there are."""
        return len({place.outcome for place in self.places})


def device() -> tuple[int, int, list[int]]:
    """Address and size of the image's device, and which bytes of it are compared."""
    size, leaves = members("lw_device", ELF)
    compared = [
        byte
        for leaf in leaves
        if WHOLE.match(leaf.path) and not TIMES.search(leaf.path) and not BUFFERS.search(leaf.path)
        for byte in range(leaf.offset, leaf.offset + leaf.size)
    ]
    return symbol("app_device", ELF), size, compared


def told(place: Place, whole: list[Outcome]) -> str:
    """Where it was, and what of it is neither nor."""
    leaves = {leaf.path: leaf for leaf in members("lw_device", ELF)[1]}
    lines = [f"before instruction {place.instruction}, at 0x{place.address:08x}:"]
    for path, leaf in leaves.items():
        values = [
            int.from_bytes(one.memory[leaf.offset : leaf.offset + leaf.size], "little")
            for one in (place.outcome, *whole)
        ]
        if len(set(values)) > 1:
            lines.append(f"{path}: {values[0]}, whole: {values[1:]}")
    for name in ("windows", "steps", "answer"):
        values = [getattr(one, name) for one in (place.outcome, *whole)]
        if len(set(values)) > 1:
            lines.append(f"{name}: {values[0]!r}, whole: {values[1:]!r}")
    return "\n".join(lines)


# ---- interrupts ----------------------------------------------------------------------------------


def edge(board: Board) -> None:
    """Channel A changes, and has passed the filter: an edge of the drum."""
    board.drive(CHANNEL_A, int(not board.level(CHANNEL_A)))
    board.pass_filters()


def contact(side: int) -> Callable[[Board], None]:
    """The NO contact of a limit switch changes."""

    def change(board: Board) -> None:
        board.drive(NO[side], None if not board.level(NO[side]) else 0)

    return change


def timer_edge(board: Board) -> None:
    """The edge timer runs over."""
    board.poke(EGR, 1)


def more_edges(board: Board) -> None:
    """A few edges on, of the drum and of the edge timer where it runs: all that waits is taken."""
    for _ in range(MORE_EDGES):
        board.drive(CHANNEL_B, int(not board.level(CHANNEL_B)))
        board.pass_filters()
        board.run(EDGE_S)
        edge(board)
        board.run(EDGE_S)
    if board.peek(CR1) & 1:
        for _ in range(MORE_EDGES):
            timer_edge(board)
            board.run(TIMER_EDGE_S)
    board.run(END_S)


# ---- walks ---------------------------------------------------------------------------------------


class Injector:
    """Walks through the operations of one board."""

    def __init__(self, board: Board) -> None:
        self.board = board
        self.address, self.size, compared = device()
        self.mask = bytearray(self.size)
        for byte in compared:
            self.mask[byte] = 0xFF
        self.mask_number = int.from_bytes(self.mask, "little")
        self.leaves = {leaf.path: leaf for leaf in members("lw_device", ELF)[1]}
        self.window_size = members("lw_law_window", ELF)[0]

    def _value(self, memory: bytes, path: str) -> int:
        leaf = self.leaves[path]
        return int.from_bytes(memory[leaf.offset : leaf.offset + leaf.size], "little")

    def _windows(self, memory: bytes) -> tuple[bytes, ...]:
        pointers = ["controller.motion.window"]
        if self._value(memory, REQUESTS) & WITH_WINDOW:
            pointers.append("controller.motion.request_window")
        return tuple(
            self.board.ram(self._value(memory, pointer), self.window_size) for pointer in pointers
        )

    def _outcome(self) -> Outcome:
        board = self.board
        memory = board.ram(self.address, self.size)
        compared = int.from_bytes(memory, "little") & self.mask_number
        windows, steps = self._windows(memory), board.seen.steps
        while not board.line_idle:  # a whole answer, however late it began
            board.run(END_S)
        answer = bytes(byte.value for byte in board.heard())
        memory_compared = compared.to_bytes(self.size, "little")
        return Outcome(memory_compared, windows, steps, without_measures(answer))

    def _inject(self, interrupt: Callable[[Board], None] | None, settled_ns: int) -> Outcome:
        board = self.board
        state = board.save()
        if interrupt is not None:
            interrupt(board)
        board.run_ns(settled_ns - board.now_ns)
        more_edges(board)
        outcome = self._outcome()
        board.restore(state)
        board.forget(state)
        return outcome

    def walk(
        self,
        interrupt: Callable[[Board], None],
        window_s: float,
        stride: int = STRIDE,
        first: int = 0,
    ) -> Walk:
        """From where the board stands, `window_s` on; it stands at the end then.

        Where the processor sleeps an interrupt is injected whatever the stride, for the judge.
        """
        board = self.board
        end_ns = board.now_ns + round(window_s * 1e9)
        settled_ns = end_ns + round(SETTLE_S * 1e9)
        places: list[Place] = []
        none = self._inject(None, settled_ns)
        instruction, due = 0, first
        while board.now_ns < end_ns:
            asleep = board.asleep
            if asleep or instruction >= due or not places:
                outcome = self._inject(interrupt, settled_ns)
                places.append(Place(instruction, asleep, board.register(15), outcome))
                if not asleep:
                    due = instruction + stride
            done = board.run_instructions(1, (end_ns - board.now_ns) / 1e9)
            if done == 0:
                break
            assert done <= STEP_MAX, "not every instruction"
            instruction += done
        while not board.asleep and board.now_ns < settled_ns:
            instruction += board.run_instructions(1, SETTLE_S)
        outcome = self._inject(interrupt, settled_ns)
        places.append(Place(instruction, True, board.register(15), outcome))
        return Walk(places, none)
