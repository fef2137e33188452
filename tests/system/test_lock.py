# SPDX-License-Identifier: Apache-2.0
"""The write lock of the whole controller: what it guards, and what it must never guard."""

import pytest
from levelwind.map_table import POINTS, Command, Mode, Reason, Result, State
from world import RequestRefusedError, World

CODE = 471_100
HIDDEN = POINTS["lock_code"].max
BUSY = 6
GUARDED = {
    Command.APPLY,
    Command.REVERT,
    Command.SAVE,
    Command.FACTORY_MOTION,
    Command.FACTORY_LINE,
    Command.FACTORY_ALL,
    Command.TRY_LINE,
    Command.CAM_CHECK,
    Command.CAM_ACTIVATE,
    Command.CAM_DISCARD,
}
PARAMETERS = [point for point in POINTS.values() if point.block == "parameters"]


@pytest.fixture
def world() -> World:
    """Locked: a code has just been applied."""
    world = World()
    world.apply(lock_code=CODE)
    return world


def refusal(world: World, **values: int) -> tuple[int, Reason] | None:
    try:
        world.write(**values)
    except RequestRefusedError as error:
        return error.exception, error.reason
    return None


def test_no_lock_without_a_code() -> None:
    world = World()
    assert "locked" not in world.flags
    assert refusal(world, pitch_um=11_000) is None


def test_a_new_code_locks_at_once(world: World) -> None:
    assert "locked" in world.flags
    world.write(unlock=CODE)
    assert "locked" not in world.flags
    world.apply(lock_code=CODE + 1)
    assert "locked" in world.flags


@pytest.mark.parametrize("point", PARAMETERS, ids=lambda point: point.name)
def test_every_parameter_is_guarded(world: World, point) -> None:
    before = world.value(point.name)
    assert refusal(world, **{point.name: point.default}) == (BUSY, Reason.LOCKED)
    assert world.value(point.name) == before
    assert world.value("last_error_reason") == Reason.LOCKED


# Not guarded, but refused for a reason of their own where the carriage does not follow.
NOT_NOW = {
    Command.SET_ROPE: Reason.ROPE_NOT_DESCRIBED,
    Command.TRIM_EARLY: Reason.TRIM_NOT_FOLLOWING,
    Command.TRIM_LATE: Reason.TRIM_NOT_FOLLOWING,
    Command.REACQUIRE: Reason.DRUM_AT_REST,
}


@pytest.mark.parametrize("command", [c for c in Command if c != Command.NONE])
def test_commands(world: World, command: Command) -> None:
    """Each command, locked and then with the lock open."""
    sequence = world.value("command_sequence")
    if command in GUARDED:
        assert refusal(world, command=command) == (BUSY, Reason.LOCKED)
        assert world.value("command_result") == Result.REFUSED
        assert world.value("command_reason") == Reason.LOCKED
        world.write(unlock=CODE)
        assert refusal(world, command=command) is None
        sequence += 1
    elif command in NOT_NOW:
        assert refusal(world, command=command) == (BUSY, NOT_NOW[command])
    else:
        assert refusal(world, command=command) is None
    assert world.value("command_sequence") == sequence + 1
    assert world.value("command_code") == command


def test_what_makes_things_safer_works_locked(world: World) -> None:
    """Stop in motion, off, and a fault acknowledged; and the operator's other set-points."""
    world.write(command=Command.INDEX)
    world.run(0.1)
    assert world.state == State.SEEKING
    assert world.command(Command.STOP) == Result.DONE
    world.run_until(lambda: world.state == State.UNINDEXED)
    world.write(mode=Mode.TRACK)
    world.write(bench_direction_reversed=1)
    world.index_faulted()
    world.write(bench_direction_reversed=0)
    assert world.command(Command.CLEAR_FAULT) == Result.DONE
    assert world.state == State.UNINDEXED
    world.write(jog=1)
    world.run(0.05)
    assert world.state == State.JOGGING
    world.write(jog=0)
    world.run_until(lambda: world.state == State.UNINDEXED)
    world.write(trim_plus_um=-100)
    world.write(mode=Mode.OFF)
    world.run(0.01)
    assert world.state == State.OFF
    assert "stepper_enabled" not in world.flags
    assert "locked" in world.flags


def test_closes_after_its_time() -> None:
    world = World()
    world.apply(lock_code=CODE, lock_timeout_s=12)
    world.write(unlock=CODE)
    world.run(11.99)
    assert refusal(world, pitch_um=11_000) is None
    world.run(0.02)
    assert "locked" in world.flags
    assert refusal(world, pitch_um=12_000) == (BUSY, Reason.LOCKED)
    world.write(unlock=CODE)
    world.write(unlock=0)
    assert "locked" in world.flags


def test_locked_again_after_a_power_cut(world: World) -> None:
    world.write(unlock=CODE)
    assert world.command(Command.SAVE) == Result.DONE
    assert "locked" not in world.flags
    world.write(bench_command=4)  # power_cut
    world.run(0.3)
    assert "locked" in world.flags
    world.write(unlock=CODE)
    assert refusal(world, pitch_um=11_000) is None


def test_the_code_cannot_be_read(world: World) -> None:
    names = ("lock_code", "active.lock_code", "stored.lock_code", "unlock")
    assert world.read(*names) == dict(zip(names, (HIDDEN, HIDDEN, 0, 0), strict=True))
    world.write(unlock=CODE)
    assert world.value("unlock") == 0
    world.command(Command.SAVE)
    assert world.value("stored.lock_code") == HIDDEN
    world.write(lock_code=HIDDEN)  # what a master does that writes back what it has read
    assert "staged" not in world.flags
    for address in range(65536):
        for function in (3, 4):
            answer = world.request(bytes([function, address >> 8, address & 0xFF, 0, 2]))
            assert CODE.to_bytes(4, "big") not in answer
    world.apply(lock_code=0)
    assert "locked" not in world.flags
    assert world.value("lock_code") == 0


def test_wrong_codes_are_slowed_down(world: World) -> None:
    assert refusal(world, unlock=CODE + 1) == (3, Reason.WRONG_CODE)
    assert world.value("last_error_value") == 0
    assert refusal(world, unlock=CODE) == (BUSY, Reason.UNLOCK_WAIT)
    world.run(1.0)
    assert refusal(world, unlock=CODE + 2) == (3, Reason.WRONG_CODE)
    world.run(1.9)
    assert refusal(world, unlock=CODE) == (BUSY, Reason.UNLOCK_WAIT)
    world.run(0.2)
    assert refusal(world, unlock=CODE) is None
