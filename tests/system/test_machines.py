# SPDX-License-Identifier: Apache-2.0
"""Machines of other people: with the parameters that are right for them they index and track, and
what is wrong in a machine is to be seen in its truth."""

import itertools
import statistics

import pytest
from levelwind.line.rtu import sealed
from levelwind.map_table import Command, Fault, Mode
from levelwind.simulate import machine
from right_machines import RIGHT, USTEPS, sides
from world import USTEP, World

DRUM_MILLIRPM = 400_000


# Play is an error of the place that no controller sees.
MACHINES = {
    **{name: figures for name, figures in RIGHT.items() if "backlash_mm" not in figures},
    "5-phase-like motor": {"full_steps_per_rev": 500, USTEPS: 5000, **sides(50, -50, 56, 60)},
    "all but one side": sides(78.4, 2, 86, 90),
    "begun aside": {**RIGHT["everything"], "start_mm": -40},
}


def started(figures: dict[str, float]) -> tuple[World, machine.Machine]:
    winch = machine.make(figures)
    return World(machine=winch.given, **winch.parameters()), winch


def turn(world: World, millirpm: int) -> None:
    world.write(bench_drum_acceleration_millirpm_per_s=200_000, bench_drum_speed_millirpm=millirpm)


@pytest.mark.parametrize("figures", MACHINES.values(), ids=MACHINES)
def test_a_right_machine_indexes_and_tracks(figures: dict[str, float]):
    world, winch = started(figures)
    world.index()
    um = winch.um_per_ustep
    # A switch is read in the millisecond after its contact, at 40 mm/s; a microstep for the rest.
    reading_um = 50 + 2 * um
    assert abs(world.error_usteps * um) < reading_um
    assert abs(world.value("span_error_um")) < 2 * reading_um
    world.mode(Mode.TRACK)
    turn(world, DRUM_MILLIRPM)
    reached = []
    for _ in range(600):
        world.run(0.02)
        reached.append(world.truth.carriage_um / 1000)
    turn(world, -DRUM_MILLIRPM)
    world.run(5)
    assert world.permit, f"{world}"
    assert not world.flags & {"los", "los_1_plus", "los_1_minus", "los_2_plus", "los_2_minus"}
    truth = world.truth
    assert truth.pole_slips == 0
    assert abs(truth.carriage_usteps - world.value("m") / USTEP) * um < reading_um + 60
    assert max(reached) > winch["switch_plus_mm"] - 2
    assert min(reached) < winch["switch_minus_mm"] + 2
    assert max(map(abs, reached)) < winch["overtravel_mm"]


def test_the_drum_of_a_right_machine_is_counted_right():
    world, winch = started(MACHINES["begun aside"])
    turn(world, DRUM_MILLIRPM)
    world.run(3)
    # 2 s to the speed, 1 s at it
    turns = 2 * DRUM_MILLIRPM / 60_000
    assert float(world.truth.drum_transitions / winch.transitions_per_drum_rev) == pytest.approx(
        turns, rel=0.001
    )
    edges_per_rev = world.value("edges_per_1000_drum_revs") / 1000
    assert world.value("net_edges") / edges_per_rev == pytest.approx(turns, rel=0.001)


# ---- what is wrong -------------------------------------------------------------------------------


def wrong(**figures: float) -> World:
    """A machine whose builder believes in the default one."""
    believed = machine.make({}).parameters()
    return World(machine=machine.make(figures).given, **believed)


@pytest.mark.parametrize(
    ("figures", "real_per_believed"),
    [
        ({"screw_lead_mm": 10}, 0.5),
        ({"microsteps_per_rev": 1000}, 2),
        ({"screw_lead_mm": 25}, 1.25),
    ],
)
def test_another_lead_or_microsteps_is_another_way(
    figures: dict[str, float], real_per_believed: float
):
    world = wrong(**figures)
    for _ in range(10):
        world.write(jog=1)
        world.run(0.1)
    world.write(jog=0)
    world.run(0.5)
    believed_um = world.value("steps") * 10  # unindexed there is no position: the steps tell
    assert believed_um > 10_000
    assert world.truth.carriage_um == pytest.approx(believed_um * real_per_believed, abs=20)


def test_another_lead_fails_the_span_check():
    world = wrong(screw_lead_mm=19)
    assert world.index_faulted() == Fault.INDEX_SPAN


def test_a_reversed_motor_moves_the_other_way():
    world = wrong(motor_reversed=1)
    for _ in range(5):
        world.write(jog=1)
        world.run(0.1)
    assert world.truth.carriage_um < -1000


@pytest.mark.parametrize(
    ("figures", "factor"),
    [
        ({"encoder_pulses_per_rev": 500}, 500 / 360),
        ({"encoder_ratio_numerator": 3}, 3 / 4),
        ({"encoder_ratio_denominator": 2}, 1 / 2),
        ({"encoder_channels_swapped": 1}, -1),
        ({"encoder_a_inverted": 1}, -1),
        ({"encoder_b_inverted": 1}, -1),
        ({"encoder_a_inverted": 1, "encoder_b_inverted": 1}, 1),
    ],
)
def test_another_encoder_counts_other_edges(figures: dict[str, float], factor: float):
    world = wrong(**figures)
    turn(world, 60_000)
    world.run(10)
    right = wrong()
    turn(right, 60_000)
    right.run(10)
    assert world.value("net_edges") == pytest.approx(right.value("net_edges") * factor, abs=2)
    assert world.value("illegal_transitions") == 0


def test_swapped_limit_switches_are_the_wrong_one():
    world = wrong(limit_switches_swapped=1)
    assert world.index_faulted() == Fault.INDEX_WRONG_SWITCH
    assert world.truth.carriage_um > 70_000  # it has gone plus, and minus told


@pytest.mark.parametrize(
    ("figure", "flag"),
    [("switch_plus_contacts_swapped", "switch_plus"), ("overtravel_plus_fault", "overtravel_plus")],
)
def test_a_contact_that_is_wrong_from_the_beginning_is_told(figure: str, flag: str):
    world = wrong(**{figure: 2 if figure.endswith("fault") else 1})
    assert flag in world.flags
    assert flag not in wrong().flags


def test_swapped_overtravel_switches_tell_of_each_other():
    world = wrong(overtravel_switches_swapped=1, start_mm=88)
    assert "overtravel_minus" in world.flags
    assert "overtravel_plus" not in world.flags


def test_backlash_shows_at_the_other_switch():
    believed = machine.make({}).parameters() | {"span_tolerance_um": 2000}
    spans = {}
    for backlash_mm in (0, 0.6):
        world = World(machine={"backlash_mm": backlash_mm}, **believed)
        spans[backlash_mm] = world.index().value("span_error_um")
    # From the indexing switch to the other one the screw has gone it more than the carriage.
    assert abs(spans[0.6] - spans[0]) == pytest.approx(600, abs=50)


def test_a_loose_coupling_loses_the_place_while_every_step_is_made():
    world = wrong(coupling_grip_mm_per_s2=900)  # 400 after friction: enough for an indexing
    world.index()
    assert abs(world.error_usteps) < 10
    world.mode(Mode.TRACK)
    turn(world, DRUM_MILLIRPM)
    world.run_until(lambda: world.truth.carriage_um > 75_000, step_s=0.01)
    assert abs(world.truth.coupling_slip_um) < 100
    world.run(1.5)
    # 80 mm/s, taken up at 400 mm/s2 where the reversal asks for 1280.
    lost_um = 1000 * 80**2 / 2 * (1 / 400 - 1 / 1280)
    assert world.truth.coupling_slip_um == pytest.approx(-lost_um, rel=0.05)
    world.run_until(lambda: "los" in world.flags, step_s=0.1)
    assert world.truth.pole_slips == 0


@pytest.mark.parametrize("sigma_mm", [0, 0.1])
def test_a_switch_with_scatter_shows_in_repeated_indexings(sigma_mm: float):
    world = wrong(switch_plus_scatter_mm=sigma_mm)
    spans = []
    for _ in range(12):
        world.command(Command.INDEX)
        spans.append(world.value("span_error_um"))
    deviation = statistics.pstdev(spans)
    assert deviation == pytest.approx(1000 * sigma_mm, rel=0.7, abs=15)


def test_a_switch_that_drifts_shows_in_repeated_indexings():
    world = wrong(switch_minus_drift_mm=0.05)
    spans = []
    for _ in range(6):
        world.command(Command.INDEX)
        spans.append(world.value("span_error_um"))
    steps = [second - first for first, second in itertools.pairwise(spans)]
    assert all(abs(step) == pytest.approx(50, abs=25) for step in steps)
    assert len({step > 0 for step in steps}) == 1
    assert world.truth.limit_um[1] == pytest.approx(-78_400 - 5 * 50, abs=1)  # it is pressed


def test_noise_on_the_line_is_counted():
    world = wrong(line_errors_ppm=20_000)
    frame = sealed(bytes([1, 4, 0, 100, 0, 8]))
    answered = sum(len(world.line(frame, 0.05)) == 21 for _ in range(300))
    assert 200 < answered < 290  # 8 bytes there: 15 % of the requests are lost
    assert world.value("crc_errors") > 20


def test_a_weak_motor_slips():
    figures = {"holding_acceleration_mm_per_s2": 6000, "top_speed_mm_per_s": 60}
    pull_out = machine.make(figures).pull_out_mm_per_s()
    assert 40 < pull_out < 60
    slipped = {}
    for share in (0.8, 1.2):
        world = wrong(**figures)
        mm_per_edge = 12 / 2880
        world.apply(index_rate_edges_per_s=round(share * pull_out / mm_per_edge))
        world.write(command=Command.INDEX)
        world.run(1.0)
        slipped[share] = world.truth.pole_slips
    assert slipped[0.8] == 0
    assert slipped[1.2] > 10
