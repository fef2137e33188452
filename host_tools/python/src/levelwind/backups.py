"""Backup files: one whole parameter set as YAML."""

import time
from pathlib import Path

import yaml

from levelwind import yaml_file
from levelwind.device import Device
from levelwind.errors import ToolError
from levelwind.map_table import MAP_VERSION
from levelwind.output import json_value, warn
from levelwind.parameter_sets import read_set
from levelwind.points import PARAMETERS, parse_value


def read_firmware(device: Device) -> str:
    """The version of the connected controller."""
    version = device.read_names("version_major", "version_minor", "version_patch")
    return ".".join(map(str, version.values()))


def write(device: Device, copy: str, path: Path) -> Path | None:
    """Save one of the three sets. A file that is there is kept under the name returned."""
    values = read_set(device, copy)
    document = {
        "levelwind_backup": MAP_VERSION,
        "firmware": read_firmware(device),
        "saved": time.strftime("%Y-%m-%d %H:%M:%S"),
        "parameters": {p.name: json_value(p, values[p.name]) for p in PARAMETERS},
    }
    kept = path.with_name(f"{path.name}.bak") if path.exists() else None
    try:
        if kept is not None:
            path.replace(kept)
        path.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.") from error
    return kept


def read(path: Path, firmware: str) -> dict[str, int]:
    """All parameters of a backup, every one checked against its limits.

    Warns if the backup is from another version than `firmware`, the connected controller's.
    """
    document = yaml_file.load(path)
    if not isinstance(document, dict) or "levelwind_backup" not in document:
        raise ToolError(f"{path} is no backup made by `levelwind backup`.")
    if document["levelwind_backup"] != MAP_VERSION:
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
    return {p.name: parse_value(p, given[p.name]) for p in PARAMETERS}
