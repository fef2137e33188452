"""Moving the carriage from the laptop."""

import time

from levelwind.device import Device

INDEX_LIMIT_S = 600.0
# The shortest jog_hold_ms is 50 ms.
JOG_REWRITE_S = 0.03


def hold_jog(device: Device, direction: str, seconds: float) -> None:
    """Jog toward plus or minus, held by writing again; released however this ends."""
    end = time.monotonic() + seconds
    try:
        while time.monotonic() < end:
            device.write({"jog": 1 if direction == "plus" else -1})
            time.sleep(JOG_REWRITE_S)
    finally:
        device.write({"jog": 0})
