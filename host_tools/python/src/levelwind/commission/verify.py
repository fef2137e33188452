# SPDX-License-Identifier: Apache-2.0
"""Whether a report is of this machine, as it is now."""

import json
from collections.abc import Mapping
from pathlib import Path

from levelwind.commission.others import machine_of
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.live import IDENTITY_POINTS
from levelwind.line.parameter_sets import read_set, set_crc
from levelwind.line.points import PARAMETERS, format_value

FORM = 1
"""Of report.json."""


def load(path: Path) -> dict[str, object]:
    """The JSON of a report; of report.html and report.pdf the one beside it."""
    path = path.with_suffix(".json") if path.suffix in (".html", ".pdf") else path
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ToolError(f"{path} cannot be read: {error.strerror}.") from error
    except ValueError as error:
        raise ToolError(f"{path} is no report: {error}.") from error
    if not isinstance(document, dict) or document.get("levelwind_report") != FORM:
        raise ToolError(f"{path} is no report of `levelwind commission`.")
    return document


def differences(document: Mapping[str, object], device: Device) -> list[str]:
    """What the machine and the report say differently, in words; none: they agree."""
    machine, parameters = document.get("machine"), document.get("parameters")
    if not isinstance(machine, dict) or not isinstance(parameters, dict):
        raise ToolError("The report is incomplete: it names no machine or no parameters.")
    found = []
    accepted = document.get("accepted_crc")
    missing = [p.name for p in PARAMETERS if not p.secret and p.name not in parameters]
    if missing:
        found.append(f"the report lacks parameters that this tool knows: {', '.join(missing)}")
    elif not accepted:
        found.append("the report was never signed")
    elif set_crc({**dict.fromkeys((p.name for p in PARAMETERS), 0), **parameters}) != accepted:
        found.append("the report's parameters are not those that were signed: it was changed")
    now = machine_of(device.read(IDENTITY_POINTS))
    for name in ("firmware", "image"):
        if machine.get(name) != now[name]:
            found.append(f"{name}: {machine.get(name)} in the report, {now[name]} in the machine")
    active = read_set(device, "active")
    for point in PARAMETERS:
        if point.secret or point.scope != "motion" or point.name not in parameters:
            continue
        if active[point.name] != parameters[point.name]:
            found.append(
                f"{point.name}: {format_value(point, int(parameters[point.name]))} in the report, "
                f"{format_value(point, active[point.name])} in the machine"
            )
    return found
