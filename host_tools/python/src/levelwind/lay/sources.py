# SPDX-License-Identifier: Apache-2.0
"""The parameter set that a lay is asked of: from a file, with changes."""

from collections.abc import Mapping
from pathlib import Path

from levelwind.errors import ToolError
from levelwind.files import yaml_file
from levelwind.line.points import PARAMETERS, parse_value
from levelwind.map_table import MAP_VERSION

FACTORY = {p.name: p.default or 0 for p in PARAMETERS}


def read(path: Path) -> tuple[dict[str, int], list[str]]:
    """The parameters of a backup or of `levelwind plan --json`; names that it lacks.

    Those get their factory value: a backup of older firmware lacks newer parameters.
    """
    document = yaml_file.load(path)
    given = document.get("parameters") if isinstance(document, dict) else None
    if not isinstance(document, dict) or not isinstance(given, dict):
        raise ToolError(
            f"{path} holds no parameters: give a backup (`levelwind backup`) or what "
            "`levelwind plan --json` prints."
        )
    version = document.get("levelwind_backup", str(MAP_VERSION))
    if version != str(MAP_VERSION):
        raise ToolError(f"{path} has map version {version}, this tool {MAP_VERSION}.")
    known = {p.name: p for p in PARAMETERS}
    unknown = sorted(str(name) for name in given if name not in known)
    if unknown:
        raise ToolError(f"{path}: unknown {', '.join(unknown)}.")
    values = {}
    try:
        for name, text in given.items():
            with yaml_file.at(text):
                values[str(name)] = parse_value(known[name], text)
    except ToolError as error:
        raise yaml_file.placed(path, error) from None
    return FACTORY | values, [name for name in known if name not in values]


def changed(parameters: Mapping[str, int], changes: Mapping[str, int]) -> dict[str, int]:
    """With other values; ToolError for a name that is no parameter."""
    for name in changes:
        if name not in FACTORY:
            raise ToolError(f"{name} is no parameter.")
    return {**parameters, **changes}


def trimmed(parameters: Mapping[str, int], plus_um: int, minus_um: int) -> dict[str, int]:
    """With the reversal points where a live trim has them."""
    changes = {}
    for side, um in (("plus", plus_um), ("minus", minus_um)):
        if parameters["expert_mode"]:
            usteps = um * parameters["microsteps_per_rev"] / parameters["screw_lead_um"]
            changes[f"raw_reversal_{side}_usteps"] = round(usteps)
        else:
            changes[f"reversal_{side}_um"] = um
    return {**parameters, **{name: parameters[name] + by for name, by in changes.items()}}
