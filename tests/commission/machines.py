# SPDX-License-Identifier: Apache-2.0
"""Machines of other people: right ones of many geometries, and wrong ones with what must be said.

A machine is figures of `levelwind sim --machine` that differ from the default's. A wrong one has,
besides, what the person answers otherwise, and the code of the finding.
"""

import os
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")

LEAD, USTEPS, PULSES = "screw_lead_mm", "microsteps_per_rev", "encoder_pulses_per_rev"
OVER, UNDER = "encoder_ratio_numerator", "encoder_ratio_denominator"
SWAPPED, INVERT_A, INVERT_B = "encoder_channels_swapped", "encoder_a_inverted", "encoder_b_inverted"


def sides(plus_mm: float, minus_mm: float, overtravel_mm: float, end_mm: float) -> dict[str, float]:
    return {
        "switch_plus_mm": plus_mm,
        "switch_minus_mm": minus_mm,
        "overtravel_mm": overtravel_mm,
        "end_stop_mm": end_mm,
    }


RIGHT: dict[str, dict[str, float]] = {
    "default": {},
    "fine lead": {LEAD: 5, USTEPS: 1600, **sides(30, -30, 36, 40)},
    "fine microsteps": {LEAD: 20, USTEPS: 6400, **sides(40, -40, 46, 48)},
    "long lead": {LEAD: 50, USTEPS: 2000, **sides(200, -200, 212, 220)},
    "inch lead": {LEAD: 12.7, USTEPS: 2000},
    "belt": {LEAD: 100, USTEPS: 6400, **sides(150, -150, 160, 166)},
    "0.9 degree motor": {"full_steps_per_rev": 400, USTEPS: 3200},
    "100 pulses": {PULSES: 100, OVER: 7, UNDER: 2},
    "1024 pulses on the drum": {PULSES: 1024, OVER: 1},
    "2500 pulses on the drum": {PULSES: 2500, OVER: 1},
    "odd ratio": {PULSES: 500, OVER: 7, UNDER: 3},
    "counts backward": {SWAPPED: 1},
    "channel A inverted": {INVERT_A: 1},
    "channel B inverted": {INVERT_B: 1},
    "both inverted, swapped": {SWAPPED: 1, INVERT_A: 1, INVERT_B: 1},
    "motor reversed": {"motor_reversed": 1},
    "off the middle": sides(60, -72.5, 80, 84),
    "narrow": sides(25, -25, 33, 36),
    "late switches": {"switch_late_ms": 4, "contact_travel_ms": 3, "bounce_ms": 8},
    "some play": {"backlash_mm": 0.15},
    "half steps": {LEAD: 4, USTEPS: 400, **sides(45, -45, 53, 56)},
    "everything": {
        LEAD: 32,
        USTEPS: 3200,
        PULSES: 600,
        OVER: 5,
        UNDER: 3,
        SWAPPED: 1,
        INVERT_B: 1,
        "motor_reversed": 1,
        **sides(95.5, -101.25, 110, 114),
    },
}

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
    "coupling slips": ({"coupling_grip_mm_per_s2": 700}, {}, "geometry.index_span"),
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
