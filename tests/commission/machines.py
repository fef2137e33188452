# SPDX-License-Identifier: Apache-2.0
"""Machines of other people that are wrong, with what must be said.

A wrong one has, besides its figures, what the person answers otherwise, and the code of the
finding.
"""

import os
from collections.abc import Sequence
from typing import TypeVar

from right_machines import LEAD, OVER, PULSES, USTEPS

T = TypeVar("T")

WRONG: dict[str, tuple[dict[str, float], dict[str, object], str]] = {
    "limit switches swapped": ({"limit_switches_swapped": 1}, {}, "contacts.swapped"),
    "overtravels swapped": ({"overtravel_switches_swapped": 1}, {}, "contacts.overtravel_swapped"),
    "plus contacts exchanged": (
        {"switch_plus_contacts_swapped": 1}, {}, "contacts.plus_actuated_at_rest",
    ),
    "minus contacts exchanged": (
        {"switch_minus_contacts_swapped": 1}, {}, "contacts.minus_actuated_at_rest",
    ),
    "other pulses than the nameplate's": (
        {PULSES: 400}, {"encoder.pulses": 360}, "encoder.pulses",
    ),
    "other pulses, no index": (
        {PULSES: 500, "encoder_index_open": 1},
        {"encoder.pulses": 360, "encoder.ratio": 4},
        "encoder.ratio",
    ),
    "other ratio": ({OVER: 5}, {"encoder.ratio": 4}, "encoder.ratio"),
    "other microsteps": ({USTEPS: 1600}, {"stepper.microsteps": 2000}, "stepper.microsteps"),
    "other lead": (
        {LEAD: 16}, {"stepper.lead_mm": 20, "stepper.microsteps": 2000}, "stepper.microsteps",
    ),
    "motor without force": ({"holding_acceleration_mm_per_s2": 300}, {}, "stepper.still"),
    "weak motor": ({"holding_acceleration_mm_per_s2": 5000}, {}, "pull_out.weak"),
    "slow motor": ({"top_speed_mm_per_s": 180}, {}, "pull_out.weak"),
    "plus switch scatters": ({"switch_plus_scatter_mm": 0.22}, {}, "repeat.plus_loose"),
    "minus switch scatters": ({"switch_minus_scatter_mm": 0.22}, {}, "repeat.minus_loose"),
    "plus switch wanders": ({"switch_plus_drift_mm": 0.06}, {}, "repeat.plus_drift"),
    "minus switch wanders": ({"switch_minus_drift_mm": 0.06}, {}, "repeat.minus_drift"),
    "coupling slips when it is fast": ({"coupling_grip_mm_per_s2": 3000}, {}, "pull_out.weak"),
    "coupling slips": ({"coupling_grip_mm_per_s2": 670}, {}, "geometry.index_span"),
    "friction": ({"friction_mm_per_s2": 15_000}, {}, "pull_out.weak"),
}  # fmt: skip

MOTORS: dict[str, dict[str, float]] = {
    f"{force} mm/s2, half at {half} mm/s{', top ' + str(top) if top else ''}": {
        "holding_acceleration_mm_per_s2": force,
        "half_torque_speed_mm_per_s": half,
        "top_speed_mm_per_s": top,
        "friction_mm_per_s2": friction,
    }
    for force, half, top, friction in (
        (30_000, 400, 0, 500), (15_000, 400, 0, 500), (60_000, 200, 0, 500),
        (20_000, 800, 0, 1000), (40_000, 150, 0, 2000), (25_000, 400, 500, 500),
        (30_000, 300, 400, 1500), (12_000, 600, 0, 200), (50_000, 400, 350, 3000),
        (18_000, 250, 600, 800),
    )
}  # fmt: skip


def some(names: Sequence[T], every: int) -> list[T]:
    """A sample, where not all are asked for (./dev longtest)."""
    return list(names) if os.environ.get("LEVELWIND_MACHINES") == "all" else list(names)[::every]
