"""Moving the carriage from the laptop."""

import time

from levelwind.device import Device
from levelwind.errors import RefusedError

INDEX_LIMIT_S = 600.0
# The shortest jog_hold_ms is 50 ms.
JOG_REWRITE_S = 0.03


def hold_jog(device: Device, direction: str, seconds: float) -> None:
    """Jog toward plus or minus, held by writing again; released however this ends.

    A switch that stops the carriage on the way ends it too.
    """
    end = time.monotonic() + seconds
    begun = False
    try:
        while time.monotonic() < end:
            try:
                device.write({"jog": 1 if direction == "plus" else -1})
            except RefusedError:
                if not begun:
                    raise
                break
            begun = True
            time.sleep(JOG_REWRITE_S)
    finally:
        device.write({"jog": 0})
