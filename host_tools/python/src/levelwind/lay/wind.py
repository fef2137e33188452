# SPDX-License-Identifier: Apache-2.0
"""The wind ratio, and what follows from it: where a coil lies beside earlier ones.

Drum turns per double traverse decide the lay before the first turn. Fractions here are exact: the
law repeats to the edge. doc/rope.md explains the words.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from levelwind.core import native
from levelwind.core.ideal_screw import USTEP
from levelwind.lay import field

ORDERS = range(1, 13)
"""Earlier coils that are looked at: so many double traverses ago."""
NEAR_ROPES = Fraction(1, 4)
"""Nearer to an earlier coil than this part of a rope's diameter: coil on coil."""
STACK_MIN = 3
"""So many coils on each other, or more, are a ribbon."""


@dataclass(frozen=True)
class Wind:
    """How the pattern of a parameter set comes back to the drum's angles."""

    double_traverses: tuple[int, ...]
    """Edges of each until it repeats: one, or as many as the ribbon breaker has cycles."""
    edges_per_drum_rev: Fraction
    pitch_mm: Fraction
    """Of the law: what Ks makes of the pitch that was asked for."""

    @property
    def period_edges(self) -> Fraction:
        """A double traverse; with a ribbon breaker the mean one."""
        return Fraction(sum(self.double_traverses), len(self.double_traverses))

    @property
    def ratio(self) -> Fraction:
        """Drum turns per double traverse."""
        return self.period_edges / self.edges_per_drum_rev

    def displacement_mm(self, order: int) -> float:
        """How far beside the coil laid so many double traverses ago, same direction."""
        return self._beside(order * self.ratio)

    @property
    def displacements_mm(self) -> list[float]:
        """For all orders."""
        return [self.displacement_mm(order) for order in ORDERS]

    def ribbons(self, rope_um: int, turns: float) -> list[int]:
        """Orders in which coil comes to lie on coil on coil within so many turns.

        Multiples of one are the same ribbon. With a ribbon breaker it counts if more than half of
        the coils come to lie so.
        """
        near_mm = NEAR_ROPES * rope_um / 1000
        found: list[int] = []
        for order in ORDERS:
            if any(order % lower == 0 for lower in found):
                continue
            if (STACK_MIN - 1) * order * self.ratio > turns:
                break
            beside = [abs(self._beside(between)) for between in self._turns_between(order)]
            if 2 * sum(mm < near_mm for mm in beside) > len(beside):
                found.append(order)
        return found

    def _beside(self, turns: Fraction) -> float:
        return float(self.pitch_mm * (turns - round(turns)))

    def _turns_between(self, order: int) -> list[Fraction]:
        """Drum turns from each coil of a repetition to the one so many double traverses later."""
        count = len(self.double_traverses)
        return [
            sum(self.double_traverses[(first + i) % count] for i in range(order))
            / self.edges_per_drum_rev
            for first in range(count)
        ]


def edges_per_drum_rev(parameters: Mapping[str, int]) -> Fraction:
    """Used encoder edges per drum revolution."""
    return Fraction(
        parameters["encoder_pulses_per_rev"]
        * parameters["encoder_edges_per_pulse"]
        * parameters["encoder_ratio_numerator"],
        parameters["encoder_ratio_denominator"],
    )


def pitch_mm(parameters: Mapping[str, int], ks: int) -> Fraction:
    """Carriage travel per drum revolution in the sweep, by the law."""
    um_per_ustep = Fraction(parameters["screw_lead_um"], parameters["microsteps_per_rev"])
    return Fraction(ks, USTEP) * edges_per_drum_rev(parameters) * um_per_ustep / 1000


def wind(parameters: Mapping[str, int]) -> Wind:
    """Of a parameter set, by the compiled law; RefusedError if the core refuses the set."""
    derived = native.derive(parameters)
    cycles = parameters["breaker_cycles"] if parameters["breaker_millirev"] else 0
    return Wind(
        tuple(field.double_traverses(parameters, max(1, cycles))),
        edges_per_drum_rev(parameters),
        pitch_mm(parameters, derived.ks),
    )


def ordinal(order: int) -> str:
    """1st, 2nd, 3rd, 4th."""
    ending = {1: "st", 2: "nd", 3: "rd"}.get(order, "th")
    return f"{order}{ending}"


def warning(parameters: Mapping[str, int], turns: float) -> str | None:
    """One line if rope of the set's diameter makes a ribbon, or climbs on itself; else None."""
    rope_um = parameters["rope_diameter_um"]
    if not rope_um:
        return None
    found = wind(parameters)
    if found.pitch_mm * 1000 < rope_um:
        return (
            f"The pitch, {float(found.pitch_mm):.2f} mm, is less than the rope is thick, "
            f"{rope_um / 1000:g} mm: every coil climbs on the one before. "
            "`levelwind lay` shows it."
        )
    ribbons = found.ribbons(rope_um, turns)
    if not ribbons:
        return None
    order = ribbons[0]
    every = "Every double traverse" if order == 1 else f"Every {ordinal(order)} double traverse"
    return (
        f"{every} lays rope {found.displacement_mm(order):+.2f} mm beside earlier coils, so on "
        "them: a ribbon. `levelwind lay` shows how uneven that is, and better settings."
    )
