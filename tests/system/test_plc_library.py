# SPDX-License-Identifier: Apache-2.0
"""The function blocks for PLCs, run as a PLC runs them, against the controller."""

import struct
from pathlib import Path

import pytest
from levelwind.map_table import POINTS, Command, State
from structured_text import Block, Program
from world import World

TEXT = Path(__file__).resolve().parents[2] / "modbus_map" / "tags_iec61131.st"
CYCLE_MS = 50


class Plc:
    """A PLC with the function block that gives commands; its master reads in every cycle."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.program = Program(TEXT.read_text(encoding="ascii"))
        self.give = self.program.instance("LevelwindGiveCommand")
        self.writes = 0
        self.line_writes = True
        self._wrote = False
        self.cycle()

    def words(self, first: int, count: int) -> list[int]:
        answer = self.world.request(struct.pack(">BHH", 4, first, count))
        return list(struct.unpack(f">{count}H", answer[2:]))

    def cycle(self, **inputs: object) -> Block:
        self.give(words=self.words(POINTS["command_sequence"].address, 9), **inputs)
        if self.give.write_now and not self._wrote:
            self.writes += 1
            if self.line_writes:
                self.world.request(struct.pack(">BHH", 6, 0, self.give.code))
        self._wrote = self.give.write_now
        self.world.run(CYCLE_MS / 1000)
        self.program.now_ms += CYCLE_MS
        return self.give

    def until_ended(self, **inputs: object) -> Block:
        for _ in range(2000):
            if not self.cycle(execute=True, **inputs).busy:
                return self.give
        raise AssertionError("never ended")


def test_status_of_a_launch() -> None:
    world = World().index()
    world.drum(20_000)
    world.run(2.0)
    plc = Plc(world)
    block = plc.program.instance("LevelwindStatusFromWords")
    block(words=plc.words(POINTS["state"].address, len(block.words)))
    expected = world.read("position_um", "rope_mm", "net_edges", "flags", "flags_2", "m")
    assert block.values.state == "LEVELWIND_STATE_TRACKING"
    assert block.values.position_um == expected["position_um"]
    assert block.values.m == expected["m"]
    assert block.values.net_edges_low == expected["net_edges"] > 0
    assert {name for name, on in vars(block.flags).items() if on} == world.flags
    assert block.flags.launch_permit
    assert not any(vars(block.inhibits).values())


def test_a_command_is_followed_to_its_end() -> None:
    plc = Plc(World())
    give = plc.cycle(execute=True, command="LEVELWIND_COMMAND_INDEX")
    assert give.busy
    give = plc.until_ended()
    assert (give.done, give.error, give.uncertain) == (True, False, False)
    assert plc.world.state == State.TRACKING
    assert plc.writes == 1
    for _ in range(5):  # held on: not given again
        plc.cycle(execute=True)
    assert plc.writes == 1
    plc.cycle(execute=False)
    assert plc.cycle(execute=True, command="LEVELWIND_COMMAND_STOP").code == Command.STOP
    assert plc.until_ended().done
    assert plc.writes == 2


def test_a_refused_command_says_why() -> None:
    world = World().index()
    plc = Plc(world)
    give = plc.until_ended(command="LEVELWIND_COMMAND_APPLY")
    assert (give.done, give.error, give.uncertain) == (False, True, False)
    assert give.result == "LEVELWIND_RESULT_REFUSED"
    assert give.reason == "LEVELWIND_REASON_BUSY_TRACKING"


def test_a_command_that_is_stopped_has_failed() -> None:
    plc = Plc(World())
    for _ in range(10):
        plc.cycle(execute=True, command="LEVELWIND_COMMAND_INDEX")
    plc.world.write(jog=0)
    plc.world.write(mode=0)
    give = plc.until_ended()
    assert (give.done, give.error, give.uncertain) == (False, True, False)
    assert give.reason == "LEVELWIND_REASON_STOPPED"


def test_a_command_that_leaves_no_sign_is_uncertain() -> None:
    plc = Plc(World())
    plc.line_writes = False
    give = plc.until_ended(command="LEVELWIND_COMMAND_STOP")
    assert (give.done, give.error, give.uncertain) == (False, True, True)
    assert 5000 <= plc.program.now_ms < 6000
    assert not give.write_now


def test_without_a_line_nothing_is_given() -> None:
    plc = Plc(World())
    give = plc.until_ended(command="LEVELWIND_COMMAND_INDEX", line_good=False)
    assert (give.done, give.error, give.uncertain) == (False, True, False)
    plc.cycle(line_good=True)
    assert plc.writes == 0
    assert plc.world.state == State.UNINDEXED


@pytest.mark.parametrize("what", ["another command", "a restart", "no answers"])
def test_a_command_that_is_lost_on_its_way_is_uncertain(what: str) -> None:
    plc = Plc(World())
    for _ in range(10):
        plc.cycle(execute=True, command="LEVELWIND_COMMAND_INDEX")
    assert plc.give.busy
    if what == "another command":
        plc.world.write(command=Command.STOP)
    elif what == "a restart":
        plc.world.write(bench_command=4)
    give = plc.until_ended(line_good=what != "no answers")
    assert (give.done, give.error, give.uncertain) == (False, True, True)


def test_the_sequence_number_wraps() -> None:
    """By words of the test's own: the controller would need 65,535 commands."""
    program = Program(TEXT.read_text(encoding="ascii"))
    give = program.instance("LevelwindGiveCommand")
    give(words=[65_535, 4, 2, *[0] * 6])
    give(words=[65_535, 4, 2, *[0] * 6], execute=True, command="LEVELWIND_COMMAND_STOP")
    give(words=[0, 2, 2, *[0] * 6])
    assert (give.done, give.error) == (True, False)
