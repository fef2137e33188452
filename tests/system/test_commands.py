# SPDX-License-Identifier: Apache-2.0
"""Every command in every state: taken, or refused with a reason; no permit without an index."""

from collections.abc import Callable

import pytest
from command_rules import DOCUMENT, STATES, WRITES, document, expected_refusal
from levelwind.map_table import BenchCommand, Command, Mode, State
from world import RequestRefusedError, World


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


def reacquiring() -> World:
    """After a restart in a launch, the turning drum is taken up."""
    world = turning()
    world.write(bench_command=BenchCommand.RESTART)
    world.run(0.8)
    world.write(command=Command.REACQUIRE)
    world.run(0.05)
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


def with_the_drum_turning(make: Callable[[], World]) -> Callable[[], World]:
    """The same, and then the drum is turned."""

    def make_turning() -> World:
        world = make()
        world.drum(5_000)
        world.run(1.0)
        return world

    return make_turning


MAKE: dict[str, Callable[[], World]] = {
    "unindexed": World,
    "unindexed_turning": with_the_drum_turning(World),
    "backing_off": indexing(State.BACKING_OFF),
    "seeking": indexing(State.SEEKING),
    "index_reversal": indexing(State.INDEX_REVERSAL),
    "span_check": indexing(State.SPAN_CHECK),
    "parking": indexing(State.PARKING),
    "ready": stopped,
    "ready_turning": with_the_drum_turning(stopped),
    "tracking": lambda: World().index(),
    "tracking_turning": turning,
    "centring": centring,
    "centred": centred,
    "centred_turning": with_the_drum_turning(centred),
    "jogging": jogging,
    "reacquiring_turning": reacquiring,
    "off": off,
    "off_turning": with_the_drum_turning(off),
    "fault": overtravelled,
    "fault_turning": moved_in_fault,
}


def check_permit(world: World) -> None:
    """A launch permit says that all is well."""
    flags = world.flags
    if "launch_permit" in flags:
        assert {"indexed", "tracking", "stepper_enabled"} <= flags
        assert flags.isdisjoint({"los", "faulted", "wiring_plus", "overtravel_plus"})


@pytest.mark.parametrize("name", STATES)
def test_every_command(name: str):
    state = STATES[name][0]
    for register, value in WRITES:
        world = MAKE[name]()
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
        world = MAKE[name]()
        world.write(**write)
        world.run(1.0)  # a ramp takes 1187 edges
        world.run_until(lambda w=world: "moving" not in w.flags, 5.0)
        steps = world.value("steps")
        world.run(1.0)
        assert world.value("steps") == steps
        assert not world.permit


def test_the_document_is_made_from_these_rules():
    assert set(MAKE) == set(STATES)
    assert {state for state, _ in STATES.values()} == set(State)
    assert DOCUMENT.read_text() == document(), "run python tests/command_rules.py"
