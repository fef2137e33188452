# SPDX-License-Identifier: Apache-2.0
"""The answer is found in whatever bytes come, and nothing else is taken for it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from levelwind.conformance.line import sealed
from levelwind.line.rtu import AnswerSearch, Heard


def word(*values: int) -> bytes:
    return b"".join(value.to_bytes(2, "big") for value in values)


def search(request: bytes, pieces: list[bytes], echoes: bool | None = False) -> bytes:
    """What is found; the pieces come one after the other, then nothing more."""
    looking = AnswerSearch(request, echoes)
    for piece in pieces:
        if found := looking.add(piece):
            return found
    return looking.end()


WRITE_PITCH = sealed(bytes.fromhex("01 10 00 72 00 02 04 00 00 2b 67"))
PITCH_WRITTEN = bytes.fromhex("01 10 00 72 00 02 e1 d3")
READ_TWO = sealed(bytes.fromhex("01 03 00 72 00 02"))
TWO_READ = sealed(bytes.fromhex("01 03 04 00 00 2b 67"))
READ_LOG = sealed(bytes.fromhex("01 14 07 06 00 01 00 00 00 02"))
LOG_READ = sealed(bytes.fromhex("01 14 06 05 06 00 00 00 01"))
WRITE_FILE = sealed(bytes.fromhex("01 15 09 06 00 02 00 00 00 01 12 34"))
EXCHANGES = [(WRITE_PITCH, PITCH_WRITTEN), (READ_TWO, TWO_READ), (READ_LOG, LOG_READ)]
UNITS = [1, 3, 9, 16, 30, 129, 131, 144, 247]


@st.composite
def exchanges(draw: st.DrawFn) -> tuple[bytes, bytes]:
    """A request that the tool sends, and its right answer."""
    unit = draw(st.integers(1, 247))
    function = draw(st.sampled_from([1, 2, 3, 4, 16, 20]))
    address = draw(st.integers(0, 0xFF00))
    if function in (1, 2):
        count = draw(st.integers(1, 2000))
        size = -(-count // 8)
        data = draw(st.binary(min_size=size, max_size=size))
        head, answer = word(address, count), bytes([size]) + data
    elif function in (3, 4):
        count = draw(st.integers(1, 125))
        data = draw(st.binary(min_size=2 * count, max_size=2 * count))
        head, answer = word(address, count), bytes([2 * count]) + data
    elif function == 16:
        count = draw(st.integers(1, 123))
        data = draw(st.binary(min_size=2 * count, max_size=2 * count))
        answer = word(address, count)
        head = answer + bytes([2 * count]) + data
    else:
        count = draw(st.integers(1, 120))
        data = draw(st.binary(min_size=2 * count, max_size=2 * count))
        head = b"\x07\x06" + word(draw(st.integers(1, 9)), address, count)
        answer = bytes([2 * count + 2, 2 * count + 1, 6]) + data
    answer = sealed(bytes([unit, function]) + answer)
    if draw(st.booleans()):
        answer = sealed(bytes([unit, function | 0x80, draw(st.integers(1, 8))]))
    return sealed(bytes([unit, function]) + head), answer


GLITCHES = st.builds(
    lambda byte, count: bytes([byte]) * count, st.sampled_from([0, 255]), st.integers(0, 3)
)


@given(exchanges(), GLITCHES, GLITCHES, st.booleans(), st.booleans(), st.data())
def test_an_answer_among_echo_glitches_and_foreign_frames_is_found(
    exchange: tuple[bytes, bytes],
    before: bytes,
    between: bytes,
    echo: bool,
    foreign: bool,
    data: st.DataObject,
):
    request, answer = exchange
    stream = before + request * echo + between
    if foreign:
        other = data.draw(st.integers(1, 247).filter(lambda unit: unit != request[0]))
        stream += sealed(bytes([other]) + answer[1:-2])
    stream += answer
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=6)))
    pieces = [stream[a:b] for a, b in zip([0, *cuts], [*cuts, len(stream)], strict=True)]
    assert search(request, pieces, data.draw(st.sampled_from([None, False, True]))) == answer


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("noise", ["ff", "00", "ff ff", "00 00 00", "00 ff 00", "01", "01 10"])
def test_bytes_before_an_answer_do_not_hide_it(unit: int, noise: str):
    for request, answer in EXCHANGES:
        asked = sealed(bytes([unit]) + request[1:-2])
        given_back = sealed(bytes([unit]) + answer[1:-2])
        stream = bytes.fromhex(noise) + given_back
        assert search(asked, [stream]) == given_back
        assert search(asked, [bytes([byte]) for byte in stream]) == given_back


def test_a_frame_that_is_cut_short_or_damaged_is_no_answer():
    for request, answer in EXCHANGES:
        for at in range(len(answer)):
            damaged = answer[:at] + bytes([answer[at] ^ 0x10]) + answer[at + 1 :]
            assert search(request, [damaged]) == b""
            assert search(request, [answer[:at]]) == b""


@pytest.mark.parametrize(
    "other",
    [
        "01 03 02 00 00",  # another count
        "01 04 04 00 00 2b 67",  # another function
        "09 03 04 00 00 2b 67",  # another unit
        "01 84 02",  # an exception to another function
    ],
)
def test_an_answer_to_another_request_is_not_taken(other: str):
    frame = sealed(bytes.fromhex(other))
    assert search(READ_TWO, [frame]) == b""
    assert search(READ_TWO, [frame, TWO_READ]) == TWO_READ
    assert search(READ_TWO, [TWO_READ[:3] + frame + TWO_READ]) == TWO_READ


def test_a_write_to_other_registers_is_not_this_one():
    elsewhere = sealed(PITCH_WRITTEN[:3] + b"\x74" + PITCH_WRITTEN[4:6])
    assert search(WRITE_PITCH, [elsewhere]) == b""


def test_an_exception_inside_of_the_answers_data_is_data():
    inside = sealed(bytes.fromhex("01 83 02"))
    request = sealed(bytes.fromhex("01 03 00 00 00 04"))
    answer = sealed(b"\x01\x03\x08" + inside + b"\0\0\0")
    for cut in range(len(answer)):
        assert search(request, [answer[:cut], answer[cut:]]) == answer


def test_the_beginning_of_an_echo_that_looks_like_the_answer_is_an_echo():
    # The values happen to be what the CRC of the answer would be, then a byte count that fits.
    request = next(
        sealed(bytes([unit, 0x10]) + word(address, 2) + b"\x04" + bytes([high, 0, 0, 0]))
        for address in range(0x1000)
        for unit in range(1, 248)
        for high in [sealed(bytes([unit, 0x10]) + word(address, 2))[7]]
        if sealed(bytes([unit, 0x10]) + word(address, 2))[6] == 4
    )
    answer = sealed(request[:6])
    assert request.startswith(answer)
    refusal = sealed(bytes([request[0], 0x90, 3]))
    assert search(request, [request[:8], request[8:], refusal]) == refusal
    assert search(request, [request[:8], request[8:]]) == b""
    assert search(request, [answer]) == answer


def test_a_file_write_is_told_from_its_echo():
    refused = sealed(bytes.fromhex("01 95 06"))
    for echoes in (None, True):
        assert search(WRITE_FILE, [WRITE_FILE], echoes) == b""  # the echo, or nobody knows
        assert search(WRITE_FILE, [WRITE_FILE, WRITE_FILE], echoes) == WRITE_FILE
        assert search(WRITE_FILE, [WRITE_FILE, refused], echoes) == refused
        assert search(WRITE_FILE, [b"\xff" + WRITE_FILE + b"\0", refused], echoes) == refused
    assert search(WRITE_FILE, [WRITE_FILE], False) == WRITE_FILE
    assert search(WRITE_FILE, [refused], False) == refused


@pytest.mark.parametrize(
    ("came", "heard"),
    [
        (b"", Heard.NOTHING),
        (READ_TWO, Heard.ECHO),
        (b"\xff", Heard.NO_FRAME),
        (READ_TWO + b"\xff\x01", Heard.NO_FRAME),
        (TWO_READ[:-1], Heard.NO_FRAME),
        (sealed(bytes.fromhex("09 03 02 00 00")), Heard.OTHER_UNIT),
        (sealed(bytes.fromhex("01 03 02 00 00")), Heard.OTHER_ANSWER),
    ],
)
def test_what_came_instead_is_told(came: bytes, heard: Heard):
    looking = AnswerSearch(READ_TWO, None)
    assert looking.add(came) + looking.end() == b""
    assert looking.heard() == heard


def test_bytes_without_an_end_are_not_kept():
    looking = AnswerSearch(READ_TWO, False)
    for _ in range(100):
        assert looking.add(b"\x01" * 5000) == b""
    assert looking.add(TWO_READ) == TWO_READ
