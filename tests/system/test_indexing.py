# SPDX-License-Identifier: Apache-2.0
"""Indexing from anywhere, and with a broken machine."""

import random

import pytest
from levelwind.map_table import Command, Fault, Mode, ParkAt, Side, State, SwitchFault
from world import World

STOP_UM = 90_000
SWITCH_UM = 78_400
OVERTRAVEL_UM = 86_000
RANDOM = random.Random(2024)
STARTS_UM = [
    *(0, STOP_UM, -STOP_UM),
    *(sign * um for sign in (1, -1) for um in (SWITCH_UM - 1, SWITCH_UM, SWITCH_UM + 300)),
    *(sign * um for sign in (1, -1) for um in (OVERTRAVEL_UM - 50, OVERTRAVEL_UM, 88_000)),
    *(sign * um for sign in (1, -1) for um in (SWITCH_UM - 400, SWITCH_UM - 2_000)),
]
STARTS_UM += [RANDOM.randint(-STOP_UM, STOP_UM) for _ in range(50 - len(STARTS_UM))]
LAG_USTEPS = 0.15  # friction of the plant holds a resting rotor that far beside its field
CONFIGURATIONS = [
    pytest.param(side, park, id=f"{side.label}-{park.label}") for side in Side for park in ParkAt
]


@pytest.mark.parametrize(("side", "park"), CONFIGURATIONS)
def test_index_from_anywhere_ends_at_the_same_place(side: Side, park: ParkAt):
    parameters = {"index_switch": side, "park_at": park, "park_position_um": 20_000}
    offsets_usteps = []
    for seed, start_um in enumerate(STARTS_UM):
        world = World(seed, start_um, **parameters)
        world.mode(Mode.CENTRE if seed % 5 == 0 else Mode.TRACK)
        world.index()
        if seed % 5 == 0:
            world.run_until(lambda w=world: w.state == State.CENTRED, step_s=0.01)
        else:
            assert world.state == State.TRACKING
            assert world.permit
            parked_um = world.value("position_um")
            if park == ParkAt.POSITION:
                assert abs(parked_um - 20_000) <= 20
            else:
                assert abs(parked_um) == pytest.approx(82_500, abs=60)
                assert (parked_um < 0) == (side == Side.PLUS)
        world.run(0.3)  # until the rotor has swung out
        truth = world.truth
        assert abs(truth.lag_usteps) <= LAG_USTEPS
        offsets_usteps.append(truth.commanded_usteps - world.value("position_usteps"))
    # The switch tells late, by transit and speed: the same for all, but for the step it falls into.
    assert max(offsets_usteps) - min(offsets_usteps) <= 1
    assert max(map(abs, offsets_usteps)) <= 8


@pytest.mark.parametrize("side", list(Side), ids=lambda s: s.label)
@pytest.mark.parametrize("start_um", [0, 60_000, -60_000])
def test_index_names_what_is_broken(side: Side, start_um: int):
    this, other = ("plus", "minus") if side == Side.PLUS else ("minus", "plus")

    def broken(**bench: int) -> Fault:
        world = World(1, start_um, index_switch=side)
        world.write(**bench)
        world.run(0.1)
        fault = world.index_faulted()
        assert not world.permit
        assert "indexed" not in world.flags
        before = world.value("steps")
        world.run(1.0)
        assert world.value("steps") == before
        # Repaired, it works again.
        world.write(**dict.fromkeys(bench, 0))
        world.run(0.1)
        assert world.index().permit
        return fault

    overtravel = Fault[f"OVERTRAVEL_{this.upper()}"]
    assert broken(bench_stall=1) == Fault.INDEX_NO_SWITCH
    assert broken(bench_direction_reversed=1) == Fault.INDEX_WRONG_SWITCH
    assert broken(**{f"bench_switch_{this}_fault": SwitchFault.STUCK_RELEASED}) == overtravel
    assert broken(**{f"bench_switch_{other}_fault": SwitchFault.STUCK_RELEASED}) == Fault.INDEX_SPAN
    for stuck in (this, other):
        assert broken(**{f"bench_switch_{stuck}_fault": SwitchFault.STUCK_ACTUATED}) in (
            Fault.BOTH_SWITCHES_ACTIVE,
            Fault.BACK_OFF_NO_RELEASE,
        )


@pytest.mark.parametrize("start_um", [78_600, -78_600, 85_900, -85_900, 88_000, -88_000])
@pytest.mark.parametrize("fault", ["bench_stall", "bench_direction_reversed"])
def test_backing_off_gives_up_when_the_switch_does_not_release(start_um: int, fault: str):
    world = World(1, start_um)
    world.write(**{fault: 1})
    assert world.index_faulted() == Fault.BACK_OFF_NO_RELEASE


@pytest.mark.parametrize("side", list(Side), ids=lambda s: s.label)
@pytest.mark.parametrize("off_um", [3000, -3000])
def test_span_error(side: Side, off_um: int):
    """The other switch is 3 mm from where it was calibrated."""
    name, true_um = (
        ("switch_minus_um", -SWITCH_UM) if side == Side.PLUS else ("switch_plus_um", SWITCH_UM)
    )
    room = {"reversal_plus_um": 82_000, "reversal_minus_um": -82_000}
    room |= {"flange_plus_um": 84_600, "flange_minus_um": -84_600}
    world = World(1, 0, index_switch=side, **room, **{name: true_um + off_um})
    assert world.index_faulted() == Fault.INDEX_SPAN
    found_um = world.value("span_error_um")
    assert abs(found_um) > 1000
    assert (found_um > 0) == (off_um < 0)

    # Within the tolerance it passes, and tells how far off it is.
    world = World(1, 0, index_switch=side, **{name: true_um + off_um // 6})
    world.index()
    assert world.value("span_error_um") == pytest.approx(-off_um // 6, abs=150)


def test_index_needs_a_drum_at_rest():
    world = World()
    world.drum(3000)
    world.run(0.5)
    with pytest.raises(Exception, match="drum_moving"):
        world.command(Command.INDEX)
    world.stop_drum()
    world.index()
