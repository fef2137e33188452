# SPDX-License-Identifier: Apache-2.0
"""The image that flies, on the board: what no other host shows."""

import hashlib
import subprocess
import sys

import pytest
from levelwind.line.live import image_of
from levelwind.map_table import Command, Mode, Result, State

from board.machine import IMAGE, IRQ0, ROOT, Board, available
from board.ready import indexed

pytestmark = pytest.mark.skipif(bool(available()), reason=available())

EDGES_PER_S = 48_000
EDGE_TO_STEP_MAX_NS = 5_000
LOAD_MAX = 0.10
INSTRUCTIONS_AN_EDGE = 90
ENCODER = IRQ0 + 28
LIVE = ("state", "flags", "m", "u", "pattern_edges", "position_usteps")


def pins_since(board: Board, begin: dict[str, int], seen: tuple[int, int]) -> dict[str, int]:
    """Where edges and pulses at the pins say that the pattern and the carriage are."""
    now = board.seen
    return {
        "pattern_edges": begin["pattern_edges"] + now.edges - seen[0],
        "position_usteps": begin["position_usteps"] + now.steps - seen[1],
    }


@pytest.mark.parametrize(("cycles_permille", "phase_error_permille"), [(1000, 0), (1300, 125)])
def test_no_edge_and_no_step_is_lost_at_full_speed_while_modbus_is_polled(
    cycles_permille: int, phase_error_permille: int
):
    """At 115,200 baud without a pause; 125 permille of a pulse are 45 degrees."""
    board = indexed(
        baud=115_200, cycles_permille=cycles_permille, phase_error_permille=phase_error_permille
    )
    orbit = board.orbit()
    board.drum(EDGES_PER_S, 480_000)
    board.run(0.2)
    board.clear_seen()
    for _ in range(100):
        board.read(*LIVE)
    load = board.load
    seen = board.seen
    cost = board.costs()[ENCODER]
    board.stop_drum()
    board.check_follows(orbit)
    assert board.read("missed_edges", "illegal_transitions") == {
        "missed_edges": 0,
        "illegal_transitions": 0,
    }
    assert seen.pulse_min_ns >= 2_500
    assert seen.space_min_ns >= 2_500
    assert seen.dir_setup_min_ns >= 5_000
    assert seen.edge_to_step_max_ns < EDGE_TO_STEP_MAX_NS
    assert load < LOAD_MAX
    assert cost.count * cost.avg < INSTRUCTIONS_AN_EDGE * abs(seen.edges)


def test_pulses_and_edges_at_the_pins_are_what_the_registers_say():
    board = indexed()
    begin = board.read(*LIVE)
    at = (board.seen.edges, board.seen.steps)
    for speed in (24_000, -12_000, 36_000):
        board.drum(speed, 240_000)
        board.run(0.5)
    board.stop_drum()
    told = board.read("pattern_edges", "position_usteps")
    assert told == pins_since(board, begin, at)
    assert told["pattern_edges"] > 10_000


def test_driver_enable_stands_around_every_frame():
    board = Board()
    board.clear_seen()
    for _ in range(5):
        board.read(*LIVE)
    seen = board.seen
    assert seen.sent_without_driver == 0
    assert seen.de_before_min_ns < 100_000
    assert seen.de_after_max_ns < 50_000


def test_what_is_saved_is_there_after_a_power_cut_and_a_restart():
    board = Board()
    board.apply(pitch_um=11_000)
    assert board.command(Command.SAVE) == Result.DONE
    board.power_cycle(0.6)
    assert board.value("active.pitch_um") == 11_000
    again = Board(flash=board.stored)
    assert again.value("active.pitch_um") == 11_000


def test_nothing_moves_and_nothing_has_current_without_power():
    board = indexed()
    board.drum(EDGES_PER_S)
    board.run(0.3)
    board.power_off()
    steps = board.seen.pulses
    board.run(0.5)
    assert board.seen.pulses == steps
    board.power_on()
    board.run(0.6)
    assert board.state == State.UNINDEXED
    assert board.seen.pulses == steps


def test_the_mode_follows_the_line():
    board = indexed()
    board.mode(Mode.CENTRE)
    board.run_until(lambda: board.state == State.CENTRED, step_s=0.05)
    assert abs(board.truth.carriage_um) < 500


@pytest.mark.parametrize("spoilt_bit", [0, 1])
def test_the_registers_name_the_image_that_runs(spoilt_bit: int):
    """Worked out over the flash: the last byte, which nothing runs, counts like any other."""
    image = bytearray(IMAGE.read_bytes())
    image[-1] ^= spoilt_bit
    named = image_of(Board(image=bytes(image)).read("image_hash_high", "image_hash_low"))
    assert named == hashlib.sha256(image).hexdigest()[:16]


def test_the_bill_of_materials_is_of_this_image_and_has_its_sources():
    build = IMAGE.parents[1]
    subprocess.run([sys.executable, ROOT / "cmake/sbom.py", build], check=True)
    digest = hashlib.sha256(IMAGE.read_bytes()).hexdigest()
    for document in ("build", "zephyr", "app", "modules-deps"):
        text = (build / f"spdx/{document}.spdx").read_text()
        assert f"/{digest}/{document}\n" in text
    sources = (build / "spdx/zephyr.spdx").read_text()
    assert "cpe:2.3:o:zephyrproject:zephyr:3.7.1" in sources
    law = hashlib.sha256((ROOT / "lib/lw_core/src/motion/law.c").read_bytes()).hexdigest()
    assert f"FileChecksum: SHA256: {law}\nLicenseConcluded: Apache-2.0" in sources
