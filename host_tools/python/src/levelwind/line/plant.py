# SPDX-License-Identifier: Apache-2.0
"""The simulated plant of a bench, over Modbus."""

import os
from collections.abc import Mapping

from levelwind.errors import RefusedError, ToolError
from levelwind.line.device import Device

# Used when a command comes, without an outcome of their own.
ARGUMENTS = {
    "bench_argument",
    "bench_profile",
    "bench_trigger_position_um",
    "bench_trigger_direction",
    "bench_trigger_argument",
}


def check_plant(device: Device) -> None:
    """ToolError unless the controller runs on a simulated plant."""
    try:
        device.value("bench_time_ms")
    except RefusedError:
        raise ToolError(
            f"{device.line} has no simulated plant: a real drum turns by itself."
        ) from None


def write_plant(device: Device, values: Mapping[str, int]) -> None:
    """Write bench registers; ToolError if the plant does not accept them."""
    device.write(values)
    if values.keys() <= ARGUMENTS:
        return
    error = device.value("bench_result")
    if error:
        given = ", ".join(f"{name}={value}" for name, value in values.items())
        raise ToolError(f"The plant refused {given}: {os.strerror(error)}.")
