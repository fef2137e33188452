# SPDX-License-Identifier: Apache-2.0
"""Whatever the map promises to tell, a source of the core does: nothing stays 0 for ever."""

import re
from pathlib import Path

import map_model
import pytest

MAP = map_model.load()
STATUS = next(block for block in MAP.blocks if block.space == "input" and not block.bench)
CORE = Path(__file__).resolve().parents[1] / "lib" / "lw_core" / "src"
SOURCE = "\n".join(path.read_text(encoding="utf-8") for path in sorted(CORE.rglob("*.c")))
FILL_STATUS = ("status.c", "cam_commands.c")
TOLD = ("state", "mode", "fault", "command", "reason", "slot_state", "event", "encoder_fault")
"""Enumerations of which the core must be able to tell every value."""


def test_every_status_register_is_filled() -> None:
    filling = "".join((CORE / "device" / f).read_text(encoding="utf-8") for f in FILL_STATUS)
    empty = [p.name for p in STATUS.points if not re.search(rf"(\.|->){p.name} =\s", filling)]
    assert not empty, f"registers of the status that lw_device_refresh_status() leaves 0: {empty}"


def test_every_flag_has_its_condition() -> None:
    missing = [flag.name for flag in MAP.flags if f"FLAG({flag.name.upper()}," not in SOURCE]
    assert not missing, f"flags without a condition in flags() of device/status.c: {missing}"


def test_every_launch_inhibit_has_its_condition() -> None:
    names = [f"LW_LAUNCH_INHIBIT_{bit.name.upper()}" for bit in MAP.launch_inhibit]
    missing = [name for name in names if f"<< {name}" not in SOURCE]
    assert not missing, f"bits of launch_inhibit that nothing sets: {missing}"


@pytest.mark.parametrize("name", TOLD)
def test_every_value_is_told(name: str) -> None:
    names = [f"LW_{name}_{v.name}".upper() for v in MAP.enums[name].values if v.value != 0]
    missing = [each for each in names if not re.search(rf"\b{each}\b", SOURCE)]
    assert not missing, f"values of {name} that no source of the core names: {missing}"
