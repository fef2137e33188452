# SPDX-License-Identifier: Apache-2.0
"""What a launch of the campaign does: the machine, the drum, the faults, all of it from one number.

A quarter of all seeds walk through a grid: one fault at a place, a direction and a speed. The
others are random mixes of up to four faults at random moments, also within the indexing.
"""

import itertools
import random
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

from levelwind.map_table import (
    BenchCommand,
    ChannelFault,
    Command,
    Mode,
    ParkAt,
    Side,
    State,
    SwitchFault,
)
from world import MILLIRPM_PER_EDGE_PER_S, PlantFault, write_requests

REACTION_MS = 2  # until the tick after a request
INDEX_LIMIT_MS = 40_000
STANDING = sum(
    1 << state
    for state in (
        *(State.UNINDEXED, State.READY, State.TRACKING, State.CENTRED, State.OFF, State.FAULT),
    )
)
ROCKS = 10_000  # 400 ms
HARDEST_EDGES_PER_S2 = 50_000  # overspeed_trip to rest in 1.2 s; the drum watch trusts no more
SMALL_PULSES = 8  # fewer microsteps at once than a rotor can be off its field


class ActionKind(IntEnum):
    """enum lw_action_kind."""

    NONE = 0
    WAIT_STATE = 1
    WAIT_POSITION = 2
    REQUEST = 3
    DRUM = 4
    INJECT = 5
    ARM = 6
    ECHO = 7
    BABBLE = 8
    MASTER = 9
    FLIP = 10


@dataclass
class Scenario:
    """One launch, as a list of actions."""

    seed: int
    faults: list[str] = field(default_factory=list)
    carriage_um: int = 0
    harmless: bool = False  # nothing in it disturbs the lay: no alarm may be given
    actions: list[tuple[int, int, int, int, int, int]] = field(default_factory=list)
    requests: bytearray = field(default_factory=bytearray)
    story: list[str] = field(default_factory=list)
    dithers: bool = False  # armed, it may strike at any time
    _delay_ms: int = 0

    def _act(self, kind: ActionKind, *arguments: int) -> None:
        padded = (*arguments, 0, 0, 0, 0)[:4]
        self.actions.append((self._delay_ms, kind, *padded))
        self._delay_ms = 0

    def tell(self, text: str) -> None:
        """A line for whoever replays it."""
        self.story.append(f"+{self._delay_ms} ms: {text}")

    def run(self, milliseconds: int) -> None:
        """Let time pass."""
        self._delay_ms += milliseconds

    def until_standing(self) -> None:
        """Until an indexing, or another move, is over."""
        self.run(REACTION_MS)
        self._act(ActionKind.WAIT_STATE, STANDING, INDEX_LIMIT_MS)

    def until_position(self, position_um: int, direction: int, limit_ms: int = 10_000) -> None:
        """Until the carriage really passes a place."""
        self.tell(f"until the carriage passes {position_um} um, direction {direction:+d}")
        self._act(ActionKind.WAIT_POSITION, position_um, direction, limit_ms)

    def write(self, **values: int) -> None:
        """Write registers; a refusal is an answer like any other."""
        self.tell("write " + ", ".join(f"{name}={int(value)}" for name, value in values.items()))
        for pdu in write_requests(values):
            self._act(ActionKind.REQUEST, len(self.requests), len(pdu))
            self.requests += pdu
        self.run(REACTION_MS)

    def request(self, pdu: bytes) -> None:
        """A request of any bytes."""
        self.tell(f"request {pdu.hex(' ')}")
        self._act(ActionKind.REQUEST, len(self.requests), len(pdu))
        self.requests += pdu

    def drum(self, edges_per_s: float, edges_per_s2: float = 24_000.0) -> None:
        """Let the drum go to a speed, in edges per second of the factory decoding."""
        self.tell(f"drum to {edges_per_s:.0f} edges/s at {edges_per_s2:.0f} edges/s^2")
        if self.dithers and edges_per_s2 > HARDEST_EDGES_PER_S2:
            self.harmless = False
        self._act(
            ActionKind.DRUM,
            round(edges_per_s * MILLIRPM_PER_EDGE_PER_S),
            round(edges_per_s2 * MILLIRPM_PER_EDGE_PER_S),
        )

    def inject(self, fault: PlantFault, argument: int) -> None:
        """A fault of the machine, now."""
        self.tell(f"{fault.name.lower()} {int(argument)}")
        self._act(ActionKind.INJECT, fault, argument)

    def arm(self, position_um: int, direction: int, fault: PlantFault, argument: int) -> None:
        """A fault of the machine when the carriage passes a place."""
        self.tell(f"{fault.name.lower()} {argument} at {position_um} um, direction {direction:+d}")
        self._act(ActionKind.ARM, position_um, direction, fault, argument)

    def master(self, polls: bool) -> None:
        """The master begins or ceases to poll."""
        self.tell("the master polls" if polls else "the master is silent")
        self._act(ActionKind.MASTER, int(polls))

    def echo(self, on: bool) -> None:
        """The line begins or ceases to echo."""
        self.tell("the line echoes" if on else "the line does not echo")
        self._act(ActionKind.ECHO, int(on))

    def babble(self, milliseconds: int) -> None:
        """Another device leaves no silence."""
        self.tell(f"babble on the line for {milliseconds} ms")
        self._act(ActionKind.BABBLE, milliseconds)

    def flip(self, bit: int) -> None:
        """A bit of the controller's memory changes by itself."""
        self.tell(f"bit {bit} of the controller's memory is flipped")
        self._act(ActionKind.FLIP, bit)
        self.harmless = False

    def rest(self) -> None:
        """Stop the drum, until the controller sees it at rest."""
        self.drum(0, 48_000)
        self.run(2000)


@dataclass(frozen=True)
class Place:
    """Where and when a fault strikes."""

    position_um: int
    direction: int
    rng: random.Random


def _size(rng: random.Random, least: float, most: float) -> int:
    """A size, every order of magnitude as likely."""
    return round(least * (most / least) ** rng.random())


def stall(s: Scenario, at: Place) -> None:
    """The carriage is held."""
    s.arm(at.position_um, at.direction, PlantFault.STALL_MS, _size(at.rng, 5, 4000))
    s.harmless = False


def slip(s: Scenario, at: Place) -> None:
    """The stepper loses, or gains, steps."""
    usteps = at.rng.choice((-1, 1)) * _size(at.rng, 20, 4000)
    s.arm(at.position_um, at.direction, PlantFault.SLIP_USTEPS, usteps)
    s.harmless = False


def side_load(s: Scenario, at: Place) -> None:
    """The rope pulls the carriage."""
    s.until_position(at.position_um, at.direction)
    s.inject(PlantFault.SIDE_LOAD_MM_PER_S2, at.rng.choice((-1, 1)) * _size(at.rng, 5000, 60_000))
    s.run(_size(at.rng, 20, 2000))
    s.inject(PlantFault.SIDE_LOAD_MM_PER_S2, 0)
    s.harmless = False


def lost_edges(s: Scenario, at: Place) -> None:
    """The encoder swallows pulses."""
    pulses = _size(at.rng, 1, 1000)
    s.arm(at.position_um, at.direction, PlantFault.ENCODER_LOSE_PULSES, pulses)
    s.harmless &= pulses <= SMALL_PULSES


def extra_edges(s: Scenario, at: Place) -> None:
    """The encoder shows pulses that the drum has not made."""
    pulses = _size(at.rng, 1, 300)
    s.arm(at.position_um, at.direction, PlantFault.ENCODER_EXTRA_PULSES, pulses)
    s.harmless &= pulses <= SMALL_PULSES


def illegal_edges(s: Scenario, at: Place) -> None:
    """Both channels of the encoder change at once."""
    changes = _size(at.rng, 1, 1000)
    s.arm(at.position_um, at.direction, PlantFault.ENCODER_ILLEGAL, changes)
    s.harmless &= changes <= SMALL_PULSES


def dither(s: Scenario, at: Place) -> None:
    """The encoder rocks about an edge."""
    s.arm(at.position_um, at.direction, PlantFault.ENCODER_DITHER, _size(at.rng, 1, ROCKS))
    s.dithers = True


def rocking(s: Scenario, at: Place) -> None:
    """The drum stands, and rocks about one edge."""
    s.until_position(at.position_um, at.direction)
    s.rest()
    s.inject(PlantFault.ENCODER_DITHER, _size(at.rng, 100, ROCKS))
    s.run(600)
    s.drum(at.rng.choice((-1, 1)) * 20_000)


CHANNELS = (PlantFault.ENCODER_A, PlantFault.ENCODER_B)


def _mend(s: Scenario, at: Place, *channels: PlantFault) -> None:
    """A loose contact that comes back, or not."""
    if at.rng.random() < 0.5:
        s.run(_size(at.rng, 5, 3000))
        for channel in channels:
            s.inject(channel, ChannelFault.NONE)
    s.harmless = False


def dead_channel(s: Scenario, at: Place) -> None:
    """A channel of the encoder stands still."""
    s.until_position(at.position_um, at.direction)
    channel = at.rng.choice(CHANNELS)
    s.inject(channel, at.rng.choice((ChannelFault.STUCK_LOW, ChannelFault.STUCK_HIGH)))
    _mend(s, at, channel)


def loose_channel(s: Scenario, at: Place) -> None:
    """A channel of the encoder has a loose wire."""
    s.until_position(at.position_um, at.direction)
    channel = at.rng.choice(CHANNELS)
    s.inject(channel, ChannelFault.FLICKER)
    _mend(s, at, channel)


def dead_encoder(s: Scenario, at: Place) -> None:
    """Both channels stand still."""
    s.until_position(at.position_um, at.direction)
    for channel in CHANNELS:
        s.inject(channel, at.rng.choice((ChannelFault.STUCK_LOW, ChannelFault.STUCK_HIGH)))
    _mend(s, at, *CHANNELS)


def stopped_index(s: Scenario, at: Place) -> None:
    """STOP at any millisecond of an indexing; then it is done again."""
    s.rest()
    s.write(command=Command.INDEX)
    s.run(at.rng.randint(0, 9000))
    s.write(command=Command.STOP)
    s.run(at.rng.randint(0, 1500))
    s.write(mode=Mode.TRACK)
    s.run(100)
    s.until_standing()
    _index(s)
    s.drum(at.rng.choice((-1, 1)) * 20_000)


def bounce(s: Scenario, at: Place) -> None:
    """The limit switches bounce longer than usual."""
    s.inject(PlantFault.BOUNCE_US, _size(at.rng, 100, 10_000))


def _broken_switch(s: Scenario, at: Place, broken: SwitchFault) -> None:
    s.until_position(at.position_um, at.direction)
    switch = at.rng.choice((PlantFault.LIMIT_PLUS, PlantFault.LIMIT_MINUS))
    s.inject(switch, broken)
    if at.rng.random() < 0.3:  # a loose contact
        s.run(_size(at.rng, 5, 3000))
        s.inject(switch, SwitchFault.NONE)
    s.harmless = False


def stuck_switch(s: Scenario, at: Place) -> None:
    """A limit switch is stuck, released or actuated."""
    _broken_switch(s, at, at.rng.choice((SwitchFault.STUCK_RELEASED, SwitchFault.STUCK_ACTUATED)))


def broken_wire(s: Scenario, at: Place) -> None:
    """A wire of a limit switch is broken, or its wires are shorted."""
    broken = (SwitchFault.NO_WIRE_BROKEN, SwitchFault.NC_WIRE_BROKEN, SwitchFault.SHORTED)
    _broken_switch(s, at, at.rng.choice(broken))


def overtravel(s: Scenario, at: Place) -> None:
    """An overtravel switch actuates."""
    s.until_position(at.position_um, at.direction)
    switch = at.rng.choice((PlantFault.OVERTRAVEL_PLUS, PlantFault.OVERTRAVEL_MINUS))
    s.inject(switch, SwitchFault.STUCK_ACTUATED)
    s.run(_size(at.rng, 1, 2000))
    s.inject(switch, SwitchFault.NONE)
    s.harmless = False


def overtravel_blip(s: Scenario, at: Place) -> None:
    """An overtravel contact opens for less than a millisecond, again and again."""
    s.until_position(at.position_um, at.direction)
    switch = at.rng.choice((PlantFault.BLIP_PLUS_US, PlantFault.BLIP_MINUS_US))
    for _ in range(at.rng.randint(1, 20)):
        s.inject(switch, _size(at.rng, 20, 950))
        s.run(at.rng.randint(1, 30))
    s.harmless = False


def chatter(s: Scenario, at: Place) -> None:
    """A limit switch chatters long, as a worn single contact does."""
    s.inject(PlantFault.BOUNCE_US, _size(at.rng, 10_000, 300_000))
    s.harmless = False


def echo(s: Scenario, at: Place) -> None:
    """The line echoes: a transceiver that hears itself."""
    s.echo(True)
    s.run(_size(at.rng, 100, 3000))
    commands(s, at)
    # Requests whose answers are the same bytes.
    for pdu in (bytes((6, 0, 2, 0, 1)), bytes((6, 0, 2, 0, 0)), bytes((5, 0, 1, 0xFF, 0))):
        s.request(pdu)
        s.run(at.rng.randint(5, 500))
    s.write(mode=Mode.TRACK)
    s.echo(False)


def babble(s: Scenario, at: Place) -> None:
    """Another device leaves no silence on the line."""
    s.babble(_size(at.rng, 10, 3000))


def reversed_motor(s: Scenario, at: Place) -> None:
    """The motor turns the wrong way from here on."""
    s.until_position(at.position_um, at.direction)
    s.inject(PlantFault.CARRIAGE_REVERSED, 1)
    s.harmless = False


def power_cut(s: Scenario, at: Place) -> None:
    """The controller restarts; the drum turns on."""
    s.until_position(at.position_um, at.direction)
    s.write(bench_command=BenchCommand.POWER_CUT)
    s.harmless = False


def restart(s: Scenario, at: Place) -> None:
    """The watchdog restarts the controller in the launch; the master lets it take up the drum."""
    s.until_position(at.position_um, at.direction)
    s.write(bench_command=BenchCommand.RESTART)
    if at.rng.random() < 0.7:
        for _ in range(at.rng.randint(1, 3)):  # the first one may come too early
            s.run(at.rng.randint(0, 900))
            s.write(command=Command.REACQUIRE)
    s.harmless = False


def silent_master(s: Scenario, at: Place) -> None:
    """The master is not heard for a while."""
    s.master(False)
    s.run(_size(at.rng, 200, 3000))
    s.master(True)


def parameter_changes(s: Scenario, at: Place) -> None:
    """Writes of parameters and of commands about them, in the middle of a launch."""
    s.until_position(at.position_um, at.direction)
    for _ in range(at.rng.randint(1, 6)):
        name, value = at.rng.choice(
            (
                ("pitch_um", at.rng.randint(6000, 14_000)),
                ("reversal_plus_um", at.rng.randint(70_000, 82_000)),
                ("reversal_minus_um", -at.rng.randint(70_000, 82_000)),
                ("switch_plus_um", at.rng.randint(60_000, 80_000)),
                ("flange_plus_um", at.rng.randint(60_000, 100_000)),
                ("encoder_edges_per_pulse", at.rng.choice((1, 2, 4))),
                ("command", Command.APPLY),
                ("command", Command.SAVE),
                ("command", Command.REVERT),
                ("command", Command.FACTORY_ALL),
                ("command", Command.CLEAR_FAULT),
            )
        )
        s.write(**{name: value})
        s.run(at.rng.randint(0, 300))


def trim(s: Scenario, at: Place) -> None:
    """The operator shifts the reversal points."""
    s.until_position(at.position_um, at.direction)
    for _ in range(at.rng.randint(1, 3)):
        side = at.rng.choice(("plus", "minus"))
        s.write(**{f"trim_{side}_um": at.rng.randint(-1500, 1500)})
        s.run(at.rng.randint(0, 800))


def commands(s: Scenario, at: Place) -> None:
    """Commands at the wrong moment: stop, mode, index, jog."""
    s.until_position(at.position_um, at.direction)
    for _ in range(at.rng.randint(1, 3)):
        name, value = at.rng.choice(
            (
                ("command", Command.STOP),
                ("command", Command.INDEX),
                ("command", Command.REACQUIRE),
                ("command", Command.CLEAR_FAULT),
                ("mode", Mode.OFF),
                ("mode", Mode.CENTRE),
                ("mode", Mode.TRACK),
                ("jog", at.rng.choice((-1, 1))),
            )
        )
        s.write(**{name: value})
        s.run(at.rng.randint(0, 1500))
    s.write(mode=Mode.TRACK)
    s.harmless = False


def drum_reversal(s: Scenario, at: Place) -> None:
    """The drum turns back, and on again."""
    s.until_position(at.position_um, at.direction)
    acceleration = _size(at.rng, 20_000, 500_000)
    back = at.rng.choice((-1, 1)) * _size(at.rng, 500, 40_000)
    s.drum(back, acceleration)
    s.run(_size(at.rng, 5, 2000))
    s.drum(-back, acceleration)
    s.run(_size(at.rng, 5, 2000))


def overspeed(s: Scenario, at: Place) -> None:
    """The drum turns faster than the stepper can follow."""
    s.until_position(at.position_um, at.direction)
    s.drum(at.rng.choice((-1, 1)) * at.rng.randint(52_000, 70_000), 100_000)
    s.run(_size(at.rng, 100, 2000))
    s.drum(20_000, 100_000)
    s.harmless = False


FAULTS: dict[str, Callable[[Scenario, Place], None]] = {
    function.__name__: function
    for function in (
        *(stall, slip, side_load),
        *(lost_edges, extra_edges, illegal_edges, dither, rocking),
        *(dead_channel, loose_channel, dead_encoder, stopped_index),
        *(bounce, chatter, stuck_switch, broken_wire, overtravel, overtravel_blip, echo, babble),
        *(reversed_motor, power_cut, restart, silent_master, overspeed, drum_reversal),
        *(parameter_changes, trim, commands),
    )
}

SPEEDS_EDGES_PER_S = (-40_000, -8_000, 8_000, 20_000, 48_000)
POSITIONS_UM = (-81_000, -78_000, -60_000, 0, 60_000, 78_000, 81_000)
GRID = list(itertools.product(FAULTS, POSITIONS_UM, (1, -1), SPEEDS_EDGES_PER_S))
GRID_STRIDE = 547  # a prime: a few launches see all kinds, all launches all cells


def _machine(s: Scenario, rng: random.Random) -> None:
    """The machine and its parameters, as somebody may have built it."""
    s.run(300)  # the drum counts as at rest
    s.carriage_um = rng.choice((0, rng.randint(-89_000, 89_000)))
    s.harmless = abs(s.carriage_um) < 85_000  # else it begins with overtravel
    edges_per_pulse = rng.choice((2, 2, 2, 2, 2, 2, 2, 2, 1, 4))
    index_rate = rng.choice((5000, *12 * (20_000,))) * edges_per_pulse
    parameters = {
        "encoder_edges_per_pulse": edges_per_pulse,
        "overspeed_warning_edges_per_s": 26_000 * edges_per_pulse,
        "overspeed_trip_edges_per_s": 30_000 * edges_per_pulse,
        "index_rate_edges_per_s": min(index_rate, 50_000),
        "index_switch": rng.choice(list(Side)),
        "park_at": rng.choice(list(ParkAt)),
        "handover_direction": rng.choice(list(Side)),
        "switch_contacts": rng.choice((0, 0, 0, 1, 2)),
        "los_recoveries_max": rng.choice((0, 3, 3, 10)),
        "master_timeout_ms": rng.choice((0, 0, 1000)),
    }
    s.write(**parameters)
    s.write(command=Command.APPLY)
    if rng.random() < 0.5:  # an encoder without them
        s.inject(PlantFault.ENCODER_INDEX, 0)


def _index(s: Scenario) -> None:
    s.write(command=Command.INDEX)
    s.until_standing()
    s.run(20)


def _place(rng: random.Random) -> Place:
    position_um = rng.choice((rng.randint(-82_000, 82_000), rng.choice(POSITIONS_UM)))
    return Place(position_um, rng.choice((-1, 0, 1)), rng)


def _mixed_launch(s: Scenario, rng: random.Random) -> None:
    faults = rng.sample(sorted(FAULTS), rng.choice((1, 1, 2, 2, 3, 4)))
    early = rng.random() < 0.15
    s.faults = faults
    if early:  # the first one strikes while indexing
        s.write(command=Command.INDEX)
        s.run(_size(rng, 10, 5000))
        FAULTS[faults[0]](s, _place(rng))
        s.until_standing()
        s.run(20)
        s.harmless = False
    else:
        _index(s)
    s.drum(rng.choice((1, 1, 1, -1)) * rng.randint(2_000, 48_000), _size(rng, 10_000, 500_000))
    for fault in faults[1:] if early else faults:
        s.run(rng.randint(0, 2000))
        FAULTS[fault](s, _place(rng))
    s.run(rng.randint(500, 3000))
    # More than two traverses: time for a LOS to be told and made good.
    s.drum(rng.choice((1, 1, -1)) * rng.randint(25_000, 48_000), 50_000)
    s.run(4500)


def _grid_launch(s: Scenario, cell: int, rng: random.Random) -> None:
    fault, position_um, direction, speed = GRID[cell * GRID_STRIDE % len(GRID)]
    s.faults = [fault]
    _index(s)
    s.drum(speed, 48_000)
    s.run(1000)
    FAULTS[fault](s, Place(position_um, direction, rng))
    s.run(3000)
    s.drum(speed, 48_000)
    s.run(min(14_000, 200_000_000 // abs(speed)))


def scenario(seed: int) -> Scenario:
    """The launch of a seed."""
    rng = random.Random(seed)
    s = Scenario(seed)
    _machine(s, rng)
    if seed % 4 == 0:
        _grid_launch(s, seed // 4, rng)
    else:
        _mixed_launch(s, rng)
    if rng.random() < 0.2:  # repaired, and indexed again
        s.rest()
        for switch in (PlantFault.LIMIT_PLUS, PlantFault.LIMIT_MINUS):
            s.inject(switch, SwitchFault.NONE)
        s.inject(PlantFault.CARRIAGE_REVERSED, 0)
        s.inject(PlantFault.STALL_MS, 0)
        for channel in CHANNELS:
            s.inject(channel, ChannelFault.NONE)
        s.write(mode=Mode.TRACK)
        _index(s)
        s.write(command=Command.ACKNOWLEDGE_ROPE)
        s.drum(rng.choice((-1, 1)) * 20_000)
        s.run(3000)
    s.rest()
    return s


def flip_scenario(seed: int, bits: int, bit: int | None = None) -> tuple[Scenario, int]:
    """A sound launch in which one bit of the controller's memory is flipped; and which one."""
    rng = random.Random(seed)
    s = Scenario(seed, faults=["flip"])
    bit = rng.randrange(bits) if bit is None else bit
    s.run(300)
    s.write(encoder_watch_ms=500)
    s.write(command=Command.APPLY)
    _index(s)
    s.drum(rng.choice((1, 1, 1, -1)) * rng.randint(8_000, 48_000), 48_000)
    s.run(rng.randint(0, 3000))
    s.flip(bit)
    # More than two traverses, and as many after a rest.
    for speed in (48_000, 30_000):
        s.drum(speed, 48_000)
        s.run(5000)
        s.rest()
    return s, bit
