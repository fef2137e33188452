# SPDX-License-Identifier: Apache-2.0
"""How late the limit switches tell, by indexing at several rates.

A switch that tells `d` late is found `v * d` further out than it is, at the carriage's speed `v`.
The indexing counts from the one switch and checks the other, so it finds them `2 * v * d` too far
apart: the slope of that over the speed is the delay, whatever is wrong with the span itself.
"""

import functools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.line.motion import INDEX_LIMIT_S
from levelwind.line.parameter_sets import read_set, replace_set
from levelwind.map_table import POINTS, Command, Flag, Side

USTEP = 65536
US_PER_S = 1_000_000
SETTINGS = [
    POINTS[name]
    for name in (
        "index_rate_edges_per_s",
        "index_switch",
        "screw_lead_um",
        "microsteps_per_rev",
        "switch_delay_us",
    )
]


@dataclass(frozen=True)
class Sample:
    """One indexing."""

    rate_edges_per_s: int
    speed_um_per_s: float  # of the carriage
    apart_um: int  # how much too far apart it found the switches


@dataclass(frozen=True)
class Delay:
    """What the samples say."""

    delay_us: float  # beyond the delay that was in force
    apart_um: float  # how much too far apart the switches are at no speed: a matter of calibration
    residual_um: float  # how far the worst sample is from the line


def fit(samples: Sequence[Sample]) -> Delay:
    """The straight line through the samples, by least squares; at least two different speeds."""
    speed = sum(s.speed_um_per_s for s in samples) / len(samples)
    apart = sum(s.apart_um for s in samples) / len(samples)
    spread = sum((s.speed_um_per_s - speed) ** 2 for s in samples)
    slope = (
        sum((s.speed_um_per_s - speed) * (s.apart_um - apart) for s in samples) / spread
    )  # seconds
    begin = apart - slope * speed
    return Delay(
        slope / 2 * US_PER_S,
        begin,
        max(abs(s.apart_um - begin - slope * s.speed_um_per_s) for s in samples),
    )


def proposal_us(in_force_us: int, delay: Delay) -> int:
    """The value for switch_delay_us, within its limits."""
    point = POINTS["switch_delay_us"]
    assert point.min is not None
    assert point.max is not None
    return min(max(round(in_force_us + delay.delay_us), point.min), point.max)


def measure(
    device: Device, rates: Iterable[int], watch: Callable[[int], None] = lambda _: None
) -> tuple[list[Sample], int]:
    """Index at each rate, then put the index rate back; the delay in force too.

    `watch` is called with the rate at every look.
    """
    if not flag(read_live(device), Flag.DRUM_AT_REST):
        raise ToolError("The drum must be at rest for this.")
    before = read_set(device, "active", SETTINGS)
    if read_set(device, "staged") != read_set(device, "active"):
        raise ToolError(
            "Other parameters are staged and would be applied with the rates: "
            "`levelwind diff` shows them; apply or revert them first."
        )
    outward = -1 if before["index_switch"] == Side.PLUS else 1  # of the switch that is checked
    um_per_ustep = before["screw_lead_um"] / before["microsteps_per_rev"]
    samples = []
    try:
        for rate in rates:
            device.command(Command.STOP)
            replace_set(device, {"index_rate_edges_per_s": rate})
            device.command(Command.INDEX, functools.partial(watch, rate), INDEX_LIMIT_S)
            now = device.read_names("ks", "span_error_um")
            speed = now["ks"] / USTEP * rate * um_per_ustep
            samples.append(Sample(rate, speed, outward * now["span_error_um"]))
    finally:
        device.command(Command.STOP)
        replace_set(device, {"index_rate_edges_per_s": before["index_rate_edges_per_s"]})
    return samples, before["switch_delay_us"]
