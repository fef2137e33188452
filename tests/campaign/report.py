# SPDX-License-Identifier: Apache-2.0
"""The campaign's report: one HTML file with everything in it."""

import base64
import html
import io
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from levelwind.line.points import enum_label
from levelwind.map_table import Fault, Flag, State
from levelwind.show.plots import new_figure
from matplotlib.figure import Figure

from .launch import Invariant, Sample, Verdict, play
from .scenario import FAULTS, scenario

if TYPE_CHECKING:
    from .workers import Played

UM_PER_USTEP = 10
LOS_FLAGS = (Flag.LOS, Flag.LOS1_PLUS, Flag.LOS1_MINUS, Flag.LOS2_PLUS, Flag.LOS2_MINUS)
MARKS_MM = {
    "flange": (83.0, "tab:red"),
    "reversal": (80.0, "tab:gray"),
    "switch": (78.4, "tab:green"),
}
OUTCOMES = ("broken", "fault", "LOS told", "not launched", "no alarm")
WORST_EACH = 2

STATEMENTS = {
    Invariant.FLANGE: "In step, with sound switches: the steps command no place past a flange.",
    Invariant.OVERTRAVEL: "No step goes toward an actuated overtravel switch.",
    Invariant.SILENT: "A lay that is wrong to the drum is told within one traverse, or 600 ms.",
    Invariant.PERMIT: "No launch permit without an indexing that really went to both switches.",
    Invariant.BURST: "At most one step per edge, and a microstep of slope between two.",
    Invariant.UNASKED: "No step in a state in which the carriage rests.",
    Invariant.PATTERN: "While tracking, position and slope are the ideal screw's, bit for bit.",
    Invariant.ODOMETER: "Every edge on the pins is counted; only hidden edges differ.",
    Invariant.RECOVERY: "A LOS is made good in the sweep after the next reversal.",
    Invariant.FALSE_ALARM: "What does not disturb the lay gives no alarm.",
    Invariant.STANDING: "Rope laid while the carriage stood is told.",
    Invariant.LINE: "A request is answered once, also over an echo and after babble.",
}

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; margin: 1rem 0 }
td, th { border: 1px solid #ccc; padding: .25rem .6rem; text-align: left }
td.number { text-align: right }
th { background: #f0f3f7 } td.bad { background: #f8c9c4; font-weight: bold }
img { max-width: 100%; border: 1px solid #ddd } code, pre { background: #f4f4f4 }
pre { padding: .6rem; overflow-x: auto }
"""


class Launch:
    """A launch that has been played."""

    def __init__(self, seed: int, faults: Sequence[str], verdict: Verdict) -> None:
        self.seed = seed
        self.faults = tuple(faults)
        self.verdict = verdict

    @property
    def outcome(self) -> str:
        """What came of it, in a word."""
        if self.verdict.broken is not None:
            return "broken"
        if self.verdict.fault:
            return "fault"
        if self.verdict.los_seen:
            return "LOS told"
        return "no alarm" if self.verdict.tracking_ms else "not launched"

    def summary(self) -> str:
        """One line."""
        v = self.verdict
        los = [flag.label for flag in LOS_FLAGS if v.los_seen >> flag & 1]
        parts = [
            f"launch {self.seed}: {' + '.join(self.faults)}",
            f"{v.duration_ms / 1000:.1f} s, {v.tracking_ms / 1000:.1f} s of it tracking",
            f"ended in {enum_label(State, v.state)}",
        ]
        if v.fault:
            parts.append(f"fault {enum_label(Fault, v.fault)}")
        if los:
            parts.append("told " + ", ".join(los))
        if v.broken is not None:
            parts.append(
                f"BROKEN at {v.broken_ms / 1000:.3f} s: {v.broken.name} "
                f"(found {v.found:g}, limit {v.limit:g})"
            )
        return "; ".join(parts)


def worst(launches: Iterable[Launch]) -> dict[Launch, list[str]]:
    """What to look at, with the reasons: what broke an invariant, then the nearest misses."""
    launches = list(launches)
    failed = [x for x in launches if x.verdict.broken is not None]
    chosen = {x: ["broke an invariant"] for x in failed[:20]}
    for reason, key in (
        ("longest wrong lay before it was told", lambda v: v.silent_edges),
        ("largest error of the carriage while the permit stood", lambda v: v.error_usteps),
        ("longest way from being told to being right again", lambda v: v.recovered_edges),
        ("most recoveries in one launch", lambda v: v.recoveries),
        ("most edges hidden from the pins", lambda v: v.hidden_edges),
        ("most rope laid wrong on a drum too slow for its watch", lambda v: v.slow_turns),
        (
            "most electrical periods slipped while it went on",
            lambda v: v.pole_slips * (not v.fault),
        ),
    ):
        ranked = sorted(launches, key=lambda x, key=key: key(x.verdict), reverse=True)
        for launch in ranked[:WORST_EACH]:
            if key(launch.verdict) > 0:
                chosen.setdefault(launch, []).append(reason)
    return chosen


def draw(trace: Sequence[Sample], title: str) -> Figure:
    """A launch over time: where the carriage is, where it should be, the drum."""
    figure = new_figure(13, 6.5)
    place, error, drum = figure.subplots(3, 1, sharex=True, height_ratios=(4, 1.6, 1.2))
    times = [row.time_ms / 1000 for row in trace]
    mm = UM_PER_USTEP / 1000
    nothing = float("nan")
    ideal = [row.ideal_usteps * mm if row.following else nothing for row in trace]
    indexed = [bool(row.flags >> Flag.INDEXED & 1) for row in trace]
    told = [row.told_usteps * mm if on else nothing for row, on in zip(trace, indexed, strict=True)]
    real = [row.carriage_usteps * mm for row in trace]
    for name, (at, colour) in MARKS_MM.items():
        place.axhline(at, color=colour, linewidth=0.6, linestyle=":")
        place.axhline(-at, color=colour, linewidth=0.6, linestyle=":", label=name)
    place.plot(times, real, color="tab:orange", linewidth=2.4, label="real carriage")
    place.plot(times, ideal, color="tab:green", linewidth=1.6, label="ideal screw")
    place.plot(times, told, color="#0b3c8c", linewidth=0.9, label="told by the controller")
    place.set_ylabel("carriage, mm")
    place.set_title(title, fontsize=10)
    gap = [a - b for a, b in zip(real, told, strict=True)]
    error.plot(times, gap, color="tab:red", linewidth=1)
    error.set_ylabel("real - told, mm")
    drum.plot(times, [row.drum_edges_per_s / 1000 for row in trace], color="black", linewidth=1)
    drum.set_ylabel("1000 edges/s")
    drum.set_xlabel("s")
    for bit, colour, label in (
        (Flag.LAUNCH_PERMIT, "#c7e9c0", "launch permit"),
        (Flag.LOS, "#f6b6ae", "LOS told"),
        (Flag.FAULTED, "#b9b9b9", "fault"),
    ):
        on = [bool(row.flags >> bit & 1) for row in trace]
        place.fill_between(
            times,
            *(0, 1),
            where=on,
            transform=place.get_xaxis_transform(),
            color=colour,
            alpha=0.55,
            linewidth=0,
            label=label,
        )
    place.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def _picture(launch: Launch, library: Path | None) -> str:
    _, trace = play(scenario(launch.seed), traced=True, library=library)
    buffer = io.BytesIO()
    draw(trace, launch.summary()).savefig(buffer, format="png", dpi=75)
    encoded = base64.b64encode(buffer.getvalue()).decode()
    return f'<img alt="launch {launch.seed}" src="data:image/png;base64,{encoded}">'


def _table(head: Sequence[str], rows: Iterable[Sequence[object]], bad_column: int = -1) -> str:
    parts = ["<table><tr>", *(f"<th>{html.escape(h)}</th>" for h in head), "</tr>"]
    for row in rows:
        parts.append("<tr>")
        for column, value in enumerate(row):
            kind = "number" if isinstance(value, int) else ""
            kind += " bad" if column == bad_column and value else ""
            parts.append(f'<td class="{kind}">{html.escape(str(value))}</td>')
        parts.append("</tr>")
    return "".join([*parts, "</table>"])


def by_invariant(launches: Sequence[Launch]) -> list[tuple[str, str, int]]:
    """Invariant, statement, launches that broke it."""
    counts = Counter(x.verdict.broken for x in launches)
    return [(i.name.lower(), STATEMENTS[i], counts[i]) for i in Invariant]


def by_fault(launches: Sequence[Launch]) -> list[tuple[str | int, ...]]:
    """Fault, launches with it, and how many of each outcome."""
    rows = []
    for fault in FAULTS:
        outcomes = Counter(x.outcome for x in launches if fault in x.faults)
        rows.append((fault, sum(outcomes.values()), *(outcomes[o] for o in OUTCOMES)))
    outcomes = Counter(x.outcome for x in launches)
    rows.append(("all launches", len(launches), *(outcomes[o] for o in OUTCOMES)))
    return rows


def _ranges(seeds: Iterable[int]) -> str:
    """1-20, 41-60"""
    ranges: list[list[int]] = []
    for seed in sorted(seeds):
        if ranges and seed == ranges[-1][1] + 1:
            ranges[-1][1] = seed
        else:
            ranges.append([seed, seed])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in ranges)


def by_worker(pieces: Iterable["Played"]) -> list[tuple[str, int, int, float, str]]:
    """Host, process, launches that it has played, time of its processor, their seeds."""
    workers: dict[tuple[str, int], list[Played]] = {}
    for piece in pieces:
        workers.setdefault((piece.host, piece.process), []).append(piece)
    rows = []
    for (host, process), played in sorted(workers.items()):
        seeds = [launch.seed for piece in played for launch in piece.launches]
        seconds = sum(piece.seconds for piece in played)
        rows.append((host, process, len(seeds), seconds, _ranges(seeds)))
    return rows


def write(
    path: Path,
    launches: Sequence[Launch],
    command: str,
    pieces: Sequence["Played"],
    library: Path | None = None,
) -> None:
    """Write the report."""
    edges = sum(x.verdict.pin_edges for x in launches)
    hours = sum(x.verdict.duration_ms for x in launches) / 3_600_000
    seeds = sorted(x.seed for x in launches)
    faults = Counter(x.verdict.fault for x in launches if x.verdict.fault)
    sections = [
        f"<h1>Fault campaign</h1><p><code>{html.escape(command)}</code></p>",
        f"<p>{len(launches)} launches, seeds {seeds[0]} to {seeds[-1]}, {hours:.1f} h of winch "
        f"time, {edges / 1e6:.0f} million edges. What is tried and what each invariant means is "
        "in doc/campaign.md.</p>",
        "<h2>Invariants</h2>",
        _table(("invariant", "statement", "broken"), by_invariant(launches), bad_column=2),
        "<h2>What was tried, and what came of it</h2>",
        "<p>A launch with several faults counts once for each of them.</p>",
        _table(("fault", "launches", *OUTCOMES), by_fault(launches), bad_column=2),
        "<h2>Faults of the controller that ended launches</h2>",
        _table(
            ("fault", "launches"),
            ((enum_label(Fault, fault), count) for fault, count in faults.most_common()),
        ),
        "<h2>Where they ran</h2>",
        _table(
            ("host", "process", "launches", "s of its processor", "seeds"),
            (
                (host, str(process), count, round(seconds), seeds)
                for host, process, count, seconds, seeds in by_worker(pieces)
            ),
        ),
        "<h2>To look at</h2>",
    ]
    for launch, reasons in worst(launches).items():
        story = html.escape("\n".join(scenario(launch.seed).story))
        sections.append(
            f"<h3>{html.escape('; '.join(reasons))}</h3><p>{html.escape(launch.summary())}</p>"
            f"<p><code>./dev campaign --replay {launch.seed}</code></p>"
            f"{_picture(launch, library)}<details><summary>what was done</summary>"
            f"<pre>{story}</pre></details>"
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        "<!doctype html><html lang=en><meta charset=utf-8><title>Fault campaign</title>"
        f"<style>{STYLE}</style>{''.join(sections)}</html>\n"
    )
