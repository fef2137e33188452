# SPDX-License-Identifier: Apache-2.0
"""How the rope lies that has come in since the server began: from where the carriage really was."""

import base64
import threading
from collections.abc import Mapping

from levelwind.errors import ToolError
from levelwind.serve.view import Seen

CELLS_MAX = 160
NO_ROPE = "No rope yet."
TURNS_MAX = 5000
GAP_TURNS_MAX = 20
"""More turns than this between two looks: nobody knows where the carriage was."""


class Growth:
    """The path of the rope, angle by angle of the drum. Hauled in it grows, paid out it shrinks."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._drawing = threading.Lock()
        self._path_mm: list[float] = []
        self._before: tuple[float, float] | None = None
        """Drum's angle, in angles, and place, at the last look."""
        self._rope_um = 0
        self._changed = True
        self._picture: dict[str, object] = {"why": NO_ROPE}

    def see(self, seen: Seen, parameters: Mapping[str, int]) -> None:
        """A look at the controller."""
        if not parameters:
            return
        from levelwind.lay.field import ANGLES  # noqa: PLC0415 - numpy takes its time

        status = seen.status
        edges_per_rev = (
            parameters["encoder_pulses_per_rev"]
            * parameters["encoder_edges_per_pulse"]
            * parameters["encoder_ratio_numerator"]
            / parameters["encoder_ratio_denominator"]
        )
        with self._lock:
            self._rope_um = parameters["rope_diameter_um"]
            now = (status["net_edges"] / edges_per_rev * ANGLES, status["position_um"] / 1000)
            before, self._before = self._before, now
            if before is None or before[0] == now[0]:
                return
            self._changed = True
            if abs(now[0] - before[0]) > GAP_TURNS_MAX * ANGLES:
                self._path_mm.clear()
                return
            first, last = int(before[0] // 1), int(now[0] // 1)
            if last < first:
                del self._path_mm[max(0, len(self._path_mm) + last - first) :]
                return
            for angle in range(first + 1, last + 1):
                part = (angle - before[0]) / (now[0] - before[0])
                self._path_mm.append(before[1] + part * (now[1] - before[1]))
            del self._path_mm[: -TURNS_MAX * ANGLES]

    def picture(self) -> dict[str, object]:
        """The surface, a byte for each cell, rows by the drum's angle; or why there is none."""
        with self._drawing:  # who comes meanwhile must not get the one before
            with self._lock:
                if not self._changed:
                    return self._picture
                self._changed = False
                path, rope_um = list(self._path_mm), self._rope_um
            self._picture = _draw(path, rope_um)
            return self._picture


def _draw(path: list[float], rope_um: int) -> dict[str, object]:
    if not rope_um:
        return {"why": "The parameter rope_diameter_um is not set."}
    if len(path) < 2:
        return {"why": NO_ROPE}
    import numpy as np  # noqa: PLC0415

    from levelwind.lay.field import ANGLES, lay_path  # noqa: PLC0415

    try:
        field = lay_path(np.array(path), rope_um)
    except ToolError as error:
        return {"why": str(error)}
    height = field.height_mm
    step = max(1, -(-height.shape[1] // CELLS_MAX))
    columns = height.shape[1] // step * step
    cells = height[:, :columns].reshape(height.shape[0], -1, step).max(axis=2)
    top_mm = float(cells.max()) or 1.0
    grey = np.round(cells / top_mm * 255).astype(np.uint8)
    return {
        "rows": cells.shape[0],
        "columns": cells.shape[1],
        "top_mm": round(top_mm, 1),
        "mean_mm": [round(float(mm), 2) for mm in cells.mean(axis=0)],
        "from_mm": round(float(field.place_mm[0]), 1),
        "to_mm": round(float(field.place_mm[columns - 1]), 1),
        "turns": round(len(path) / ANGLES, 1),
        "cells": base64.b64encode(grey.tobytes()).decode(),
    }
