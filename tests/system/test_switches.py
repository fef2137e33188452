# SPDX-License-Identifier: Apache-2.0
"""Limit switches that bounce, and limit switches with broken wires."""

import pytest
from levelwind.map_table import Fault, LaunchInhibit, Side, State, SwitchContacts, SwitchFault
from world import World

SIDES = ("plus", "minus")
SWITCH_UM = 78_400
NOTICED_S = 0.1
BAD_AT_ONCE = (SwitchFault.NC_WIRE_BROKEN, SwitchFault.SHORTED)  # seen with the switch released


def indexed(seed: int, bounce_ms: int) -> tuple[float, int]:
    """Where an indexing leaves the carriage, and the span that it has found."""
    world = World(seed, carriage_um=137 * seed)  # another phase between steps and ticks
    world.write(bench_bounce_ms=bounce_ms)
    world.index().run(0.3)
    return world.truth.carriage_usteps - world.value("position_usteps"), world.value(
        "span_error_um"
    )


@pytest.mark.parametrize("seed", range(1, 6))
def test_bounce_does_not_move_the_position_of_the_first_closure(seed: int):
    assert indexed(seed, bounce_ms=10) == pytest.approx(indexed(seed, bounce_ms=0), abs=0.2)


@pytest.mark.parametrize("edges_per_s", [500, 5_000, 40_000])
@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_bounce_gives_one_event_per_passage(edges_per_s: int, drum: int):
    world = World()
    world.write(bench_bounce_ms=10)
    world.index()
    if edges_per_s < 5000:  # a slow drum: bring the carriage near the switch first
        world.drum(drum * 40_000)
        world.run_until(lambda: abs(world.value("position_um")) < 70_000)
        world.run_until(lambda: abs(world.value("position_um")) > 76_000)
    world.drum(drum * edges_per_s, edges_per_s2=1e6)
    orders, passages = [], {side: world.value(f"switch_{side}_triggers") for side in SIDES}
    # Real passages outward, seen from behind the contacts.
    outside = {"plus": False, "minus": False}
    deadline_s = 10.0 if edges_per_s >= 5000 else 20.0
    for _ in range(round(deadline_s / 0.001)):
        world.run(0.001)
        um = world.truth.carriage_um
        for side, sign in (("plus", 1), ("minus", -1)):
            if sign * um > SWITCH_UM + 400 and not outside[side]:
                outside[side] = True
                orders.append(side)
            elif sign * um < SWITCH_UM - 1500:
                outside[side] = False
    assert orders
    started_outside = orders[0] == "minus" and edges_per_s >= 5000  # parked at the minus flange
    for side in SIDES:
        real = orders.count(side) - (1 if started_outside and side == "minus" else 0)
        assert world.value(f"switch_{side}_triggers") - passages[side] == real
    assert "los" not in world.flags
    assert world.permit


@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
@pytest.mark.parametrize("side", SIDES)
def test_a_trigger_while_the_carriage_moves_away_is_not_judged(side: str, drum: int):
    """The carriage's direction counts, not the drum's."""
    world = World().index()
    orbit = world.orbit()
    world.drum(drum * 20_000)
    away = -1 if side == "plus" else 1
    world.run_until(
        lambda: (
            world.truth.carriage_um_per_s * away > 50_000
            and abs(world.value("position_um")) < 5_000
        )
    )
    before = world.value(f"switch_{side}_triggers")
    world.write(**{f"bench_switch_{side}_fault": SwitchFault.STUCK_ACTUATED})
    world.run(0.05)
    assert world.value(f"switch_{side}_triggers") == before + 1
    assert "los" not in world.flags
    world.check_follows(orbit)
    world.write(**{f"bench_switch_{side}_fault": SwitchFault.NONE})
    world.run(5.0)
    assert world.permit
    world.check_follows(orbit)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("fault", BAD_AT_ONCE)
def test_wiring_at_rest_is_noticed_and_index_names_it(side: str, fault: SwitchFault):
    world = World()
    world.write(**{f"bench_switch_{side}_fault": fault})
    world.run_until(lambda: f"wiring_{side}" in world.flags, NOTICED_S)
    assert world.index_faulted() == Fault[f"WIRING_{side.upper()}"]
    assert not world.permit

    # Repaired: indexing clears it.
    world.write(**{f"bench_switch_{side}_fault": SwitchFault.NONE})
    world.run(0.1)
    assert world.index().permit


@pytest.mark.parametrize("side", SIDES)
def test_a_broken_no_wire_stops_indexing_where_the_switch_had_to_tell(side: str):
    world = World()
    world.write(**{f"bench_switch_{side}_fault": SwitchFault.NO_WIRE_BROKEN})
    assert world.index_faulted() == Fault[f"WIRING_{side.upper()}"]
    assert abs(world.truth.carriage_um) < SWITCH_UM + NOTICED_S * 41_700  # speed of indexing


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(
    "fault", [SwitchFault.NO_WIRE_BROKEN, SwitchFault.NC_WIRE_BROKEN, SwitchFault.SHORTED]
)
def test_wiring_in_a_launch_is_noticed_and_takes_the_permit(side: str, fault: SwitchFault):
    world = World().index()
    world.drum(10_000)
    world.run_until(lambda: abs(world.value("position_um")) < 50_000, step_s=0.01)
    assert world.permit
    world.write(**{f"bench_switch_{side}_fault": fault})
    if fault not in BAD_AT_ONCE:
        sign = 1 if side == "plus" else -1
        world.run_until(lambda: sign * world.truth.carriage_um > SWITCH_UM)
    world.run_until(lambda: f"wiring_{side}" in world.flags, NOTICED_S)
    assert not world.permit
    assert world.value("launch_inhibit") >> LaunchInhibit.WIRING & 1
    assert world.state == State.TRACKING  # a launch in progress goes on
    # It stays, though the contacts agree again.
    world.write(**{f"bench_switch_{side}_fault": SwitchFault.NONE})
    world.run(3.0)
    assert f"wiring_{side}" in world.flags


# ---- found by the fault campaign ----------------------------------------------------------------


@pytest.mark.parametrize("contacts", [SwitchContacts.SINGLE_NO, SwitchContacts.SINGLE_NC])
@pytest.mark.parametrize("index_switch", list(Side), ids=lambda s: s.label)
def test_a_single_contact_that_bounces_past_the_span_tolerance_is_no_fault(
    contacts: SwitchContacts, index_switch: Side
):
    """It closed in its place; only the debouncing took longer than the way to the tolerance."""
    world = World(
        switch_contacts=contacts, index_switch=index_switch, index_rate_edges_per_s=40_000
    )
    world.write(bench_bounce_ms=3)
    assert world.index().permit


@pytest.mark.parametrize("contacts", [SwitchContacts.SINGLE_NO, SwitchContacts.SINGLE_NC])
@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_a_single_contact_that_bounces_past_the_reversal_point_is_no_los(
    contacts: SwitchContacts, drum: int
):
    world = World(switch_contacts=contacts)
    world.write(bench_bounce_ms=10)
    world.index().drum(drum * 48_000)
    world.run(6.0)
    assert world.value("switch_plus_triggers") > 2
    assert "los" not in world.flags
    # It is one as soon as the switch does not close at all.
    world.write(bench_switch_plus_fault=SwitchFault.STUCK_RELEASED)
    world.run(2.0)
    assert "los1_plus" in world.flags


@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
@pytest.mark.parametrize("stuck", [False, True])
def test_a_reversal_trimmed_close_to_its_switch_waits_for_the_switch_tolerance(
    drum: int, stuck: bool
):
    """Its switch may trigger up to its tolerance late: not before is it missing."""
    world = World(index_rate_edges_per_s=40_000).index()
    world.drum(drum * 20_000)
    world.run(1.0)
    world.write(trim_plus_um=-1580, trim_minus_um=1580)
    if stuck:
        world.write(bench_switch_plus_fault=SwitchFault.STUCK_RELEASED)
    world.run(8.0)
    assert world.value("reversal_plus_usteps") == 7842
    assert world.value("switch_minus_triggers") > 2
    assert ("los1_plus" in world.flags) == stuck
    assert not world.flags & {"los1_minus", "los2_plus", "los2_minus"}


# ---- against the known position -----------------------------------------------------------------


@pytest.mark.parametrize("index_switch", list(Side), ids=lambda s: s.label)
def test_a_broken_wire_of_a_normally_closed_contact_takes_the_permit_at_rest(index_switch: Side):
    """Parked on one switch, the other reads as actuated: both cannot be."""
    world = World(switch_contacts=SwitchContacts.SINGLE_NC, index_switch=index_switch).index()
    assert world.permit
    world.write(**{f"bench_switch_{index_switch.label}_fault": SwitchFault.NC_WIRE_BROKEN})
    world.run_until(lambda: "switch_implausible" in world.flags, 0.1)
    assert world.value("launch_inhibit") == 1 << LaunchInhibit.SWITCH_IMPLAUSIBLE
    world.write(**{f"bench_switch_{index_switch.label}_fault": SwitchFault.NONE})
    world.run_until(lambda: world.permit, 0.1)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("fault", [SwitchFault.STUCK_ACTUATED, SwitchFault.STUCK_RELEASED])
def test_a_stuck_pair_takes_the_permit_before_the_drum_turns(side: str, fault: SwitchFault):
    world = World().index()  # parked on the minus switch
    world.write(**{f"bench_switch_{side}_fault": fault})
    world.run(0.1)
    wrong = (side == "plus") == (fault == SwitchFault.STUCK_ACTUATED)
    assert world.permit != wrong
    assert ("switch_implausible" in world.flags) == wrong


def test_a_single_contact_that_bounces_for_long_stops_the_indexing():
    world = World(switch_contacts=SwitchContacts.SINGLE_NC)
    world.write(bench_bounce_ms=100)
    assert world.index_faulted() in (Fault.WIRING_PLUS, Fault.WIRING_MINUS)
    assert abs(world.truth.carriage_um) < 82_000
