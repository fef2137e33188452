# SPDX-License-Identifier: Apache-2.0
"""How long a slave takes to answer, at the fastest drum."""

import os
import statistics
from dataclasses import dataclass
from pathlib import Path

from levelwind.conformance.line import SerialLine, sealed
from levelwind.line.port import Line
from levelwind.map_table import Command, Flag, Result, State
from slave import Slave, start

BAUD = 115_200
REGISTERS = 20
UNIT = 1
ANSWER_SIZE = 5 + 2 * REGISTERS
LIVE_STATUS = 100
TOP_MILLIRPM = 1_000_000  # 48,000 edges/s
TRACKED_EDGES_PER_S = 47_000
ANSWER_MAX_MS = 20.0


@dataclass(frozen=True)
class Latency:
    """From the end of a request to the first byte of its answer."""

    answer_ms: list[float]
    slave_ms: list[float]  # without the time that either process waited for a processor

    @property
    def median_ms(self) -> float:
        return statistics.median(self.answer_ms)

    @property
    def slowest_permille_ms(self) -> float:
        """99.9 % of the answers come sooner."""
        return sorted(self.answer_ms)[len(self.answer_ms) * 999 // 1000]


def waited_s(pid: int) -> float:
    """How long the threads of a process have waited for a processor so far."""
    stats = Path(f"/proc/{pid}/task").glob("*/schedstat")
    return sum(int(stat.read_text().split()[1]) for stat in stats) / 1e9


def measure(port: str, pid: int, count: int) -> Latency:
    """Read 20 registers again and again. `pid` is the slave's process."""
    line = SerialLine(Line(port, BAUD))
    request = sealed(bytes([UNIT, 4, 0, LIVE_STATUS, 0, REGISTERS]))
    answer_ms = []
    slave_ms = []
    try:
        for _ in range(count):
            before_s = waited_s(pid) + waited_s(os.getpid())
            received = line.exchange([request], 0, 1.0)
            after_s = waited_s(pid) + waited_s(os.getpid())
            assert len(received.frame) == ANSWER_SIZE, received.frame.hex(" ")
            answer_ms.append(1000 * received.latency_s)
            slave_ms.append(1000 * max(0.0, received.latency_s - (after_s - before_s)))
    finally:
        line.close()
    return Latency(answer_ms, slave_ms)


def of_target(target: str, folder: Path, count: int) -> Latency:
    """Of a program of its own: index, turn the drum at its fastest, read."""
    simulator = start(target, folder, folder / "parameters.bin")
    try:
        slave = Slave(str(simulator.port))
        slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
        assert slave.command(Command.INDEX) == Result.DONE
        slave.wait(lambda: slave.read("state") == State.TRACKING)
        slave.write("bench_drum_acceleration_millirpm_per_s", 1_000_000)
        slave.write("bench_drum_speed_millirpm", TOP_MILLIRPM)
        slave.wait(lambda: slave.read("drum_speed_edges_per_s") > TRACKED_EDGES_PER_S)
        slave.close()
        latency = measure(str(simulator.port), simulator.process.pid, count)
        slave = Slave(str(simulator.port))
        assert slave.read("state") == State.TRACKING
        assert slave.read("drum_speed_edges_per_s") > TRACKED_EDGES_PER_S
        slave.close()
        return latency
    finally:
        simulator.process.kill()
        simulator.process.wait()
