"""The three parameter sets of a controller: staged, active, stored."""

from collections.abc import Iterable, Mapping

from levelwind.device import Device
from levelwind.errors import RefusedError, ToolError
from levelwind.map_table import Command, Point
from levelwind.points import PARAMETERS, mirror

COPIES = ("staged", "active", "stored")


def read_set(device: Device, copy: str, points: Iterable[Point] = PARAMETERS) -> dict[str, int]:
    """Parameter values by name."""
    if copy == "staged":
        return device.read(points)
    return device.read(mirror(point, copy) for point in points)


def read_sets(device: Device, points: Iterable[Point]) -> dict[str, dict[str, int]]:
    """The values of parameters in all three sets."""
    points = list(points)
    return {copy: read_set(device, copy, points) for copy in COPIES}


def replace_set(device: Device, values: Mapping[str, int]) -> None:
    """Stage and apply values; if any part is refused nothing stays staged."""
    try:
        device.write(values)
        device.command(Command.APPLY)
    except RefusedError as refusal:
        try:
            device.command(Command.REVERT)
        except RefusedError as second:
            raise ToolError(f"{refusal}\nREVERT was refused too: {second}") from refusal
        raise RefusedError(f"{refusal}\nNothing was changed.") from refusal
