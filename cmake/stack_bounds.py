#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The most stack that each thread and the interrupts of a firmware for Arm can need.

The image itself says it: how far every instruction has moved the stack pointer, who calls whom,
which interrupt has which handler, and how large the stacks are. Whom a pointer may call it does
not say: stack_bounds.yaml does, and what it does not name is an error, as is recursion. Fails if a
stack is smaller than what may be needed.
"""

import argparse
import fnmatch
import json
import pickle
import re
import struct
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import yaml
from elftools.elf.constants import SH_FLAGS
from elftools.elf.elffile import ELFFile

# What an exception puts on the stack that was in use: eight registers, four bytes to align them.
EXCEPTION_FRAME = 36
SYSTEM_EXCEPTIONS = 16
SPURIOUS = "z_irq_spurious"
WRAPPER = "_isr_wrapper"
THREAD = "z_thread_entry"
INIT = "z_sys_init_run_level"
CLONE = re.compile(r"\.(isra|constprop|part|cold)\.?\d*")
ENDS = re.compile(r"^(?:b(?:\.n|\.w)?|bx)$")
CONDITIONAL = re.compile(
    r"^(?:b(?:eq|ne|cs|hs|cc|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(?:\.n|\.w)?|cbn?z)$"
)
VISITS_MAX = 64


class BoundsError(Exception):
    """Something that cannot be bounded, with what to do."""


@dataclass
class Instruction:
    """One line of the disassembly."""

    address: int
    name: str
    operands: str
    source: str  # the function in which it was written, the innermost of what was inlined
    following: int = 0

    @property
    def target(self) -> int | None:
        """Where a branch goes."""
        found = re.search(r"(?:^|, )([0-9a-f]+) <", self.operands)
        return int(found[1], 16) if found else None

    def moves(self) -> int | None:
        """By how much it makes the stack deeper; None if that is not to be seen."""
        operands = self.operands
        count = operands.count(",") + 1
        moves: int | None = 0
        if self.name.startswith(("push", "pop")):
            moves = 4 * count if self.name.startswith("push") else -4 * count
        elif found := re.match(r"^sp(?:, sp)?, #(\d+)", operands):
            moves = int(found[1]) if self.name.startswith("sub") else -int(found[1])
        elif operands.startswith("sp!, {"):
            moves = 4 * (count - 1) * (1 if self.name.startswith("stm") else -1)
        elif found := re.search(r"\[sp, #(-?\d+)\]!|\[sp\], #(-?\d+)", operands):
            moves = -int(found[1] or found[2])
        elif re.match(r"^sp\b", operands) and not self.name.startswith(("cmp", "str", "stm")):
            moves = None
        return moves


@dataclass
class Function:
    """What a function does with the stack: its calls, each with how deep the stack is at it."""

    name: str
    address: int
    instructions: list[Instruction]
    frame: int = 0
    calls: dict[int, int] = field(default_factory=dict)
    by_pointer: dict[str, int] = field(default_factory=dict)  # the same, by the source of the call
    strange: str = ""

    def __post_init__(self) -> None:
        code = {i.address: i for i in self.instructions}
        depths: dict[int, int] = {}
        visits: defaultdict[int, int] = defaultdict(int)
        switches: list[int] = []
        work = [(self.address, 0)]
        while True:
            while work:
                at, depth = work.pop()
                if at not in code or depths.get(at, -1) >= depth:
                    continue
                depths[at] = depth
                visits[at] += 1
                if visits[at] > VISITS_MAX:
                    self.strange = f"the stack grows in a loop at 0x{at:x}"
                    return
                work += self._follow(code[at], depth, code, switches)
            # What a table of a switch leads to begins where nothing else leads to.
            lone = [
                i.following
                for i in self.instructions
                if i.address in depths and i.following in code and i.following not in depths
            ]
            if not (switches and lone):
                return
            work = [(lone[0], max(switches))]

    def _follow(
        self, at: Instruction, depth: int, code: dict[int, Instruction], switches: list[int]
    ) -> Iterator[tuple[int, int]]:
        """Where it goes from here, and how deep the stack is there."""
        moves = at.moves()
        if moves is None:
            self.strange = f"{at.name} {at.operands} at 0x{at.address:x}"
            moves = 0
        depth += moves
        self.frame = max(self.frame, depth)
        if at.name in ("bl", "blx") or ENDS.match(at.name) or CONDITIONAL.match(at.name):
            if at.target is None:
                if at.operands.strip() != "lr" or at.name == "blx":
                    self.by_pointer[at.source] = max(self.by_pointer.get(at.source, 0), depth)
            elif at.name == "bl" or at.target not in code:
                self.calls[at.target] = max(self.calls.get(at.target, 0), depth)
            else:
                yield at.target, depth
        if at.name in ("tbb", "tbh") or at.operands.startswith("pc, [r"):
            switches.append(depth)
        elif not ENDS.match(at.name) and not re.search(r"^pc\b|\bpc\}", at.operands):
            yield at.following, depth


def disassemble(objdump: str, elf: Path) -> Iterator[Function]:
    """All functions of an image, those of the assembler too."""
    text = subprocess.run(
        [objdump, "-d", "--line-numbers", "--no-show-raw-insn", elf],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    for part in re.split(r"\n(?=[0-9a-f]{8} <)", text)[1:]:
        head, *lines = part.splitlines()
        address, name = re.match(r"([0-9a-f]+) <(.+)>:", head).groups()  # type: ignore[union-attr]
        instructions = []
        source = ""
        for line in lines:
            if found := re.match(r"^(\S+)\(\):$", line):
                source = CLONE.sub("", found[1])
            found = re.match(r"^\s+([0-9a-f]+):\t(\S+)\s*(.*)$", line)
            if found and not found[2].startswith("."):
                operands = re.split(r"\s*[@;]", found[3])[0].strip()
                instructions.append(Instruction(int(found[1], 16), found[2], operands, source))
        for this, after in pairwise(instructions):
            this.following = after.address
        yield Function(CLONE.sub("", name), int(address, 16), instructions)


class Image:
    """An image, and what is declared about it."""

    def __init__(self, build: Path, declared: dict[str, Any]) -> None:
        self.build = build
        elf = build / "zephyr/zephyr.elf"
        cache = (build / "CMakeCache.txt").read_text()
        objdump = re.search(r"^CMAKE_OBJDUMP:\w+=(.+)$", cache, re.M)
        assert objdump, "no objdump in CMakeCache.txt"
        self.functions = {f.address: f for f in disassemble(objdump[1], elf)}
        with elf.open("rb") as file:
            self._read(ELFFile(file))
        self.named: defaultdict[str, list[Function]] = defaultdict(list)
        for function in self.functions.values():
            self.named[function.name].append(function)
        for functions in [f for f in self.named.values() if len(f) > 1]:
            for function in functions:
                function.name = f"{self.files.get(function.address, '')}:{function.name}"
                self.named[function.name].append(function)
        self.frames: dict[str, int] = declared["frames"]
        self.by_priority: dict[int, dict[str, list[str]]] = declared["priorities"]
        self.recursion: dict[str, int] = declared["recursion"]
        self.errors: list[str] = []
        self.reached: set[str] = set()
        self.resolved: set[str] = set()
        self.claims: list[list[Function]] = []
        self.pointers = self._callees(declared["pointers"])
        self.pointers[INIT] = [self.functions[a] for a in self.init_functions if a]
        self._bounds: dict[int, int] = {}
        self.uncalled = {f.address for name in declared["uncalled"] for f in self._declared(name)}

    def _callees(self, declared: dict[str, list[str]]) -> dict[str, list[Function]]:
        found = {
            caller: [f for callee in callees for f in self._declared(callee)]
            for caller, callees in declared.items()
        }
        self.claims += found.values()
        return found

    def _declared(self, pattern: str) -> list[Function]:
        found = [f for name in fnmatch.filter(self.named, pattern) for f in self.named[name]]
        if not found:
            self.errors.append(f"{pattern} is declared to be called, and is not in the image")
        return found

    def _read(self, elf: ELFFile) -> None:
        symbols = elf.get_section_by_name(".symtab")
        self.symbols: dict[str, tuple[int, int]] = {}
        self.stacks: dict[str, int] = {}
        self.files: dict[int, str] = {}  # of static functions
        file = ""
        for symbol in symbols.iter_symbols():
            value, size = symbol["st_value"], symbol["st_size"]
            if symbol["st_info"]["type"] == "STT_FILE":
                file = symbol.name
            elif symbol["st_info"]["type"] == "STT_FUNC":
                self.files[value & ~1] = file
            elif symbol["st_info"]["type"] == "STT_OBJECT" and "stack" in symbol.name:
                local = symbol["st_info"]["bind"] == "STB_LOCAL"
                self.stacks[f"{file}:{symbol.name}" if local else symbol.name] = size
            self.symbols[symbol.name] = (value, size)
        self.guard = self.stacks["z_main_stack"] - self.symbols["CONFIG_MAIN_STACK_SIZE"][0]
        self.vectors = self._words(elf, "_vector_table", SYSTEM_EXCEPTIONS)
        size = self.symbols["_irq_vector_table"][1] // 4
        self.irq_vectors = self._words(elf, "_irq_vector_table", size)
        self.handlers = self._words(elf, "_sw_isr_table", 2 * size)[1::2]
        self.words = {
            word
            for section in elf.iter_sections()
            if section["sh_flags"] & SH_FLAGS.SHF_ALLOC and section["sh_type"] == "SHT_PROGBITS"
            for (word,) in struct.iter_unpack("<I", section.data()[: section["sh_size"] & ~3])
        }
        data = elf.get_section_by_name("initlevel").data()
        self.init_functions = [word & ~1 for word, _ in struct.iter_unpack("<II", data)]

    def _words(self, elf: ELFFile, name: str, count: int) -> list[int]:
        address = self.symbols[name][0]
        for segment in elf.iter_segments():
            begin = segment["p_vaddr"]
            if segment["p_type"] == "PT_LOAD" and begin <= address < begin + segment["p_filesz"]:
                data = segment.data()[address - begin :][: 4 * count]
                return [word & ~1 for word in struct.unpack(f"<{count}I", data)]
        raise BoundsError(f"{name} is not in the image")

    def bound(self, function: Function, path: tuple[str, ...] = ()) -> int:
        """The most stack that a call of it needs."""
        if function.address in self._bounds:
            return self._bounds[function.address]
        name = function.name
        if name in path:
            if name not in self.recursion:
                circle = " -> ".join([*path[path.index(name) :], name])
                self.errors.append(f"recursion: {circle}. Declare how deep it goes")
            self.reached.add(name)
            return 0
        if function.strange and name not in self.frames:
            self.errors.append(f"{name}: {function.strange}: declare its frame")
        self.reached.add(name)
        most = max(function.frame, self.frames.get(name, 0))
        path += (name,)
        for address, depth in function.calls.items():
            # A branch into the midst of a function is one of a piece that was split off.
            if callee := self.functions.get(address):
                most = max(most, depth + self.bound(callee, path))
            else:
                self.errors.append(f"{name} goes to 0x{address:x}, where no function begins")
        for depth, callee in self.pointed(function):
            most = max(most, depth + self.bound(callee, path))
        most += self.recursion.get(name, 0)
        if not set(path) & self.recursion.keys() or name in self.recursion:
            self._bounds[function.address] = most
        return most

    def pointed(self, function: Function) -> Iterator[tuple[int, Function]]:
        """What it may call by a pointer, by the innermost inline function with the call."""
        if function.name in (WRAPPER, THREAD):
            return  # each is asked for with what it calls
        for source, depth in function.by_pointer.items():
            name = INIT if function.name == INIT else source
            if name not in self.pointers:
                self.errors.append(f"{function.name} calls by a pointer, in {source}: declare what")
            self.resolved.add(name)
            yield from ((depth, callee) for callee in self.pointers.get(name, []))

    def calls_of(self, name: str) -> int:
        """How deep the stack is where a function calls by a pointer."""
        return max(self.named[name][0].by_pointer.values())

    @contextmanager
    def besides(self, own: dict[str, list[str]]) -> Iterator[None]:
        """While other pointers are declared: for a thread, or for a priority."""
        before = self.pointers, self._bounds
        self.pointers, self._bounds = self.pointers | self._callees(own), {}
        yield
        self.pointers, self._bounds = before

    def unclaimed(self, entries: Iterable[str]) -> list[str]:
        """Functions with an address that is taken, for which no call by a pointer is declared."""
        claimed = {f.address for callees in self.claims for f in callees}
        claimed |= {f.address for f in self.pointers[INIT]}
        claimed |= {*self.vectors, *self.irq_vectors, *self.handlers, *self.uncalled}
        claimed |= {f.address for name in entries for f in self.named[name]}
        taken = [f for a, f in self.functions.items() if a | 1 in self.words]
        return sorted(f.name for f in taken if f.address not in claimed)

    def bound_of(self, name: str) -> int:
        """The same, by the name."""
        if not self.named[name]:
            self.errors.append(f"{name} is not in the image")
        return max((self.bound(f) for f in self.named[name]), default=0)

    def levels(self) -> dict[str, list[tuple[str, int]]]:
        """Handlers and their needs, by priority: each may interrupt those below."""
        by_priority: defaultdict[int, list[tuple[str, int]]] = defaultdict(list)
        wrapper = self.named[WRAPPER][0]
        for number, priority in self._priorities().items():
            vector = self.functions[self.irq_vectors[number]]
            handler = self.functions[self.handlers[number]] if vector is wrapper else vector
            if handler.name == SPURIOUS:
                continue
            with self.besides(self.by_priority.get(priority, {})):
                need = self.bound(handler)
                if vector is wrapper:
                    need = max(self.bound(wrapper), self.calls_of(WRAPPER) + need)
            by_priority[priority].append((f"{number} {handler.name}", need))
        system = {self.functions[v].name: self.functions[v] for v in self.vectors[1:] if v}
        faults = [
            (n, self.bound(f))
            for n, f in system.items()
            if n not in ("z_arm_pendsv", "z_arm_reset", "__start")
        ]
        switch = [("z_arm_pendsv", self.bound_of("z_arm_pendsv"))]
        return {
            "faults": faults,
            **{f"priority {p}": by_priority[p] for p in sorted(by_priority)},
            "switching": switch,
        }

    def _priorities(self) -> dict[int, int]:
        """By the number of the interrupt, of the devicetree."""
        base = re.search(
            r"^ZEPHYR_BASE:\w+=(.+)$", (self.build / "CMakeCache.txt").read_text(), re.M
        )
        assert base, "no ZEPHYR_BASE in CMakeCache.txt"
        sys.path.insert(0, f"{base[1]}/scripts/dts/python-devicetree/src")
        with (self.build / "zephyr/edt.pickle").open("rb") as file:
            tree = pickle.load(file)
        return {
            interrupt.data["irq"]: interrupt.data["priority"]
            for node in tree.nodes
            for interrupt in node.interrupts
            if node.status == "okay" and "irq" in interrupt.data
        }


def measure(image: Image, declared: dict[str, Any]) -> dict[str, dict[str, int]]:
    """Need and size of every stack, by what runs on it."""
    found = {}
    for thread, about in declared["threads"].items():
        with image.besides(about.get("pointers", {})):
            need = image.calls_of(THREAD) + image.bound_of(about["entry"]) + EXCEPTION_FRAME
        found[thread] = {"need": need, "size": size_of(image, about["stack"])}
    levels = image.levels()
    nested = sum(max(n for _, n in level) + EXCEPTION_FRAME for level in levels.values() if level)
    found["interrupts"] = {
        # The first of them puts its frame on the stack of the thread.
        "need": nested - EXCEPTION_FRAME,
        "size": size_of(image, "z_interrupt_stacks"),
    }
    found["start"] = {
        "need": image.bound_of("z_cstart"),
        "size": size_of(image, "z_interrupt_stacks"),
    }
    return found


def size_of(image: Image, stack: str) -> int:
    """Of a stack, without its guard."""
    if stack not in image.stacks:
        raise BoundsError(f"no stack {stack} in the image: it has {', '.join(image.stacks)}")
    return image.stacks[stack] - image.guard


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="build/BOARD")
    parser.add_argument("--declared", type=Path, default=Path(__file__).with_suffix(".yaml"))
    parser.add_argument("--json", action="store_true", help="print need and size as JSON")
    parser.add_argument("--frames", action="store_true", help="print every function's own as JSON")
    parser.add_argument("--path", metavar="FUNCTION", help="print what its need is made of")
    arguments = parser.parse_args()
    declared = yaml.safe_load(arguments.declared.read_text())
    try:
        image = Image(arguments.build, declared)
        stacks = measure(image, declared)
        unclaimed = image.unclaimed([*(t["entry"] for t in declared["threads"].values()), THREAD])
    except BoundsError as error:
        sys.exit(f"stack_bounds: {error}")
    image.errors += [f"{name} may be called by a pointer: declare by whom" for name in unclaimed]
    unused = [
        f"{name} is declared, and nothing that runs needs it"
        for names, needed in (
            (image.pointers, image.resolved),
            ([*image.frames, *image.recursion], image.reached),
        )
        for name in names
        if name not in needed
    ]
    if arguments.path:
        print_path(image, arguments.path)
    elif arguments.frames:
        print(json.dumps({f.name: f.frame for f in image.functions.values()}))
    elif arguments.json:
        print(json.dumps(stacks))
    else:
        print(f"{'stack, bytes':24}{'need':>8}{'size':>8}")
        for name, about in stacks.items():
            print(f"{name:24}{about['need']:8}{about['size']:8}")
    over = [
        f"{name} may need {about['need']} bytes of stack, and has {about['size']}"
        for name, about in stacks.items()
        if about["need"] > about["size"]
    ]
    wrong = [*dict.fromkeys(image.errors), *unused, *over]
    for line in wrong:
        print(f"stack_bounds: {line}", file=sys.stderr)
    return 1 if wrong else 0


def print_path(image: Image, name: str) -> None:
    """The dearest calls from a function on."""
    function: Function | None = image.named[name][0]
    while function is not None:
        print(f"{image.bound(function):6} {function.frame:6} {function.name}")
        calls = [(d, image.functions[a]) for a, d in function.calls.items() if a in image.functions]
        calls += image.pointed(function)
        depth, deepest = max(calls, key=lambda c: c[0] + image.bound(c[1]), default=(0, None))
        if deepest is None or depth + image.bound(deepest) < function.frame:
            return
        function = deepest


if __name__ == "__main__":
    sys.exit(main())
