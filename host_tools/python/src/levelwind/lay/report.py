# SPDX-License-Identifier: Apache-2.0
"""What is told of a lay: for programs and for people."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction

from levelwind.lay import field, rope
from levelwind.lay.search import Recommendation
from levelwind.lay.wind import NEAR_ROPES, ORDERS, Wind, ordinal, wind


@dataclass(frozen=True)
class Lay:
    """How a parameter set lays a length of rope."""

    parameters: Mapping[str, int]
    rope_m: float
    turns: float
    wind: Wind
    ribbons: list[int]
    evenness: field.Evenness

    @property
    def rope_um(self) -> int:
        """Diameter."""
        return self.parameters["rope_diameter_um"]

    def document(self, recommended: list[Recommendation]) -> dict[str, object]:
        """For --json."""
        return {
            **_numbers(self.wind, self.ribbons, self.evenness),
            "recommended": [
                {
                    "set": best.command,
                    "changes": best.changes,
                    **_numbers(best.wind, best.ribbons, best.evenness),
                    "near_std_mm": round(best.near_std_mm, 3),
                }
                for best in recommended
            ],
        }

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Of the wind ratio and the evenness, for the table."""
        found, even = self.wind, self.evenness
        cycles = len(found.double_traverses)
        mean = f"mean of the {cycles} of the ribbon breaker" if cycles > 1 else ""
        return [
            ("wind ratio", _fraction(found.ratio), "", f"{float(found.ratio):.5f} drum turns"),
            ("double traverse", f"{_plain(found.period_edges)}", "edges", mean),
            ("drum revolution", f"{_plain(found.edges_per_drum_rev)}", "edges", ""),
            ("pitch", f"{float(found.pitch_mm):.3f}", "mm", "as the law makes it"),
            (
                "rope",
                f"{self.rope_m:g}",
                "m",
                f"{self.rope_um / 1000:g} mm thick: {self.turns:.1f} drum turns, "
                f"{self.turns / float(found.ratio):.1f} double traverses",
            ),
            ("highest", f"{even.max_mm:.1f}", "mm", "above the bare drum"),
            ("mean", f"{even.mean_mm:.1f}", "mm", ""),
            ("unevenness", f"{even.std_mm:.1f}", "mm", "standard deviation"),
            ("low", f"{even.p5_mm:.1f}", "mm", "a twentieth of the surface lies lower"),
        ]

    def displacements(self) -> list[tuple[str, str, str]]:
        """Double traverses ago, millimetres beside that coil, what it means."""
        rope_mm = self.rope_um / 1000
        rows = []
        for order in ORDERS:
            mm = self.wind.displacement_mm(order)
            if order in self.ribbons:
                meaning = "RIBBON: coil on coil on coil"
            elif abs(mm) < NEAR_ROPES * rope_mm:
                meaning = "coil on coil"
            elif abs(mm) < rope_mm:
                meaning = "overlapping"
            else:
                meaning = "beside it"
            rows.append((str(order), f"{mm:+.3f}", meaning))
        return rows

    def sentences(self) -> list[str]:
        """What is bad about it, and how bad."""
        rope_mm = self.rope_um / 1000
        pitch_mm = float(self.wind.pitch_mm)
        if pitch_mm < rope_mm:
            return [
                f"The pitch, {pitch_mm:.2f} mm, is less than the rope is thick, {rope_mm:g} mm: "
                "every coil climbs on the one before."
            ]
        told = []
        if len(self.wind.double_traverses) > 1:
            told.append(
                "With the ribbon breaker a coil comes to lie elsewhere from one double traverse to "
                "the next: millimetres beside it are those of the mean."
            )
        for order in self.ribbons:
            traverse = "double traverse" if order == 1 else f"{ordinal(order)} double traverse"
            gaps = (
                f"{order * rope_mm:g} mm of rope do not fill a pitch of {pitch_mm:.1f} mm: walls, "
                "with valleys between."
                if order * rope_mm < pitch_mm
                else f"{order} coils side by side fill the pitch, so it shows little."
            )
            told.append(
                f"Ribbon: every {traverse} the coils come to lie on earlier ones, "
                f"{self.wind.displacement_mm(order):+.2f} mm beside them. {gaps}"
            )
        return told


def recommended_rows(recommended: list[Recommendation]) -> list[tuple[str, ...]]:
    """For the table of recommendations."""
    return [
        (
            f"{best.evenness.std_mm:.1f}",
            f"{best.near_std_mm:.1f}",
            f"{best.evenness.max_mm:.1f}",
            f"{best.evenness.p5_mm:.1f}",
            f"{float(best.wind.ratio):.4f}",
            ", ".join(map(str, best.ribbons)) or "none",
            best.command,
        )
        for best in recommended
    ]


def lay(parameters: Mapping[str, int], rope_m: float) -> Lay:
    """Of a set whose rope_diameter_um is known."""
    turns = rope.turns_of(parameters, rope_m)
    found = wind(parameters)
    rope_um = parameters["rope_diameter_um"]
    even = field.evenness(parameters, rope_um, turns)
    return Lay(parameters, rope_m, turns, found, found.ribbons(rope_um, turns), even)


def _numbers(found: Wind, ribbons: list[int], even: field.Evenness) -> dict[str, object]:
    return {
        "wind_ratio": _fraction(found.ratio),
        "period_edges": _plain(found.period_edges),
        "edges_per_drum_rev": _plain(found.edges_per_drum_rev),
        "displacements_mm": [round(mm, 6) for mm in found.displacements_mm],
        "ribbons": ribbons,
        "evenness": {name: round(mm, 3) for name, mm in asdict(even).items()},
    }


def _fraction(value: Fraction) -> str:
    return f"{value.numerator}/{value.denominator}"


def _plain(value: Fraction) -> int | float:
    """A whole number as such."""
    return int(value) if value.denominator == 1 else round(float(value), 6)
