# SPDX-License-Identifier: Apache-2.0
"""Records of the live status over time, as a table and as a picture."""

import csv
import io
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from levelwind import whole_file
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.live import read_live
from levelwind.line.points import enum_label
from levelwind.map_table import State

PERIOD_S = 0.05
LIVE_REFRESH_S = 0.25
Recording = list[dict[str, Any]]


def record(device: Device, seconds: float, live: bool, recording: Recording) -> None:
    """Append the live status about 20 times a second; `live` draws it in a window meanwhile."""
    window = _Window() if live else None
    began = time.monotonic()
    while (now := time.monotonic() - began) < seconds:
        recording.append(_row(now, read_live(device)))
        if window is not None and not window.update(recording):
            break
        time.sleep(max(0.0, began + len(recording) * PERIOD_S - time.monotonic()))


def _row(time_s: float, status: Mapping[str, int]) -> dict[str, Any]:
    values = {k: v for k, v in status.items() if k != "state"}
    return {"time_s": round(time_s, 4), "state": enum_label(State, status["state"]), **values}


def write_csv(recording: Recording, path: Path) -> None:
    """One line per record, all live registers."""
    table = io.StringIO()
    writer = csv.DictWriter(table, recording[0].keys())
    writer.writeheader()
    writer.writerows(recording)
    whole_file.write(path, table.getvalue())


def write_plot(recording: Recording, path: Path) -> None:
    """Position and rope speed over time."""
    from levelwind.show.plots import new_figure, save  # noqa: PLC0415 - matplotlib takes a second

    figure = new_figure(11, 6)
    draw(figure, recording)
    save(figure, path)


def draw(figure: Any, recording: Sequence[Mapping[str, Any]]) -> None:
    """Position and rope speed over time, into a figure of matplotlib."""
    figure.clear()
    top, bottom = figure.subplots(2, 1, sharex=True)
    times = [row["time_s"] for row in recording]
    top.plot(times, [row["position_um"] / 1000 for row in recording])
    top.set_ylabel("carriage, mm")
    top.set_title(f"{recording[-1]['state']}" if recording else "")
    bottom.plot(times, [row["rope_speed_mm_per_s"] / 1000 for row in recording], color="C1")
    bottom.set_ylabel("rope, m/s (in +)")
    bottom.set_xlabel("time, s")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)


class _Window:
    """A window that follows a recording."""

    def __init__(self) -> None:
        import matplotlib.pyplot as plt  # noqa: PLC0415

        try:
            plt.switch_backend("tkagg")
            self._figure = plt.figure("levelwind", figsize=(10, 6))
        except Exception as error:
            raise ToolError(
                "No window can be opened here (no display, or Python without tkinter): "
                "use --plot FILE.png."
            ) from error
        self._plt = plt
        self._drawn = 0.0

    def update(self, recording: Recording) -> bool:
        """Draw now and then; False once the user has closed the window."""
        if time.monotonic() - self._drawn > LIVE_REFRESH_S:
            draw(self._figure, recording)
            self._plt.pause(0.001)
            self._drawn = time.monotonic()
        return bool(self._plt.fignum_exists(self._figure.number))
