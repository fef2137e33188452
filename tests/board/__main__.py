# SPDX-License-Identifier: Apache-2.0
"""`./dev board`: the Nucleo's image in the demonstration's launch, judged at its pins alone."""

import argparse
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from levelwind.core.ideal_screw import USTEP, State
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import Flag
from levelwind.show.output import console, print_table
from levelwind.simulate import launches, picture, trace
from levelwind.simulate.demo import DEVIATION_LIMIT_UM, Expectation, launch, report

from board import every_instruction, jitter
from board.machine import IRQ0, Board, Seen, available
from board.serve import ROW, Server

OUT = Path("out")
NAME = "board_launch"
TIMEOUT_S = 10.0  # of a request: the processor stands still while its flash is erased
OVERSHOOT_TOLERANCE_UM = 10.0  # a microstep is what a pulse can show
# What the drivers promise (app/boards/nucleo_f446re.overlay).
PULSE_NS, SPACE_NS, DIR_SETUP_NS, DIR_HOLD_NS = 2500, 2500, 5000, 5000
INTERRUPTS = {
    14: "switching of threads",
    IRQ0 + 8: "encoder index",
    IRQ0 + 10: "switch, line 4",
    IRQ0 + 23: "switches, lines 5 to 9",
    IRQ0 + 28: "encoder",
    IRQ0 + 29: "end of a step pulse",
    IRQ0 + 30: "edge timer",
    IRQ0 + 37: "UART",
    IRQ0 + 40: "switch, line 10",
    IRQ0 + 50: "kernel's clock",
}


def recording(rows: np.ndarray, result: launches.Launch, screw: picture.Screw) -> trace.Trace:
    """The rows as a trace: the position is that of the pulses, the slope that of the ideal screw.

    The drum stood until the launch, so its first edge tells where the launch began.
    """
    first = int(np.argmax(rows["edges"] != rows["edges"][0]))
    at = rows[max(0, first - 1)]
    edges = result.begin["pattern_edges"] + rows["edges"] - at["edges"]
    steps = result.begin["position_usteps"] + rows["steps"] - at["steps"]
    orbit = screw.orbit(State(result.begin["m"], result.begin["u"]))
    begun = np.arange(len(rows)) >= first
    slopes = [
        orbit.after(int(edge) - result.begin["pattern_edges"]).u if moving else 0
        for edge, moving in zip(edges, begun, strict=True)
    ]
    return trace.Trace(
        {
            "time_ms": rows["time_ms"],
            "state": rows["state"],
            "flags": rows["flags"],
            "net_edges": edges,
            "pattern_edges": edges,
            "m": steps * USTEP,
            "u": np.array(slopes),
            "carriage_um": rows["carriage_um"],
            "drum_millirpm": rows["drum_millirpm"],
        }
    )


def pulse_errors(tracked: trace.Trace, result: launches.Launch, screw: picture.Screw) -> list[int]:
    """Microsteps between the pulses given and the ideal screw, by row.

    A row may fall between an edge and its pulse: then the ideal is that of the edge before.
    """
    orbit = screw.orbit(State(result.begin["m"], result.begin["u"]))
    errors = []
    edges = tracked["pattern_edges"] - result.begin["pattern_edges"]
    for edge, m in zip(edges.tolist(), tracked["m"].tolist(), strict=True):
        ideals = [(orbit.after(edge + near).m // USTEP) for near in (0, -1, 1)]
        errors.append(min(abs(ideal - m // USTEP) for ideal in ideals))
    return errors


def judge(
    board: Board,
    result: launches.Launch,
    machine: picture.Machine,
    tracked: trace.Trace,
    seen: Seen,
) -> list[Expectation]:
    """The demonstration's table, from the pins, and what only the pins can tell."""
    um = machine.um_per_ustep
    screw = machine.screw
    end = result.end
    errors = pulse_errors(tracked, result, screw)
    moved = np.diff(tracked["pattern_edges"])
    backward = int(-moved[moved < 0].sum())
    retraced_m = backward / machine.edges_per_drum_rev * machine.rope_mm_per_drum_rev / 1000
    reversals = int(trace.turns(tracked).sum())
    overshoot_um = (tracked["m"].max() - screw.sweep_end) / USTEP * um
    predicted_um = screw.overshoot / USTEP * um
    deviation_um = abs(tracked["carriage_um"] - tracked["m"] / USTEP * um).max()
    los = any(end["flags"] >> bit & 1 for bit in (Flag.LOS, Flag.FAULTED))
    place = int(tracked["m"][-1]) // USTEP
    edges = int(tracked["pattern_edges"][-1])
    return [
        Expectation("launch permit", result.permit, result.permit == "kept"),
        Expectation("loss of synchronization", "yes" if los else "none", not los),
        Expectation(
            "largest error of the pulses against the ideal screw",
            f"{max(errors)} microsteps in {len(errors)} samples",
            max(errors) == 0,
        ),
        Expectation(
            "position: pulses counted, register",
            f"{place}, {end['position_usteps']} microsteps",
            place == end["position_usteps"],
        ),
        Expectation(
            "drum edges: pins counted, register",
            f"{edges}, {end['pattern_edges']}",
            edges == end["pattern_edges"],
        ),
        Expectation(
            "drum edges forward, backward",
            f"{int(moved[moved > 0].sum())}, {backward} ({retraced_m:.1f} m pulled out)",
            backward > 0,
        ),
        Expectation("reversals, sweeps", f"{reversals}, {reversals + 1}", reversals > 0),
        Expectation(
            "overshoot measured, predicted",
            f"{overshoot_um:.0f} um, {predicted_um:.1f} um",
            abs(overshoot_um - predicted_um) <= OVERSHOOT_TOLERANCE_UM,
        ),
        Expectation(
            "real carriage from commanded position",
            f"{deviation_um:.0f} um at most, {end['bench_slipped_usteps']} steps slipped",
            bool(deviation_um < DEVIATION_LIMIT_UM) and end["bench_slipped_usteps"] == 0,
        ),
        Expectation(
            "step pulse",
            f"{seen.pulse_min_ns} to {seen.pulse_max_ns} ns wide, {seen.space_min_ns} ns apart",
            seen.pulse_min_ns >= PULSE_NS and seen.space_min_ns >= SPACE_NS,
        ),
        Expectation(
            "direction before, after a pulse",
            f"{seen.dir_setup_min_ns}, {seen.dir_hold_min_ns} ns at least",
            seen.dir_setup_min_ns >= DIR_SETUP_NS and seen.dir_hold_min_ns >= DIR_HOLD_NS,
        ),
        Expectation("edge to its pulse", f"{seen.edge_to_step_max_ns / 1000:.1f} us at most"),
        Expectation(
            "driver enable around a frame",
            f"{seen.de_before_min_ns} ns before, {seen.de_after_max_ns} ns after, "
            f"{seen.sent_without_driver} bytes without",
            seen.sent_without_driver == 0,
        ),
        Expectation(
            "processor",
            f"{100 * board.load:.0f} % at work, masked {seen.masked_max_instructions} instructions",
        ),
        Expectation(
            "restarts",
            f"{seen.resets_software} by software, {seen.resets_watchdog} by watchdog",
            seen.resets_software + seen.resets_watchdog == 0,
        ),
        Expectation("Modbus requests", str(result.requests)),
        Expectation("simulated time of the launch", f"{result.plant_time_s:.1f} s"),
    ]


def print_interrupts(board: Board) -> None:
    """What interrupts have cost, in instructions from entry to return."""
    rows = [
        (
            INTERRUPTS.get(number, f"exception {number}"),
            *(str(n) for n in (c.count, c.min, round(c.avg), c.max)),
        )
        for number, c in sorted(board.costs().items())
    ]
    print_table(("interrupt", "times", "min", "average", "max instructions"), rows)


def stay(flash: bytes, port: Path) -> None:
    """Power the board up again with what it has stored, in real time, until Ctrl-C."""
    file = port.with_name("board_flash.bin")
    file.write_bytes(flash)
    command = [sys.executable, "-m", "board.serve", "--port", str(port), "--storage", str(file)]
    console.print(
        f"\nThe board runs again, in real time, with what it has stored. Connect an HMI or PLC to\n"
        f"    port {port}, 19200 baud, unit 1 (a pseudo terminal has no parity: choose none)\n"
        "or try, in another terminal,\n"
        f"    levelwind --port {port} index\nCtrl-C ends it."
    )
    subprocess.run(command, check=False)


def main() -> int:
    parser = argparse.ArgumentParser(prog="dev board", description=__doc__)
    parser.add_argument("--stay", action="store_true", help="leave the board running for a master")
    parser.add_argument("--cpi", type=float, default=1.0, help="cycles that an instruction takes")
    parser.add_argument("--jitter", action="store_true", help="step pulses against the ideal screw")
    parser.add_argument(
        "--injections",
        nargs="?",
        const="",
        metavar="REGEX",
        help="an interrupt at every instruction of the operations whose name matches (all)",
    )
    given = parser.parse_args()
    if why := available():
        console.print(f"[red]board: {why}[/red]")
        return 1
    OUT.mkdir(exist_ok=True)
    if given.jitter:
        return jitter.main(OUT / "board_jitter.png")
    if given.injections is not None:
        return every_instruction.main(given.injections)
    began = time.monotonic()
    port = (OUT / "board-port").absolute()
    board = Board(cycles_permille=round(1000 * given.cpi))
    console.print(
        f"board       the image of nucleo_f446re, HCLK {board.clock_hz(0) / 1e6:g} MHz, "
        f"{given.cpi:g} cycles an instruction"
    )
    board.clear_seen()
    server = Server(board, port, speed=0, traced=True)
    with server, Device(Line(str(port), timeout_s=TIMEOUT_S)) as device:
        result, machine = launch(device)
    rows = np.array(server.rows, dtype=ROW)
    whole = recording(rows, result, machine.screw)
    tracked = whole.tracking()
    seen = board.seen
    expectations = judge(board, result, machine, tracked, seen)
    expectations.append(Expectation("real time", f"{time.monotonic() - began:.1f} s"))
    columns = list(whole.columns)
    np.savetxt(
        OUT / f"{NAME}_trace.csv",
        np.column_stack([whole[name] for name in columns]),
        delimiter=",",
        header=",".join(columns),
        comments="",
        fmt="%.10g",
    )
    picture.draw(whole, machine, OUT / f"{NAME}.png")
    report(expectations, OUT, NAME)
    print_interrupts(board)
    if board.complaints:
        console.print("Against the manual:\n" + board.complaints.rstrip())
    if given.stay:
        stay(board.flash.raw, port)
    return 0 if all(e.held is not False for e in expectations) else 1


if __name__ == "__main__":
    sys.exit(main())
