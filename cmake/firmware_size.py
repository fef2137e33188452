#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Print where the flash and RAM of a firmware go. Fails if the image is larger than it may be."""

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

# Of an input section: address, size, and file. Of an output section: its name.
INPUT = re.compile(r"^ \S+\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$")
OUTPUT = re.compile(r"^([\w.]+)\s+0x[0-9a-f]+\s+0x[0-9a-f]+(?: load address 0x[0-9a-f]+)?$")
NOT_LOADED = (".debug", ".comment", ".ARM.attributes", ".stab")
RAM_BEGIN, RAM_END = 0x20000000, 0x40000000
IN_FLASH_TOO = {
    "datas",
    "device_states",
    "k_sem_area",
    "k_mutex_area",
    "k_msgq_area",
    "sw_isr_table",
}


def owner(file: str) -> str:
    """The part of the firmware that an object file belongs to."""
    for part, text in {
        "levelwind: core": "liblw_core",
        "levelwind: plant": "liblw_plant",
        "levelwind: drivers": "liblw_drivers",
        "levelwind: application": "app/libapp",
        "Zephyr: drivers": "zephyr/drivers/",
        "Zephyr: kernel": "zephyr/kernel/",
        "C library": "libc.a",
        "compiler's library": "libgcc",
    }.items():
        if text in file:
            return part
    return "Zephyr: the rest" if "zephyr/" in file else "other"


def symbol(text: str, name: str) -> int:
    """The value of a symbol that the linker script defines."""
    match = re.search(rf"^ +0x([0-9a-f]+) +{name} = ", text, re.M)
    if match is None:
        sys.exit(f"firmware_size: no symbol {name}: is this the map of a Zephyr image?")
    return int(match[1], 16)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("map", type=Path, help="build/BOARD/zephyr/zephyr.map")
    parser.add_argument("--flash-max", type=int, metavar="BYTES", help="largest image")
    parser.add_argument("--ram-max", type=int, metavar="BYTES", help="most RAM")
    arguments = parser.parse_args()
    text = arguments.map.read_text()
    text = text[text.index("Linker script and memory map") :]
    text = re.sub(r"\n(\S+| \S+)\n\s+(?=0x)", r"\n\1 ", text)  # long names
    flash: Counter[str] = Counter()
    ram: Counter[str] = Counter()
    output = ""
    for line in text.splitlines():
        if match := OUTPUT.match(line):
            output = match[1]
        elif (match := INPUT.match(line)) and not output.startswith(NOT_LOADED):
            address, size = int(match[1], 16), int(match[2], 16)
            in_ram = RAM_BEGIN <= address < RAM_END
            if in_ram:
                ram[owner(match[3])] += size
            if not in_ram or output in IN_FLASH_TOO:
                flash[owner(match[3])] += size
    print(f"{'':24}{'flash':>8}{'RAM':>8}")
    for part in sorted({*flash, *ram}):
        print(f"{part:24}{flash[part]:8}{ram[part]:8}")
    # The linker's own count of the whole: what is left of it lies between the parts.
    totals = {"flash": symbol(text, "_flash_used"), "RAM": symbol(text, "_image_ram_size")}
    between = [totals["flash"] - flash.total(), totals["RAM"] - ram.total()]
    print(f"{'alignment':24}{between[0]:8}{between[1]:8}")
    print(f"{'whole image':24}{totals['flash']:8}{totals['RAM']:8}")

    limits = {"flash": arguments.flash_max, "RAM": arguments.ram_max}
    too_large = {kind: limit for kind, limit in limits.items() if limit and totals[kind] > limit}
    for kind, limit in too_large.items():
        print(f"the image takes {totals[kind]} bytes of {kind}, limit {limit}", file=sys.stderr)
    return 1 if too_large else 0


if __name__ == "__main__":
    sys.exit(main())
