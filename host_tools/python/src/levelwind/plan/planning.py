# SPDX-License-Identifier: Apache-2.0
"""What follows from a parameter set: the core's derived values, rates, times, and a picture."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path

from levelwind.core import native
from levelwind.core.ideal_screw import USTEP, Screw, State
from levelwind.errors import RefusedError, ToolError
from levelwind.lay import rope
from levelwind.lay.wind import warning as lay_warning
from levelwind.line.points import PARAMETERS, check_limits
from levelwind.map_table import POINTS, Reason

RUN_EDGES_MAX = 2**31 - 1
I16_MAX = 32767
POSITION_MAX_USTEPS = 32_700
"""As in lib/lw_core/src/control/params.c."""
USUAL_MICROSTEPS = (25600, 20000, 12800, 10000, 6400, 5000, 4000, 3200, 2000, 1600, 1000, 800, 400)
"""Microsteps per revolution that stepper drivers offer."""

# Above these a plan is worth a second look: rules of thumb for steppers and ball screws.
SCREW_RPM_MAX = 1500
ACCELERATION_MAX_MM_PER_S2 = 20_000
SEARCH_MM_PER_S_MAX = 100

RATIO_ERROR_MAX_PPM = 20_000
"""A ratio that is further off is no help."""

# Between flange, reversal point, switch and end stop, where they are not given.
FLANGE_CLEARANCE_UM = 3_000
OVERSHOOT_CLEARANCE_UM = 500
SWITCH_CLEARANCE_UM = 1_600
TRAVEL_CLEARANCE_UM = 14_000


# What the law takes: 10 drum revolutions of the finest encoder, and 2.
DWELL_EDGES_MAX = 40_000_000
BREAKER_EDGES_MAX = 8_000_000
BREAKER_CYCLES_MAX = POINTS["breaker_cycles"].max or 0


@dataclass(frozen=True)
class Plan:
    """A parameter set and what the core makes of it."""

    parameters: dict[str, int]
    derived: native.Derived
    rope_speed_m_per_s: float
    belt: bool = False
    """A belt moves the carriage: it has a pulley, no screw."""

    @property
    def screw(self) -> Screw:
        """The ideal screw of this set."""
        d = self.derived
        return Screw(
            d.ka,
            d.nr,
            d.reversal_plus_usteps,
            d.reversal_minus_usteps,
            d.dwell_plus_edges,
            d.dwell_minus_edges,
            d.breaker_edges,
            d.breaker_cycles,
        )

    @property
    def um_per_ustep(self) -> float:
        """Carriage travel per microstep."""
        return self.parameters["screw_lead_um"] / self.parameters["microsteps_per_rev"]

    @property
    def edges_per_drum_rev(self) -> float:
        """Used encoder edges per drum revolution."""
        return self.derived.edges_per_1000_drum_revs / 1000

    def sides_mm(self, place: str) -> tuple[float, float]:
        """Where reversals (in force, also in expert mode), switches or flanges are."""
        if place == "reversal":
            plus, minus = self.derived.reversal_plus_usteps, self.derived.reversal_minus_usteps
            return plus * self.um_per_ustep / 1000, minus * self.um_per_ustep / 1000
        plus, minus = (self.parameters[f"{place}_{side}_um"] for side in ("plus", "minus"))
        return plus / 1000, minus / 1000

    @property
    def range_mm(self) -> float:
        """How far from 0 a position can be."""
        return POSITION_MAX_USTEPS * self.um_per_ustep / 1000

    def _mm_per_s(self, edges_per_s: float) -> float:
        """Speed of the carriage in the sweep."""
        return edges_per_s * self.derived.ks / USTEP * self.um_per_ustep / 1000

    def _rope_m_per_s(self, edges_per_s: float) -> float:
        revs_per_s = edges_per_s / self.edges_per_drum_rev
        return revs_per_s * self.parameters["rope_per_drum_rev_um"] / 1e6

    def rates(self) -> dict[str, float]:
        """Speeds and times at the rope speed."""
        revs_per_s = self.rope_speed_m_per_s * 1e6 / self.parameters["rope_per_drum_rev_um"]
        edges_per_s = revs_per_s * self.edges_per_drum_rev
        slope = self.derived.ks / USTEP
        usteps_per_s2 = self.derived.ka / USTEP * edges_per_s**2
        orbit = self.screw.orbit(State(self.screw.sweep_begin, self.screw.ks))
        return {
            "rope_speed_m_per_s": self.rope_speed_m_per_s,
            "drum_rpm": revs_per_s * 60,
            "edges_per_s": edges_per_s,
            "steps_per_s": edges_per_s * slope,
            "carriage_mm_per_s": self._mm_per_s(edges_per_s),
            "screw_rpm": edges_per_s * slope / self.parameters["microsteps_per_rev"] * 60,
            "index_mm_per_s": self._mm_per_s(self.parameters["index_rate_edges_per_s"]),
            "jog_mm_per_s": self._mm_per_s(self.parameters["jog_rate_edges_per_s"]),
            "reversal_s": 2 * self.derived.nr / edges_per_s,
            "reversal_acceleration_mm_per_s2": usteps_per_s2 * self.um_per_ustep / 1000,
            "drum_revs_per_sweep": orbit.sweep_edges / self.edges_per_drum_rev,
            "pattern_period_s": orbit.period_edges / edges_per_s,
        }

    def warnings(self) -> list[str]:
        """What the core takes, and a winch hardly would."""
        rates = self.rates()
        found = []
        at_speed = f"At {self.rope_speed_m_per_s:g} m/s of rope"
        for name, what in (
            ("overspeed_trip_edges_per_s", "the controller stops with a fault"),
            ("overspeed_warning_edges_per_s", "the flag overspeed_warning is on"),
        ):
            limit = self.parameters[name]
            if rates["edges_per_s"] > limit:
                found.append(
                    f"{at_speed} the encoder gives {rates['edges_per_s']:.0f} edges/s, more than "
                    f"{name} {limit} ({self._rope_m_per_s(limit):.1f} m/s): {what}. Use fewer "
                    "edges per drum revolution, or raise it if controller and stepper can follow."
                )
                break
        if rates["screw_rpm"] > SCREW_RPM_MAX:
            found.append(
                f"{at_speed} the {self._shaft} turns at {rates['screw_rpm']:.0f} rpm; above "
                f"{SCREW_RPM_MAX} few steppers have torque left. Use a longer "
                f"{'belt pulley' if self.belt else 'lead'}, or a smaller pitch."
            )
        if rates["reversal_acceleration_mm_per_s2"] > ACCELERATION_MAX_MM_PER_S2:
            found.append(
                f"{at_speed} the carriage reverses with "
                f"{rates['reversal_acceleration_mm_per_s2'] / 1000:.1f} m/s2, more than "
                f"{ACCELERATION_MAX_MM_PER_S2 / 1000:g}: it may lose steps. Use more overshoot, or "
                "a smaller pitch."
            )
        limit = self.parameters["cam_steps_per_s_max"]
        if rates["steps_per_s"] > limit:
            found.append(
                f"{at_speed} the stepper gets {rates['steps_per_s']:.0f} steps/s, more than "
                f"cam_steps_per_s_max {limit}. Use fewer microsteps."
            )
        for what, parameter in (("Indexing", "index"), ("Jogging", "jog")):
            if rates[f"{parameter}_mm_per_s"] > SEARCH_MM_PER_S_MAX:
                found.append(
                    f"{what} moves the carriage at {rates[f'{parameter}_mm_per_s']:.0f} mm/s, more "
                    f"than {SEARCH_MM_PER_S_MAX}. Lower {parameter}_rate_edges_per_s."
                )
        laid = lay_warning(self.parameters, rope.turns_of(self.parameters, rope.LAUNCH_M))
        return [*found, laid] if laid else found

    @property
    def _shaft(self) -> str:
        return "pulley" if self.belt else "screw"

    def document(self) -> dict[str, object]:
        """For --json."""
        return {
            "derived": asdict(self.derived),
            "at_rope_speed": {name: round(value, 6) for name, value in self.rates().items()},
            "range_mm": round(self.range_mm, 3),
            "warnings": self.warnings(),
            "parameters": self.parameters,
        }

    def rows(self) -> list[tuple[str, str, str, str]]:
        """For the table."""
        d = self.derived
        rates = self.rates()
        pitch_um = self.parameters["pitch_um"]
        return [
            ("Ka", str(d.ka), "usteps/65536", "slope change per edge in a reversal"),
            ("Nr", str(d.nr), "edges", "from sweep slope to zero slope"),
            ("Ks", str(d.ks), "usteps/65536", f"sweep slope, {d.ks / USTEP:.4f} steps per edge"),
            ("L+", str(d.reversal_plus_usteps), "usteps", self._mm(d.reversal_plus_usteps)),
            ("L-", str(d.reversal_minus_usteps), "usteps", self._mm(d.reversal_minus_usteps)),
            ("overshoot", str(d.overshoot_um), "um", f"{d.overshoot_error_um:+d} um from asked"),
            (
                "pitch error",
                f"{d.slope_error_ppm:+d}",
                "ppm",
                f"{pitch_um * d.slope_error_ppm / 1e6:+.3f} um per drum revolution",
            ),
            ("edges", f"{self.edges_per_drum_rev:.3f}", "per drum rev", ""),
            ("dwell +", str(d.dwell_plus_edges), "edges", ""),
            ("dwell -", str(d.dwell_minus_edges), "edges", ""),
            (
                "breaker",
                str(d.breaker_edges),
                "edges",
                f"at most on top, up and down in {d.breaker_cycles} double traverses"
                if d.breaker_edges
                else "",
            ),
            (
                "range",
                f"{self.range_mm:.1f}",
                "mm",
                f"either way from 0, also for travel: {POSITION_MAX_USTEPS} usteps",
            ),
            ("index speed", f"{rates['index_mm_per_s']:.1f}", "mm/s", "index_rate_edges_per_s"),
            ("jog speed", f"{rates['jog_mm_per_s']:.1f}", "mm/s", "jog_rate_edges_per_s"),
            ("sweep", f"{rates['drum_revs_per_sweep']:.2f}", "drum revs", ""),
            ("rope speed", f"{self.rope_speed_m_per_s:g}", "m/s", "for the rest of this table"),
            ("drum", f"{rates['drum_rpm']:.1f}", "rpm", ""),
            ("edge rate", f"{rates['edges_per_s']:.0f}", "edges/s", ""),
            ("step rate", f"{rates['steps_per_s']:.0f}", "steps/s", ""),
            ("carriage", f"{rates['carriage_mm_per_s']:.1f}", "mm/s", "in the sweep"),
            (self._shaft, f"{rates['screw_rpm']:.0f}", "rpm", "in the sweep"),
            ("reversal", f"{rates['reversal_s'] * 1000:.1f}", "ms", "sweep to sweep"),
            (
                "acceleration",
                f"{rates['reversal_acceleration_mm_per_s2'] / 1000:.2f}",
                "m/s2",
                "in the reversal",
            ),
            ("pattern", f"{rates['pattern_period_s']:.2f}", "s", "there and back"),
        ]

    def _mm(self, usteps: int) -> str:
        return f"{usteps * self.um_per_ustep / 1000:+.3f} mm"


def check(values: Mapping[str, int]) -> dict[str, int]:
    """Parameter values within the limits of their registers."""
    return {name: check_limits(POINTS[name], value) for name, value in values.items()}


def along(given: Mapping[str, int]) -> dict[str, int]:
    """What must move where a flange or a reversal point was given alone, in micrometres.

    A reversal point keeps its distance from the flange, a switch its from the reversal point, and
    the travel reaches beyond both flanges.
    """
    factory = {p.name: p.default or 0 for p in PARAMETERS}
    moved: dict[str, int] = {}
    if given.get("expert_mode"):
        return moved  # its reversal points are raw_ values
    overshoot = given.get("overshoot_um", factory["overshoot_um"])
    clearance = max(FLANGE_CLEARANCE_UM, overshoot + OVERSHOOT_CLEARANCE_UM)
    for side, sign in (("plus", 1), ("minus", -1)):
        flange, reversal, switch = (
            f"{place}_{side}_um" for place in ("flange", "reversal", "switch")
        )
        if flange in given and reversal not in given:
            moved[reversal] = given[flange] - sign * clearance
        if switch not in given and (reversal in given or reversal in moved):
            moved[switch] = {**given, **moved}[reversal] - sign * SWITCH_CLEARANCE_UM
    places = {**factory, **given}
    needed = places["flange_plus_um"] - places["flange_minus_um"] + TRAVEL_CLEARANCE_UM
    flanges_given = "flange_plus_um" in given or "flange_minus_um" in given
    if flanges_given and "travel_um" not in given and needed > factory["travel_um"]:
        moved["travel_um"] = needed
    return {name: um for name, um in moved.items() if um != factory[name]}


def ratio(text: str) -> Fraction:
    """A gear ratio as given: 4/1, 4 or 2.54."""
    match = re.fullmatch(r"(\d{1,9}(?:\.\d{1,9})?)(?:[/:](\d{1,9}(?:\.\d{1,9})?))?", text.strip())
    drum = Fraction(match[2] or 1) if match else Fraction(0)
    value = Fraction(match[1]) / drum if match and drum else Fraction(0)
    if value == 0:
        raise ToolError(f"--ratio {text}: give encoder per drum revolutions, as 4/1 or 4.")
    numerator_max, denominator_max = (
        POINTS[f"encoder_ratio_{part}"].max or 0 for part in ("numerator", "denominator")
    )
    if value.numerator <= numerator_max and value.denominator <= denominator_max:
        return value
    nearest = min(
        (
            Fraction(numerator, denominator)
            for numerator in range(1, numerator_max + 1)
            for below in (int(numerator / value), int(numerator / value) + 1)
            for denominator in (min(max(below, 1), denominator_max),)
        ),
        key=lambda fraction: abs(fraction - value),
    )
    message = (
        f"--ratio {text}: the numerator goes to {numerator_max}, the denominator to "
        f"{denominator_max}, in lowest terms."
    )
    error_ppm = float((nearest - value) / value) * 1e6
    if abs(error_ppm) < RATIO_ERROR_MAX_PPM:
        message += (
            f" The nearest that fits is {nearest.numerator}/{nearest.denominator}, "
            f"{error_ppm:+.0f} ppm: the pitch would be {-error_ppm:+.0f} ppm off."
        )
    raise ToolError(message)


def _fewer_microsteps(parameters: Mapping[str, int]) -> str:
    """The way out where a position does not fit, as the core sees it."""
    given = parameters["microsteps_per_rev"]
    lead_um = parameters["screw_lead_um"]
    text = (
        f"Positions and travel go to {POSITION_MAX_USTEPS} microsteps, which are "
        f"{POSITION_MAX_USTEPS * lead_um / given / 1000:.1f} mm with {given} microsteps and "
        f"{lead_um / 1000:g} mm per revolution."
    )
    for microsteps in USUAL_MICROSTEPS:
        if microsteps < given:
            try:
                native.derive({**parameters, "microsteps_per_rev": microsteps})
            except RefusedError as error:
                if _is_overflow(error):
                    continue
            return f"{text} {microsteps} microsteps would do: --microsteps {microsteps}"
    return text


def _is_overflow(error: RefusedError) -> bool:
    return error.reason == Reason.POSITION_OVERFLOW


def plan(changes: Mapping[str, int], rope_speed_m_per_s: float, *, belt: bool = False) -> Plan:
    """The factory set with changes; RefusedError with reason, value and limit if it is refused."""
    for name in changes:
        if not POINTS[name].mirrors:
            raise ToolError(f"{name} is no parameter.")
    parameters = {p.name: p.default or 0 for p in PARAMETERS} | dict(changes)
    try:
        derived = native.derive(parameters)
    except RefusedError as error:
        if _is_overflow(error):
            raise error.saying(f"{error}\n{_fewer_microsteps(parameters)}") from None
        raise
    return Plan(parameters, derived, rope_speed_m_per_s, belt)


def plot(result: Plan, path: Path) -> None:
    """Carriage position over drum revolutions for one pattern, and one reversal enlarged."""
    from levelwind.show.plots import new_figure, save  # noqa: PLC0415 - matplotlib takes a second

    screw = result.screw
    orbit = screw.orbit(State(screw.sweep_begin, screw.ks))
    mm_per_m = result.um_per_ustep / 1000 / USTEP
    stride = max(1, orbit.period_edges // 4000)
    figure = new_figure(12, 6)
    whole, detail = figure.subplots(1, 2, width_ratios=(2, 1))
    phases = range(0, orbit.period_edges + 1, stride)
    whole.plot(
        [phase / result.edges_per_drum_rev for phase in phases],
        [orbit.after(phase).m * mm_per_m for phase in phases],
        color="tab:blue",
    )
    whole.set_xlabel("drum revolutions, hauling in")
    whole.set_ylabel("carriage, mm")
    whole.set_title(
        f"Ka {screw.ka}, Nr {screw.nr}, Ks {screw.ks}: {screw.ks / USTEP:.4f} steps per edge"
    )
    margin = 2 * screw.nr // 3
    reversal = range(orbit.plus_at - margin, orbit.down_at + margin, max(1, (4 * screw.nr) // 2000))
    detail.plot(
        [phase - orbit.plus_at for phase in reversal],
        [orbit.after(phase).m * mm_per_m for phase in reversal],
        color="tab:blue",
    )
    detail.set_xlabel("edges since the reversal at plus began")
    overshoot_mm = screw.overshoot * mm_per_m
    detail.set_title(f"reversal: {overshoot_mm:.3f} mm in {2 * screw.nr} edges")
    for axes in (whole, detail):
        for place, dashes in (("reversal", "--"), ("switch", ":"), ("flange", "-")):
            for mm in result.sides_mm(place):
                label = place if axes is whole and mm == result.sides_mm(place)[0] else None
                axes.axhline(mm, color="tab:red", linestyle=dashes, linewidth=0.9, label=label)
        axes.grid(alpha=0.3)
    center = orbit.entry_plus * mm_per_m
    detail.set_ylim(center - 1.5 * overshoot_mm, center + 1.5 * overshoot_mm)
    whole.legend(loc="center right")
    save(figure, path)


def parse_runs(text: str) -> list[int]:
    """Runs of edges as given to --drum."""
    runs = []
    for part in text.split(","):
        try:
            edges = int(part)
        except ValueError:
            raise ToolError(f"--drum: {part!r} is no number of edges.") from None
        if abs(edges) > RUN_EDGES_MAX:
            raise ToolError(f"--drum: {edges} edges in one run, limit {RUN_EDGES_MAX}.")
        runs.append(edges)
    return runs


def replay_setup(
    ka: int,
    nr: int,
    lplus: int,
    lminus: int,
    m: int,
    u: int,
    *,
    dwells: tuple[int, int] = (0, 0),
    breaker: tuple[int, int] = (0, 0),
) -> dict[str, int]:
    """The arguments of a replay; ToolError names the value and its limit.

    dwells: edges at plus and minus; breaker: most edges that it adds, and its cycles.
    """
    limits: Sequence[tuple[str, int, int, int]] = (
        ("--ka", ka, 1, USTEP - 1),
        ("--nr", nr, 1, USTEP - 1),
        ("--ka times --nr (Ks)", ka * nr, 1, USTEP - 1),
        ("--lplus", lplus, -I16_MAX, I16_MAX),
        ("--lminus", lminus, -I16_MAX, lplus - 2),
        ("--lplus plus overshoot", lplus + _reach(ka, nr), -I16_MAX, I16_MAX),
        ("--lminus minus overshoot", lminus - _reach(ka, nr), -I16_MAX, I16_MAX),
        ("--u", u, -ka * nr, ka * nr),
        (
            "--m",
            m,
            (lminus - _reach(ka, nr)) * USTEP,
            (lplus + _reach(ka, nr)) * USTEP,
        ),
        ("--dwell-plus", dwells[0], 0, DWELL_EDGES_MAX),
        ("--dwell-minus", dwells[1], 0, DWELL_EDGES_MAX),
        ("--breaker-edges", breaker[0], 0, BREAKER_EDGES_MAX),
        ("--breaker-cycles", breaker[1], 2 if breaker[0] else 0, BREAKER_CYCLES_MAX),
    )
    for name, value, low, high in limits:
        if not low <= value <= high:
            raise ToolError(f"{name} is {value}, limits {low} to {high}.")
    if u % ka != 0:
        raise ToolError(f"--u is {u}, limit: a multiple of Ka, {ka}.")
    return {
        "ka": ka,
        "nr": nr,
        "lplus_usteps": lplus,
        "lminus_usteps": lminus,
        "m": m,
        "u": u,
        "dwell_plus_edges": dwells[0],
        "dwell_minus_edges": dwells[1],
        "breaker_edges": breaker[0],
        "breaker_cycles": breaker[1],
    }


def _reach(ka: int, nr: int) -> int:
    """Overshoot in whole microsteps, rounded up."""
    return ka * nr * (nr - 1) // 2 // USTEP + 1


def plot_replay(
    trace: Sequence[int], stride: int, title: str, lines: Sequence[int], path: Path
) -> None:
    """Position over edges, with horizontal lines."""
    from levelwind.show.plots import new_figure, save  # noqa: PLC0415

    figure = new_figure(11, 5)
    axes = figure.subplots()
    axes.plot([i * stride for i in range(len(trace))], trace)
    for usteps in lines:
        axes.axhline(usteps, color="tab:red", linestyle="--", linewidth=0.9)
    axes.set_xlabel("drum edges, forward and backward")
    axes.set_ylabel("carriage, microsteps")
    axes.set_title(title, parse_math=False)  # a cam's name may have $ in it
    axes.grid(alpha=0.3)
    save(figure, path)
