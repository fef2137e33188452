"""Every command in every state: taken, or refused with a reason; no permit without an index."""

from collections.abc import Callable

import pytest
from levelwind.map_table import Command, Mode, Reason, State
from world import RequestRefusedError, World

MOVING = {
    *(State.BACKING_OFF, State.SEEKING, State.INDEX_REVERSAL, State.SPAN_CHECK, State.PARKING),
    *(State.CENTRING, State.JOGGING),
}
SET_COMMANDS = {
    *(Command.APPLY, Command.REVERT, Command.SAVE),
    *(Command.FACTORY_MOTION, Command.FACTORY_LINE, Command.FACTORY_ALL, Command.TRY_LINE),
}


def indexing(state: State) -> Callable[[], World]:
    """A world that indexes and has come to a state."""

    def make() -> World:
        world = World(carriage_um=79_500 if state == State.BACKING_OFF else 0)
        world.write(command=Command.INDEX)
        world.run_until(lambda: world.state == state, step_s=0.005)
        return world

    return make


def stopped() -> World:
    """Indexed, and held by stop."""
    world = World().index()
    world.write(command=Command.STOP)
    return world


def turning() -> World:
    """In a launch."""
    world = World().index()
    world.drum(20_000)
    world.run(2.0)
    return world


def centring() -> World:
    """On the way to the centre."""
    world = World().index()
    world.mode(Mode.CENTRE)
    world.run(0.5)
    return world


def centred() -> World:
    """At the centre."""
    world = centring()
    world.run_until(lambda: world.state == State.CENTRED, step_s=0.01)
    return world


def jogging() -> World:
    """Jogging toward plus."""
    world = World()
    world.write(jog=1)
    world.run(0.2)
    return world


def off() -> World:
    """Mode off."""
    world = World()
    world.mode(Mode.OFF)
    world.run(0.01)
    return world


def overtravelled() -> World:
    """A fault whose cause is still there."""
    world = World()
    world.write(bench_overtravel_plus=1)
    world.run(0.05)
    return world


def moved_in_fault() -> World:
    """A fault whose cause is gone, drum turning."""
    world = overtravelled()
    world.write(bench_overtravel_plus=0)
    world.drum(5_000)
    world.run(1.0)
    return world


STATES: dict[str, tuple[State, Callable[[], World]]] = {
    "unindexed": (State.UNINDEXED, World),
    "backing_off": (State.BACKING_OFF, indexing(State.BACKING_OFF)),
    "seeking": (State.SEEKING, indexing(State.SEEKING)),
    "index_reversal": (State.INDEX_REVERSAL, indexing(State.INDEX_REVERSAL)),
    "span_check": (State.SPAN_CHECK, indexing(State.SPAN_CHECK)),
    "parking": (State.PARKING, indexing(State.PARKING)),
    "ready": (State.READY, stopped),
    "tracking": (State.TRACKING, lambda: World().index()),
    "tracking_turning": (State.TRACKING, turning),
    "centring": (State.CENTRING, centring),
    "centred": (State.CENTRED, centred),
    "jogging": (State.JOGGING, jogging),
    "off": (State.OFF, off),
    "fault": (State.FAULT, overtravelled),
    "fault_turning": (State.FAULT, moved_in_fault),
}


def busy(state: State) -> Reason | None:
    """Why what needs a standing carriage is refused."""
    if state == State.TRACKING:
        return Reason.BUSY_TRACKING
    return Reason.BUSY_MOVING if state in MOVING else None


def jog_refusal(name: str, state: State, direction: int) -> Reason | None:
    """A jog may be held on, ended, and begun where nothing else moves the carriage."""
    if direction == 0 or (state == State.JOGGING and direction > 0) or name == "tracking":
        return None
    if name == "fault" and direction > 0:
        return Reason.OVERTRAVEL
    return Reason.MODE_OFF if state == State.OFF else busy(state)


def command_refusal(name: str, state: State, command: int) -> Reason | None:
    """Stop is never refused; sets change at rest; indexing needs current and a resting drum."""
    if command in SET_COMMANDS:
        return busy(state)
    if command == Command.CLEAR_FAULT and name == "fault":
        return Reason.CAUSE_PRESENT
    if command != Command.INDEX:
        return None
    if state == State.OFF:
        return Reason.MODE_OFF
    if state in MOVING:
        return Reason.BUSY_MOVING
    return Reason.DRUM_MOVING if name.endswith("turning") else None


def expected_refusal(name: str, state: State, register: str, value: int) -> Reason | None:
    """Why a write must be refused here; None if it must be taken."""
    if register == "jog":
        return jog_refusal(name, state, value)
    if register == "command":
        return command_refusal(name, state, value)
    if register == "pitch_um":
        return Reason.BUSY_TRACKING if state == State.TRACKING else None
    if register == "trim_plus_um":
        return Reason.BUSY_MOVING if state in MOVING else None
    return None


WRITES = [
    *(("command", command) for command in Command),
    *(("mode", mode) for mode in Mode),
    *(("jog", direction) for direction in (-1, 0, 1)),
    ("pitch_um", 11_000),
    ("trim_plus_um", -500),
]


def check_permit(world: World) -> None:
    """A launch permit says that all is well."""
    flags = world.flags
    if "launch_permit" in flags:
        assert {"indexed", "tracking", "stepper_enabled"} <= flags
        assert flags.isdisjoint({"los", "faulted", "wiring_plus", "overtravel_plus"})


@pytest.mark.parametrize("name", STATES)
def test_every_command(name: str):
    state, make = STATES[name]
    for register, value in WRITES:
        world = make()
        assert world.state == state
        indexed = "indexed" in world.flags
        before = world.read("command_sequence", "steps")
        expected = expected_refusal(name, state, register, value)
        try:
            world.write(**{register: value})
            refused = None
        except RequestRefusedError as refusal:
            assert refusal.exception == 6, f"{register} {value}: {refusal}"
            refused = refusal.reason
        assert refused == expected, f"{register} {value}"
        if expected is not None:
            assert world.state == state
            assert ("indexed" in world.flags) == indexed
        if register == "command" and value != Command.NONE:
            assert world.value("command_sequence") == before["command_sequence"] + 1
            assert world.value("command_code") == value
        for _ in range(40):
            world.run(0.05)
            check_permit(world)
        assert world.truth.in_sync or not {"indexed", "launch_permit"} & world.flags


@pytest.mark.parametrize("name", STATES)
def test_stop_and_off_always_end_motion(name: str):
    for write in ({"command": Command.STOP}, {"mode": Mode.OFF}):
        world = STATES[name][1]()
        world.write(**write)
        world.run(1.0)  # a ramp takes 1187 edges
        world.run_until(lambda w=world: "moving" not in w.flags, 5.0)
        steps = world.value("steps")
        world.run(1.0)
        assert world.value("steps") == steps
        assert not world.permit
