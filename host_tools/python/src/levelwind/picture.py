"""The picture of a launch: what the carriage did, and how the rope lies on the drum."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Circle, Patch

from levelwind.ideal_screw import USTEP, Screw
from levelwind.map_table import Flag
from levelwind.map_table import State as ControllerState
from levelwind.plots import new_figure, save
from levelwind.points import enum_label
from levelwind.trace import Trace, turns

WIDTH_IN, HEIGHT_IN = 16, 11
ROPE_MM = 5.0  # thickness that the rope is drawn with
LAYER_RISE = 0.86  # of a thickness: the next layer settles into the gaps
COLOURS = colormaps["turbo"]
REAL = "#ffb04f"
COMMANDED = "#0b3c8c"
FREE = "#707070"
STATE_COLOURS = {
    ControllerState.SEEKING: "#f6d365",
    ControllerState.INDEX_REVERSAL: "#f0a35e",
    ControllerState.SPAN_CHECK: "#f7b7a3",
    ControllerState.PARKING: "#c9b6e4",
    ControllerState.READY: "#a8dadc",
    ControllerState.TRACKING: "#c7e9c0",
    ControllerState.FAULT: "#e63946",
}


@dataclass(frozen=True)
class Machine:
    """The numbers that turn a trace into millimetres."""

    screw: Screw
    active: Mapping[str, int]
    edges_per_drum_rev: float

    @property
    def um_per_ustep(self) -> float:
        """Carriage travel per microstep."""
        return self.active["screw_lead_um"] / self.active["microsteps_per_rev"]

    @property
    def rope_mm_per_drum_rev(self) -> float:
        """Rope per drum revolution."""
        return self.active["rope_per_drum_rev_um"] / 1000

    def mm(self, name: str) -> float:
        """A parameter in um as mm."""
        return self.active[name] / 1000

    def position_mm(self, q16: np.ndarray) -> np.ndarray:
        """Q16.16 microsteps as mm."""
        return q16 / USTEP * self.um_per_ustep / 1000


@dataclass(frozen=True)
class Lay:
    """Where the rope was laid: carriage position and layer by drum revolution, in order."""

    revs: np.ndarray
    position_mm: np.ndarray
    layer: np.ndarray
    revs_left: float  # what is on the drum at the end; beyond it the rope was pulled out again

    @property
    def layers(self) -> int:
        """Number of layers begun."""
        return int(self.layer[-1]) + 1


def draw(recording: Trace, machine: Machine, path: Path) -> None:
    """Make the picture."""
    tracked = recording.tracking()
    lay = _lay(tracked, machine)
    figure = new_figure(WIDTH_IN, HEIGHT_IN)
    grid = figure.add_gridspec(4, 12, height_ratios=(3.2, 2.2, 0.28, 4.6))
    position = figure.add_subplot(grid[0, :9])
    zoom = figure.add_subplot(grid[0, 9:])
    speed = figure.add_subplot(grid[1, :9], sharex=position)
    bars = figure.add_subplot(grid[2, :9], sharex=position)
    legend = figure.add_subplot(grid[1:3, 9:])
    surface = figure.add_subplot(grid[3, :6])
    section = figure.add_subplot(grid[3, 6:])

    zero_ms = tracked["time_ms"][0]
    _position(position, recording, machine, zero_ms)
    _zoom(zoom, tracked, machine, zero_ms)
    _speed(speed, recording, machine, zero_ms)
    _bars(bars, recording, zero_ms)
    _state_legend(legend, recording)
    _surface(surface, lay, machine)
    _section(section, lay, machine)
    length_m = lay.revs[-1] * machine.rope_mm_per_drum_rev / 1000
    figure.suptitle(
        f"Level wind over one launch: {length_m:.0f} m of rope in {lay.layers} layers, "
        f"laid by {machine.active['pitch_um'] / 1000:g} mm per drum revolution",
        fontsize=15,
        fontweight="bold",
    )
    save(figure, path)


def _lay(tracked: Trace, machine: Machine) -> Lay:
    """The rope's path: position at every drum revolution reached for the first time."""
    edges = tracked["pattern_edges"]
    furthest = np.maximum.accumulate(edges)
    fresh = np.concatenate(([True], np.diff(furthest) > 0)) & (edges == furthest)
    rows = tracked.rows(fresh)
    revs = rows["pattern_edges"] / machine.edges_per_drum_rev
    return Lay(
        revs=revs,
        position_mm=machine.position_mm(rows["m"]),
        layer=np.cumsum(turns(rows)),
        revs_left=edges[-1] / machine.edges_per_drum_rev,
    )


def _seconds(trace: Trace, zero_ms: int) -> np.ndarray:
    return (trace["time_ms"] - zero_ms) / 1000


def _position(axes: Axes, recording: Trace, machine: Machine, zero_ms: int) -> None:
    times = _seconds(recording, zero_ms)
    indexed = recording.flag(Flag.INDEXED)
    commanded = machine.position_mm(recording["m"])
    axes.plot(
        times,
        recording["carriage_um"] / 1000,
        color="tab:orange",
        linewidth=2.6,
        label="real carriage",
    )
    axes.plot(
        times,
        np.where(indexed, commanded, np.nan),
        color=COMMANDED,
        linewidth=1.0,
        label="commanded (once indexed)",
    )
    _sides(axes, machine, labels=True)
    axes.set_ylabel("carriage, mm")
    axes.set_ylim(machine.mm("flange_minus_um") * 1.12, machine.mm("flange_plus_um") * 1.12)
    axes.legend(loc="upper center", ncols=4, fontsize=8, bbox_to_anchor=(0.5, 1.14), frameon=False)
    axes.grid(alpha=0.25)
    axes.tick_params(labelbottom=False)


def _sides(axes: Axes, machine: Machine, labels: bool) -> None:
    for side in ("plus", "minus"):
        flange, reversal = machine.mm(f"flange_{side}_um"), machine.mm(f"reversal_{side}_um")
        label = "reversal point" if labels and side == "plus" else None
        axes.axhline(reversal, color="tab:red", linestyle="--", linewidth=1, label=label)
        label = "flange" if labels and side == "plus" else None
        axes.axhspan(flange, flange * 1.3, color="0.6", alpha=0.55, label=label)


def _zoom(axes: Axes, tracked: Trace, machine: Machine, zero_ms: int) -> None:
    """The reversal at plus that was taken fastest."""
    turning = np.flatnonzero(turns(tracked) & (tracked["m"] >= machine.screw.sweep_end))
    if len(turning) == 0:
        axes.set_axis_off()
        return
    at = turning[np.argmax(np.abs(tracked["drum_millirpm"][turning]))]
    rpm = abs(tracked["drum_millirpm"][at]) / 1000
    edges_per_ms = max(1.0, rpm / 60e3 * machine.edges_per_drum_rev)
    half_ms = 1.6 * machine.screw.nr / edges_per_ms
    near = np.abs(tracked["time_ms"] - tracked["time_ms"][at]) <= half_ms
    rows = tracked.rows(near)
    times = rows["time_ms"] - tracked["time_ms"][at]
    axes.plot(times, rows["carriage_um"] / 1000, color=REAL, linewidth=3)
    axes.plot(times, machine.position_mm(rows["m"]), color=COMMANDED, linewidth=1.2)
    reversal = machine.mm("reversal_plus_um")
    overshoot = machine.screw.overshoot / USTEP * machine.um_per_ustep / 1000
    _sides(axes, machine, labels=False)
    axes.set_ylim(reversal - 1.2 * overshoot, machine.mm("flange_plus_um") + 0.35 * overshoot)
    axes.set_xlim(-half_ms, half_ms)
    seconds = (tracked["time_ms"][at] - zero_ms) / 1000
    axes.set_title(f"a reversal at {rpm:.0f} drum rpm, {seconds:.1f} s", fontsize=10)
    axes.set_xlabel("ms", labelpad=1)
    axes.set_ylabel("mm")
    axes.grid(alpha=0.25)


def _speed(axes: Axes, recording: Trace, machine: Machine, zero_ms: int) -> None:
    times = _seconds(recording, zero_ms)
    rope = recording["drum_millirpm"] / 60e6 * machine.rope_mm_per_drum_rev
    for state, begin, end in _spans(recording, times):
        colour = STATE_COLOURS.get(state)
        if colour is not None:
            axes.axvspan(begin, end, color=colour, linewidth=0)
    axes.plot(times, rope, color="black", linewidth=1.3)
    axes.axhline(0, color="0.4", linewidth=0.7)
    backward = rope < 0
    axes.fill_between(times, rope, 0, where=backward, color="tab:purple", alpha=0.45)
    if backward.any():
        where = times[backward].mean()
        axes.annotate(
            "rope pulled out: drum backward",
            (where, rope.min()),
            (where, rope.max() * 0.45),
            ha="right",
            fontsize=9,
            arrowprops={"arrowstyle": "->"},
        )
    axes.set_ylabel("rope, m/s (in +)")
    twin = axes.secondary_yaxis(
        "right",
        functions=(
            lambda v: v * 60e3 / machine.rope_mm_per_drum_rev,
            lambda rpm: rpm * machine.rope_mm_per_drum_rev / 60e3,
        ),
    )
    twin.set_ylabel("drum, rpm")
    axes.tick_params(labelbottom=False)
    axes.grid(alpha=0.25)


def _spans(recording: Trace, times: np.ndarray) -> list[tuple[int, float, float]]:
    """Times in which the state stayed the same."""
    state = recording["state"]
    starts = np.concatenate(([0], np.flatnonzero(np.diff(state)) + 1))
    ends = np.concatenate((starts[1:], [len(state) - 1]))
    return [
        (int(state[a]), float(times[a]), float(times[b])) for a, b in zip(starts, ends, strict=True)
    ]


def _bars(axes: Axes, recording: Trace, zero_ms: int) -> None:
    """Two strips: launch permit above, LOS below."""
    times = _seconds(recording, zero_ms)
    permit, los = recording.flag(Flag.LAUNCH_PERMIT), recording.flag(Flag.LOS)
    axes.fill_between(times, 1.05, 2, where=permit, color="#2a9d8f", step="post", linewidth=0)
    axes.fill_between(times, 1.05, 2, where=~permit, color="#d9d9d9", step="post", linewidth=0)
    axes.fill_between(times, 0, 0.95, where=los, color="#e63946", step="post", linewidth=0)
    axes.fill_between(times, 0, 0.95, where=~los, color="#d8f3dc", step="post", linewidth=0)
    axes.set_yticks([0.5, 1.5], ["LOS", "permit"], fontsize=8)
    axes.set_ylim(0, 2)
    axes.set_xlim(times[0], times[-1])
    axes.set_xlabel("simulated time since the drum is followed, s", labelpad=1)


def _state_legend(axes: Axes, recording: Trace) -> None:
    seen = [state for state in STATE_COLOURS if (recording["state"] == state).any()]
    handles = [
        Patch(color=STATE_COLOURS[s], label=enum_label(ControllerState, s).replace("_", " "))
        for s in seen
    ]
    handles += [
        Patch(color="#2a9d8f", label="launch permitted"),
        Patch(color="#d9d9d9", label="launch not permitted"),
        Patch(color="#d8f3dc", label="in synchronization"),
        Patch(color="#e63946", label="loss of synchronization"),
    ]
    axes.set_axis_off()
    axes.legend(handles=handles, loc="center", fontsize=9, frameon=False, title="states and flags")


def _colour(layer: int, layers: int) -> tuple[float, ...]:
    """Blue inside to red outside; every other layer lighter, so that neighbours differ."""
    colour = COLOURS(0.08 + 0.84 * layer / max(1, layers - 1))[:3]
    white = 0.4 if layer % 2 else 0.0
    return tuple(part + (1 - part) * white for part in colour)


def _surface(axes: Axes, lay: Lay, machine: Machine) -> None:
    """The drum unrolled: every wrap is a line, later layers lie on earlier ones."""
    axes.set_facecolor("#3b2f2a")
    axes.set_xlim(machine.mm("flange_minus_um") - 6, machine.mm("flange_plus_um") + 6)
    axes.set_ylim(0, 360)
    width_pt = _points_per_mm(axes, machine) * ROPE_MM
    degrees = 6.0
    revs = np.arange(0, lay.revs_left, degrees / 360)
    if len(revs) < 2:
        return
    x = np.interp(revs, lay.revs, lay.position_mm)
    layer = lay.layer[np.searchsorted(lay.revs, revs, side="right") - 1]
    angle = revs * 360
    for number in range(int(layer[-1]) + 1):
        chosen = np.flatnonzero(layer == number)
        lines = _wraps(x, angle, chosen)
        colour = _colour(number, lay.layers)
        shade = tuple(0.45 * part for part in colour)
        for line_width, line_colour in ((width_pt, shade), (width_pt * 0.72, colour)):
            axes.add_collection(
                LineCollection(lines, colors=[line_colour], linewidths=line_width, capstyle="butt")
            )
    axes.set_yticks(range(0, 361, 90))
    axes.set_ylabel("drum angle, degrees")
    axes.set_xlabel("mm across the drum")
    axes.set_title("The drum unrolled, at the end: rope coloured by layer", fontsize=11)
    for name, outward in (("flange_minus_um", -1), ("flange_plus_um", 1)):
        edge = machine.mm(name) + outward * ROPE_MM / 2
        axes.axvspan(edge, edge + outward * 6, color="0.6", zorder=3)


def _points_per_mm(axes: Axes, machine: Machine) -> float:
    """Of the unrolled drum, so that rope is drawn to scale across the drum."""
    span_mm = machine.mm("flange_plus_um") - machine.mm("flange_minus_um") + 12
    return WIDTH_IN * 72 * 0.46 / span_mm


def _wraps(x: np.ndarray, angle: np.ndarray, chosen: np.ndarray) -> list[np.ndarray]:
    """Lines of one layer, cut where the drum has gone round; each reaches past the cut."""
    lines = []
    first, last = int(chosen[0]), min(int(chosen[-1]) + 1, len(x) - 1)
    for turn in range(int(angle[first] // 360), int(angle[last] // 360) + 1):
        inside = np.arange(first, last + 1)
        inside = inside[(angle[inside] >= turn * 360 - 12) & (angle[inside] <= turn * 360 + 372)]
        if len(inside) > 1:
            lines.append(np.column_stack((x[inside], angle[inside] - turn * 360)))
    return lines


def _section(axes: Axes, lay: Lay, machine: Machine) -> None:
    """A cut through the wound drum: one circle for every wrap, layer on layer."""
    wraps = np.arange(0.5, lay.revs[-1])
    x = np.interp(wraps, lay.revs, lay.position_mm)
    layer = lay.layer[np.searchsorted(lay.revs, wraps, side="right") - 1]
    rise = ROPE_MM * LAYER_RISE
    left = wraps <= lay.revs_left
    for chosen, on_drum in ((left, True), (~left, False)):
        circles = [
            Circle((a, ROPE_MM / 2 + b * rise), ROPE_MM / 2)
            for a, b in zip(x[chosen], layer[chosen], strict=True)
        ]
        axes.add_collection(
            PatchCollection(
                circles,
                facecolors=[_colour(b, lay.layers) for b in layer[chosen]] if on_drum else "none",
                edgecolors="black" if on_drum else FREE,
                linewidths=0.6,
                linestyles="-" if on_drum else ":",
            )
        )
    top = ROPE_MM + lay.layers * rise + 4
    inner = machine.mm("flange_minus_um"), machine.mm("flange_plus_um")
    axes.axhspan(-8, 0, color="#3b2f2a")
    for edge, outward in zip(inner, (-1, 1), strict=True):
        flange = edge + outward * ROPE_MM / 2
        axes.fill_betweenx((-8, top), flange, flange + outward * 5, color="0.6")
    axes.set_xlim(inner[0] - 6, inner[1] + 6)
    axes.set_ylim(-8, top)
    axes.set_aspect("equal", adjustable="box")
    axes.set_yticks(
        [ROPE_MM / 2 + n * rise for n in range(0, lay.layers, 2)],
        [str(n + 1) for n in range(0, lay.layers, 2)],
    )
    axes.set_ylabel("layer")
    axes.set_xlabel("mm across the drum")
    pulled_m = (lay.revs[-1] - lay.revs_left) * machine.rope_mm_per_drum_rev / 1000
    axes.set_title(
        f"A cut through the drum, {len(wraps)} wraps; dotted: the last {pulled_m:.0f} m, "
        "pulled out again",
        fontsize=11,
    )
