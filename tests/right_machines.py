# SPDX-License-Identifier: Apache-2.0
"""Machines of other people that are right, of many geometries.

A machine is figures of `levelwind sim --machine` that differ from the default's.
"""

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
