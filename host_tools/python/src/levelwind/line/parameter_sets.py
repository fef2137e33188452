# SPDX-License-Identifier: Apache-2.0
"""The three parameter sets of a controller: staged, active, stored."""

import struct
import zlib
from collections.abc import Iterable, Mapping

from levelwind.errors import NoAnswerError, RefusedError, ToolError, UnknownOutcomeError
from levelwind.line.device import Device
from levelwind.line.points import PARAMETERS, mirror
from levelwind.map_table import POINTS, Command, Point

COPIES = ("staged", "active", "stored")
LOOK = "`levelwind diff` shows which parameters are staged and active, `levelwind revert` unstages."
PUT_BACK = "Put back: the active parameters are as before, and nothing is staged."


def read_set(device: Device, copy: str, points: Iterable[Point] = PARAMETERS) -> dict[str, int]:
    """Parameter values by name."""
    if copy == "staged":
        return device.read(points)
    return device.read(mirror(point, copy) for point in points)


def read_sets(device: Device, points: Iterable[Point]) -> dict[str, dict[str, int]]:
    """The values of parameters in all three sets."""
    points = list(points)
    return {copy: read_set(device, copy, points) for copy in COPIES}


def set_crc(values: Mapping[str, int]) -> int:
    """The number that names a whole set, as the register `active_crc` tells it of the active one.

    Of the CRC-32 over register address and value of each parameter that moves the carriage, the
    remainder by 2^30 - 1, plus 1 (lw_params_crc() in lw/control/params.h).
    """
    crc = 0
    for point in sorted(PARAMETERS, key=lambda p: p.address):
        if point.scope == "motion" and not point.secret and point.name != "accepted_crc":
            entry = struct.pack(">HI", point.address, values[point.name] & 0xFFFFFFFF)
            crc = zlib.crc32(entry, crc)
    return crc % 0x3FFFFFFF + 1


def replace_set(device: Device, values: Mapping[str, int]) -> None:
    """Stage and apply values; unless all of them are taken, nothing stays staged.

    Where an answer is lost it is put back too, or the error says what may have been done.
    """
    staged = False
    try:
        device.write(values)
        staged = True
        device.command(Command.APPLY)
    except RefusedError as refusal:
        _put_back(device, str(refusal))
        raise refusal.saying(f"{refusal}\n{PUT_BACK}") from refusal
    except (NoAnswerError, UnknownOutcomeError, KeyboardInterrupt) as lost:
        if isinstance(lost, NoAnswerError) and not staged:
            raise  # only read so far
        interrupted = isinstance(lost, KeyboardInterrupt)
        what = "Interrupted." if interrupted else str(lost).splitlines()[0]
        _put_back(device, what)
        if _all_active(device, values, what):
            raise UnknownOutcomeError(
                f"{what}\nIt was done: all {len(values)} values are active. They are not saved: "
                "`levelwind save` does it."
            ) from None
        raise ToolError(f"{what}\n{PUT_BACK}") from None


def _put_back(device: Device, what: str) -> None:
    try:
        device.command(Command.REVERT)
    except ToolError as second:
        raise UnknownOutcomeError(
            f"{what}\nPutting it back failed too: {str(second).splitlines()[0]}\n{LOOK}"
        ) from None


def _all_active(device: Device, values: Mapping[str, int], what: str) -> bool:
    try:
        return read_set(device, "active", [POINTS[name] for name in values]) == values
    except NoAnswerError as second:
        raise UnknownOutcomeError(
            f"{what}\nReverted: nothing is staged. {str(second).splitlines()[0]}\n{LOOK}"
        ) from None
