# SPDX-License-Identifier: Apache-2.0
"""The stepper stalls in a launch: noticed, recovered from, and told until indexed again."""

import pytest
from levelwind.map_table import Command, Flag, State
from world import USTEP, World

SPEED_EDGES_PER_S = 20_000  # 16.7 m/s of rope
HOLD_MS = 1200
RECOVERY_S = 8.0
SWITCH_USTEPS = 7840  # calibrated, either side
TOLERANCE_USTEPS = 100  # switch_tolerance_um
HYSTERESIS_USTEPS = 150
"""
After a re-index in motion the switch has told its position late, by the transit of its contact
(1 ms) and by the speed shift of the simulated switch (0.5 ms), at 83 mm/s: 125 um.
"""
RECOVERED_USTEPS = 16
JUDGED_MS = 2  # an event is told by the tick that follows it

SIDES = {1: "plus", -1: "minus"}
POSITIONS_UM = [*range(-76_000, 80_001, 8_000)]
assert len(POSITIONS_UM) == 20


LOS_FLAGS = {
    flag: flag.label for flag in (Flag.LOS1_PLUS, Flag.LOS1_MINUS, Flag.LOS2_PLUS, Flag.LOS2_MINUS)
}


class Watch:
    """What the law is allowed to do and what the controller has to tell, every millisecond."""

    NAMES = (
        *("m", "u", "flags", "net_edges", "steps", "los_recoveries"),
        *("switch_plus_triggers", "switch_minus_triggers"),
    )

    def __init__(self, world: World, drum: int) -> None:
        self.world = world
        self.drum = drum
        self.ks = world.value("ks")
        self.reversal = {
            1: world.value("reversal_plus_usteps"),
            -1: world.value("reversal_minus_usteps"),
        }
        self.now = world.read(*self.NAMES)
        self.told = set(self.los_flags())
        self.due: dict[str, int] = {}  # LOS flags that must be set, and in how many ms
        self.approached = {1: False, -1: False}  # sides whose switch must trigger before reversal

    def flag(self, flag: Flag) -> bool:
        """A flag now."""
        return bool(self.now["flags"] >> flag & 1)

    def los_flags(self) -> list[str]:
        """LOS flags now."""
        return [name for flag, name in LOS_FLAGS.items() if self.flag(flag)]

    def millisecond(self) -> None:
        """Let one pass."""
        before = self.now
        self.world.run(0.001)
        self.now = self.world.read(*self.NAMES)
        self.check_steps(before)
        self.check_slope()
        self.expect_los(before)
        self.check_los()

    def check_steps(self, before: dict[str, int]) -> None:
        edges = abs(self.now["net_edges"] - before["net_edges"])
        assert 0 <= self.now["steps"] - before["steps"] <= edges * self.ks // USTEP + 1

    def check_slope(self) -> None:
        u = abs(self.now["u"])
        in_sweep = self.reversal[-1] < self.now["m"] >> 16 < self.reversal[1]
        assert u == self.ks if in_sweep else u <= self.ks

    def expect_los(self, before: dict[str, int]) -> None:
        for side, name in SIDES.items():
            toward = before["u"] * self.drum * side > 0
            triggered = self.now[f"switch_{name}_triggers"] != before[f"switch_{name}_triggers"]
            position = side * (before["m"] >> 16)
            # Before its correction the position says nothing about where a switch is.
            corrected = not before["flags"] >> Flag.CORRECTION_PENDING & 1
            if corrected and position < SWITCH_USTEPS - TOLERANCE_USTEPS - HYSTERESIS_USTEPS:
                self.approached[side] = True
            if triggered and toward:
                self.approached[side] = False
                if abs(position - SWITCH_USTEPS) > TOLERANCE_USTEPS + 10:
                    self.due.setdefault(f"los2_{name}", JUDGED_MS)
            entered = side * (self.now["m"] >> 16) >= side * self.reversal[side]
            if entered and self.approached[side]:
                self.approached[side] = False
                self.due.setdefault(f"los1_{name}", JUDGED_MS)

    def check_los(self) -> None:
        flags = self.los_flags()
        for name in flags:
            assert name in self.told or name in self.due, f"{name} without a cause"
        self.told |= set(flags)
        assert self.told == set(flags), "a LOS flag has been cleared"
        for name in set(self.due) - self.told:
            self.due[name] -= 1
            assert self.due[name] > 0, f"{name} is not told"
        assert self.flag(Flag.LOS) == bool(flags)
        assert not (flags and self.flag(Flag.LAUNCH_PERMIT))


@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
@pytest.mark.parametrize("direction", [1, -1], ids=["toward_plus", "toward_minus"])
@pytest.mark.parametrize("position_um", POSITIONS_UM)
def test_stall(position_um: int, direction: int, drum: int):
    world = World(seed=1 + abs(position_um)).index()
    assert world.permit
    world.drum(drum * SPEED_EDGES_PER_S)
    world.run(1.0)
    watch = Watch(world, drum)
    world.write(
        bench_trigger_position_um=position_um,
        bench_trigger_direction=direction,
        bench_trigger_argument=HOLD_MS,
        bench_trigger_fault=1,
    )
    while world.value("bench_trigger_fault"):
        watch.millisecond()
    for _ in range(HOLD_MS):
        watch.millisecond()
    assert abs(world.error_usteps) > TOLERANCE_USTEPS, "the stall has cost no step"

    # The first trigger in the right direction brings it back, in the next edges.
    for _ in range(round(RECOVERY_S * 1000)):
        watch.millisecond()
        if watch.now["los_recoveries"] and not watch.flag(Flag.CORRECTION_PENDING):
            break
    assert watch.now["los_recoveries"] == 1
    assert any(name.startswith("los2") for name in watch.told)
    for _ in range(50):
        watch.millisecond()
    assert abs(world.error_usteps) <= RECOVERED_USTEPS

    # From here all is well, and yet no launch.
    told = set(watch.told)
    for _ in range(2000):
        watch.millisecond()
    assert watch.told == told
    assert watch.now["los_recoveries"] == 1
    assert world.state == State.TRACKING
    assert abs(world.error_usteps) <= RECOVERED_USTEPS
    world.stop_drum()
    world.command(Command.CLEAR_FAULT)
    assert not world.permit
    world.index()
    assert world.permit
    assert "los" not in world.flags
