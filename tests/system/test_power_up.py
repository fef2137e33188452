# SPDX-License-Identifier: Apache-2.0
"""Every state of every input at power-up: nothing moves, nothing is permitted, indexing tells."""

import itertools

import pytest
from levelwind.map_table import (
    BenchCommand,
    Command,
    Fault,
    Result,
    State,
    SwitchContacts,
    SwitchFault,
)
from world import World

# Levels of a limit switch's pins, NO closed and NC closed, and what makes the plant show them.
CONTACTS = {
    (False, True): SwitchFault.NONE,
    (True, False): SwitchFault.STUCK_ACTUATED,
    (False, False): SwitchFault.NC_WIRE_BROKEN,
    (True, True): SwitchFault.SHORTED,
}
OVERTRAVELS = list(itertools.product((False, True), repeat=2))
TRANSITIONS_PER_PULSE = 4
OVERTRAVEL_UM = 86_000


def power_up(
    wiring: SwitchContacts,
    contacts: tuple[tuple[bool, bool], tuple[bool, bool]],
    overtravel: tuple[bool, bool],
    encoder_phase: int,
) -> World:
    """A machine that is switched on with these levels at its inputs, and half a second later."""
    world = World(switch_contacts=wiring, index_rate_edges_per_s=40_000)
    assert world.command(Command.SAVE) == Result.DONE
    world.drum(20, edges_per_s2=1e6)
    world.run_until(lambda: world.truth.drum_transitions % TRANSITIONS_PER_PULSE == encoder_phase)
    world.drum(0, edges_per_s2=1e6)
    world.write(
        bench_switch_plus_fault=CONTACTS[contacts[0]],
        bench_switch_minus_fault=CONTACTS[contacts[1]],
        bench_overtravel_plus=overtravel[0],
        bench_overtravel_minus=overtravel[1],
    )
    world.run(0.3)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)
    return world


def actuated(wiring: SwitchContacts, no_closed: bool, nc_closed: bool) -> bool:
    """What the contacts say when the power comes."""
    if wiring == SwitchContacts.SINGLE_NO:
        return no_closed
    if wiring == SwitchContacts.SINGLE_NC:
        return not nc_closed
    return no_closed and not nc_closed


def check_standing(
    world: World,
    wiring: SwitchContacts,
    contacts: tuple[tuple[bool, bool], tuple[bool, bool]],
    overtravel: tuple[bool, bool],
) -> None:
    """Nothing has moved, nothing is permitted, and the flags say what the inputs say."""
    flags = world.flags
    assert world.value("steps") == 0
    assert world.value("net_edges") == 0
    assert world.value("illegal_transitions") == 0
    assert flags.isdisjoint({"indexed", "tracking", "launch_permit", "moving", "los"})
    assert "drum_at_rest" in flags
    for side, (no_closed, nc_closed), beyond in zip(
        ("plus", "minus"), contacts, overtravel, strict=True
    ):
        contradict = wiring == SwitchContacts.NO_NC_PAIR and no_closed == nc_closed
        assert (f"wiring_{side}" in flags) == contradict
        assert (f"switch_{side}" in flags) == actuated(wiring, no_closed, nc_closed)
        assert (f"overtravel_{side}" in flags) == beyond
    if any(overtravel):
        assert world.state == State.FAULT
        assert world.fault == (Fault.OVERTRAVEL_PLUS if overtravel[0] else Fault.OVERTRAVEL_MINUS)
    else:
        assert (world.state, world.fault) == (State.UNINDEXED, Fault.NONE)


def expected_faults(
    wiring: SwitchContacts,
    contacts: tuple[tuple[bool, bool], tuple[bool, bool]],
    overtravel: tuple[bool, bool],
) -> set[Fault]:
    """How an indexing may end; empty: it succeeds."""
    if wiring == SwitchContacts.NO_NC_PAIR:
        for fault, (no_closed, nc_closed) in zip(
            (Fault.WIRING_PLUS, Fault.WIRING_MINUS), contacts, strict=True
        ):
            if no_closed == nc_closed:
                return {fault}
    limits = [actuated(wiring, *contacts[side]) for side in (0, 1)]
    active = [limits[side] or overtravel[side] for side in (0, 1)]
    # An overtravel switch without its limit switch: most likely its wire is broken.
    alone = [overtravel[side] and not limits[side] for side in (0, 1)]
    named = Fault.OVERTRAVEL_PLUS if alone[0] else Fault.OVERTRAVEL_MINUS
    if all(active):
        return {named if alone[0] != alone[1] else Fault.BOTH_SWITCHES_ACTIVE}
    # A normally closed contact that is shorted never opens: the carriage runs past its switch.
    blind = wiring == SwitchContacts.SINGLE_NC and (True, True) in contacts
    past = {Fault.INDEX_SPAN, Fault.OVERTRAVEL_PLUS, Fault.OVERTRAVEL_MINUS} if blind else set()
    if any(alone):
        return {named} | past
    if any(active):  # it stays so however far the carriage backs off
        return {Fault.BOTH_SWITCHES_ACTIVE, Fault.BACK_OFF_NO_RELEASE} | past
    return past


CASES = list(itertools.product(CONTACTS, CONTACTS, OVERTRAVELS))


@pytest.mark.parametrize("wiring", list(SwitchContacts), ids=lambda w: w.label)
@pytest.mark.parametrize("encoder_phase", range(TRANSITIONS_PER_PULSE))
def test_every_input_at_power_up(wiring: SwitchContacts, encoder_phase: int):
    for number, (plus, minus, overtravel) in enumerate(CASES):
        if (number // len(OVERTRAVELS) + number) % TRANSITIONS_PER_PULSE != encoder_phase:
            continue  # each of the 64 with one of the encoder's four, in turn
        world = power_up(wiring, (plus, minus), overtravel, encoder_phase)
        check_standing(world, wiring, (plus, minus), overtravel)
        faults = expected_faults(wiring, (plus, minus), overtravel)
        result = world.command(Command.INDEX)
        if result == Result.DONE:
            world.run(0.01)
            assert not faults, f"{plus} {minus} {overtravel}: {world}"
            assert world.permit
        else:
            assert result == Result.FAILED
            assert world.fault in faults, f"{plus} {minus} {overtravel}: {world}"
            assert not world.permit
        if not faults & {Fault.OVERTRAVEL_PLUS, Fault.OVERTRAVEL_MINUS}:
            assert abs(world.truth.carriage_um) < OVERTRAVEL_UM
        steps = world.value("steps")
        world.run(0.5)
        assert world.value("steps") == steps


@pytest.mark.parametrize("carriage_um", range(-89_000, 89_001, 8_900))
def test_every_place_at_power_up(carriage_um: int):
    """Also beyond a switch, or an overtravel switch: index brings it back by itself."""
    world = World(carriage_um=carriage_um)
    beyond = abs(carriage_um) >= OVERTRAVEL_UM
    assert world.state == (State.FAULT if beyond else State.UNINDEXED)
    assert world.value("steps") == 0
    assert not world.permit
    assert world.index().permit
