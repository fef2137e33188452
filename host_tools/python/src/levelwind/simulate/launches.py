# SPDX-License-Identifier: Apache-2.0
"""Playing a drum speed profile on the simulated plant of a bench."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from levelwind.errors import ToolError
from levelwind.files.profiles import MOTOR_PER_ENCODER, Gearing, Profile
from levelwind.line.device import Device
from levelwind.line.live import all_flags, read_live
from levelwind.line.parameter_sets import read_set
from levelwind.line.plant import write_plant
from levelwind.line.points import encode, enum_label, flag_names
from levelwind.map_table import POINTS, BenchCommand, Fault, Flag, State

POINTS_PER_APPEND = POINTS["bench_profile"].count // 2
POLL_S = 0.05
LOOK = (Flag.LOS, Flag.ROPE_LAID_STANDING)


@dataclass
class Launch:
    """What a launch did, as seen over Modbus."""

    begin: dict[str, int]
    end: dict[str, int] = field(default_factory=dict)
    plant_time_s: float = 0.0
    real_time_s: float = 0.0
    polls: int = 0
    max_rope_speed_mm_per_s: int = 0
    min_rope_speed_mm_per_s: int = 0
    permit: str = "kept"
    requests: int = 0
    worst_latency_s: float = 0.0

    def gained(self, name: str) -> int:
        """How much a counter has changed."""
        return self.end[name] - self.begin[name]

    @property
    def wrong(self) -> list[str]:
        """What an operator would have had to see: why it was no launch in order."""
        end = self.end
        wrong = []
        if self.permit != "kept":
            wrong.append(f"launch permit {self.permit}")
        if end["state"] != State.TRACKING:
            wrong.append(f"the carriage does not follow the drum, state {state_words(end)}")
        wrong += [bit.text for bit in LOOK if all_flags(end) >> bit & 1]
        return wrong

    def summary(self) -> dict[str, object]:
        """For tables and JSON."""
        return {
            "state": enum_label(State, self.end["state"]),
            "flags": flag_names(all_flags(self.end)),
            "launch_permit": self.permit,
            "net_edges": self.gained("net_edges"),
            "pattern_edges": self.gained("pattern_edges"),
            "step_pulses": self.gained("steps"),
            "illegal_transitions": self.gained("illegal_transitions"),
            "los_recoveries": self.end["los_recoveries"],
            "rope_m": self.gained("rope_mm") / 1000,
            "max_rope_speed_m_per_s": self.max_rope_speed_mm_per_s / 1000,
            "min_rope_speed_m_per_s": self.min_rope_speed_mm_per_s / 1000,
            "simulated_s": round(self.plant_time_s, 3),
            "real_s": round(self.real_time_s, 3),
            "status_polls": self.polls,
            "requests": self.requests,
            "worst_latency_s": round(self.worst_latency_s, 4),
        }


def state_words(live: Mapping[str, int]) -> str:
    """The state, and the fault if there is one."""
    state = enum_label(State, live["state"])
    return f"{state} ({enum_label(Fault, live['fault'])})" if live["fault"] else state


def read_gearing(device: Device, motor_per_encoder: float = MOTOR_PER_ENCODER) -> Gearing:
    """Conversions by the controller's active parameters."""
    names = ("rope_per_drum_rev_um", "encoder_ratio_numerator", "encoder_ratio_denominator")
    active = read_set(device, "active", [POINTS[name] for name in names])
    return Gearing(
        active["rope_per_drum_rev_um"],
        device.value("edges_per_1000_drum_revs"),
        active["encoder_ratio_numerator"] / active["encoder_ratio_denominator"],
        motor_per_encoder,
    )


def upload(device: Device, profile: Profile) -> None:
    """Send the points of a profile."""
    window = POINTS["bench_profile"]
    write_plant(device, {"bench_command": BenchCommand.PROFILE_CLEAR})
    for at in range(0, len(profile), POINTS_PER_APPEND):
        points = profile[at : at + POINTS_PER_APPEND]
        numbers = [number for point in points for number in point]
        device.write_registers(
            window.address,
            [w for n in numbers for w in encode(window, n)],
            window.name,
            "`levelwind get bench_profile_points` shows how many are held.",
        )
        write_plant(
            device,
            {"bench_command": BenchCommand.PROFILE_APPEND, "bench_argument": len(points)},
        )
    held = device.value("bench_profile_points")
    if held != len(profile):
        raise ToolError(f"The simulator holds {held} of the profile's {len(profile)} points.")


def play(device: Device, profile: Profile, progress: Callable[[float], None]) -> Launch:
    """Play an uploaded profile to its end; the drum stops however this ends."""
    counters = ("steps", "illegal_transitions")
    launch = Launch(read_live(device) | device.read_names(*counters))
    began = time.monotonic()
    plant_began_ms = device.value("bench_time_ms")
    duration_s = profile[-1][0] / 1000
    permit = 1 << Flag.LAUNCH_PERMIT
    if not launch.begin["flags"] & permit:
        launch.permit = "never given"
    try:
        write_plant(device, {"bench_command": BenchCommand.PROFILE_START})
        running = True
        while running:
            time.sleep(POLL_S)
            bench = device.read_names("bench_profile_running", "bench_time_ms")
            live = read_live(device)
            running = bool(bench["bench_profile_running"])
            speed = live["rope_speed_mm_per_s"]
            launch.polls += 1
            launch.max_rope_speed_mm_per_s = max(launch.max_rope_speed_mm_per_s, speed)
            launch.min_rope_speed_mm_per_s = min(launch.min_rope_speed_mm_per_s, speed)
            if launch.permit == "kept" and not live["flags"] & permit:
                launch.permit = "lost"
            launch.plant_time_s = (bench["bench_time_ms"] - plant_began_ms) / 1000
            progress(min(1.0, launch.plant_time_s / duration_s))
    finally:
        device.write({"bench_drum_speed_millirpm": 0})
    wait_for_rest(device)
    launch.end = read_live(device) | device.read_names(*counters)
    launch.real_time_s = time.monotonic() - began
    launch.requests = device.requests
    launch.worst_latency_s = device.worst_latency_s
    return launch


def wait_for_rest(device: Device, limit_s: float = 30.0) -> None:
    """Wait until the controller sees the drum at rest."""
    deadline = time.monotonic() + limit_s
    while not device.value("drum_at_rest"):
        if time.monotonic() > deadline:
            raise ToolError(f"The drum did not come to rest within {limit_s:g} s.")
        time.sleep(POLL_S)
