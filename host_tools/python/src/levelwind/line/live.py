# SPDX-License-Identifier: Apache-2.0
"""The live status of a controller, read in one consistent snapshot."""

from collections.abc import Mapping
from dataclasses import dataclass

from levelwind.line.device import Device
from levelwind.line.parameter_sets import read_set
from levelwind.map_table import POINTS, Flag

LIVE_POINTS = [p for p in POINTS.values() if p.block == "status" and 100 <= p.address < 200]
LOS_POINTS = [
    POINTS[f"{kind}_{part}"]
    for kind in ("los1_plus", "los1_minus", "los2_plus", "los2_minus")
    for part in ("count", "position_um", "time_ms")
]
HEALTH_POINTS = [p for p in POINTS.values() if p.block == "status" and 340 <= p.address < 370]
SLOT_POINTS = [POINTS[f"slot_{slot}"] for slot in range(8)]
IDENTITY_POINTS = [p for p in POINTS.values() if p.block == "status" and p.address < 100]
ROPE_POINTS = [p for p in POINTS.values() if p.block == "status" and 390 <= p.address < 400]
CAM_POINTS = [POINTS[name] for name in ("cam_version", "cam_rows", "cam_row", "cam_cycles")]
MORE_POINTS = [
    *(*IDENTITY_POINTS, *LOS_POINTS, *ROPE_POINTS, *CAM_POINTS, *SLOT_POINTS, *HEALTH_POINTS)
]
"""What read_status() reads besides: it changes rarely."""


@dataclass(frozen=True)
class Travel:
    """The places that the carriage bar is drawn between."""

    flange_minus_um: int
    reversal_minus_um: int
    reversal_plus_um: int
    flange_plus_um: int


def read_live(device: Device) -> dict[str, int]:
    """State, flags, position, speeds: one request, one consistent snapshot."""
    return device.read(LIVE_POINTS)


def read_status(device: Device) -> dict[str, int]:
    """The live status, what needs a look at the rope, the cam, the storage, the firmware."""
    return read_live(device) | device.read(MORE_POINTS)


def version_of(status: Mapping[str, int]) -> str:
    """The firmware's version, as 0.1.0."""
    return ".".join(str(status[f"version_{part}"]) for part in ("major", "minor", "patch"))


def image_of(status: Mapping[str, int]) -> str | None:
    """What `sha256sum zephyr.bin` begins with, 16 digits. None: a simulator, which has no image."""
    image = status["image_hash_high"] << 32 | status["image_hash_low"]
    return f"{image:016x}" if image else None


def read_travel(device: Device) -> Travel:
    """Flanges and reversal points of the active set."""
    names = list(Travel.__dataclass_fields__)
    return Travel(**read_set(device, "active", [POINTS[name] for name in names]))


def all_flags(status: Mapping[str, int]) -> int:
    """Every flag of a status: bit number = discrete input address."""
    return status["flags"] | status["flags_2"] << 32


def flag(status: Mapping[str, int], bit: Flag) -> bool:
    """One flag of a status."""
    return bool(all_flags(status) >> bit & 1)
