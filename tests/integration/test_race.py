# SPDX-License-Identifier: Apache-2.0
"""Everything at once at 48,000 edges/s, the fastest drum: nothing may be lost and nothing mixed."""

from itertools import count

import pytest
from levelwind.core.ideal_screw import Screw
from levelwind.core.ideal_screw import State as LawState
from levelwind.map_table import Command, Flag, Reason, Result, State
from slave import Slave

FASTEST_MILLIRPM = 1_000_000  # 2,880 edges per drum revolution: 48,000 edges/s
TRANSITIONS_PER_EDGE = 2
USTEP = 65536


@pytest.fixture
def duration_ms(target: str) -> int:
    """A minute; the emulator needs several for it."""
    return 10_000 if target == "qemu" else 60_000


def spin(slave: Slave) -> None:
    assert slave.write("bench_drum_acceleration_millirpm_per_s", 500_000) == 0
    assert slave.write("bench_drum_speed_millirpm", FASTEST_MILLIRPM) == 0
    slave.wait(lambda: slave.read("drum_speed_edges_per_s") > 47_500)


def come_to_rest(slave: Slave) -> None:
    assert slave.write("bench_drum_speed_millirpm", 0) == 0
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))


def edges_missed(slave: Slave) -> int:
    """Edges that the encoder has given and the controller has not counted; at rest."""
    return slave.read("bench_transitions") // TRANSITIONS_PER_EDGE - slave.read("net_edges")


def test_apply_while_the_drum_turns(slave: Slave, duration_ms: int) -> None:
    """Not indexed, the set may change at any speed. The odometer must not notice."""
    missed = edges_missed(slave)
    illegal = slave.read("illegal_transitions")
    spin(slave)
    end_ms = slave.read("uptime_ms") + duration_ms // 4
    for turn in count():
        assert slave.write("reversal_plus_um", 79_000 + 500 * (turn % 2)) == 0
        assert slave.command(Command.APPLY) == Result.DONE
        if slave.read("uptime_ms") > end_ms:
            break
    come_to_rest(slave)
    assert abs(edges_missed(slave) - missed) <= 1  # the drum may rest between two edges
    assert slave.read("illegal_transitions") == illegal


def test_every_read_is_of_one_moment(slave: Slave, duration_ms: int) -> None:
    """Position, slope and edge counts of one request belong together, by the ideal screw."""
    names = ("position_um", "position_usteps", "m", "u", "net_edges", "pattern_edges")
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    start = slave.read_run(*names)
    assert start["pattern_edges"] == 0
    screw = Screw(
        *(slave.read(name) for name in ("ka", "nr")),
        *(slave.read(f"reversal_{side}_usteps") for side in ("plus", "minus")),
        *(slave.read(f"dwell_{side}_edges") for side in ("plus", "minus")),
    )
    orbit = screw.orbit(LawState(start["m"], start["u"]))
    um_per_m = slave.read("screw_lead_um") / slave.read("microsteps_per_rev") / USTEP
    spin(slave)
    end_ms = slave.read("uptime_ms") + duration_ms // 4
    while slave.read("uptime_ms") < end_ms:
        for _ in range(20):
            now = slave.read_run(*names)
            ideal = orbit.after(now["pattern_edges"])
            assert (now["m"], now["u"]) == (ideal.m, ideal.u)
            assert now["position_usteps"] == now["m"] // USTEP
            assert abs(now["position_um"] - now["m"] * um_per_m) <= 1
            assert now["net_edges"] - now["pattern_edges"] == start["net_edges"]
    come_to_rest(slave)


def test_trim_and_refused_apply_while_tracking(slave: Slave, duration_ms: int) -> None:
    """The law must take whole windows only, or the carriage ends up somewhere else."""
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    missed = edges_missed(slave)
    offset_usteps = slave.read("bench_commanded_usteps") - slave.read("position_usteps")
    spin(slave)
    end_ms = slave.read("uptime_ms") + duration_ms
    for turn in count():
        assert slave.write("trim_plus_um", -10 * (turn % 50)) == 0
        assert slave.write("trim_minus_um", 10 * (turn % 30)) == 0
        assert slave.command(Command.APPLY) == Result.REFUSED
        assert slave.read("command_reason") == Reason.BUSY_TRACKING
        if slave.read("uptime_ms") > end_ms:
            break
    come_to_rest(slave)
    assert not slave.flag(Flag.LOS)
    assert abs(edges_missed(slave) - missed) <= 1
    assert slave.read("bench_commanded_usteps") - slave.read("position_usteps") == offset_usteps
    assert slave.read("state") == State.TRACKING
