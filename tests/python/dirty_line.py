# SPDX-License-Identifier: Apache-2.0
"""A line that is not clean, on virtual time: between the tool and a whole machine in this process.

It may return what is sent, add bytes, cut frames in pieces, damage or lose them, and let frames of
other units pass. What was sent over it, and what of that the controller has done, is kept: the
judge of what the tool says afterwards.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest
from levelwind.cli import app
from levelwind.conformance.line import sealed
from levelwind.line import rtu
from levelwind.line.port import Line
from typer.testing import CliRunner, Result
from world import World

READS = {1, 2, 3, 4, 20}
FRAME_GAP_S = 0.01
ENDLESS_S = 0.005  # between the bytes that do not end


@dataclass
class Sent:
    """One request of the tool, and what became of it."""

    frame: bytes
    answer: bytes = b""  # of the controller; none: it has not got the request
    delivered: bool = False  # an undamaged answer reached the tool

    @property
    def reading(self) -> bool:
        return self.frame[1] in READS

    @property
    def executed(self) -> bool:
        """The controller did what was asked."""
        return bool(self.answer) and not self.answer[1] & 0x80


Pieces = list[tuple[float, bytes]]
"""What comes to the tool: seconds after the last, bytes."""


@dataclass
class DirtyLine:
    """The port, the clock, and the machine behind them."""

    world: World
    carry: Callable[[Sent, Callable[[bytes], bytes]], Pieces]
    """What the line does with a request; it is given the honest controller."""
    now_s: float = 1000.0
    sent: list[Sent] = field(default_factory=list)
    endless: bytes = b""
    timeout: float = 0.0
    _coming: Pieces = field(default_factory=list)
    _owed_s: float = 0.0

    # ---- time ----

    def monotonic(self) -> float:
        self.sleep(1e-6)  # who waits by looking at the clock must see it go on
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds
        self._owed_s += seconds

    # ---- what the tool sees of serial.Serial ----

    @property
    def port(self) -> str:
        return "/dev/dirty"

    def _due(self) -> bytes:
        due = b"".join(data for at, data in self._coming if at <= self.now_s)
        self._coming = [piece for piece in self._coming if piece[0] > self.now_s]
        return due

    @property
    def in_waiting(self) -> int:
        return sum(len(data) for at, data in self._coming if at <= self.now_s)

    def read(self, size: int) -> bytes:
        if size == 0:
            return b""
        end_s = self.now_s + self.timeout
        got = b""
        while len(got) < size:
            got += self._due()
            if len(got) >= size:
                break
            if self.endless:
                self._coming.append((self.now_s + ENDLESS_S, self.endless))
            following = min((at for at, _ in self._coming), default=end_s)
            if following > end_s or not self._coming:
                self.sleep(max(0.0, end_s - self.now_s))
                break
            self.sleep(following - self.now_s)
        if len(got) > size:
            self._coming.insert(0, (self.now_s, got[size:]))
        return got[:size]

    def reset_input_buffer(self) -> None:
        self._due()

    def write(self, frame: bytes) -> int:
        self.sent.append(Sent(bytes(frame)))
        at_s = self.now_s
        for after_s, data in self.carry(self.sent[-1], self.honest):
            at_s += after_s
            self._coming.append((at_s, data))
        return len(frame)

    def flush(self) -> None:
        pass

    def close(self) -> None:
        pass

    # ---- the controller ----

    def settle(self) -> None:
        """Let the machine catch up with the clock."""
        self.world.run(self._owed_s)
        self._owed_s = 0.0

    def honest(self, frame: bytes) -> bytes:
        """What the controller answers to this, after its silence."""
        self.settle()
        answer = self.world.line(frame, FRAME_GAP_S)
        self.now_s += FRAME_GAP_S
        self.sent[-1].answer = answer
        return answer

    def executed(self) -> list[Sent]:
        """What was done that is no reading."""
        return [sent for sent in self.sent if sent.executed and not sent.reading]


def clean(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
    """A line as it should be."""
    sent.delivered = True
    return [(0.0, honest(sent.frame))]


def connect(monkeypatch: pytest.MonkeyPatch) -> DirtyLine:
    """A machine that has just been switched on, at the other end of a clean line."""
    made = DirtyLine(World(), clean)

    def opened(wanted: Line) -> DirtyLine:
        del wanted
        made.reset_input_buffer()
        return made

    monkeypatch.setattr(rtu, "open_port", opened)
    monkeypatch.setattr("levelwind.conformance.line.open_port", opened)
    monkeypatch.setattr(time, "monotonic", made.monotonic)
    monkeypatch.setattr(time, "sleep", made.sleep)
    return made


def levelwind(*arguments: str) -> Result:
    """A command of the tool, in this process."""
    return CliRunner().invoke(app, list(arguments))


# ---- lines with one fault ------------------------------------------------------------------------


def noise_before(noise: bytes) -> Callable[..., Pieces]:
    """Bytes stand before every answer."""

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        sent.delivered = True
        answer = honest(sent.frame)
        return [(0.0, noise + answer)] if answer else []

    return carry


def echoing(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
    """Every request comes back first."""
    sent.delivered = True
    return [(0.001, sent.frame), (0.002, honest(sent.frame))]


def losing(which: Callable[[Sent], bool]) -> Callable[..., Pieces]:
    """The first answer of a kind is lost; the request has arrived."""
    lost = []

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        answer = honest(sent.frame)
        if not lost and which(sent):
            lost.append(sent)
            return []
        sent.delivered = True
        return [(0.0, answer)]

    return carry


# ---- a line with all of them, at random ----------------------------------------------------------


class RandomLine:
    """Echoes, glitches, cuts frames in pieces, damages and loses them, by the numbers of a seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._dead = 0  # so many requests more

    def __call__(self, sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        chance = self._random.random
        self._dead = max(0, self._dead - 1)
        if chance() < 0.02:
            self._dead = self._random.randint(1, 12)
        if self._dead:
            if chance() < 0.5:
                honest(sent.frame)
            return []
        pieces: Pieces = []
        if chance() < 0.3:
            pieces += self._cut(self._maybe_glitch(sent.frame, inside=0.03))
        if chance() < 0.02:  # the request does not arrive
            return pieces
        frame = sent.frame
        if chance() < 0.01:
            at = self._random.randrange(len(frame))
            frame = (
                frame[:at] + bytes([frame[at] ^ 1 << self._random.randrange(8)]) + frame[at + 1 :]
            )
        answer = honest(frame)
        if chance() < 0.1:
            other = bytes([self._random.choice([2, 9, 16, 30]), self._random.choice([3, 4])])
            pieces += self._cut(sealed(other + b"\x02" + self._random.randbytes(2)))
        if not answer or chance() < 0.06:  # or the answer does not
            return pieces
        said = self._maybe_glitch(answer, inside=0.02)
        sent.delivered = answer in said
        return pieces + self._cut(said)

    def _glitch(self) -> bytes:
        return bytes([self._random.choice([0x00, 0xFF])]) * self._random.randint(1, 3)

    def _maybe_glitch(self, frame: bytes, inside: float) -> bytes:
        if self._random.random() < 0.2:
            frame = self._glitch() + frame
        if self._random.random() < 0.1:
            frame += self._glitch()
        if self._random.random() < inside:
            at = self._random.randrange(1, len(frame))
            frame = frame[:at] + self._glitch() + frame[at:]
        return frame

    def _cut(self, frame: bytes) -> Pieces:
        pieces: Pieces = []
        while frame:
            size = (
                len(frame) if self._random.random() < 0.5 else self._random.randint(1, len(frame))
            )
            pieces.append((self._random.uniform(0.001, 0.02), frame[:size]))
            frame = frame[size:]
        return pieces
