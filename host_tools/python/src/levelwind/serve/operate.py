# SPDX-License-Identifier: Apache-2.0
"""What the page may ask of the controller once the PIN has been given."""

import threading
import time
from collections.abc import Callable, Mapping

from levelwind.errors import RefusedError, ToolError
from levelwind.line.device import Device
from levelwind.line.motion import INDEX_LIMIT_S, JOG_REWRITE_S
from levelwind.line.parameter_sets import read_sets
from levelwind.line.points import PARAMETERS, check_limits, format_value, limits_text, parse_value
from levelwind.map_table import POINTS, Command, Mode
from levelwind.serve.owner import PortOwner, QueuedClient

JOG_HELD_S = 0.3
"""The page says again and again that the key is held; silent for so long, it is let go."""


def _command(command: Command, limit_s: float = 30.0) -> Callable[[Device], None]:
    return lambda device: device.command(command, limit_s=limit_s)


def _mode(mode: Mode) -> Callable[[Device], None]:
    return lambda device: device.write({"mode": int(mode)})


ACTIONS: dict[str, Callable[[Device], None]] = {
    "index": _command(Command.INDEX, INDEX_LIMIT_S),
    "stop": _command(Command.STOP),
    "clear_fault": _command(Command.CLEAR_FAULT),
    "acknowledge": _command(Command.ACKNOWLEDGE_ROPE),
    "follow": _mode(Mode.TRACK),
    "centre": _mode(Mode.CENTRE),
    "off": _mode(Mode.OFF),
    "trim_early": _command(Command.TRIM_EARLY),
    "trim_late": _command(Command.TRIM_LATE),
    "apply": _command(Command.APPLY),
    "revert": _command(Command.REVERT),
    "save": _command(Command.SAVE),
}


class Operator:
    """Actions over the owner's queue, each with a device of its own: none waits for another."""

    def __init__(self, owner: PortOwner) -> None:
        self._owner = owner

    def device(self) -> Device:
        """A device whose requests go through the queue."""
        return Device(self._owner.line, QueuedClient(self._owner))

    def act(self, name: str) -> str:
        """Do it and wait for its end; what to tell. ToolError says why not."""
        if name not in ACTIONS:
            raise ToolError(f"There is no action {name!r}.")
        ACTIONS[name](self.device())
        return f"{name.replace('_', ' ')}: done."

    def set_rope(self, metres: object) -> str:
        """So much rope is on the drum."""
        try:
            rope_mm = round(float(str(metres)) * 1000)
        except (ValueError, OverflowError):
            raise ToolError(f"{metres}: metres of rope on the drum.") from None
        device = self.device()
        device.write({"set_rope_mm": check_limits(POINTS["set_rope_mm"], rope_mm)})
        device.command(Command.SET_ROPE)
        return f"{rope_mm / 1000:.1f} m on the drum."

    def stage(self, given: Mapping[str, object]) -> str:
        """Stage parameters, all or none."""
        known = {point.name for point in PARAMETERS}
        values = {}
        for name, value in given.items():
            if name not in known:
                raise ToolError(f"There is no parameter {name!r}.")
            values[name] = parse_value(POINTS[name], value)
        if not values:
            raise ToolError("No value was given.")
        self.device().write(values)
        return f"{', '.join(values)}: staged. Apply makes it active."

    def parameters(self) -> list[dict[str, object]]:
        """All parameters in their three copies, in words."""
        sets = read_sets(self.device(), PARAMETERS)
        return [
            {
                "name": point.name,
                "text": point.text,
                "unit": point.unit,
                "limits": limits_text(point),
                **{copy: format_value(point, values[point.name]) for copy, values in sets.items()},
            }
            for point in PARAMETERS
        ]


class Jog:
    """The carriage moved by hand while a key of the page is held.

    A thread writes the register again and again, as its hold time asks. It lets go when the page
    says so, when its connection ends, and when the page has not said for JOG_HELD_S that the key is
    still held. Should the server die, the controller stops by itself after jog_hold_ms.
    """

    def __init__(self, operator: Operator) -> None:
        self.problem = ""
        """Why the last jog has ended by itself."""
        self._operator = operator
        self._holder: object = None
        self._direction = 0
        self._until_s = 0.0
        self._changed = threading.Condition()
        self._ended = False
        self._thread = threading.Thread(target=self._run, name="jog", daemon=True)
        self._thread.start()

    def hold(self, holder: object, direction: int) -> bool:
        """The key is held, still; False while somebody else holds it."""
        with self._changed:
            if self._holder not in (None, holder):
                return False
            if self._holder is None:
                self.problem = ""
            self._holder, self._direction = holder, direction
            self._until_s = time.monotonic() + JOG_HELD_S
            self._changed.notify()
            return True

    def let_go(self, holder: object) -> None:
        """The key was let go, or who held it has gone."""
        with self._changed:
            if self._holder is holder:
                self._until_s = 0.0
                self._changed.notify()

    def close(self) -> None:
        """End; the carriage is let go."""
        with self._changed:
            self._ended, self._until_s = True, 0.0
            self._changed.notify()
        self._thread.join(2.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                while self._holder is None and not self._ended:
                    self._changed.wait()
                if self._ended:
                    return
            device, refused = self._operator.device(), ""
            while not refused and (direction := self._held()):
                try:
                    device.write({"jog": direction})
                except ToolError as error:
                    refused = str(error)
                with self._changed:
                    self._changed.wait(JOG_REWRITE_S)
            try:
                device.write({"jog": 0})
            except RefusedError:
                pass  # it does not jog any more
            except ToolError as error:
                refused = refused or str(error)
            with self._changed:
                self.problem = refused
                if refused:  # a key that is still held does not begin anew
                    self._changed.wait(JOG_HELD_S)
                self._holder = None

    def _held(self) -> int:
        with self._changed:
            return self._direction if time.monotonic() < self._until_s else 0
