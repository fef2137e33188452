# SPDX-License-Identifier: Apache-2.0
"""Pictures of rope on a drum: unrolled as a relief, cut across, and evenness over pitch."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.colors import LightSource, Normalize
from matplotlib.patches import Circle

from levelwind.lay import field
from levelwind.lay.report import Lay
from levelwind.lay.search import Recommendation
from levelwind.lay.wind import NEAR_ROPES, ORDERS, Wind
from levelwind.show.plots import new_figure, save

COLOURS = colormaps["turbo"]
RELIEF = colormaps["cividis"]
DRUM = "#3b2f2a"
RIBBON_COLOURS = {1: "#e63946", 2: "#f0a35e", 3: "#f6d365"}
LIGHT = 0.3
"""Of the height: less than all of it, or the colours would drown."""
MM_BETWEEN_ANGLES = 6.0
"""What the relief's light takes for the way from one angle to the next: less than it is, so that
coils that cross show."""


def relief(axes: Axes, laid: field.Field) -> None:
    """The drum unrolled, lit from the side; colour by height."""
    shown = laid.height_mm[:, laid.judged]
    places = laid.place_mm[laid.judged]
    low, high = np.percentile(shown, [1, 99])
    heights = Normalize(low, max(high, low + laid.rope_mm))
    image = LightSource(azdeg=300, altdeg=45).shade(
        shown.astype(float),
        RELIEF,
        norm=heights,
        blend_mode="soft",
        vert_exag=LIGHT,
        dx=1 / field.COLUMNS_PER_MM,
        dy=MM_BETWEEN_ANGLES,
    )
    axes.imshow(
        image,
        extent=(places[0], places[-1], 0, 360),
        origin="lower",
        aspect="auto",
        interpolation="bilinear",
    )
    bar = axes.figure.colorbar(ScalarMappable(heights, RELIEF), ax=axes, pad=0.02, aspect=40)
    bar.set_label("mm above the drum", fontsize=8)
    bar.ax.tick_params(labelsize=8)
    axes.set_yticks(range(0, 361, 90))
    axes.set_ylabel("drum angle, degrees")
    axes.set_xlabel("mm across the drum")


def cut(axes: Axes, laid: field.Field, colour_of: Sequence[float], left: int | None = None) -> None:
    """A cut across the drum at angle 0: a circle for every coil, coloured from 0 to 1.

    From `left` on, counted in angles, the rope has been pulled out again: dotted.
    """
    coils = range(0, len(laid.position_mm), field.ANGLES)
    radius = laid.rope_mm / 2
    on_drum = [i for i in coils if left is None or i < left]
    for chosen in (on_drum, [i for i in coils if i not in set(on_drum)]):
        circles = [Circle((laid.position_mm[i], laid.centre_mm[i]), radius) for i in chosen]
        here = chosen is on_drum
        colours = [COLOURS(0.08 + 0.84 * colour_of[i]) for i in chosen]
        axes.add_collection(
            PatchCollection(
                circles,
                facecolors=colours if here else "none",
                edgecolors="black" if here else "#707070",
                linewidths=0.4,
                linestyles="-" if here else ":",
            )
        )
    top = max(laid.centre_mm[i] for i in coils) + radius
    axes.axhspan(-0.08 * top, 0, color=DRUM)
    axes.set_xlim(laid.place_mm[0], laid.place_mm[-1])
    axes.set_ylim(-0.08 * top, 1.05 * top)
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("mm across the drum")
    axes.set_ylabel("mm above the drum")


def displacements(axes: Axes, lay: Lay) -> None:
    """Where a coil comes to lie beside earlier ones."""
    rope_mm = lay.rope_um / 1000
    values = lay.wind.displacements_mm
    near = float(NEAR_ROPES) * rope_mm
    axes.axhspan(-near, near, color="#e63946", alpha=0.25, label="coil on coil")
    colours = ["#e63946" if order in lay.ribbons else "#35618f" for order in ORDERS]
    axes.bar(list(ORDERS), values, color=colours)
    for mm in (-rope_mm, rope_mm):
        axes.axhline(mm, color="0.4", linestyle="--", linewidth=0.8)
    axes.axhline(0, color="black", linewidth=0.6)
    axes.set_xticks(list(ORDERS))
    axes.set_xlabel("double traverses ago")
    axes.set_ylabel("mm beside that coil")
    axes.set_title("Beside earlier coils; dashed: one rope", fontsize=10)
    axes.grid(alpha=0.25, axis="y")


def over_pitch(
    axes: Axes,
    lay: Lay,
    curve: Sequence[tuple[Wind, field.Evenness]],
    recommended: Sequence[Recommendation],
) -> None:
    """Unevenness by pitch, the ribbons marked, and where the set stands."""
    pitch = np.array([float(wind.pitch_mm) for wind, _ in curve])
    std = np.array([even.std_mm for _, even in curve])
    order = np.argsort(pitch)
    pitch, std = pitch[order], std[order]
    ribbons = [curve[i][0].ribbons(lay.rope_um, lay.turns) for i in order]
    top = 1.25 * max(std.max(initial=0.0), lay.evenness.std_mm)
    for number, colour in reversed(RIBBON_COLOURS.items()):
        axes.fill_between(
            pitch, 0, top,
            where=[number in found for found in ribbons],
            step="mid", color=colour, alpha=0.45, linewidth=0,
            label="ribbon: coil on the last" if number == 1 else f"ribbon of order {number}",
        )  # fmt: skip
    axes.plot(pitch, std, color="black", linewidth=1.1)
    here = float(lay.wind.pitch_mm)
    axes.axvline(here, color="#0b3c8c", linewidth=1.4)
    axes.plot(here, lay.evenness.std_mm, "o", color="#0b3c8c", markersize=8, label="this set")
    for best in recommended:
        axes.plot(
            float(best.wind.pitch_mm), best.evenness.std_mm, "D", color="#2a9d8f", markersize=7,
            label="recommended" if best is recommended[0] else None,
        )  # fmt: skip
    axes.set_ylim(0, top)
    if len(pitch) > 1:
        axes.set_xlim(min(pitch[0], here), max(pitch[-1], here))
    axes.set_xlabel("pitch, mm per drum revolution (all else as it is)")
    axes.set_ylabel("unevenness, mm")
    axes.set_title("How near a bad pitch is: standard deviation of the surface", fontsize=10)
    axes.legend(loc="upper right", fontsize=8, ncols=2)
    axes.grid(alpha=0.25)


def draw(
    lay: Lay,
    curve: Sequence[tuple[Wind, field.Evenness]],
    recommended: Sequence[Recommendation],
    path: Path,
) -> None:
    """The whole picture."""
    laid = field.lay(lay.parameters, lay.rope_um, lay.turns)
    figure = new_figure(14, 10)
    grid = figure.add_gridspec(2, 5, height_ratios=(5, 4))
    unrolled = figure.add_subplot(grid[0, :2])
    section = figure.add_subplot(grid[0, 2:])
    relief(unrolled, laid)
    unrolled.set_title("The drum unrolled", fontsize=10)
    turns = np.arange(len(laid.position_mm)) / field.ANGLES
    cut(section, laid, list(turns / max(lay.turns, 1.0)))
    section.set_title("A cut across; blue: wound first, red: last", fontsize=10)
    over_pitch(figure.add_subplot(grid[1, :3]), lay, curve, recommended)
    displacements(figure.add_subplot(grid[1, 3:]), lay)
    even = lay.evenness
    figure.suptitle(
        f"{lay.rope_m:g} m of {lay.rope_um / 1000:g} mm rope, pitch "
        f"{float(lay.wind.pitch_mm):.2f} mm: highest {even.max_mm:.0f}, mean {even.mean_mm:.0f}, "
        f"unevenness {even.std_mm:.1f} mm",
        fontsize=13,
        fontweight="bold",
    )
    save(figure, path)
