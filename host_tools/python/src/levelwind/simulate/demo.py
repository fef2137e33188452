# SPDX-License-Identifier: Apache-2.0
"""The demonstration: simulator, field setup, indexing, one launch, checks, a picture."""

import contextlib
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from rich.progress import Progress

from levelwind.core.ideal_screw import USTEP, Screw
from levelwind.errors import ToolError
from levelwind.files import profiles, script
from levelwind.line.device import Device
from levelwind.line.parameter_sets import read_set
from levelwind.line.port import Line
from levelwind.map_table import Flag
from levelwind.show.output import console, print_table
from levelwind.simulate import launches, picture, simulator, trace

# A time-out of the line, far above what the simulator needs.
LATENCY_LIMIT_S = 1.0
# The trace has a line per millisecond: at 26 edges per line the top of a reversal shows to this.
OVERSHOOT_TOLERANCE_UM = 5.0
DEVIATION_LIMIT_UM = 1000.0


@dataclass(frozen=True)
class Expectation:
    """One line of the result table."""

    text: str
    value: str
    held: bool | None = None  # None: only told, nothing expected


def run_demo(out: Path, speed: str, stay: bool) -> bool:
    """Run it all; True if every expectation held."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ToolError(f"--out {out}: no folder can be made there: {error.strerror}.") from error
    port = str((out / "levelwind-port").absolute())
    trace_path = out / "launch_trace.csv"
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="levelwind-") as folder:
        storage = Path(folder) / "parameters"
        line = simulator.arguments(port, speed=speed, storage=storage, trace=trace_path)
        with simulator.Simulator(line) as running, Device(Line(running.port)) as device:
            console.print(f"simulator   on {port}, speed {speed}")
            result, machine = launch(device)
        recording = trace.read(trace_path)
        tracked = recording.tracking()
        pattern = trace.judge(tracked, machine.screw)
        expectations = _judge(result, machine, tracked, pattern)
        expectations.append(Expectation("real time", f"{time.monotonic() - began:.1f} s"))
        picture.draw(recording, machine, out / "launch.png")
        report(expectations, out)
        if stay:
            _stay(port, storage)
    return all(expectation.held is not False for expectation in expectations)


def launch(device: Device) -> tuple[launches.Launch, picture.Machine]:
    """Setup, indexing, launch; what happened and what the machine is."""
    steps = script.load(profiles.find("field_setup.yaml"))
    for step in steps:
        try:
            step.run(device)
        except ToolError as error:
            raise ToolError(f"field_setup.yaml, {step.text}: {error}") from error
    live = device.read_names("position_um", "span_error_um")
    console.print(
        f"setup       applied, saved, indexed: parked at {live['position_um'] / 1000:+.2f} mm, "
        f"span error {live['span_error_um'] / 1000:+.2f} mm, launch permitted"
    )
    profile = profiles.read(profiles.find("ground_launch.csv"), launches.read_gearing(device))
    launches.upload(device, profile)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("launch", total=1.0)
        result = launches.play(device, profile, lambda done: progress.update(task, completed=done))
    derived = device.read_names(
        "ka",
        "nr",
        "reversal_plus_usteps",
        "reversal_minus_usteps",
        "dwell_plus_edges",
        "dwell_minus_edges",
        "edges_per_1000_drum_revs",
    )
    result.end |= device.read_names("bench_slipped_usteps")
    machine = picture.Machine(
        screw=Screw(
            derived["ka"],
            derived["nr"],
            derived["reversal_plus_usteps"],
            derived["reversal_minus_usteps"],
            derived["dwell_plus_edges"],
            derived["dwell_minus_edges"],
        ),
        active=read_set(device, "active"),
        edges_per_drum_rev=derived["edges_per_1000_drum_revs"] / 1000,
    )
    console.print(
        f"launch      {result.plant_time_s:.0f} s of rope in and out, in {result.real_time_s:.0f} s"
    )
    return result, machine


def _judge(
    result: launches.Launch,
    machine: picture.Machine,
    tracked: trace.Trace,
    pattern: trace.Pattern,
) -> list[Expectation]:
    um = machine.um_per_ustep
    overshoot_um = pattern.overshoot_q16 / USTEP * um
    predicted_um = pattern.overshoot_predicted_q16 / USTEP * um
    deviation_um = abs(tracked["carriage_um"] - tracked["m"] / USTEP * um).max()
    los = any(result.end["flags"] >> bit & 1 for bit in (Flag.LOS, Flag.FAULTED))
    same = all(result.end[name] == tracked[name][-1] for name in ("m", "u", "pattern_edges"))
    retraced_m = (
        pattern.backward_edges / machine.edges_per_drum_rev * machine.rope_mm_per_drum_rev / 1000
    )
    return [
        Expectation("launch permit", result.permit, result.permit == "kept"),
        Expectation("loss of synchronization", "yes" if los else "none", not los),
        Expectation(
            "largest error against the ideal reversing screw",
            f"{pattern.largest_error_q16 / USTEP:g} microsteps in {pattern.rows} samples",
            pattern.largest_error_q16 == 0,
        ),
        Expectation("trace and registers agree at the end", "yes" if same else "no", same),
        Expectation(
            "drum edges forward, backward",
            f"{pattern.forward_edges}, {pattern.backward_edges} ({retraced_m:.1f} m pulled out)",
            pattern.backward_edges > 0,
        ),
        Expectation(
            "reversals, sweeps",
            f"{pattern.reversals}, {pattern.reversals + 1}",
            pattern.reversals > 0,
        ),
        Expectation("step pulses", str(result.gained("steps"))),
        Expectation(
            "overshoot measured, predicted",
            f"{overshoot_um:.1f} um, {predicted_um:.1f} um",
            abs(overshoot_um - predicted_um) <= OVERSHOOT_TOLERANCE_UM,
        ),
        Expectation(
            "real carriage from commanded position",
            f"{deviation_um:.0f} um at most, {result.end['bench_slipped_usteps']} steps slipped",
            bool(deviation_um < DEVIATION_LIMIT_UM) and result.end["bench_slipped_usteps"] == 0,
        ),
        Expectation(
            "Modbus requests, worst latency",
            f"{result.requests}, {result.worst_latency_s * 1000:.0f} ms",
            result.worst_latency_s < LATENCY_LIMIT_S,
        ),
        Expectation("simulated time of the launch", f"{result.plant_time_s:.1f} s"),
    ]


def report(expectations: list[Expectation], out: Path, name: str = "launch") -> None:
    """Print the table, and where the picture is."""
    marks = {True: "ok", False: "FAILED", None: ""}
    print_table(("", "", ""), [(e.text, e.value, marks[e.held]) for e in expectations])
    console.print(f"picture     {out / name}.png, trace {out / name}_trace.csv")


def _stay(port: str, storage: Path) -> None:
    """Power the simulator up again with the stored parameters, in real time, until Ctrl-C."""
    line = simulator.arguments(port, storage=storage)
    with simulator.Simulator(line) as running:
        console.print(
            "\nThe simulator runs again, in real time, with the saved parameters. "
            "Connect an HMI or PLC to\n"
            f"    port {running.port}, 19200 baud, 8 data bits, 1 stop bit, unit 1\n"
            "    (a pseudo terminal has no parity bit: choose parity none)\n"
            "or try, in another terminal,\n"
            f"    mbpoll -m rtu -b 19200 -P none -a 1 -0 -t 3 -r 100 -c 5 {running.port}\n"
            f"    source {Path(sys.prefix) / 'bin' / 'activate'}\n"
            f"    export LEVELWIND_PORT={running.port}\n"
            "    levelwind index && levelwind status --watch\n"
            "Ctrl-C ends it."
        )
        with contextlib.suppress(KeyboardInterrupt):
            running.wait()
