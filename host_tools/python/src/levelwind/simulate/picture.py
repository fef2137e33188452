# SPDX-License-Identifier: Apache-2.0
"""The picture of a launch: what the carriage did, and how the rope lies on the drum."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from levelwind.core.ideal_screw import USTEP, Screw
from levelwind.lay import field, plots
from levelwind.line.points import enum_label
from levelwind.map_table import Flag
from levelwind.map_table import State as ControllerState
from levelwind.show.plots import new_figure, save
from levelwind.simulate.trace import Trace, turns

WIDTH_IN, HEIGHT_IN = 16, 11
REAL = "#ffb04f"
COMMANDED = "#0b3c8c"
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
    """Where the rope was laid: carriage position and layer at every angle of the drum, in order."""

    position_mm: np.ndarray
    layer: np.ndarray
    revs_left: float  # what is on the drum at the end; beyond it the rope was pulled out again

    @property
    def revs(self) -> float:
        """Drum revolutions that were laid."""
        return len(self.layer) / field.ANGLES

    @property
    def left(self) -> int:
        """Angles whose rope is on the drum at the end."""
        return min(len(self.layer), round(self.revs_left * field.ANGLES))

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
    _rope(surface, section, lay, machine)
    length_m = lay.revs * machine.rope_mm_per_drum_rev / 1000
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
    reached = rows["pattern_edges"] / machine.edges_per_drum_rev
    revs = np.arange(max(1, int(reached[-1] * field.ANGLES))) / field.ANGLES
    layer = np.cumsum(turns(rows))
    return Lay(
        position_mm=np.interp(revs, reached, machine.position_mm(rows["m"])),
        layer=layer[np.searchsorted(reached, revs, side="right") - 1],
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


def _rope(surface: Axes, section: Axes, lay: Lay, machine: Machine) -> None:
    """The drum unrolled, and a cut across it, by the height field."""
    rope_um = machine.active["rope_diameter_um"]
    if rope_um == 0:
        for axes in (surface, section):
            axes.set_axis_off()
            axes.text(0.5, 0.5, "rope_diameter_um is 0: the rope is not drawn", ha="center")
        return
    if lay.left:
        plots.relief(surface, field.lay_path(lay.position_mm[: lay.left], rope_um))
    _flanges(surface, machine, rope_um / 1000)
    surface.set_title("The drum unrolled, at the end: its surface, lit from the side", fontsize=11)
    laid = field.lay_path(lay.position_mm, rope_um)
    plots.cut(section, laid, lay.layer / max(1, lay.layers - 1), lay.left)
    _flanges(section, machine, rope_um / 1000)
    pulled_m = (lay.revs - lay.revs_left) * machine.rope_mm_per_drum_rev / 1000
    section.set_title(
        f"A cut through the drum, {lay.layers} layers, blue to red; dotted: the last "
        f"{pulled_m:.0f} m, pulled out again",
        fontsize=11,
    )


def _flanges(axes: Axes, machine: Machine, rope_mm: float) -> None:
    """Half a rope beyond the farthest place of its middle."""
    edges = []
    for name, outward in (("flange_minus_um", -1), ("flange_plus_um", 1)):
        edge = machine.mm(name) + outward * rope_mm / 2
        axes.axvspan(edge, edge + outward * 6, color="0.6", zorder=3)
        edges.append(edge + outward * 4)
    axes.set_xlim(*edges)
