# SPDX-License-Identifier: Apache-2.0
"""Figures without a display, and their look."""

import io
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from levelwind import whole_file
from levelwind.errors import ToolError

DPI = 100


def new_figure(width_in: float, height_in: float) -> Figure:
    """A figure for a file; no window, no global state."""
    figure = Figure(figsize=(width_in, height_in), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def check_format(path: Path) -> None:
    """ToolError if no picture can be written in the format of this suffix; before the work."""
    suffix = path.suffix.removeprefix(".").lower()
    known = FigureCanvasAgg.get_supported_filetypes()
    if suffix and suffix not in known:
        raise ToolError(f"{path} cannot be written: give a suffix of {', '.join(sorted(known))}.")


def save(figure: Figure, path: Path) -> None:
    """Write the picture; the suffix of the path says the format."""
    picture = io.BytesIO()
    try:
        figure.savefig(picture, format=path.suffix.removeprefix(".") or None)
    except ValueError as error:
        raise ToolError(f"{path} cannot be written: {error}.") from error
    whole_file.write(path, picture.getvalue())
