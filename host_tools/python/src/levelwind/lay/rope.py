# SPDX-License-Identifier: Apache-2.0
"""Metres and turns: the wound drum grows with its layers.

R = R0 + pi c N and L = 2 pi R0 N + pi^2 c N^2 with c = d^2 / (4 p w): N turns since the drum was
bare, bare radius R0, rope diameter d, packing p, width w between the far points of the reversals.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, sqrt

from levelwind.core import native
from levelwind.errors import ToolError

PACKING_MIN, PACKING_MAX = 0.1, 1.0
ROPE_M_MAX = 20_000
LAUNCH_M = 650.0
"""What a launch winds in, where nothing else is said."""
NEEDED = ("rope_diameter_um", "drum_core_diameter_um")


@dataclass(frozen=True)
class Drum:
    """A drum whose bare diameter and rope are known. All in metres."""

    radius_m: float
    rope_m: float
    width_m: float

    def growth(self, packing: float) -> float:
        """c, square metres per metre of rope."""
        return self.rope_m**2 / (4 * packing * self.width_m)

    def turns(self, length_m: float, packing: float) -> float:
        """Drum turns that lay so much rope on the bare drum."""
        c = self.growth(packing)
        return length_m / (pi * (self.radius_m + sqrt(self.radius_m**2 + c * length_m)))

    def wound_radius_m(self, length_m: float, packing: float) -> float:
        """With so much rope on it."""
        return sqrt(self.radius_m**2 + self.growth(packing) * length_m)

    def length_m(self, turns: float, packing: float) -> float:
        """The other way round."""
        return 2 * pi * self.radius_m * turns + pi**2 * self.growth(packing) * turns**2


def drum(parameters: Mapping[str, int]) -> Drum:
    """The drum of a parameter set; ToolError names what is not known."""
    missing = [name for name in NEEDED if not parameters[name]]
    if missing:
        raise ToolError(
            f"Not known: {', '.join(missing)}. Measure and set: "
            f"levelwind set {' '.join(f'{name}=...' for name in missing)}"
        )
    derived = native.derive(parameters)
    um_per_ustep = parameters["screw_lead_um"] / parameters["microsteps_per_rev"]
    usteps = (
        derived.reversal_plus_usteps - derived.reversal_minus_usteps
        + 2 * derived.overshoot_um / um_per_ustep
    )  # fmt: skip
    return Drum(
        parameters["drum_core_diameter_um"] / 2e6,
        parameters["rope_diameter_um"] / 1e6,
        usteps * um_per_ustep / 1e6,
    )


def turns_of(parameters: Mapping[str, int], rope_m: float) -> float:
    """Drum turns of so much rope: by the growing layers if they are known, else by one length."""
    packing = parameters["rope_packing_permille"] / 1000
    if packing and all(parameters[name] for name in NEEDED):
        return drum(parameters).turns(rope_m, packing)
    return rope_m * 1e6 / parameters["rope_per_drum_rev_um"]


def fit(drum_: Drum, first_m: float, second_m: float, turns: float, *, clip: bool = False) -> float:
    """The packing with which so many turns lie between two lengths on the drum.

    The tighter it packs the slower the drum grows, and the more turns it takes. ToolError if none
    that can be fits; with clip the nearest that can be.
    """

    def between(packing: float) -> float:
        return drum_.turns(second_m, packing) - drum_.turns(first_m, packing)

    low, high = between(PACKING_MIN), between(PACKING_MAX)
    if not clip and not low <= turns <= high:
        raise ToolError(
            f"{turns:g} turns from {first_m:g} to {second_m:g} m fit no packing from "
            f"{PACKING_MIN:g} to {PACKING_MAX:g}: those need {low:.1f} to {high:.1f} turns. "
            "Check the lengths, the turns, and the diameters of rope and bare drum."
        )
    below, above = PACKING_MIN, PACKING_MAX
    for _ in range(60):
        packing = (below + above) / 2
        below, above = (packing, above) if between(packing) < turns else (below, packing)
    return (below + above) / 2
