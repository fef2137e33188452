# SPDX-License-Identifier: Apache-2.0
"""Over the line and through the pins: metres of rope over a power cut, and the buttons' trim."""

from levelwind.map_table import BenchCommand, Command, Flag, Reason, Result, State
from slave import Slave
from test_life import index, turn_drum

DRUM = {
    "rope_diameter_um": 5_000,
    "drum_core_diameter_um": 380_000,
    "rope_packing_permille": 750,
}


def press(slave: Slave, button: str) -> None:
    """Press and let go, as long as a finger does."""
    slave.write(f"bench_trim_{button}", 1)
    slave.settle(100)
    slave.write(f"bench_trim_{button}", 0)
    slave.settle(100)


def test_metres_are_told_wound_out_and_in_and_kept_over_a_power_cut(slave: Slave) -> None:
    assert slave.command(Command.SET_ROPE) == Result.REFUSED
    assert slave.read("command_reason") == Reason.ROPE_NOT_DESCRIBED
    for name, value in DRUM.items():
        slave.write(name, value)
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.command(Command.SAVE) == Result.DONE
    assert slave.flag(Flag.ROPE_DOUBTFUL)

    slave.write("set_rope_mm", 950_000)
    assert slave.command(Command.SET_ROPE) == Result.DONE
    assert not slave.flag(Flag.ROPE_DOUBTFUL)
    assert (slave.read("rope_on_drum_mm"), slave.read("rope_out_mm")) == (950_000, 0)

    turn_drum(slave, -300_000)
    slave.wait(lambda: slave.read("rope_out_mm") > 5_000)
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    at = slave.read_run("rope_on_drum_mm", "rope_out_mm", "rope_layer", "rope_radius_um")
    assert at["rope_on_drum_mm"] + at["rope_out_mm"] == 950_000
    assert at["rope_layer"] == 1 + (at["rope_radius_um"] - 190_000) // 5_000

    slave.settle(3_000)  # written while the drum rests
    boots = slave.read("boots")
    slave.write("bench_command", BenchCommand.POWER_CUT)
    slave.wait(lambda: slave.read("boots") == boots + 1)
    assert slave.read_run("rope_on_drum_mm", "rope_out_mm", "rope_layer", "rope_radius_um") == at
    assert slave.flag(Flag.ROPE_DOUBTFUL)


def test_a_press_of_a_button_is_one_step(slave: Slave) -> None:
    slave.write("trim_step_um", 250)
    assert slave.command(Command.APPLY) == Result.DONE
    press(slave, "early")  # nothing to trim yet: not taken, and no command of a master's
    assert (slave.read("trim_plus_um"), slave.read("trim_minus_um")) == (0, 0)
    assert slave.read("command_code") == Command.APPLY

    index(slave)
    turn_drum(slave, 20_000)
    slave.wait(lambda: slave.read("u") > 0 and 0 < slave.read("position_um") < 40_000)
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert slave.read("state") == State.TRACKING
    press(slave, "early")
    assert slave.read("trim_plus_um") == -250
    press(slave, "late")
    press(slave, "late")
    assert slave.read("trim_plus_um") == 250
    assert slave.read("trim_minus_um") == 0
    slave.write("bench_trim_early", 1)  # held down: one press, however long
    slave.settle(1_500)
    assert slave.read("trim_plus_um") == 0
    slave.write("bench_trim_early", 0)
