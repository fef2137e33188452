"""Figures without a display, and their look."""

from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from levelwind.errors import ToolError

DPI = 100


def new_figure(width_in: float, height_in: float) -> Figure:
    """A figure for a file; no window, no global state."""
    figure = Figure(figsize=(width_in, height_in), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write the picture; the suffix of the path says the format."""
    try:
        figure.savefig(path)
    except (OSError, ValueError) as error:
        raise ToolError(f"{path} cannot be written: {error}.") from error
