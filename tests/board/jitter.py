# SPDX-License-Identifier: Apache-2.0
"""`./dev board --jitter`: step pulses against the ideal screw at constant speed, over the speeds.

The ideal screw turns without steps of its own: at a constant speed its microsteps are equally far
apart. A pulse is later by two parts: the edge that it comes with is the first one behind the ideal
time, and the pulse is behind its edge.
"""

from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from levelwind.core.ideal_screw import USTEP
from levelwind.show.output import console, print_table

from board.machine import CHANNEL_A, STEP
from board.ready import indexed

SPEEDS_EDGES_PER_S = (300, 1_000, 3_000, 10_000, 20_000, 30_000, 48_000)
CYCLES_PERMILLE = 1300
LIVE = ("state", "flags", "m", "u", "position_usteps")
PULSES = 4_000
LONGEST_S = 20.0
UM_PER_USTEP = 10.0
MOTOR_S = 0.010  # a stepper with its load follows what is slower than about 100 Hz


class Jitter(NamedTuple):
    """At one speed, in the sweep, with Modbus polled without a pause."""

    edges_per_s: int
    slope: float  # microsteps for an edge
    edge_us: np.ndarray  # of the pulses: the edge behind the ideal screw
    interrupt_us: np.ndarray  # the pulse behind its edge

    @property
    def total_us(self) -> np.ndarray:
        """The pulse behind the ideal screw."""
        return self.edge_us + self.interrupt_us

    @property
    def um_per_us(self) -> float:
        """Speed of the carriage."""
        return self.edges_per_s * self.slope * UM_PER_USTEP * 1e-6

    @property
    def pulses_um(self) -> float:
        """From the least to the most that the pulses are behind the ideal screw."""
        return np.ptp(self.total_us) * self.um_per_us

    @property
    def motor_um(self) -> float:
        """The same of their means over the time of the motor."""
        count = max(1, round(MOTOR_S * self.edges_per_s * self.slope))
        means = np.convolve(self.total_us, np.full(count, 1 / count), mode="valid")
        return np.ptp(means) * self.um_per_us


def measure(edges_per_s: int) -> Jitter:
    """Let the drum turn and take the times of the pins."""
    board = indexed(baud=115_200, cycles_permille=CYCLES_PERMILLE, phase_error_permille=125)
    slope = board.value("ks") / USTEP
    board.drum(edges_per_s, 480_000)
    board.run(max(0.2, 1_500 / edges_per_s))
    board.run_until(board.in_sweep, step_s=0.05)
    for pin in (CHANNEL_A, STEP):
        board.record(pin)
    seconds = min(PULSES / (slope * edges_per_s), LONGEST_S)
    begin = board.now_ns
    while board.now_ns - begin < seconds * 1e9 and board.in_sweep():
        for _ in range(5):
            board.read(*LIVE)
    changes = board.recorded()
    is_a = (changes["port"] == CHANNEL_A[0]) & (changes["pin"] == CHANNEL_A[1])
    edges_us = changes["time_ns"][is_a] / 1000
    steps_us = changes["time_ns"][~is_a & (changes["level"] == 1)] / 1000
    steps_us = steps_us[(steps_us > edges_us[1]) & (steps_us < edges_us[-1])]
    edge_of_step = np.searchsorted(edges_us, steps_us, side="right") - 1
    at_edge_us = edges_us[edge_of_step]
    period_us = np.diff(edges_us).mean() / slope
    behind_us = at_edge_us - period_us * np.arange(len(at_edge_us))
    return Jitter(edges_per_s, slope, behind_us - behind_us.min(), steps_us - at_edge_us)


def draw(found: list[Jitter], path: Path) -> None:
    """Both parts over the speed, and how the pulses are distributed at the highest."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))
    speeds = np.array([jitter.edges_per_s for jitter in found])
    for values, color, name in (
        ([j.edge_us.max() for j in found], "#1f77b4", "its edge behind the ideal screw, worst"),
        ([j.interrupt_us.max() for j in found], "#d62728", "the pulse behind its edge, worst"),
        ([np.median(j.interrupt_us) for j in found], "#ff9896", "the same, median"),
    ):
        left.loglog(speeds, values, "o-", color=color, label=name)
    left.loglog(speeds, 1e6 / speeds, ":", color="gray", label="time from edge to edge")
    left.set_xlabel("drum, edges/s")
    left.set_ylabel("us")
    left.grid(True, which="major", alpha=0.3)
    left.legend(fontsize=8)
    left.set_title("A step pulse behind the ideal screw")
    top = found[-1]
    bins = np.arange(0, top.total_us.max() + 0.5, 0.5)
    right.hist(top.total_us, bins, color="#1f77b4", label="pulse behind the ideal screw")
    right.hist(top.interrupt_us, bins, color="#d62728", alpha=0.7, label="pulse behind its edge")
    right.set_yscale("log")
    right.set_xlabel("us")
    right.set_ylabel("pulses in 0.5 us")
    right.legend(fontsize=8)
    right.set_title(f"{len(top.total_us)} pulses at {top.edges_per_s} edges/s")
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main(path: Path) -> int:
    """Measure all speeds, print a table, and draw."""
    found = [measure(speed) for speed in SPEEDS_EDGES_PER_S]
    rows = []
    for jitter in found:
        interrupt, edge = jitter.interrupt_us, jitter.edge_us
        rows.append(
            (
                str(jitter.edges_per_s),
                str(len(edge)),
                f"{edge.max():.1f}",
                *(f"{value:.2f}" for value in np.percentile(interrupt, (0, 50, 99.9, 100))),
                f"{jitter.pulses_um:.1f}",
                f"{jitter.motor_um:.2f}",
            )
        )
    print_table(
        (
            *("edges/s", "pulses", "edge late, us", "pulse behind it, us: least", "median"),
            *("99.9 %", "worst", "in all, um", "over 10 ms, um"),
        ),
        rows,
    )
    draw(found, path)
    console.print(f"picture     {path}")
    return 0
