# SPDX-License-Identifier: Apache-2.0
"""Backup files: one whole parameter set as YAML."""

import time
from pathlib import Path

from levelwind import whole_file
from levelwind.errors import ToolError
from levelwind.files import yaml_file
from levelwind.line.device import Device
from levelwind.line.live import version_of
from levelwind.line.parameter_sets import read_set
from levelwind.line.points import PARAMETERS, parse_value
from levelwind.map_table import MAP_VERSION, Point
from levelwind.show.output import json_value, warn


def read_firmware(device: Device) -> str:
    """The version of the connected controller."""
    return version_of(device.read_names("version_major", "version_minor", "version_patch"))


def write(device: Device, copy: str, path: Path) -> Path | None:
    """Save one of the three sets. A file that is there is kept under the name returned."""
    values = read_set(device, copy)
    document = {
        "levelwind_backup": MAP_VERSION,
        "firmware": read_firmware(device),
        "saved": time.strftime("%Y-%m-%d %H:%M:%S"),
        "parameters": {p.name: json_value(p, values[p.name]) for p in PARAMETERS},
    }
    kept = path.with_name(f"{path.name}.bak") if path.is_file() else None
    if kept is not None:
        try:
            old = path.read_bytes()
        except OSError as error:
            raise ToolError(f"{path} cannot be read: {error.strerror}.") from error
        whole_file.write(kept, old)
    whole_file.write(path, yaml_file.dump(document))
    return kept


def read(path: Path, firmware: str) -> dict[str, int]:
    """All parameters of a backup, every one checked against its limits.

    Warns if the backup is from another version than `firmware`, the connected controller's.
    """
    document = yaml_file.load(path)
    if not isinstance(document, dict) or "levelwind_backup" not in document:
        raise ToolError(f"{path} is no backup made by `levelwind backup`.")
    if document["levelwind_backup"] != str(MAP_VERSION):
        raise ToolError(
            f"{path} has map version {document['levelwind_backup']}, this tool {MAP_VERSION}."
        )
    made_with = document.get("firmware", "unknown")
    if made_with != firmware:
        warn(f"{path} is from firmware {made_with}, this controller has {firmware}.")
    given = document.get("parameters")
    if not isinstance(given, dict):
        raise ToolError(f"{path}: the mapping `parameters` is missing.")
    known = {p.name for p in PARAMETERS}
    wrong = [f"unknown {name}" for name in given if name not in known]
    wrong += [f"missing {name}" for name in known if name not in given]
    if wrong:
        raise ToolError(f"{path}: {', '.join(sorted(wrong))}.")
    try:
        return {p.name: _value(p, given[p.name]) for p in PARAMETERS}
    except ToolError as error:
        raise yaml_file.placed(path, error) from None


def _value(point: Point, given: object) -> int:
    with yaml_file.at(given):
        return parse_value(point, given)
