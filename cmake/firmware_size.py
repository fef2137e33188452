#!/usr/bin/env python3
"""Print where the flash and the RAM of a firmware go: firmware_size.py zephyr.map."""

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


def main() -> None:
    text = Path(sys.argv[1]).read_text()
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
    print(f"{'sum':24}{flash.total():8}{ram.total():8}")


if __name__ == "__main__":
    main()
