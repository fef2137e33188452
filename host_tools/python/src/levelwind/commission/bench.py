# SPDX-License-Identifier: Apache-2.0
"""What every step has at hand: the controller, the person, and motions that end by themselves.

A jog is held by writing it again; when this program, the line or the laptop dies, the controller
ends it after jog_hold_ms, and before a switch. An indexing ends by itself at its switches. So the
carriage stands however the program ends.
"""

import contextlib
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from levelwind.commission.human import Human
from levelwind.commission.session import Finding, Session
from levelwind.core import native
from levelwind.errors import RefusedError, ToolError
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.line.motion import INDEX_LIMIT_S, JOG_REWRITE_S
from levelwind.line.parameter_sets import read_set, replace_set
from levelwind.line.points import enum_label, enum_text
from levelwind.map_table import POINTS, Command, Fault, Flag, Mode, State

USTEP = 65536
REST_LIMIT_S = 10.0
POLL_S = 0.05
SLOPE = 0.4  # microsteps per edge of a set for measuring: far from 1, far from 0
POSITION_MAX_USTEPS = 31_000  # a little below what the controller takes
PROVISIONAL_HALF_UM = 80_000
CALM_MM_PER_S = 25.0
RATE = POINTS["index_rate_edges_per_s"]
PITCH = POINTS["pitch_um"]
OFTEN_S = 0.02

REMEDIES: dict[int, str] = {
    Fault.BACK_OFF_NO_RELEASE: "Does the carriage really move? More current at the driver, less "
    "friction; or the switch is stuck.",
    Fault.STEPPER_ALARM: "Look at the driver's display, the motor's cable and the supply.",
    Fault.WIRING_PLUS: "Look at the plus switch's plug, terminals and cable: step 2 finds which.",
    Fault.WIRING_MINUS: "Look at the minus switch's plug, terminals and cable: step 2 finds which.",
    Fault.INDEX_NO_SWITCH: "Is the carriage free, the stepper powered, the switch's wire whole?",
    Fault.INDEX_WRONG_SWITCH: "Swap the wires of the two limit switches, or set "
    "carriage_direction_invert: the contacts and the stepper steps tell which.",
    Fault.INDEX_SPAN: "The carriage has slipped, a switch has moved, or it tells too late: look at "
    "the coupling, the switches and the stepper's current.",
}


class WrongError(Exception):
    """The machine is not as it must be: the step ends here."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.what)
        self.finding = finding


def wrong(code: str, what: str, remedy: str) -> WrongError:
    """To be raised."""
    return WrongError(Finding(code, what, remedy))


@dataclass
class Index:
    """One indexing."""

    steps: int
    """Step pulses that it took."""
    span_um: int
    """By how much the other switch was from its place."""


@dataclass
class Bench:
    """The controller, the person, and what is known so far."""

    device: Device
    human: Human
    session: Session

    # ---- parameters ----------------------------------------------------------------------------

    def active(self) -> dict[str, int]:
        """The whole set in force."""
        return read_set(self.device, "active")

    def apply(self, values: Mapping[str, int]) -> None:
        """Make values active; all of them or none. Ends every motion first."""
        self.rest()
        replace_set(self.device, values)

    @contextlib.contextmanager
    def for_now(self, values: Mapping[str, int]) -> Iterator[None]:
        """Values for a measurement; afterwards those before."""
        before = read_set(self.device, "active", [POINTS[name] for name in values])
        self.apply(values)
        try:
            yield
        finally:
            self.apply(before)

    def provisional(self, known: Mapping[str, int]) -> dict[str, int]:
        """A whole set around what is known so far, that the controller takes: for measuring only.

        Where nothing is known it is as wide as positions go, with a pitch that makes a slope of
        SLOPE, so that any encoder and any screw can be moved.
        """
        values = {**self.active(), **known}
        per_um = values["microsteps_per_rev"] / values["screw_lead_um"]
        edges = (
            values["encoder_pulses_per_rev"]
            * values["encoder_edges_per_pulse"]
            * values["encoder_ratio_numerator"]
            / values["encoder_ratio_denominator"]
        )
        half = round(min(PROVISIONAL_HALF_UM, 0.4 * POSITION_MAX_USTEPS / per_um))
        assert PITCH.min is not None
        assert PITCH.max is not None
        pitch = min(max(round(SLOPE * edges / per_um), PITCH.min), PITCH.max)
        overshoot = max(1, round(half / 32))
        places = {
            "pitch_um": pitch,
            "overshoot_um": overshoot,
            "slope_tolerance_ppm": 20_000,
            "travel_um": max(1000, round(min(600_000, POSITION_MAX_USTEPS / per_um))),
            "park_at": 1,
        }
        for name, side in (("plus", 1), ("minus", -1)):
            places[f"flange_{name}_um"] = side * half
            places[f"reversal_{name}_um"] = side * round(half - 1.2 * overshoot)
            places[f"switch_{name}_um"] = side * round(half - 1.8 * overshoot)
        tolerance = min(max(10, round(overshoot / 3)), 20_000)
        for name in ("switch_tolerance_um", "span_tolerance_um", "switch_hysteresis_um"):
            places[name] = tolerance
        changed = {**known, **places, "centre_position_um": 0, "park_position_um": 0}
        native.derive({**values, **changed})  # its refusal is told better than by halves
        return changed

    def um_per_ustep(self) -> float:
        """Of the set in force."""
        screw = read_set(
            self.device, "active", [POINTS["screw_lead_um"], POINTS["microsteps_per_rev"]]
        )
        return screw["screw_lead_um"] / screw["microsteps_per_rev"]

    def rate_for(self, mm_per_s: float) -> int:
        """Edges per second at which the carriage is so fast, within the limits of an index rate."""
        assert RATE.min is not None
        assert RATE.max is not None
        return min(max(round(mm_per_s / self.speed_mm_per_s(1)), RATE.min), RATE.max)

    def speed_mm_per_s(self, rate: int) -> float:
        """The carriage's speed at a rate of edges."""
        return self.device.value("ks") / USTEP * self.um_per_ustep() / 1000 * rate

    # ---- looking -------------------------------------------------------------------------------

    def live(self) -> dict[str, int]:
        """One snapshot."""
        return read_live(self.device)

    def flags(self, *bits: Flag) -> list[bool]:
        """Some flags now."""
        live = self.live()
        return [flag(live, bit) for bit in bits]

    def see(self, seen: Callable[[], bool], limit_s: float | None = None) -> bool:
        """Look until it is seen; no longer than asked."""
        deadline = time.monotonic() + (self.human.patience_s if limit_s is None else limit_s)
        while not seen():
            if time.monotonic() > deadline:
                return False
            time.sleep(POLL_S)
        return True

    # ---- moving --------------------------------------------------------------------------------

    def rest(self) -> None:
        """STOP, and wait until the carriage stands."""
        self.device.command(Command.STOP)
        self._until_it_stands("STOP")

    def _until_it_stands(self, after: str) -> None:
        if not self.see(lambda: not self.flags(Flag.MOVING)[0], REST_LIMIT_S):
            raise ToolError(f"The carriage does not come to rest after {after}. Cut its power.")

    def steps_since(self, before: int) -> int:
        """Step pulses that were given since the register `steps` had this value."""
        return (self.device.value("steps") - before) & 0xFFFFFFFF

    def current_off(self) -> None:
        """No current: hands may move the carriage."""
        self.device.write({"mode": int(Mode.OFF)})
        if not self.see(lambda: self.live()["state"] == State.OFF, REST_LIMIT_S):
            raise ToolError("Mode off has not come into force: `levelwind status` says why.")
        self.forgive()

    def current_on(self) -> None:
        """Ready to move; nothing moves yet."""
        self.device.write({"mode": int(Mode.TRACK)})
        if not self.see(lambda: self.live()["active_mode"] == Mode.TRACK, REST_LIMIT_S):
            raise ToolError("Mode track waits for the drum to come to rest: let nobody turn it.")
        self.forgive()

    def forgive(self) -> None:
        """Acknowledge what was; what stands stays."""
        with contextlib.suppress(RefusedError):
            self.device.command(Command.CLEAR_FAULT)

    def jog(
        self, direction: int, seconds: float, end: Callable[[dict[str, int]], bool] | None = None
    ) -> dict[str, int]:
        """Jog, held, for so long at most, and wait for the rest; `end` looks and may end it.

        Refused where the controller lets nothing move that way. The live status at rest.
        """
        began = time.monotonic()
        moved = False
        try:
            while time.monotonic() - began < seconds:
                try:
                    self.device.write({"jog": direction})
                except RefusedError:
                    if not moved:
                        raise
                    break  # at a switch
                moved = True
                if end is not None and end(self.live()):
                    break
                time.sleep(OFTEN_S if end else JOG_REWRITE_S)
        finally:
            self.device.write({"jog": 0})
        self._until_it_stands("a jog")
        return self.live()

    def index(self, step: str) -> Index:
        """Index; what it took. Ctrl-C stops the carriage."""
        before = self.device.value("steps")
        try:
            self.device.command(Command.INDEX, limit_s=INDEX_LIMIT_S)
        except KeyboardInterrupt:
            self.device.command(Command.STOP)
            raise
        except RefusedError as refused:
            raise self.fault(step, refused) from None
        return Index(self.steps_since(before), self.device.value("span_error_um"))

    def fault(self, step: str, refused: RefusedError) -> WrongError:
        """What an indexing that failed says."""
        now = self.device.read_names("fault", "span_error_um")
        fault = now["fault"]
        if fault == Fault.NONE:
            return wrong(f"{step}.refused", str(refused), "`levelwind status` says what to do.")
        what = enum_text(Fault, fault)
        if fault == Fault.INDEX_SPAN:
            what += f" (by {now['span_error_um'] / 1000:+.2f} mm, or not there at all)"
        remedy = REMEDIES.get(fault, "doc/field-setup.md, When it stops, says where to look.")
        return wrong(f"{step}.{enum_label(Fault, fault)}", what, remedy)
