# SPDX-License-Identifier: Apache-2.0
"""The carriage follows a cam table: upload, start, motion, change of tables."""

import struct
from collections.abc import Iterator

import pytest
from levelwind.cam.table import Scale, Table, from_words, words
from levelwind.map_table import (
    BenchCommand,
    CamBankState,
    Command,
    Fault,
    LaunchInhibit,
    Mode,
    Reason,
    Result,
    State,
)
from levelwind.map_table import CamInterpolation as Interpolation
from levelwind.map_table import CamStart as Start
from rational_cam import NOTE_ROWS, RationalCam
from world import RequestRefusedError, World

FILE = 2
GROUP_WORDS = 100
# The note's table, a tenth as high so that it fits between the flanges.
NOTE = Table(NOTE_ROWS, name="note", version=7)
NOTE_SCALE = {"cam_slave_usteps": 1, "cam_slave_units": 10}
HILL = Table(((0, 0), (1000, 1500), (3000, -500), (4000, 0)), name="hill", version=1)
OTHER = Table(((0, 0), (500, -900), (1500, 0)), Interpolation.TRAPEZOID, name="other")


def write_words(world: World, file: int, data: list[int], first: int = 0) -> bytes:
    """FC21, as many requests as it takes; the last answer."""
    answer = b""
    for at in range(0, len(data), GROUP_WORDS):
        part = data[at : at + GROUP_WORDS]
        group = struct.pack(f">BHHH{len(part)}H", 6, file, first + at, len(part), *part)
        answer = world.request(struct.pack(">BB", 21, len(group)) + group)
    return answer


def read_words(world: World, file: int, first: int, count: int) -> list[int]:
    """FC20."""
    data: list[int] = []
    while len(data) < count:
        part = min(GROUP_WORDS, count - len(data))
        answer = world.request(struct.pack(">BBBHHH", 20, 7, 6, file, first + len(data), part))
        data += struct.unpack(f">{part}H", answer[4:])
    return data


def upload(world: World, table: Table, file: int = FILE) -> Result:
    """Write a bank and have it checked."""
    write_words(world, file, words(table))
    return world.command(Command.CAM_CHECK)


def put_in_force(world: World, table: Table, file: int = FILE) -> World:
    """Upload, check, activate."""
    assert upload(world, table, file) == Result.DONE, Reason(world.value("cam_reason")).label
    assert world.command(Command.CAM_ACTIVATE) == Result.DONE
    return world


def camming(table: Table = HILL, **parameters: int) -> World:
    """An indexed machine that follows a table."""
    world = World(park_at=1, park_position_um=0, **parameters)
    put_in_force(world, table)
    world.apply(motion_profile=1)
    assert world.command(Command.INDEX) == Result.DONE
    world.run_until(lambda: world.state == State.TRACKING)
    return world


def banks(world: World) -> tuple[CamBankState, CamBankState]:
    """What the banks hold."""
    at = world.read("cam_bank_0_state", "cam_bank_1_state")
    return CamBankState(at["cam_bank_0_state"]), CamBankState(at["cam_bank_1_state"])


def check_in_step(world: World, model: RationalCam, phase: int = 0) -> None:
    """The controller, and the pulses that the stepper got, are where the table says."""
    at = world.read("position_usteps", "net_edges", "cam_position_usteps")
    expected = model.usteps(at["net_edges"] + phase)
    assert at["cam_position_usteps"] == expected
    assert at["position_usteps"] == expected


def drives(world: World) -> Iterator[None]:
    """Forward, backward, to and fro."""
    for speed, seconds in ((20_000, 0.7), (-15_000, 1.1), (300, 0.3), (-20_000, 0.4), (5_000, 0.5)):
        world.drum(speed, 200_000)
        world.run(seconds)
        yield
    world.stop_drum()
    yield


@pytest.mark.parametrize("interpolation", Interpolation, ids=lambda i: i.label)
def test_follows_the_table_at_every_look(interpolation: Interpolation):
    """The note's table at 20,000 edges/s, forward and backward, with the plant's truth."""
    table = Table(NOTE_ROWS, interpolation, name="note")
    world = camming(table, **NOTE_SCALE)
    model = RationalCam(table, Scale(1, 1, 1, 10))
    offset = world.value("bench_commanded_usteps") - world.value("position_usteps")
    for _ in drives(world):
        for _ in range(20):
            world.run(0.0137)
            check_in_step(world, model)
        at = world.read("bench_commanded_usteps", "position_usteps")
        assert abs(at["bench_commanded_usteps"] - offset - at["position_usteps"]) <= 2
    assert "launch_permit" in world.flags
    assert world.truth.in_sync


def test_upload_reads_back_and_tells_what_it_holds():
    world = World()
    assert banks(world) == (CamBankState.EMPTY, CamBankState.EMPTY)
    write_words(world, 2, words(NOTE))
    assert banks(world)[0] == CamBankState.LOADING
    world.apply(**NOTE_SCALE)
    put_in_force(world, NOTE)
    assert banks(world) == (CamBankState.ACTIVE, CamBankState.EMPTY)
    assert from_words(read_words(world, 2, 0, 16 + 4 * 11)) == NOTE
    at = world.read("cam_version", "cam_rows", "cam_cycle_edges", "cam_min_usteps")
    assert at == {
        "cam_version": 7,
        "cam_rows": 11,
        "cam_cycle_edges": 200_000,
        "cam_min_usteps": -5000,
    }


def test_upload_through_the_window_of_registers():
    """The same words by FC16, and read back by FC03."""
    world = World()
    table = Table(
        tuple((100 * i, -i * (255 - i) // 4) for i in range(256)), name="window", version=3
    )
    data = words(table)

    def write(address: int, values: list[int]) -> None:
        for at in range(0, len(values), 120):
            part = values[at : at + 120]
            head = struct.pack(">BHHB", 16, address + at, len(part), 2 * len(part))
            answer = world.request(head + struct.pack(f">{len(part)}H", *part))
            assert answer[0] == 16, answer

    write(3000, data[:16])
    for row in range(0, 256, 30):
        world.write(cam_upload_first_row=row + 1)
        write(3018, data[16 + 4 * row : 16 + 4 * (row + 30)])
    assert read_words(world, 2, 0, len(data)) == data
    world.write(cam_upload_first_row=241)
    answer = world.request(struct.pack(">BHH", 3, 3018, 120))
    assert list(struct.unpack(">120H", answer[2:])) == data[16 + 4 * 240 :] + [0] * 56
    answer = world.request(struct.pack(">BHH", 3, 3000, 16))
    assert list(struct.unpack(">16H", answer[2:])) == data[:16]
    assert world.command(Command.CAM_CHECK) == Result.DONE
    assert banks(world)[0] == CamBankState.READY


BAD = {
    "torn": (words(HILL)[:-4], Reason.CAM_CRC, 0),
    "wrong wrap": (
        words(Table(((0, 0), (1000, 10)), advance=-10)),
        Reason.CAM_WRAP,
        2,
    ),
    "single row": (words(Table(((0, 0),))), Reason.CAM_TOO_FEW_ROWS, 1),
    "a row too many": (
        words(Table(tuple((i, 0) for i in range(257))))[: 16 + 4 * 256],
        Reason.CAM_TOO_MANY_ROWS,
        257,
    ),
    "equal masters": (
        words(Table(((0, 0), (100, 5), (100, 0)))),
        Reason.CAM_MASTER_NOT_ASCENDING,
        3,
    ),
    "slope 4.01": (
        words(Table(((0, 0), (100, 401), (300, 0)))),
        Reason.CAM_SLOPE,
        1,
    ),
    "pulse rate": (words(Table(((0, 0), (100, 334), (300, 0)))), Reason.CAM_STEP_RATE, 1),
    "beyond the flange": (
        words(Table(((0, 0), (9000, -8301), (20_000, 0)))),
        Reason.CAM_BEYOND_FLANGE,
        2,
    ),
    "advances": (words(Table(((0, 0), (100, 1)), advance=1)), Reason.CAM_ADVANCES, 2),
}


@pytest.mark.parametrize(("data", "reason", "row"), BAD.values(), ids=BAD.keys())
def test_a_bad_table_is_refused_and_the_old_one_runs_on(data: list[int], reason: Reason, row: int):
    world = camming()
    model = RationalCam(HILL)
    world.drum(8000)
    world.run(0.2)
    write_words(world, 3, data)
    world.write(command=Command.CAM_CHECK)
    assert world.value("command_result") == Result.REFUSED
    at = world.read("command_reason", "cam_reason", "cam_reason_row")
    assert (at["command_reason"], at["cam_reason"], at["cam_reason_row"]) == (reason, reason, row)
    world.write(command=Command.CAM_ACTIVATE)
    assert world.value("command_reason") == Reason.CAM_NO_TABLE
    world.run(0.9)
    check_in_step(world, model)
    assert banks(world) == (CamBankState.ACTIVE, CamBankState.LOADING)


def test_the_bank_in_force_cannot_be_written():
    world = camming()
    before = read_words(world, 2, 0, 32)
    assert write_words(world, 2, words(OTHER))[:2] == bytes((0x80 | 21, 6))
    assert world.value("last_error_reason") == Reason.CAM_BANK_IN_USE
    assert read_words(world, 2, 0, 32) == before


def test_another_table_at_the_end_of_the_cycle():
    world = camming()
    world.drum(2000)
    assert upload(world, OTHER, 3) == Result.DONE
    assert world.command(Command.CAM_ACTIVATE) == Result.DONE
    assert banks(world) == (CamBankState.ACTIVE, CamBankState.QUEUED)
    world.write(command=Command.CAM_CHECK)
    assert world.value("command_reason") == Reason.CAM_QUEUED
    assert write_words(world, 3, words(HILL))[:2] == bytes((0x80 | 21, 6))
    cycles = world.value("cam_cycles")
    model = RationalCam(HILL)
    while banks(world)[1] == CamBankState.QUEUED:
        if world.value("cam_cycles") == cycles:
            check_in_step(world, model)
        world.run(0.011)
    assert world.value("cam_cycles") == cycles + 1
    assert banks(world) == (CamBankState.READY, CamBankState.ACTIVE)
    # The joint is where the net edges were a whole number of the first table's cycles.
    joint = world.value("net_edges") // 4000 * 4000
    for _ in range(30):
        check_in_step(world, RationalCam(OTHER), -joint)
        world.run(0.017)
    world.drum(-3000)
    for _ in range(60):
        world.run(0.017)
        check_in_step(world, RationalCam(OTHER), -joint)


def test_a_queued_table_is_discarded_or_taken_when_the_cam_stops():
    world = camming()
    assert upload(world, OTHER, 3) == Result.DONE
    world.command(Command.CAM_ACTIVATE)
    assert world.command(Command.CAM_DISCARD) == Result.DONE
    assert banks(world) == (CamBankState.ACTIVE, CamBankState.READY)
    world.command(Command.CAM_ACTIVATE)
    world.mode(Mode.CENTRE)
    world.run_until(lambda: banks(world)[1] == CamBankState.ACTIVE)
    world.command(Command.CAM_DISCARD)
    assert banks(world) == (CamBankState.EMPTY, CamBankState.ACTIVE)


def test_a_table_that_begins_elsewhere_does_not_join():
    world = camming()
    assert upload(world, Table(((0, 3), (100, 3))), 3) == Result.DONE
    world.write(command=Command.CAM_ACTIVATE)
    at = world.read("command_reason", "command_value", "command_limit")
    assert at == {
        "command_reason": Reason.CAM_DOES_NOT_JOIN,
        "command_value": 3,
        "command_limit": 0,
    }
    world = camming(cam_start=Start.RELATIVE)
    assert upload(world, Table(((0, 3), (100, 3))), 3) == Result.DONE
    assert world.command(Command.CAM_ACTIVATE) == Result.DONE


def test_relative_start_begins_where_the_carriage_is():
    world = camming(cam_start=Start.RELATIVE)
    model = RationalCam(HILL)
    start = world.read("position_usteps", "net_edges", "pattern_edges")
    assert start["pattern_edges"] == 0
    for _ in drives(world):
        at = world.read("position_usteps", "pattern_edges")
        assert at["position_usteps"] - start["position_usteps"] == model.usteps(at["pattern_edges"])


@pytest.mark.parametrize("speed", [3000, -3000])
def test_start_at_the_next_cycle(speed: int):
    world = camming(Table(((0, 40), (2000, 900), (4000, 40))), cam_start=Start.NEXT_CYCLE)
    model = RationalCam(Table(((0, 40), (2000, 900), (4000, 40))))
    world.drum(speed)
    while world.value("cam_waiting"):
        at = world.read("net_edges", "position_usteps")
        assert 0 <= at["net_edges"] < 4000 or speed < 0
        assert abs(at["position_usteps"] - 40) <= 1
        world.run(0.007)
    for _ in range(50):
        world.run(0.013)
        check_in_step(world, model)


def test_phase_shift_is_spread_over_edges():
    """Never more than steps_max pulses in one edge, and then in step again."""
    world = camming()
    model = RationalCam(HILL)
    world.drum(4000)
    world.run(0.5)
    for phase in (700, -300):
        edges = world.value("net_edges")
        pulses = world.value("steps")
        world.write(cam_phase_edges=phase)
        while world.value("cam_phase_in_force_edges") != phase:
            world.run(0.003)
            at = world.read("net_edges", "steps")
            assert at["steps"] - pulses <= 3 * (at["net_edges"] - edges)
        assert world.value("net_edges") - edges >= 700
        world.run(0.01)
        check_in_step(world, model, phase)
    assert world.value("cam_phase_edges") == -300


def test_a_free_axis_gears():
    """3 / 7 of the drum, either way; where it is left is position 0."""
    gear = Table(((0, 0), (7, 3)), advance=3, name="gear")
    world = camming(gear, cam_axis=1, cam_start=Start.RELATIVE)
    begin = world.value("bench_commanded_usteps")
    for speed in (5000, -9000):
        world.drum(speed)
        world.run(1.5)
        world.stop_drum()
        at = world.read("pattern_edges", "cam_position_usteps")
        assert abs(at["cam_position_usteps"]) > 2000
        assert at["cam_position_usteps"] == (6 * at["pattern_edges"] + 7) // 14
        assert world.value("bench_commanded_usteps") - begin == at["cam_position_usteps"]
    assert world.value("cam_cycles") == at["pattern_edges"] // 7
    world.write(command=Command.STOP)
    assert world.read("position_usteps", "m") == {"position_usteps": 0, "m": 0}


def test_profile_cam_without_a_table_is_refused():
    world = World()
    world.write(motion_profile=1)
    world.write(command=Command.APPLY)
    at = world.read("command_result", "command_reason", "command_address")
    assert at == {
        "command_result": Result.REFUSED,
        "command_reason": Reason.CAM_NO_TABLE,
        "command_address": 600,
    }
    put_in_force(world, HILL)
    world.apply(motion_profile=1)
    # A scale that the table in force does not fit.
    world.write(cam_slave_usteps=10)
    world.write(command=Command.APPLY)
    assert world.value("command_reason") == Reason.CAM_SLOPE
    assert world.value("cam_reason_row") == 1
    world.write(command=Command.REVERT)
    world.write(cam_axis=1)
    world.write(command=Command.APPLY)
    assert world.value("command_reason") == Reason.CAM_FREE_AXIS


def test_a_relative_start_beyond_the_flange_is_not_made():
    world = World(cam_start=Start.RELATIVE)  # indexing ends near a flange
    put_in_force(world, Table(((0, 0), (20_000, -900), (40_000, 0))))
    world.apply(motion_profile=1)
    world.command(Command.INDEX)
    world.run(1)
    assert world.state == State.READY
    assert "launch_permit" not in world.flags
    assert world.value("launch_inhibit") >> LaunchInhibit.CAM & 1
    assert world.value("cam_reason") == Reason.CAM_BEYOND_FLANGE
    assert world.value("cam_reason_row") == 2
    world.apply(motion_profile=0)
    assert world.value("launch_inhibit") >> LaunchInhibit.CAM & 1 == 0


def test_back_to_the_screw():
    world = camming()
    world.drum(5000)
    world.run(0.3)
    world.stop_drum()
    world.mode(Mode.CENTRE)
    world.run_until(lambda: world.state == State.CENTRED)
    world.apply(motion_profile=0)
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING)
    orbit = world.orbit()
    for _ in drives(world):
        world.check_follows(orbit)


def test_overtravel_stops_a_cam_too():
    world = camming()
    world.drum(5000)
    world.run(0.1)
    world.write(bench_overtravel_plus=1)
    world.run(0.01)
    assert world.fault == Fault.OVERTRAVEL_PLUS


def test_a_switch_out_of_place_is_a_loss_of_synchronization():
    """Recorded, the permit drops; the cam is not corrected, for it has no sweep."""
    table = Table(((0, 0), (20_000, 8000), (40_000, -8000), (50_000, 0)))
    world = camming(table)
    model = RationalCam(table)
    world.drum(5000)
    world.run(12)
    assert "los" not in world.flags
    world.write(bench_argument=-200, bench_command=5)
    world.run(12)
    assert world.fault == Fault.NONE
    assert "los2_plus" in world.flags or "los2_minus" in world.flags
    assert not world.permit
    assert world.state == State.TRACKING
    check_in_step(world, model)


def test_the_lock_guards_tables():
    world = World()
    world.apply(lock_code=4711)
    world.run(0.01)
    if "locked" not in world.flags:
        world.run(400)
    assert "locked" in world.flags
    assert write_words(world, 2, words(HILL))[:2] == bytes((0x80 | 21, 6))
    assert world.value("last_error_reason") == Reason.LOCKED
    with pytest.raises(RequestRefusedError):
        world.write(command=Command.CAM_CHECK)


def power_cut(world: World) -> None:
    """Off and on again."""
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)


def test_the_table_in_force_is_there_after_a_power_cut():
    world = put_in_force(World(), HILL)
    world.run_until(lambda: world.value("cam_stored") == 1)
    power_cut(world)
    assert CamBankState.ACTIVE in banks(world)
    assert from_words(read_words(world, 2, 0, 16 + 4 * 4)) == HILL
    assert world.value("cam_stored") == 1
    # The next one; the first is kept beside it.
    put_in_force(world, OTHER, 3)
    world.run_until(lambda: world.value("cam_stored") == 1)
    power_cut(world)
    assert sorted(banks(world)) == [CamBankState.READY, CamBankState.ACTIVE]
    assert world.value("cam_rows") == 3


def test_a_power_cut_before_a_table_is_stored_leaves_the_old_one():
    """While the cam runs nothing is stored: what it went over to is lost, the old one is not."""
    world = put_in_force(World(park_at=1), HILL)
    world.apply(motion_profile=1)
    assert world.command(Command.SAVE) == Result.DONE
    world.run_until(lambda: world.value("cam_stored") == 1)
    world.command(Command.INDEX)
    world.run_until(lambda: world.state == State.TRACKING)
    world.drum(8000)
    assert upload(world, OTHER, 3) == Result.DONE
    world.command(Command.CAM_ACTIVATE)
    world.run_until(lambda: banks(world)[1] == CamBankState.ACTIVE)
    assert world.value("cam_stored") == 0
    world.stop_drum()
    power_cut(world)
    assert (world.value("cam_version"), world.value("cam_rows")) == (HILL.version, 4)
    assert world.value("motion_profile") == 1
    world.command(Command.INDEX)
    world.run_until(lambda: world.state == State.TRACKING)
    world.drum(3000)
    world.run(1)
    check_in_step(world, RationalCam(HILL))
