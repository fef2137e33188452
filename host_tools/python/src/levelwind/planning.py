"""What follows from a parameter set: the core's derived values, rates, times, and a picture."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from levelwind import native
from levelwind.errors import ToolError
from levelwind.ideal_screw import USTEP, Screw, State
from levelwind.map_table import POINTS
from levelwind.points import PARAMETERS, check_limits

RUN_EDGES_MAX = 2**31 - 1
I16_MAX = 32767


@dataclass(frozen=True)
class Plan:
    """A parameter set and what the core makes of it."""

    parameters: dict[str, int]
    derived: native.Derived
    rope_speed_m_per_s: float

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
            "carriage_mm_per_s": edges_per_s * slope * self.um_per_ustep / 1000,
            "reversal_s": 2 * self.derived.nr / edges_per_s,
            "reversal_acceleration_mm_per_s2": usteps_per_s2 * self.um_per_ustep / 1000,
            "drum_revs_per_sweep": orbit.sweep_edges / self.edges_per_drum_rev,
            "pattern_period_s": orbit.period_edges / edges_per_s,
        }

    def document(self) -> dict[str, object]:
        """For --json."""
        return {
            "derived": asdict(self.derived),
            "at_rope_speed": {name: round(value, 6) for name, value in self.rates().items()},
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
            ("sweep", f"{rates['drum_revs_per_sweep']:.2f}", "drum revs", ""),
            ("rope speed", f"{self.rope_speed_m_per_s:g}", "m/s", "for the rest of this table"),
            ("drum", f"{rates['drum_rpm']:.1f}", "rpm", ""),
            ("edge rate", f"{rates['edges_per_s']:.0f}", "edges/s", ""),
            ("step rate", f"{rates['steps_per_s']:.0f}", "steps/s", ""),
            ("carriage", f"{rates['carriage_mm_per_s']:.1f}", "mm/s", "in the sweep"),
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


def plan(changes: Mapping[str, int], rope_speed_m_per_s: float) -> Plan:
    """The factory set with changes; RefusedError with reason, value and limit if it is refused."""
    for name in changes:
        if not POINTS[name].mirrors:
            raise ToolError(f"{name} is no parameter.")
    parameters = {p.name: p.default or 0 for p in PARAMETERS} | dict(changes)
    return Plan(parameters, native.derive(parameters), rope_speed_m_per_s)


def plot(result: Plan, path: Path) -> None:
    """Carriage position over drum revolutions for one pattern, and one reversal enlarged."""
    from levelwind.plots import new_figure, save  # noqa: PLC0415 - matplotlib takes a second

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


def replay_setup(ka: int, nr: int, lplus: int, lminus: int, m: int, u: int) -> dict[str, int]:
    """The arguments of a replay; ToolError names the value and its limit."""
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
        "dwell_plus_edges": 0,
        "dwell_minus_edges": 0,
    }


def _reach(ka: int, nr: int) -> int:
    """Overshoot in whole microsteps, rounded up."""
    return ka * nr * (nr - 1) // 2 // USTEP + 1


def plot_replay(
    trace: Sequence[int], stride: int, title: str, lines: Sequence[int], path: Path
) -> None:
    """Position over edges, with horizontal lines."""
    from levelwind.plots import new_figure, save  # noqa: PLC0415

    figure = new_figure(11, 5)
    axes = figure.subplots()
    axes.plot([i * stride for i in range(len(trace))], trace)
    for usteps in lines:
        axes.axhline(usteps, color="tab:red", linestyle="--", linewidth=0.9)
    axes.set_xlabel("drum edges, forward and backward")
    axes.set_ylabel("carriage, microsteps")
    axes.set_title(title)
    axes.grid(alpha=0.3)
    save(figure, path)
