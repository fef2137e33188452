# SPDX-License-Identifier: Apache-2.0
"""The simulated machine as a file: its figures in millimetres, how it is wired, what is broken.

screw_lead_mm: 10
microsteps_per_rev: 1600
limit_switches_swapped: true
"""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType

from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.files import yaml_file
from levelwind.line.points import PARAMETERS, parse_number

INDEX_MM_PER_S = 40
JOG_MM_PER_S = 20
PITCH_MM = 12
SLOPE_MAX = 0.7
"""Microsteps per edge; the law takes less than 1."""
EDGES_PER_DRUM_REV = 2880
"""That the factory's limits of speed are meant for."""

# How the way between a limit switch and its overtravel switch is used, as by the factory values.
REVERSAL_PART, OVERSHOOT_PART, CLEARANCE_PART = 0.21, 0.33, 0.07
RELEASED_CLEARANCE_UM = 700


@dataclass(frozen=True)
class Machine:
    """A machine: all its figures, by the names that a machine file has."""

    figures: Mapping[str, float]
    given: Mapping[str, float]
    """Those that differ from the default machine's, or were written down."""

    def __getitem__(self, name: str) -> float:
        return self.figures[name]

    def arguments(self) -> list[str]:
        """For the command line of lw_sim."""
        return [part for n, value in self.given.items() for part in ("--figure", f"{n}={value!r}")]

    @property
    def um_per_ustep(self) -> float:
        """Carriage travel per microstep."""
        return self["screw_lead_mm"] * 1000 / self["microsteps_per_rev"]

    @property
    def transitions_per_drum_rev(self) -> Fraction:
        """A/B transitions of the encoder in a turn of the drum."""
        ratio = Fraction(
            int(self["encoder_ratio_numerator"]), int(self["encoder_ratio_denominator"])
        )
        return 4 * int(self["encoder_pulses_per_rev"]) * ratio

    @property
    def period_mm(self) -> float:
        """Travel of an electrical period, four full steps: a motor that slips loses whole ones."""
        return 4 * self["screw_lead_mm"] / self["full_steps_per_rev"]

    @property
    def switch_delay_ms(self) -> float:
        """Between the place at which a limit switch triggers and its contact's closing."""
        return self["switch_late_ms"] + self["contact_travel_ms"]

    def pull_out_mm_per_s(self, acceleration_mm_per_s2: float = 0) -> float:
        """Speed above which the motor cannot give this acceleration any more and falls out of step;
        0 if it never can."""
        pull = self["holding_acceleration_mm_per_s2"]
        need = self["friction_mm_per_s2"] + acceleration_mm_per_s2
        per_half = 1 / self["half_torque_speed_mm_per_s"]
        top = self["top_speed_mm_per_s"]
        per_top = 1 / top if top else 0.0
        # pull * (1 - v * per_top) / (1 + v * per_half) = need, solved for v
        return max(pull - need, 0) / (need * per_half + pull * per_top)

    def pull_out_acceleration_mm_per_s2(self, speed_mm_per_s: float) -> float:
        """Largest acceleration that the motor can give at a speed; negative: it cannot keep it."""
        top = self["top_speed_mm_per_s"]
        left = max(1 - speed_mm_per_s / top, 0) if top else 1
        pull = self["holding_acceleration_mm_per_s2"] * left
        pull /= 1 + speed_mm_per_s / self["half_torque_speed_mm_per_s"]
        return pull - self["friction_mm_per_s2"]

    def parameters(self, pitch_mm: float | None = None) -> dict[str, int]:
        """The parameter set that is right for this machine, whatever is broken in it.

        What the machine does not decide is chosen: reversals between each limit switch and its
        overtravel switch, the pitch (by default 12 mm, or what the encoder's edges allow), rates
        of indexing and jogging. ToolError if no set fits.
        """
        values = {point.name: point.default or 0 for point in PARAMETERS}
        room_um = min(
            self["overtravel_mm"] - self["switch_plus_mm"],
            self["overtravel_mm"] + self["switch_minus_mm"],
        ) * 1000  # fmt: skip
        edges_per_rev = float(self.transitions_per_drum_rev) / 2
        most_mm = SLOPE_MAX * self.um_per_ustep * edges_per_rev / 1000
        pitch_mm = min(PITCH_MM, most_mm) if pitch_mm is None else pitch_mm
        mm_per_edge = pitch_mm / edges_per_rev
        scale = edges_per_rev / EDGES_PER_DRUM_REV
        plus_um, minus_um = (round(self[f"switch_{side}_mm"] * 1000) for side in ("plus", "minus"))
        values |= {
            "encoder_pulses_per_rev": int(self["encoder_pulses_per_rev"]),
            "encoder_ratio_numerator": int(self["encoder_ratio_numerator"]),
            "encoder_ratio_denominator": int(self["encoder_ratio_denominator"]),
            "encoder_invert_a": int(self["encoder_a_inverted"]),
            "encoder_invert_b": int(self["encoder_b_inverted"]),
            "drum_direction_invert": int(self["encoder_channels_swapped"]),
            "screw_lead_um": round(self["screw_lead_mm"] * 1000),
            "microsteps_per_rev": int(self["microsteps_per_rev"]),
            "carriage_direction_invert": int(self["motor_reversed"]),
            "switch_plus_um": plus_um,
            "switch_minus_um": minus_um,
            "switch_hysteresis_um": round(self["switch_hysteresis_mm"] * 1000)
            + RELEASED_CLEARANCE_UM,
            "switch_delay_us": round(self.switch_delay_ms * 1000),
            "travel_um": round(2000 * self["end_stop_mm"]),
            "pitch_um": round(pitch_mm * 1000),
            "overshoot_um": max(1, round(OVERSHOOT_PART * room_um)),
            "reversal_plus_um": round(plus_um + REVERSAL_PART * room_um),
            "reversal_minus_um": round(minus_um - REVERSAL_PART * room_um),
            "index_rate_edges_per_s": round(INDEX_MM_PER_S / mm_per_edge),
            "jog_rate_edges_per_s": round(JOG_MM_PER_S / mm_per_edge),
            "overspeed_warning_edges_per_s": round(values["overspeed_warning_edges_per_s"] * scale),
            "overspeed_trip_edges_per_s": round(values["overspeed_trip_edges_per_s"] * scale),
            "centre_position_um": (plus_um + minus_um) // 2,
        }
        clearance_um = values["overshoot_um"] + CLEARANCE_PART * room_um
        values["flange_plus_um"] = round(values["reversal_plus_um"] + clearance_um)
        values["flange_minus_um"] = round(values["reversal_minus_um"] - clearance_um)
        # What tolerances there is room for: the factory's are meant for its own.
        for name in ("switch_tolerance_um", "span_tolerance_um"):
            values[name] = min(values[name], round(room_um / 8))
        native.derive(values)
        return values


def make(given: Mapping[str, float]) -> Machine:
    """A machine of these figures, the others being the default machine's; ToolError if it is none.

    For programs: what people write, read() reads.
    """
    known = native.machine_figures()
    for name, value in given.items():
        _check(_figure(name), value)
    native.check_machine(given)
    figures = {name: figure.default for name, figure in known.items()} | dict(given)
    return Machine(MappingProxyType(figures), MappingProxyType(dict(given)))


def describing(parameters: Mapping[str, int]) -> Machine:
    """The machine on which a whole parameter set is right; RefusedError if that set never is."""
    native.derive(parameters)
    return make(native.machine_of(parameters))


def read(path: Path) -> Machine:
    """The machine in a file; ToolError names file, line, figure, value and limit."""
    document = yaml_file.load(path)
    if not isinstance(document, dict) or not document:
        raise ToolError(
            f"{path}: a machine is lines of `figure: value`, as `screw_lead_mm: 20`; "
            "doc/machine.md has all of them."
        )
    try:
        given: dict[str, float] = {}
        for name, value in document.items():
            with yaml_file.at(name):
                figure = _figure(str(name))
                with yaml_file.at(value):
                    given[figure.name] = _check(figure, _value(figure, value))
        try:
            return make(given)
        except native.MisfitError as error:
            lines = {str(name): name for name in document}
            with yaml_file.at(lines.get(error.figure)):
                raise
    except ToolError as error:
        raise yaml_file.placed(path, error) from None


def _figure(name: str) -> native.Figure:
    known = native.machine_figures()
    if name not in known:
        near = difflib.get_close_matches(name, known, n=3)
        hint = f" Did you mean {', '.join(near)}?" if near else " doc/machine.md has all of them."
        raise ToolError(f"no machine has a figure {name}.{hint}")
    return known[name]


def _value(figure: native.Figure, given: object) -> float:
    """What stands in the file, as a number."""
    if figure.words:
        if given not in figure.words:
            raise ToolError(f"{figure.name}: {given}: give {' or '.join(figure.words)}.")
        return figure.words.index(str(given))
    try:
        return parse_number(given)
    except ValueError:
        kind = "a whole number" if figure.whole else "a number with a decimal point"
        raise ToolError(f"{figure.name}: {given}: give {kind}, {_limits(figure)}.") from None


def _limits(figure: native.Figure) -> str:
    return f"{figure.min:g} to {figure.max:g}"


def _check(figure: native.Figure, value: float) -> float:
    if not figure.min <= value <= figure.max:
        raise ToolError(f"{figure.name}: {value:g} is outside its limits: {_limits(figure)}.")
    if figure.whole and value != int(value):
        raise ToolError(f"{figure.name}: {value:g} is no whole number.")
    return value
