# SPDX-License-Identifier: Apache-2.0
"""Instructions per encoder edge on Arm Cortex-M, counted in an emulator (Unicorn, QEMU's CPUs).

edge.c is compiled with the core, bare, and its interrupts are called edge by edge over a seeded mix
of runs either way. Every step is compared with the model of tests/property.
"""

import json
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate, pairwise
from pathlib import Path

from figure import Figure
from levelwind.cam.table import Scale, Table
from levelwind.map_table import CamInterpolation
from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn import arm_const as arm

sys.path.insert(0, str(Path(__file__).parent.parent / "property"))

from rational_cam import STEPS_PER_EDGE_MAX, RationalCam
from reversing_screw import Model, Pattern

ROOT = Path(__file__).parent.parent.parent
# Of another revision, where bench.py compares with one.
SOURCES = Path(os.environ.get("LEVELWIND_BENCH_SOURCES", ROOT))
HOW_TO_INSTALL = "apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi"
RECORD = ROOT / "tests/bench/edge_cost.json"
COMPILER = "arm-none-eabi-gcc"
CPUS = {
    "cortex-m4": arm.UC_CPU_ARM_CORTEX_M4,
    "cortex-m3": arm.UC_CPU_ARM_CORTEX_M3,
    "cortex-m0plus": arm.UC_CPU_ARM_CORTEX_M0,  # the same instruction set
}
OPTIMIZATIONS = ("-O2", "-Os")
CAMS = {CamInterpolation.LINEAR: "cam, linear", CamInterpolation.TRAPEZOID: "cam, trapezoid"}
LAW, HARDWARE, SOFTWARE = "law alone", "interrupt, timer decodes", "interrupt, x4 in software"
# What a Cortex-M4 may take, and what the best code written by hand takes: average, worst. The hand
# floors have no step counter, no direction of the carriage and no mark of a reversal to keep.
TARGETS = {LAW: (12.0, 20), HARDWARE: (24.0, 36), SOFTWARE: (36.0, 48)}
TARGETS |= dict.fromkeys(CAMS.values(), (40.0, 100))
# An edge that turns back leaves the decoder's short way, to be counted for the drum watch.
TURN_WORST = 100
HAND_FLOORS = {LAW: (8.2, 13), HARDWARE: (18.6, 32)}
DEARER_MAX = 1.10  # than the record
EDGES = 40_000
EDGES_OF_A_TICK = 48  # of the supervisor, at 48,000 edges/s

FACTORY = Pattern(23, 1187, 8000, -8000)
TURN = "direction change"
CLASSES = ("sweep", "reversal", TURN)

# Registers and memory of edge.c.
FLASH, RAM, STOP = 0x08000000, 0x20000000, 0x10000000
TIMERS_2_3, EXTI_TIMER_9, ENCODER_IDR, DIR = 0x40000000, 0x40013C00, 0x40020410, 0x42400294
PULSE_CR1 = 0x400
CR1_DIR = 16
LEVELS = (0, 2, 3, 1)


@dataclass
class Cost:
    """Instructions from a function's first to its return."""

    function: str
    cpu: str
    optimization: str
    edges: str
    min: int
    avg: float
    max: int


@dataclass
class Size:
    """Bytes of code and of state."""

    cpu: str
    optimization: str
    law_code: int
    interrupt_code: int
    law_state: int


def mix(seed: int = 1) -> list[int]:
    """Runs of 1 to 1,024 edges, 87 % of them forward."""
    numbers = random.Random(seed)
    runs = []
    while sum(map(abs, runs)) < EDGES:
        run = numbers.randint(1, 1024)
        runs.append(run if numbers.random() < 0.87 else -run)
    return runs


def build(folder: Path, cpu: str, optimization: str) -> Path:
    """Compile edge.c and the core, without an operating system."""
    program = folder / f"edge_{cpu}{optimization}.elf"
    symbols = {
        "timers_2_3": TIMERS_2_3,
        "exti_timer_9": EXTI_TIMER_9,
        "encoder_idr": ENCODER_IDR,
        "dir": DIR,
    }
    roots = ("law_forward", "law_backward", "hardware_interrupt", "software_interrupt")
    roots += ("law_offset", "law_size", "setup_cam", "cam_edge", "cam_rows", "prepare_cam")
    core = SOURCES / "lib/lw_core"
    subprocess.run(
        [
            *(COMPILER, "-std=c11", "-mthumb", f"-mcpu={cpu}", optimization, "-nostartfiles"),
            *("-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections", "-Wl,-esetup"),
            *(f"-Wl,--undefined={root}" for root in roots),
            *(f"-Wl,--defsym={name}={address}" for name, address in symbols.items()),
            *(f"-Wl,-Ttext={FLASH:#x}", f"-Wl,-Tdata={RAM:#x}"),
            *(f"-I{core}/include", f"-I{core}/generated", f"{core}/generated/map.c"),
            *sorted(map(str, core.glob("src/*/*.c"))),
            *(str(SOURCES / "tests/bench/edge.c"), "-o", str(program)),
        ],
        check=True,
    )
    return program


class Machine:
    """A bare Cortex-M with a program, called function by function."""

    def __init__(self, program: Path, cpu: str) -> None:
        """Load the program."""
        self.cpu = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.cpu.ctl_set_cpu_model(CPUS[cpu])
        for address in (FLASH, RAM, STOP, 0x40000000, DIR & ~0xFFFFF):
            self.cpu.mem_map(address, 0x100000)
        image = program.read_bytes()
        (headers,) = struct.unpack_from("<I", image, 28)
        size, count = struct.unpack_from("<HH", image, 42)
        for i in range(count):
            kind, offset, address, _, length = struct.unpack_from("<5I", image, headers + i * size)
            if kind == 1:
                self.cpu.mem_write(address, image[offset : offset + length])
        symbols = subprocess.run(
            ["arm-none-eabi-nm", "-S", program], check=True, capture_output=True, text=True
        ).stdout
        self.symbols: dict[str, int] = {}
        self.sizes: dict[str, int] = {}
        for line in symbols.splitlines():
            words = line.split()
            self.symbols[words[-1]] = int(words[0], 16)
            self.sizes[words[-1]] = int(words[1], 16) if len(words) == 4 else 0
        self.count = 0
        self._instructions: dict[tuple[int, int], int] = {}
        self.cpu.hook_add(UC_HOOK_BLOCK, self._block)

    def _block(self, _cpu: Uc, address: int, size: int, _data: object) -> None:
        if (address, size) not in self._instructions:
            code = struct.unpack(f"<{size // 2}H", self.cpu.mem_read(address, size))
            i = count = 0
            while i < len(code):
                i += 2 if code[i] >> 11 >= 0b11101 else 1
                count += 1
            self._instructions[address, size] = count
        self.count += self._instructions[address, size]

    def call(self, function: str, *arguments: int) -> int:
        """Run a function. `count` has its instructions, the result is signed."""
        registers = (arm.UC_ARM_REG_R0, arm.UC_ARM_REG_R1, arm.UC_ARM_REG_R2)
        for register, argument in zip(registers, arguments, strict=False):
            self.cpu.reg_write(register, argument & 0xFFFFFFFF)
        self.cpu.reg_write(arm.UC_ARM_REG_SP, RAM + 0x80000)
        self.cpu.reg_write(arm.UC_ARM_REG_LR, STOP | 1)
        self.count = 0
        self.cpu.emu_start(self.symbols[function] | 1, STOP)
        result = self.cpu.reg_read(arm.UC_ARM_REG_R0)
        return result - (1 << 32) if result >> 31 else result

    def write(self, address: int, value: int) -> None:
        """A 32-bit word."""
        self.cpu.mem_write(address, value.to_bytes(4, "little"))

    def read(self, address: int) -> int:
        """A 32-bit word."""
        return int.from_bytes(self.cpu.mem_read(address, 4), "little")


def edges(machine: Machine, function: str, runs: list[int]) -> Iterator[int]:
    """Call a function for every edge: its step; the instructions are in `machine.count`."""
    law = machine.symbols["controller"] + machine.read(machine.symbols["law_offset"])
    pulse = PULSE_CR1 + (EXTI_TIMER_9 if function == SOFTWARE else TIMERS_2_3)
    phase = 0
    for run in runs:
        dd = 1 if run > 0 else -1
        machine.write(TIMERS_2_3, 0 if dd > 0 else CR1_DIR)
        for _ in range(abs(run)):
            if function == LAW:
                yield machine.call("law_forward" if dd > 0 else "law_backward", law)
                continue
            phase = (phase + dd) & 3
            machine.write(ENCODER_IDR, LEVELS[phase])
            machine.write(pulse, 0)
            machine.call("hardware_interrupt" if function == HARDWARE else "software_interrupt")
            if not machine.read(pulse):
                yield 0
            else:
                yield -1 if machine.read(DIR) & 1 else 1


def classes(runs: list[int], model: Model) -> list[str]:
    """What kind of edge each one is."""
    result = []
    before = 1
    positions = iter(zip(model.positions, [*model.positions[1:], model.m >> 16], strict=True))
    for run in runs:
        dd = 1 if run > 0 else -1
        for i in range(abs(run)):
            pos, after = next(positions)
            at = pos if dd > 0 else after
            if i == 0 and dd != before:
                result.append(TURN)
            elif model.pattern.minus < at < model.pattern.plus:
                result.append("sweep")
            else:
                result.append("reversal")
        before = dd
    return result


def measure(machine: Machine, cpu: str, optimization: str) -> list[Cost]:
    """The three functions over the mix, each step as the model's."""
    runs = mix()
    # A little before a reversal, so that the mix has its share of it.
    start = (FACTORY.end - 300 * FACTORY.ks, FACTORY.ks)
    model = Model(FACTORY, *start).run(runs)
    kinds = classes(runs, model)
    result = []
    for function in (LAW, HARDWARE, SOFTWARE):
        assert machine.call("setup", *start) == FACTORY.ks
        counts = []
        for i, step in enumerate(edges(machine, function, runs)):
            counts.append(machine.count)
            assert step == model.steps[i], f"{function}, edge {i}: step {step}"
        result.append(cost(function, cpu, optimization, "all", counts))
        for kind in CLASSES:
            of_kind = [n for n, k in zip(counts, kinds, strict=True) if k == kind]
            result.append(cost(function, cpu, optimization, kind, of_kind))
    return result


def cam_table(interpolation: CamInterpolation, seed: int = 1) -> RationalCam:
    """Short rows of every slope, up to the steepest, so that all that an edge may meet comes."""
    numbers = random.Random(seed)
    peak = STEPS_PER_EDGE_MAX * (0.9 if interpolation == CamInterpolation.TRAPEZOID else 1.0)
    masters, slaves = [0], [0]
    for _ in range(60):
        length = numbers.randint(20, 400)
        steepest = int(peak * length)
        masters.append(masters[-1] + length)
        slaves.append(slaves[-1] + numbers.choice((-1, 1, numbers.uniform(-1, 1))) * steepest // 1)
    masters.append(masters[-1] + 20_000)
    slaves.append(0)
    rows = tuple((m, int(s)) for m, s in zip(masters, slaves, strict=True))
    return RationalCam(Table(rows, interpolation), Scale())


def measure_cam(machine: Machine, cpu: str, optimization: str) -> list[Cost]:
    """What a cam makes of an edge, from the edge's first instruction to its return."""
    result = []
    runs = mix()
    net = list(accumulate((1 if r > 0 else -1 for r in runs for _ in range(abs(r))), initial=0))
    for interpolation in CamInterpolation:
        cam = cam_table(interpolation)
        ends = {master for master, _ in cam.table.rows}
        for i, value in enumerate(value for row in cam.table.rows for value in row):
            machine.write(machine.symbols["cam_rows"] + 4 * i, value & 0xFFFFFFFF)
        assert machine.call("setup_cam", interpolation, len(cam.table.rows)) == 0
        inside, over, ticks = [], [], []
        for i, (before, after) in enumerate(pairwise(net)):
            if i % EDGES_OF_A_TICK == 0:
                machine.call("prepare_cam")
                ticks.append(machine.count)
            steps = machine.call("cam_edge", after - before)
            expected = cam.usteps(after) - cam.usteps(before)
            assert steps == expected, f"{interpolation.label}, edge {i}: {steps}, not {expected}"
            passed = max(before, after) % cam.cycle in ends
            (over if passed else inside).append(machine.count)
        name = CAMS[interpolation]
        result += [
            cost(name, cpu, optimization, "all", inside + over),
            cost(name, cpu, optimization, "inside a row", inside),
            cost(name, cpu, optimization, "into another row", over),
            cost(f"supervisor, {name}", cpu, optimization, "a tick's pieces", ticks),
        ]
    return result


def cost(function: str, cpu: str, optimization: str, edges: str, counts: list[int]) -> Cost:
    """Of some edges."""
    avg = round(sum(counts) / len(counts), 2)
    return Cost(function, cpu, optimization, edges, min(counts), avg, max(counts))


def size(machine: Machine, cpu: str, optimization: str) -> Size:
    """Of the law in both directions, of the interrupt that decodes, and of the law's state."""
    sizes = machine.sizes
    return Size(
        cpu,
        optimization,
        sizes["law_forward"] + sizes["law_backward"],
        sizes["software_interrupt"],
        machine.read(machine.symbols["law_size"]),
    )


def measure_all(cpus: tuple[str, ...]) -> tuple[list[Cost], list[Size]]:
    """Everything, for some CPUs."""
    costs, sizes = [], []
    with tempfile.TemporaryDirectory() as folder:
        for cpu in cpus:
            for optimization in OPTIMIZATIONS:
                machine = Machine(build(Path(folder), cpu, optimization), cpu)
                costs += measure(machine, cpu, optimization)
                costs += measure_cam(machine, cpu, optimization)
                sizes.append(size(machine, cpu, optimization))
    return costs, sizes


def recorded() -> list[Cost]:
    """What was measured when the record was made."""
    return [Cost(**cost) for cost in json.loads(RECORD.read_text())["costs"]]


def write_record(costs: list[Cost], sizes: list[Size]) -> None:
    """Compare with these from now on."""
    compiler = subprocess.run([COMPILER, "--version"], check=True, capture_output=True, text=True)
    record = {
        "made_by": f"./dev bench --record, {compiler.stdout.splitlines()[0]}",
        "costs": [vars(cost) for cost in costs],
        "sizes": [vars(size) for size in sizes],
    }
    RECORD.write_text(json.dumps(record, indent=1) + "\n")


def table(costs: list[Cost], sizes: list[Size]) -> str:
    """For people."""
    before = {key(c): c for c in recorded()} if RECORD.exists() else {}
    lines = ["instructions per edge: min, average, worst; average and worst as recorded"]
    for c in costs:
        old = before.get(key(c))
        line = f"{c.function:25} {c.cpu:13} {c.optimization}  {c.edges:17}"
        line += f"{c.min:4} {c.avg:6.2f} {c.max:4}"
        line += f"   {old.avg:6.2f} {old.max:4}" if old else "        new"
        if c.cpu == "cortex-m4" and c.edges == "all" and c.function in TARGETS:
            avg, worst = TARGETS[c.function]
            line += f"   target {avg:.0f} / {worst}"
            if c.function in HAND_FLOORS:
                avg, worst = HAND_FLOORS[c.function]
                line += f", by hand {avg} / {worst}: {c.avg - avg:.1f} / {c.max - worst} away"
        lines.append(line)
    lines.append("bytes: code of the law, of the whole interrupt with decoding; state of the law")
    lines += [
        f"{s.cpu:13} {s.optimization}  {s.law_code:4} {s.interrupt_code:4} {s.law_state:4}"
        for s in sizes
    ]
    return "\n".join(lines)


def key(c: Cost) -> tuple[str, ...]:
    """What is compared with what."""
    return c.function, c.cpu, c.optimization, c.edges


def failures(costs: list[Cost], record: list[Cost]) -> list[str]:
    """Targets that are missed, and what has become dearer than the record."""
    result = []
    before = {key(c): c for c in record}
    for c in costs:
        name = f"{c.function}, {c.cpu} {c.optimization}, {c.edges}"
        avg_max, worst_max = TARGETS.get(c.function, (float("inf"), float("inf")))
        if c.function == SOFTWARE and c.edges in ("all", TURN):
            worst_max = TURN_WORST
        if c.edges != "all":
            avg_max = float("inf")  # it is for the mix
        if c.cpu == "cortex-m4" and (c.avg > avg_max or c.max > worst_max):
            result.append(f"{name}: {c.avg} / {c.max}, the target is {avg_max} / {worst_max}")
        old = before.get(key(c))
        if old is not None and (c.avg > DEARER_MAX * old.avg or c.max > DEARER_MAX * old.max):
            result.append(f"{name}: {c.avg} / {c.max} after {old.avg} / {old.max}")
    return result


def figures(costs: list[Cost], sizes: list[Size]) -> list[Figure]:
    """All of it, with the targets."""
    result = []
    for c in costs:
        limits = {}
        if c.cpu == "cortex-m4" and c.function in TARGETS:
            avg, worst = TARGETS[c.function]
            if c.function == SOFTWARE and c.edges in ("all", TURN):
                worst = TURN_WORST
            limits = {"max_max": worst}
            if c.edges == "all":
                limits = {"avg_max": avg, **limits}
        name = f"Arm edge, {c.function}, {c.optimization}, {c.edges}"
        options = "Unicorn, runs of 1 to 1,024 edges"
        values = (c.min, c.avg, c.max)
        result.append(Figure(name, c.cpu, options, *values, "instructions", None, limits, True))
    for s in sizes:
        for what, value in (
            ("code of the law", s.law_code),
            ("code of the interrupt that decodes", s.interrupt_code),
            ("state of the law", s.law_state),
        ):
            name = f"Arm, {what}, {s.optimization}"
            result.append(Figure(name, s.cpu, "", *(3 * [value]), "bytes", None, {}, True))
    return result


def available() -> bool:
    """Is there a compiler with a C library?"""
    if not shutil.which(COMPILER):
        return False
    source = b"#include <string.h>\n"
    check = [COMPILER, "-mthumb", "-mcpu=cortex-m4", "-fsyntax-only", "-xc", "-"]
    return subprocess.run(check, input=source, capture_output=True, check=False).returncode == 0
