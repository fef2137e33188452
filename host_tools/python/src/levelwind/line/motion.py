# SPDX-License-Identifier: Apache-2.0
"""Moving the carriage from the laptop."""

import time

from levelwind.errors import RefusedError
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.map_table import Flag, State

INDEX_LIMIT_S = 600.0
# The shortest jog_hold_ms is 50 ms.
JOG_REWRITE_S = 0.03
REST_LIMIT_S = 5.0
REST_POLL_S = 0.05


def hold_jog(device: Device, direction: str, seconds: float) -> str:
    """Jog toward plus or minus, held by writing again, and wait for the carriage to rest.

    Released however this ends. Returns why it ended early, or "".
    """
    end = time.monotonic() + seconds
    refusal: RefusedError | None = None
    begun = False
    try:
        while time.monotonic() < end:
            try:
                device.write({"jog": 1 if direction == "plus" else -1})
            except RefusedError as error:
                if not begun:
                    raise
                refusal = error
                break
            begun = True
            time.sleep(JOG_REWRITE_S)
    finally:
        device.write({"jog": 0})
    deadline = time.monotonic() + REST_LIMIT_S
    while (live := read_live(device))["state"] == State.JOGGING and time.monotonic() < deadline:
        time.sleep(REST_POLL_S)
    if refusal is None:
        return ""
    side = direction.upper()
    if flag(live, Flag[f"OVERTRAVEL_{side}"]):
        return f"stopped by the {direction} overtravel switch"
    if not flag(live, Flag.INDEXED) and flag(live, Flag[f"SWITCH_{side}"]):
        return f"stopped by the {direction} limit switch"
    return f"ended early: {refusal}"
