# SPDX-License-Identifier: Apache-2.0
"""The compiled slave on a line with exact times, and slaves that are broken on purpose."""

from collections.abc import Callable, Sequence

from levelwind.conformance.line import Received, crc16, sealed
from levelwind.line.port import CHARACTER_BITS
from world import World

BAUD = 19200
SILENCE_S = 0.01
UNIT = 1

Carry = Callable[[bytes, float], bytes]
"""Bytes on the line, then time; what the slave sends in it."""


class MemoryLine:
    """Carries bytes on the world's virtual clock."""

    character_s = CHARACTER_BITS / BAUD

    def __init__(self, carry: Carry) -> None:
        self._carry = carry

    def exchange(self, pieces: Sequence[bytes], pause_s: float, wait_s: float) -> Received:
        del wait_s  # what is to come comes as soon as the frame has ended
        answers = [self._carry(piece, pause_s) for piece in pieces[:-1]]
        answers.append(self._carry(pieces[-1], SILENCE_S))
        return Received(b"".join(answers), self.character_s, pause_s)


Break = Callable[[bytes, Callable[[bytes], bytes]], bytes]
"""From a whole frame and the honest slave to the broken one's answer."""


def frame_breaker(broken: Break) -> Callable[[World], Carry]:
    """A slave that sees whole frames, and treats them wrongly."""

    def make(world: World) -> Carry:
        def honest(frame: bytes) -> bytes:
            return world.line(frame, SILENCE_S)

        def carry(piece: bytes, seconds: float) -> bytes:
            if seconds < SILENCE_S:  # a part of a frame: only the honest slave puts it together
                return world.line(piece, seconds)
            return broken(piece, honest)

        return carry

    return make


def pdu_breaker(broken: Callable[[bytes, bytes], bytes]) -> Callable[[World], Carry]:
    """A slave whose framing is right: from a request PDU and the honest answer to another one."""

    def break_frame(frame: bytes, honest: Callable[[bytes], bytes]) -> bytes:
        answer = honest(frame)
        if not answer:
            return answer
        pdu = broken(frame[1:-2], answer[1:-2])
        return sealed(answer[:1] + pdu) if pdu else b""

    return frame_breaker(break_frame)


def is_intact(frame: bytes) -> bool:
    """A frame as it should be."""
    return 4 <= len(frame) <= 256 and crc16(frame) == 0
