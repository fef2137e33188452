# SPDX-License-Identifier: Apache-2.0
"""The slave under test: requests with a right CRC, answers judged by their form."""

from dataclasses import dataclass, field

from levelwind.conformance.line import FRAME_MAX, RawLine, Received, crc16, sealed

BROADCAST = 0
EXCEPTION_BIT = 0x80
EXCEPTION_CODES = {
    bytes([code]) for code in (1, 2, 3, 4, 5, 6, 8, 10, 11)
}  # AP 7; 7 is FC08's negative acknowledge
SILENCE_MIN_S = 0.05
"""How long at least an answer is waited for that must not come."""
OPTIONAL_MAX = 5
"""Refusals that a slave may leave out before they are no longer waited for with patience."""


@dataclass(frozen=True)
class Answer:
    """One answer. At most one of `exception` and `pdu` and `malformed` is there."""

    exception: int = 0
    pdu: bytes = b""
    malformed: str = ""  # what is wrong with its form

    @property
    def silent(self) -> bool:
        """There was none."""
        return not (self.exception or self.pdu or self.malformed)

    def __str__(self) -> str:
        if self.malformed:
            return self.malformed
        if self.exception:
            return f"exception {self.exception:02d}"
        if self.pdu:
            return f"answer {self.pdu[:12].hex(' ')}{' ...' if len(self.pdu) > 12 else ''}"
        return "no answer"


@dataclass
class Slave:
    """A slave at the end of a line."""

    line: RawLine
    unit: int
    timeout_s: float
    latencies_s: list[float] = field(default_factory=list)
    baseline: bytes = b""  # a request that is known to be answered normally
    left_out: int = 0  # optional answers that have not come
    understood: bool = False  # a frame of the right form has come

    @property
    def silence_s(self) -> float:
        """How long to wait for an answer that must not come: 4 of the slowest that came."""
        slowest = max(self.latencies_s, default=self.timeout_s)
        return min(self.timeout_s, max(SILENCE_MIN_S, 4 * slowest))

    def request(self, pdu: bytes) -> Answer:
        """A request to this unit that has to be answered, if only by an exception."""
        received = self.line.exchange([sealed(bytes([self.unit]) + pdu)], 0, self.timeout_s)
        if received.frame:
            self.latencies_s.append(received.latency_s)
        return self.judge(received.frame, pdu[0])

    def patiently(self, pdu: bytes) -> Answer:
        """The same request up to three times, until it is answered, in the right form at first."""
        answer = self.request(pdu)
        for _ in range(2):
            if not answer.silent and (self.understood or not answer.malformed):
                break
            answer = self.request(pdu)
        return answer

    def optional(self, pdu: bytes) -> Answer:
        """A request that should be refused, but that many slaves leave unanswered."""
        patient = self.left_out < OPTIONAL_MAX
        frame = sealed(bytes([self.unit]) + pdu)
        wait_s = self.timeout_s if patient else self.silence_s
        answer = self.judge(self.line.exchange([frame], 0, wait_s).frame, pdu[0])
        self.left_out += answer.silent
        return answer

    def raw(self, *pieces: bytes, pause_s: float = 0.0) -> Received:
        """Bytes as they are; what comes back within the time of silence."""
        return self.line.exchange(pieces, pause_s, self.silence_s)

    def frame(self, pdu: bytes, unit: int | None = None) -> bytes:
        """A request with unit id and CRC."""
        return sealed(bytes([self.unit if unit is None else unit]) + pdu)

    def alive(self) -> bool:
        """Is the baseline request answered straight away?"""
        return bool(self.request(self.baseline).pdu)

    def come_back(self, attempts: int) -> bool:
        """Is it answered at all, if asked again?"""
        return any(self.alive() for _ in range(attempts))

    def judge(self, frame: bytes, function: int) -> Answer:
        """The form of an answer."""
        if not frame:
            return Answer()
        shown = f"{frame[:16].hex(' ')}{' ...' if len(frame) > 16 else ''}"
        pdu = frame[1:-2]
        exception = pdu[0] == function | EXCEPTION_BIT if pdu else False
        for wrong, what in (
            (len(frame) > FRAME_MAX, f"{len(frame)} bytes, {FRAME_MAX} is the limit"),
            (len(frame) < 4 or crc16(frame) != 0, "no frame with a right CRC"),
            (frame[0] != self.unit, f"unit id {frame[0]} in the answer"),
            (exception and len(pdu) != 2, "an exception has 5 bytes"),
            (exception and pdu[1:] not in EXCEPTION_CODES, f"no exception code: {pdu[1:].hex()}"),
            (not exception and pdu[:1] != bytes([function]), "another function in the answer"),
        ):
            if wrong:
                return Answer(malformed=f"{what}: {shown}")
        self.understood = True
        return Answer(exception=pdu[1]) if exception else Answer(pdu=pdu)


def word(*values: int) -> bytes:
    """16-bit fields as they stand in a request."""
    return b"".join((value & 0xFFFF).to_bytes(2, "big") for value in values)


def words(data: bytes) -> list[int]:
    """16-bit fields of an answer."""
    return [int.from_bytes(data[i : i + 2], "big") for i in range(0, len(data), 2)]
