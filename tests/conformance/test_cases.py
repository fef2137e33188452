# SPDX-License-Identifier: Apache-2.0
"""The suite passes the slave that is right, and catches each of the slaves that are not."""

import pytest
from conformance.memory_line import (
    UNIT,
    Carry,
    MemoryLine,
    frame_breaker,
    is_intact,
    pdu_breaker,
)
from levelwind.conformance import framing, others, reads, writes  # noqa: F401 - they hold the cases
from levelwind.conformance.line import sealed
from levelwind.conformance.slave import Slave, word
from levelwind.conformance.suite import Outcome, Verdict, all_cases, run
from levelwind.conformance.survey import survey
from levelwind.map_table import POINTS
from world import World

SCRATCH = POINTS["encoder_pulses_per_rev"].address
SCRATCH_WORD = word(SCRATCH)
OTHER_UNIT = 2
READS = {1, 2, 3, 4}
WRITES = {5, 6, 15, 16, 22, 23}
EXACT_PAUSE = "pause: 1.5 to 3.5 characters inside a frame"


def examine(carry: Carry, only: str = "", scratch: int | None = SCRATCH) -> list[Outcome]:
    slave = Slave(MemoryLine(carry), UNIT, 0.1)
    found = survey(slave, {}, scratch=scratch)
    return run(slave, found, [case for case in all_cases() if only in case.name])


def test_the_slave_of_the_core() -> None:
    outcomes = {o.name: o for o in examine(World().line)}
    bad = [o for o in outcomes.values() if o.verdict in (Verdict.DEVIATION, Verdict.FAIL)]
    # A pause of 1.5 characters spoils a frame only where the host asks for that.
    assert [o.name for o in bad] == [EXACT_PAUSE]
    assert sum(o.verdict == Verdict.PASS for o in outcomes.values()) > 100


def test_without_a_scratch_register_nothing_changes() -> None:
    world = World()
    names = [p.name for p in POINTS.values() if p.space == "holding" and p.block != "bench"]
    before = world.read(*names)

    def carry(frame: bytes, seconds: float) -> bytes:
        answer = world.line(frame, seconds)
        if answer:  # else it may be in listen only mode
            assert world.read(*names) == before, frame.hex(" ")
        return answer

    outcomes = examine(carry, scratch=None)
    assert sum(o.detail == "needs --scratch-register" for o in outcomes) > 5


class Forgetful:
    """Keeps the last byte of a broken frame, and so spoils the next one."""

    def __init__(self) -> None:
        self.kept = b""

    def __call__(self, frame, honest):
        whole = self.kept + frame
        self.kept = b"" if is_intact(whole) or self.kept else frame[-1:]
        return honest(whole)


def changed(at: int, value: int):
    """An answer with another byte, where it is long enough."""
    return lambda pdu: pdu[:at] + bytes([value]) + pdu[at + 1 :] if len(pdu) > at else pdu


def on(functions, broken):
    """Normal answers of these functions, broken."""
    return pdu_breaker(lambda request, pdu: broken(pdu) if pdu[0] in functions else pdu)


def exceptions(code: int, broken: bytes):
    """This exception, replaced."""
    return pdu_breaker(
        lambda request, pdu: bytes([pdu[0]]) + broken if pdu[0] & 0x80 and pdu[1] == code else pdu
    )


def executes_wrong_crc(frame, honest):
    if is_intact(frame) or len(frame) < 4:
        return honest(frame)
    honest(sealed(frame[:-2]))
    return b""


def executes_for_others(frame, honest):
    answer = honest(frame)
    if is_intact(frame) and frame[0] == OTHER_UNIT:
        honest(sealed(bytes([UNIT]) + frame[1:-2]))
    return answer


def writes_in_part(frame, honest):
    """FC16 that stops where the registers end, and reports so."""
    answer = honest(frame)
    if frame[1] == 16 and answer[1:2] == b"\x90":
        honest(sealed(bytes([UNIT, 6]) + frame[2:4] + frame[7:9]))
    return answer


def mask_without_and_not(frame, honest):
    """FC22 that ORs the whole mask."""
    if frame[1] != 22 or frame[2:4] != SCRATCH_WORD:
        return honest(frame)
    present = honest(sealed(bytes([UNIT, 3]) + frame[2:4] + word(1)))[3:5]
    value = bytes(p & a | o for p, a, o in zip(present, frame[4:6], frame[6:8], strict=True))
    answer = honest(sealed(bytes([UNIT, 6]) + frame[2:4] + value))
    return sealed(bytes([UNIT, 0x96]) + answer[2:3]) if answer[1] & 0x80 else frame


def reads_before_it_writes(frame, honest):
    if frame[1] != 23:
        return honest(frame)
    before = honest(sealed(bytes([UNIT, 3]) + frame[2:6]))
    answer = honest(frame)
    return answer if answer[1] & 0x80 else sealed(bytes([UNIT, 23]) + before[2:-2])


def writes_what_it_refuses_to_read(frame, honest):
    answer = honest(frame)
    if frame[1] == 23 and answer[1:3] == b"\x97\x02" and frame[6:8] == SCRATCH_WORD:
        honest(sealed(bytes([UNIT, 6]) + frame[6:8] + frame[11:13]))
    return answer


def takes_any_coil_value(request, pdu):
    return request if request[0] == 5 and pdu == b"\x85\x03" else pdu


def reads_beyond_the_end(request, pdu):
    return b"\x03\x04\0\0\0\0" if request[3:] == word(2) and pdu == b"\x83\x02" else pdu


def with_file(broken):
    """File 1 with 10 records, whether the core has one or not."""

    def answer(request, pdu):
        groups = [request[i : i + 7] for i in range(2, len(request), 7)]
        counts = [int.from_bytes(group[5:7], "big") for group in groups]
        file_1 = all(group[:5] == b"\x06\x00\x01\x00\x00" for group in groups)
        if request[0] != 20 or not file_1 or pdu[:2] == b"\x94\x03":
            return pdu
        if max(counts) > 10:
            return broken(b"\x94\x02")
        data = b"".join(bytes([1 + 2 * count, 6]) + bytes(2 * count) for count in counts)
        return broken(bytes([20, len(data)]) + data)

    return pdu_breaker(answer)


def joined_pieces():
    """A receiver without a clock: a frame ends when its CRC is right."""

    def make(world: World) -> Carry:
        buffer = bytearray()

        def carry(piece: bytes, seconds: float) -> bytes:
            buffer.extend(piece)
            if is_intact(bytes(buffer)) or len(buffer) > 8:
                whole = bytes(buffer)
                buffer.clear()
                return world.line(whole, 0.01)
            return b""

        return carry

    return make


def loses_every_40th():
    def make(world: World) -> Carry:
        count = 0

        def carry(piece: bytes, seconds: float) -> bytes:
            nonlocal count
            count += 1
            return b"" if count % 40 == 0 else world.line(piece, seconds)

        return carry

    return make


def short_pauses_spoil():
    """A receiver that takes every pause for the end of a frame."""

    def make(world: World) -> Carry:
        def carry(piece: bytes, seconds: float) -> bytes:
            return world.line(piece, max(seconds, 0.01))

        return carry

    return make


SILENT = b""
BROKEN = [
    ("answers wrong CRCs", frame_breaker(lambda f, ok: ok(f) or ok(sealed(f[:-2]))), "wrong CRC"),
    ("executes wrong CRCs", frame_breaker(executes_wrong_crc), "wrong CRC changes nothing"),
    (
        "answers every unit",
        frame_breaker(lambda f, ok: ok(f) or (ok(sealed(b"\x01" + f[1:-2])) if f[0] else b"")),
        "frame: other units",
    ),
    ("executes other units'", frame_breaker(executes_for_others), "a write to another unit"),
    (
        "answers broadcasts",
        frame_breaker(lambda f, ok: ok(f) or (b"" if f[0] else sealed(f[:-2]))),
        "broadcast: not answered",
    ),
    *(
        (
            f"ignores broadcasts, FC{function:02d}",
            frame_breaker(lambda f, ok: ok(f) if f[0] else b""),
            f"broadcast: FC{function:02d} is executed",
        )
        for function in (6, 16)
    ),
    ("keeps old bytes, noise", frame_breaker(Forgetful()), "noise: a request after it"),
    ("keeps old bytes, short", frame_breaker(Forgetful()), "frame: shorter than 4 bytes"),
    ("keeps old bytes, beginnings", frame_breaker(Forgetful()), "every beginning"),
    ("keeps old bytes, long", frame_breaker(Forgetful()), "frame: longer than 256"),
    (
        "answers long frames",
        frame_breaker(lambda f, ok: ok(f if len(f) <= 256 else sealed(f[:6]))),
        "frame: longer than 256",
    ),
    (
        "has a short buffer",
        frame_breaker(lambda f, ok: ok(f) if len(f) < 200 else b""),
        "frame: 256 bytes",
    ),
    ("has no clock, long pause", joined_pieces(), "pause: a long one"),
    ("has no clock, half a frame", joined_pieces(), "pause: half a frame"),
    ("has no clock, 1.5 characters", joined_pieces(), EXACT_PAUSE),
    ("has no patience", short_pauses_spoil(), "pause: under 1.5"),
    ("has no patience at all", short_pauses_spoil(), "frame: in two pieces"),
    (
        "finds a request in noise",
        frame_breaker(lambda f, ok: ok(f) or ok(f[1:])),
        "noise: joined",
    ),
    ("loses requests", loses_every_40th(), "answer: 50 in a row"),
    ("silent on unknown functions", exceptions(1, SILENT), "unknown functions"),
    ("exception 03 for 01", exceptions(1, b"\x03"), "unknown functions"),
    ("silent without data", exceptions(1, SILENT), "unknown functions without data"),
    ("silent with much data", exceptions(1, SILENT), "with 252 bytes"),
    (
        "executes FC131",
        frame_breaker(lambda f, ok: ok(sealed(f[:1] + bytes([f[1] & 0x7F]) + f[2:-2]))),
        "function codes 0 and above",
    ),
    ("no exception code", exceptions(3, b"\x63"), "FC03: count 0"),
    ("a long exception", exceptions(3, b"\x03\x00"), "FC03: count 0"),
    ("a bare exception", exceptions(3, b""), "FC03: count 0"),
    *(
        (f"FC{f:02d} exception 02 for 03", exceptions(3, b"\x02"), f"FC{f:02d}: {name}")
        for f in sorted(READS)
        for name in ("count 0", "count above", "one byte too few")
    ),
    *(
        (f"FC{f:02d} exception 03 for 02", exceptions(2, b"\x03"), f"FC{f:02d}: {name}")
        for f in sorted(READS)
        for name in ("count at", "unknown address", "a range", "addresses beyond")
    ),
    *(
        (f"FC{f:02d} exception 02 for 03", exceptions(3, b"\x02"), f"FC{f:02d}: {name}")
        for f in (15, 16)
        for name in ("count 0", "count above", "byte count", "data shorter")
    ),
    *(
        (f"FC{f:02d} exception 03 for 02", exceptions(2, b"\x03"), name)
        for f, name in (
            (5, "FC05: unknown"),
            (6, "FC06: unknown"),
            (15, "FC15: unknown"),
            (16, "FC16: unknown"),
            (15, "FC15: addresses"),
            (16, "FC16: addresses"),
            (15, "FC15: count at"),
            (16, "FC16: count at"),
            (22, "FC22: unknown"),
            (23, "FC23: unknown"),
        )
    ),
    ("FC22 length", exceptions(3, b"\x02"), "FC22: one byte"),
    ("FC23 counts", exceptions(3, b"\x02"), "FC23: counts"),
    ("FC23 byte count", exceptions(3, b"\x02"), "FC23: byte count"),
    ("reads beyond the end", pdu_breaker(reads_beyond_the_end), "FC03: a range"),
    ("unused bits", on({1}, lambda p: p[:-1] + bytes([p[-1] | 0x80])), "FC01: every count"),
    ("a byte less", on({3}, lambda p: p[:-1]), "FC03: every count"),
    *(
        (
            f"FC{f:02d} alone is something else",
            pdu_breaker(
                lambda r, p, f=f: (
                    p[:2] + bytes(b ^ 1 for b in p[2:]) if p[0] == f and r[3:] == word(1) else p
                )
            ),
            f"FC{f:02d}: one by one",
        )
        for f in sorted(READS)
    ),
    *(
        (f"FC{f:02d} byte count", on({f}, changed(1, 99)), f"FC{f:02d}: every count")
        for f in sorted(READS)
    ),
    ("FC07", pdu_breaker(lambda r, p: b"\x07" if r == b"\x07" else p), "FC07, FC11"),
    (
        "silent on FC24",
        pdu_breaker(lambda r, p: b"" if r[0] == 24 else p),
        "unsupported public functions",
    ),
    ("FC17 length", on({17}, lambda p: p + b"\x00"), "FC17: the form"),
    ("FC17 with data", exceptions(3, b"\x02"), "FC17: with data"),
    ("FC20 form", with_file(lambda p: p[:-1]), "FC20: the form"),
    ("FC20 byte count", exceptions(3, b"\x02"), "FC20: byte count"),
    ("FC20 reference", exceptions(2, b"\x03"), "FC20: reference"),
    ("FC20 too long", with_file(lambda p: p if p[0] == 20 else b"\x94\x04"), "FC20: an answer"),
    ("FC21 byte count", exceptions(3, b"\x02"), "FC21: byte count"),
    ("FC21 reference", exceptions(2, b"\x03"), "FC21: reference"),
    ("FC05 echo", on({5}, changed(4, 1)), "FC05: the echo"),
    ("FC05 any value", pdu_breaker(takes_any_coil_value), "FC05: a value"),
    ("FC06 echo", on({6}, changed(4, 0x55)), "FC06: the echo"),
    ("FC15 answer", on({15}, lambda p: p + b"\x01"), "FC15: the answer"),
    ("FC16 answer", on({16}, changed(4, 9)), "FC16: the answer"),
    ("FC16 in part", frame_breaker(writes_in_part), "FC16: all or nothing"),
    ("FC22 echo", on({22}, lambda p: p[:5]), "FC22: the echo"),
    ("FC22 OR", frame_breaker(mask_without_and_not), "FC22: the echo"),
    ("FC22 writes nothing", frame_breaker(lambda f, ok: f if f[1] == 22 else ok(f)), "FC22: the m"),
    ("FC23 answer", on({23}, changed(1, 4)), "FC23: the answer"),
    ("FC23 order", frame_breaker(reads_before_it_writes), "FC23: writes before"),
    ("FC23 writes", frame_breaker(writes_what_it_refuses_to_read), "FC23: a refused"),
    ("FC08 echo", on({8}, changed(3, 0x11)), "FC08/00"),
    ("FC08 sub-functions", exceptions(1, b"\x03"), "FC08: unknown sub"),
    ("FC08 data", exceptions(3, b"\x02"), "FC08: wrong data"),
    ("FC08 length", exceptions(3, b"\x02"), "FC08: wrong lengths"),
    ("FC08 counters", on({8}, changed(4, 7)), "FC08: counters"),
    (
        "FC08 listens and talks",
        frame_breaker(lambda f, ok: ok(f) if f[1:4] != b"\x08\x00\x04" else f),
        "FC08/04",
    ),
    ("FC43 length", on({43}, lambda p: p[:-1]), "FC43/14: basic"),
    ("FC43 object", on({43}, changed(7, 5)), "FC43/14: basic"),
    ("FC43 conformity", on({43}, changed(3, 0)), "FC43/14: regular"),
    ("FC43 more follows", on({43}, changed(4, 0xFF)), "FC43/14: basic"),
    ("FC43 one object", on({43}, changed(9, 0)), "FC43/14: one object"),
    ("FC43 codes", exceptions(3, b"\x02"), "FC43: wrong codes"),
    (
        "FC43 restart",
        pdu_breaker(lambda r, p: b"\xab\x02" if r == b"\x2b\x0e\x01\x7f" else p),
        "FC43/14: a stream",
    ),
]


def test_a_file_that_is_right() -> None:
    outcomes = examine(with_file(lambda pdu: pdu)(World()), only="FC20")
    assert {o.verdict for o in outcomes} == {Verdict.PASS}


@pytest.mark.parametrize(("make", "name"), [b[1:] for b in BROKEN], ids=[b[0] for b in BROKEN])
def test_a_broken_slave_is_caught(make, name: str) -> None:
    outcomes = examine(make(World()), only=name)
    assert len(outcomes) > 0
    bad = [o for o in outcomes if o.verdict in (Verdict.DEVIATION, Verdict.FAIL)]
    assert bad, f"{[o.verdict.value for o in outcomes]} {[o.detail for o in outcomes]}"


def test_every_case_has_a_broken_slave() -> None:
    caught = [name for _, _, name in BROKEN]
    unproved = {c.name for c in all_cases() if not any(name in c.name for name in caught)}
    assert unproved == set()
