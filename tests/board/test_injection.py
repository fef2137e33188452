# SPDX-License-Identifier: Apache-2.0
"""An interrupt at any instruction of what threads and interrupts hand over: never half of anything.

Every operation of operations.py with the encoder's interrupt, a limit switch's, and where it runs
the edge timer's, before one instruction in every LEVELWIND_INJECTION_STRIDE; 1 takes every one.
injection.py says how it is judged.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from levelwind.line.points import decode
from levelwind.map_table import POINTS

from board.machine import IMAGE, ROOT, available

pytestmark = pytest.mark.skipif(bool(available()), reason=available())
pytest.importorskip("elftools.elf.elffile", reason="pyelftools is not installed")

from board.every_instruction import check, interrupts, walk  # noqa: E402
from board.injection import LIVE_FIRST, STRIDE, TornError  # noqa: E402
from board.operations import OPERATIONS  # noqa: E402

ODOMETER_STRIDE = 3  # a reading that is torn is so in a few instructions only


CASES = [(name, interrupt) for name in OPERATIONS for interrupt in interrupts(name)]


@pytest.mark.parametrize(("name", "interrupt"), CASES, ids=[" / ".join(case) for case in CASES])
def test_an_interrupt_at_any_instruction_comes_before_or_after(
    name: str, interrupt: str, record_property: Callable[[str, object], None]
):
    done = walk(name, interrupt)
    record_property("injections", len(done.places))
    check(done, interrupt)


def test_an_odometer_read_is_of_before_or_after_an_edge(
    record_property: Callable[[str, object], None],
):
    """By the numbers themselves: the closed form of the screw before and after the edge."""
    done = walk("status", "edge", min(STRIDE, ODOMETER_STRIDE))
    record_property("injections", len(done.places))
    names = ("pattern_edges", "net_edges", "m", "u", "steps")
    found = set()
    for place in done.places:
        answer = place.outcome.answer
        words = [int.from_bytes(answer[i : i + 2], "big") for i in range(3, len(answer), 2)]
        found.add(
            tuple(
                decode(POINTS[name], words[POINTS[name].address - LIVE_FIRST :])
                for name in names
                if POINTS[name].address - LIVE_FIRST < len(words)
            )
        )
    assert len(found) == 2, found
    before, after = sorted(found)
    assert after[1] - before[1] == 1
    assert after[2] - before[2] == before[3], "an edge in the sweep adds the slope"


class Broken(NamedTuple):
    """What is taken out of the firmware, and which injection must tell."""

    path: str
    text: str
    instead: str
    operation: str
    interrupt: str = "edge"


BROKEN = {
    "the drum watch's poll lets the encoder's interrupt in": Broken(
        "drivers/encoder/encoder_stm32.c",
        "	const unsigned int key = irq_lock();\n\n	if (data->seen == data->polled)",
        "	const unsigned int key = arch_irq_lock();\n\n	irq_unlock(key);\n"
        "	if (data->seen == data->polled)",
        "trim",
    ),
    "an odometer read without volatile reads once": Broken(
        "lib/lw_core/src/motion/motion.c",
        "static struct words read_words(const volatile struct lw_motion *motion)",
        "static struct words read_words(const struct lw_motion *motion)",
        "status",
    ),
    "a waiting correction is changed without withdrawing it": Broken(
        "lib/lw_core/src/control/los_judge.c",
        "	motion->requests &= (uint8_t)~LW_MOTION_REQUEST_CORRECTION;\n"
        "	motion->request_correction_usteps -= error;",
        "	motion->request_correction_usteps -= error;",
        "limit switch that changes a waiting correction",
    ),
    "a correction is looked at before its edges are kept out": Broken(
        "lib/lw_core/src/control/tracking.c",
        "	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);\n"
        "	corrected = motion->requests & LW_MOTION_REQUEST_CORRECTION;\n"
        "	correction_usteps = motion->request_correction_usteps;\n",
        "	corrected = motion->requests & LW_MOTION_REQUEST_CORRECTION;\n"
        "	correction_usteps = motion->request_correction_usteps;\n",
        "stop while a correction waits",
    ),
}


def run(*command: str, **where: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, check=False, capture_output=True, text=True, **where)


@pytest.fixture(scope="module")
def copy() -> Path:
    """The product's sources, to be broken."""
    place = ROOT / "build/broken"
    for folder in ("app", "cmake", "drivers", "dts", "include", "lib", "modbus_map", "zephyr"):
        shutil.rmtree(place / folder, ignore_errors=True)
        shutil.copytree(ROOT / folder, place / folder)
    return place


def firmware(source: Path) -> Path:
    """Build the image of a copy of the sources."""
    board = "nucleo_f446re"
    done = run("./dev", "firmware", board, str(source.relative_to(ROOT)), cwd=ROOT)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return source / board / "zephyr/zephyr.bin"


@pytest.mark.skipif(
    "LEVELWIND_BROKEN_IMAGES" not in os.environ,
    reason="builds images that are broken on purpose: LEVELWIND_BROKEN_IMAGES=1",
)
@pytest.mark.parametrize("name", BROKEN)
def test_what_is_broken_on_purpose_is_caught(copy: Path, name: str):
    broken = BROKEN[name]
    path = copy / broken.path
    sound = (ROOT / broken.path).read_text()
    assert sound.count(broken.text) == 1
    try:
        path.write_text(sound.replace(broken.text, broken.instead))
        image = firmware(copy)
        assert image.read_bytes() != IMAGE.read_bytes(), "the compiler makes the same code of it"
        test = test_an_interrupt_at_any_instruction_comes_before_or_after.__name__
        case = f"{__file__}::{test}[{broken.operation} / {broken.interrupt}]"
        changed = {"LEVELWIND_BOARD_IMAGE": str(image), "LEVELWIND_INJECTION_STRIDE": "1"}
        done = run(sys.executable, "-m", "pytest", "-q", case, env=os.environ | changed, cwd=ROOT)
        assert done.returncode == 1, done.stdout[-2000:]
        assert TornError.__name__ in done.stdout, done.stdout[-2000:]
    finally:
        path.write_text(sound)
