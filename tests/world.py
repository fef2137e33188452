# SPDX-License-Identifier: Apache-2.0
"""A whole machine in this process: controller and plant on a virtual clock, no line between.

Everything goes the way that a master goes: as Modbus requests, by the names of the map. Only
`inject` and `truth` look behind the controller's pins.
"""

import ctypes
import functools
import struct
from collections.abc import Callable, Iterator, Mapping
from ctypes import (
    POINTER,
    c_bool,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_int64,
    c_size_t,
    c_uint8,
    c_uint64,
)
from enum import IntEnum
from typing import NamedTuple

from levelwind.core import layout, native
from levelwind.core.ideal_screw import Orbit, Screw
from levelwind.core.ideal_screw import State as LawState
from levelwind.line.points import encode, lookup, runs
from levelwind.map_table import POINTS, Command, Fault, Flag, Mode, Reason, Result, State

PDU_MAX = 253
FRAME_MAX = 256
REGISTERS_MAX = 120
USTEP = 65536

MILLIRPM_PER_EDGE_PER_S = 60_000 / 2880
"""Drum speed by the default parameters: 360 pulses, 2 edges, 4 encoder revolutions per drum's."""


class PlantFault(IntEnum):
    """enum lw_plant_fault."""

    STALL_MS = 0
    SLIP_USTEPS = 1
    SIDE_LOAD_MM_PER_S2 = 2
    BOUNCE_US = 3
    LIMIT_PLUS = 4  # SwitchFault
    LIMIT_MINUS = 5
    OVERTRAVEL_PLUS = 6  # SwitchFault
    OVERTRAVEL_MINUS = 7
    ENCODER_LOSE_PULSES = 8
    ENCODER_ILLEGAL = 9
    ENCODER_DITHER = 10
    PLACE_CARRIAGE_UM = 11
    CARRIAGE_REVERSED = 12
    ENCODER_EXTRA_PULSES = 13
    STEPPER_ALARM = 14
    ENCODER_A = 15  # ChannelFault
    ENCODER_B = 16
    ENCODER_INDEX = 17
    BLIP_PLUS_US = 18
    BLIP_MINUS_US = 19
    TRIM_EARLY = 20
    TRIM_LATE = 21
    SWITCH_LATE_US = 22


class Truth(ctypes.Structure):
    """struct lw_plant_truth: what is really the case."""

    _fields_ = (
        ("time_ns", c_uint64),
        ("drum_transitions", c_int64),
        ("drum_milli_rpm", c_double),
        ("carriage_um", c_double),
        ("carriage_usteps", c_double),
        ("carriage_um_per_s", c_double),
        ("commanded_usteps", c_int64),
        ("lag_usteps", c_double),
        ("step_pulses", c_uint64),
        ("slipped_usteps", c_int64),
        ("pole_slips", c_uint64),
        ("in_sync", c_bool),
        ("coupling_slip_um", c_double),
        ("limit_um", c_double * 2),
        ("rope_um", c_double),
    )


class RequestRefusedError(Exception):
    """The controller answered a Modbus exception."""

    def __init__(self, exception: int, reason: Reason) -> None:
        super().__init__(f"Modbus exception {exception:02d}, {reason.label}")
        self.exception = exception
        self.reason = reason


@functools.cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(native.find(native.LIBRARY)))
    layout.check(
        library,
        "lw_layout_native",
        {"struct lw_plant_truth": Truth, "enum lw_plant_fault": PlantFault},
    )
    world = ctypes.c_void_p
    for name, result, arguments in (
        ("create", world, (c_uint64, POINTER(c_char_p), POINTER(c_double), c_size_t)),
        ("destroy", None, (world,)),
        ("run_ns", None, (world, c_uint64)),
        ("request", c_size_t, (world, ctypes.c_char_p, c_size_t, POINTER(c_uint8))),
        ("line", c_size_t, (world, ctypes.c_char_p, c_size_t, c_uint64, POINTER(c_uint8))),
        ("inject", c_int, (world, c_int, c_int32)),
        ("truth", None, (world, POINTER(Truth))),
    ):
        function = getattr(library, f"lw_native_world_{name}")
        function.restype, function.argtypes = result, arguments
    return library


class Slice(NamedTuple):
    """Where a value stands in an answer."""

    name: str
    begin: int
    end: int
    signed: bool


@functools.cache
def _plan(names: tuple[str, ...]) -> list[tuple[bytes, list[Slice]]]:
    """The requests that read these registers, and where in their answers the values stand."""
    points = [lookup(name) for name in names]
    plan = []
    for space, function in (("holding", 3), ("input", 4)):
        for run in runs((p for p in points if p.space == space), REGISTERS_MAX):
            slices = []
            for point in run.points:
                at = 2 + 2 * (point.address - run.address)
                signed = point.type.startswith("i")
                slices.append(Slice(point.name, at, at + 2 * point.words, signed))
            plan.append((struct.pack(">BHH", function, run.address, run.count), slices))
    return plan


def write_requests(values: Mapping[str, int]) -> Iterator[bytes]:
    """The Modbus requests that write holding registers by name."""
    for run in runs((POINTS[name] for name in values), REGISTERS_MAX):
        words = [word for point in run.points for word in encode(point, values[point.name])]
        head = struct.pack(">BHHB", 16, run.address, run.count, 2 * run.count)
        yield head + struct.pack(f">{run.count}H", *words)


class World:
    """A machine that has just been switched on."""

    def __init__(
        self,
        seed: int = 1,
        carriage_um: int = 0,
        machine: Mapping[str, float] | None = None,
        **parameters: int,
    ) -> None:
        """`machine`: figures of a machine file that differ from the default's."""
        self._library = _library()
        figures = {"start_mm": carriage_um / 1000, **(machine or {})}
        names = (c_char_p * len(figures))(*(name.encode() for name in figures))
        values = (c_double * len(figures))(*figures.values())
        self._world = self._library.lw_native_world_create(seed, names, values, len(figures))
        assert self._world, f"no machine with {figures}"
        self._answer = (c_uint8 * PDU_MAX)()
        self.run(0.3)  # the drum counts as at rest after rest_time_ms
        if parameters:
            self.apply(**parameters)

    def __del__(self) -> None:
        if getattr(self, "_world", None):
            self._library.lw_native_world_destroy(self._world)

    # ---- time ----------------------------------------------------------------------------------

    def run(self, seconds: float) -> None:
        """Let virtual time pass."""
        self._library.lw_native_world_run_ns(self._world, round(seconds * 1e9))

    def run_until(
        self, condition: Callable[[], bool], limit_s: float = 30.0, step_s: float = 0.001
    ) -> float:
        """Run until a condition holds, looking at it every step; how long it took."""
        for step in range(round(limit_s / step_s)):
            if condition():
                return step * step_s
            self.run(step_s)
        raise AssertionError(f"not within {limit_s:g} s; {self}")

    # ---- Modbus --------------------------------------------------------------------------------

    def request(self, pdu: bytes) -> bytes:
        """One Modbus request, function code and data, and its answer."""
        length = self._library.lw_native_world_request(self._world, pdu, len(pdu), self._answer)
        return bytes(self._answer[:length])

    def line(self, frame: bytes, seconds: float) -> bytes:
        """Bytes on the line, then time; what the slave has sent in it."""
        answer = (c_uint8 * FRAME_MAX)()
        length = self._library.lw_native_world_line(
            self._world, frame, len(frame), round(seconds * 1e9), answer
        )
        return bytes(answer[:length])

    def _checked(self, pdu: bytes) -> bytes:
        answer = self.request(pdu)
        if answer[0] & 0x80:
            raise RequestRefusedError(answer[1], Reason(self.value("last_error_reason")))
        return answer

    def read(self, *names: str) -> dict[str, int]:
        """Registers by name ("active.pitch_um" for a copy). Neighbours come as one snapshot."""
        values = {}
        for pdu, slices in _plan(names):
            answer = self._checked(pdu)
            for name, begin, end, signed in slices:
                values[name] = int.from_bytes(answer[begin:end], "big", signed=signed)
        return values

    def value(self, name: str) -> int:
        """One register."""
        return self.read(name)[name]

    def write(self, **values: int) -> None:
        """Write holding registers by name; raises RequestRefusedError."""
        for pdu in write_requests(values):
            self._checked(pdu)

    # ---- the controller ------------------------------------------------------------------------

    @property
    def state(self) -> State:
        """What the controller is doing."""
        return State(self.value("state"))

    @property
    def fault(self) -> Fault:
        """Why it stopped."""
        return Fault(self.value("fault"))

    @property
    def flags(self) -> set[str]:
        """Names of the flags that are set."""
        bits = self.value("flags") | self.value("flags_2") << 32
        return {flag.label for flag in Flag if bits >> flag & 1}

    @property
    def permit(self) -> bool:
        """Launch permit."""
        return "launch_permit" in self.flags

    def command(self, command: Command, limit_s: float = 60.0) -> Result:
        """Give a command and wait for its end; RequestRefusedError if it is not taken at all."""
        self.write(command=command)
        self.run_until(lambda: self.value("command_result") != Result.IN_PROGRESS, limit_s, 0.01)
        return Result(self.value("command_result"))

    def apply(self, **parameters: int) -> None:
        """Change parameters."""
        self.write(**parameters)
        self.command(Command.APPLY)
        reason = Reason(self.value("command_reason"))
        assert self.value("command_result") == Result.DONE, reason.label

    def index(self) -> "World":
        """Index, and hand over to the drum as far as the mode asks for it."""
        assert self.command(Command.INDEX) == Result.DONE, f"{self}"
        self.run(0.01)
        return self

    def index_faulted(self) -> Fault:
        """Index a broken machine; the fault that it ends with."""
        assert self.command(Command.INDEX) == Result.FAILED, f"{self}"
        assert self.state == State.FAULT
        return self.fault

    def mode(self, mode: Mode) -> None:
        """Ask for a mode."""
        self.write(mode=mode)

    # ---- the machine ---------------------------------------------------------------------------

    def drum(self, edges_per_s: float, edges_per_s2: float = 24_000.0) -> None:
        """Let the drum go to a speed, hauling in where positive."""
        self.write(
            bench_drum_acceleration_millirpm_per_s=round(edges_per_s2 * MILLIRPM_PER_EDGE_PER_S),
            bench_drum_speed_millirpm=round(edges_per_s * MILLIRPM_PER_EDGE_PER_S),
        )

    def stop_drum(self) -> None:
        """Stop the drum, and wait until the controller sees it at rest."""
        self.drum(0)
        self.run_until(lambda: "drum_at_rest" in self.flags, step_s=0.01)

    def inject(self, fault: PlantFault, argument: int) -> None:
        """A fault of the machine."""
        status = self._library.lw_native_world_inject(self._world, fault, argument)
        assert status == 0, f"{fault.name} {argument}: errno {-status}"

    @property
    def truth(self) -> Truth:
        """What is really the case."""
        truth = Truth()
        self._library.lw_native_world_truth(self._world, ctypes.byref(truth))
        return truth

    @property
    def error_usteps(self) -> float:
        """Real position minus the position that the controller believes in."""
        return self.truth.carriage_usteps - self.value("m") / USTEP

    # ---- the pattern ---------------------------------------------------------------------------

    def orbit(self) -> Orbit:
        """The ideal reversing screw from here on: from a hand-over, by pattern_edges."""
        at = self.read("m", "u", "ka", "nr", "reversal_plus_usteps", "reversal_minus_usteps")
        at |= self.read("dwell_plus_edges", "dwell_minus_edges", "pattern_edges")
        at |= self.read("breaker_edges", "active.breaker_cycles")
        at |= self.read("breaker_cycle_plus", "breaker_cycle_minus")
        assert at["pattern_edges"] == 0
        screw = Screw(
            at["ka"],
            at["nr"],
            at["reversal_plus_usteps"],
            at["reversal_minus_usteps"],
            at["dwell_plus_edges"],
            at["dwell_minus_edges"],
            at["breaker_edges"],
            at["active.breaker_cycles"],
        )
        cycles = (at["breaker_cycle_plus"], at["breaker_cycle_minus"])
        return screw.orbit(LawState(at["m"], at["u"], 0, *cycles))

    def check_follows(self, orbit: Orbit) -> None:
        """The controller is where the ideal screw is, to the last bit."""
        at = self.read("m", "u", "pattern_edges")
        ideal = orbit.after(at["pattern_edges"])
        assert (at["m"], at["u"]) == (ideal.m, ideal.u), f"after {at['pattern_edges']} edges"

    def in_sweep(self) -> bool:
        """The position lies between the reversal points."""
        at = self.read("position_usteps", "reversal_plus_usteps", "reversal_minus_usteps")
        return at["reversal_minus_usteps"] < at["position_usteps"] < at["reversal_plus_usteps"]

    def __str__(self) -> str:
        return (
            f"{self.state.label}, fault {self.fault.label}, "
            f"{Reason(self.value('command_reason')).label}, {sorted(self.flags)}, "
            f"at {self.value('position_um')} um, really {self.truth.carriage_um:.0f} um"
        )
