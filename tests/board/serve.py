# SPDX-License-Identifier: Apache-2.0
"""The board behind a pseudo terminal, for any master: `python -m board.serve --port PATH`."""

import argparse
import contextlib
import mmap
import os
import select
import signal
import sys
import threading
import time
import tty
from pathlib import Path

import numpy as np
from levelwind.line.points import decode
from levelwind.map_table import POINTS
from slave import crc16, sealed

from board.machine import BENCH, FLASH_SIZE, IMAGE, START_S, STORAGE, Board, available

SLICE_S = 0.001
LAG_MAX_S = 0.2  # what it may fall behind before it gives up catching up
READS = {3, 4}
BENCH_FUNCTIONS = {3, 4, 6, 16}
BROADCAST = 0
STATE, FLAGS = POINTS["state"], POINTS["flags"]
ROW = np.dtype(
    [
        *(("time_ms", "<i8"), ("state", "<i4"), ("flags", "<i8"), ("edges", "<i8")),
        *(("steps", "<i8"), ("carriage_um", "<f8"), ("drum_millirpm", "<f8")),
    ]
)


class Server:
    """Moves bytes between a board and a pseudo terminal, in the board's time."""

    def __init__(self, board: Board, link: Path, speed: float = 1.0, traced: bool = False) -> None:
        """`speed` 0 is as fast as it goes."""
        self.board = board
        self.link = link
        self.speed = speed
        self.rows: list[tuple] = []
        self.state, self.flags = 0, 0  # what the line last said
        self._traced = traced
        board.line_settings(0)
        self._asked: tuple[int, int, int] | None = None
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)  # and kept open, or the master would see a hang-up
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._slave))
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> "Server":
        self._thread = threading.Thread(target=self.run, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
        assert self._thread is not None
        self._thread.join()
        self.close()

    def stop(self) -> None:
        """End run()."""
        self._stop.set()

    def close(self) -> None:
        """Take the port away."""
        self.link.unlink(missing_ok=True)
        os.close(self._master)
        os.close(self._slave)

    def run(self) -> None:
        """Serve until stop()."""
        due = time.monotonic()
        answer = b""
        while not self._stop.is_set():
            wait_s = max(0.0, due - time.monotonic()) if self.speed else 0.0
            if select.select([self._master], [], [], wait_s)[0]:
                self._take(os.read(self._master, 4096))
            if self.speed and time.monotonic() < due:
                continue
            self.board.run(SLICE_S)
            if not self.board.powered:
                self.board.power_on()
            heard = bytes(byte.value for byte in self.board.heard())
            answer += heard
            # As one: the master's clock is not the board's, and would see gaps where none are.
            if answer and not heard and self.board.line_idle:
                os.write(self._master, answer)
                self._note(answer)
                answer = b""
            if self._traced:
                self._sample()
            if self.speed:
                due = max(due + SLICE_S / self.speed, time.monotonic() - LAG_MAX_S)

    def _take(self, frame: bytes) -> None:
        """Bytes of the master: to the simulated machine where they ask for it, else to the line."""
        whole = len(frame) >= 8 and crc16(frame) == 0
        address = int.from_bytes(frame[2:4], "big")
        if whole and frame[1] in BENCH_FUNCTIONS and address >= BENCH:
            starts = self.board.seen.resets_power
            answer = self.board.request(frame[1:-2])
            if self.board.seen.resets_power != starts:
                self.board.run(START_S)  # the simulator and native_sim are there at once, too
            if frame[0] != BROADCAST:  # which the controller hears, too
                os.write(self._master, sealed(frame[:1] + answer))
                return
        self._asked = None
        if whole and frame[1] in READS:
            self._asked = (frame[1], address, int.from_bytes(frame[4:6], "big"))
        self.board.send(frame)

    def _note(self, answer: bytes) -> None:
        """Keep what the live status says."""
        if self._asked is None or crc16(answer) != 0 or len(answer) != 5 + 2 * self._asked[2]:
            return
        function, first, count = self._asked
        words = [int.from_bytes(answer[i : i + 2], "big") for i in range(3, len(answer) - 2, 2)]
        if (
            function == 4
            and first <= STATE.address
            and FLAGS.address + FLAGS.words <= first + count
        ):
            self.state = words[STATE.address - first]
            self.flags = decode(FLAGS, words[FLAGS.address - first :])

    def _sample(self) -> None:
        seen = self.board.seen
        now = (self.state, self.flags, seen.edges, seen.steps)
        if self.rows and self.rows[-1][1:5] == now:
            return
        truth = self.board.truth
        where = (truth.carriage_um, truth.drum_milli_rpm)
        self.rows.append((self.board.now_ns // 1_000_000, *now, *where))


def map_flash(path: Path) -> tuple[mmap.mmap, bytes | None]:
    """A file as the board's flash: what it writes is kept however this ends; and its storage."""
    is_new = not path.exists()
    with path.open("w+b" if is_new else "r+b") as file:
        file.truncate(FLASH_SIZE)
        flash = mmap.mmap(file.fileno(), FLASH_SIZE)
    return flash, None if is_new else flash[STORAGE:]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=Path, required=True, help="where to link the port to")
    parser.add_argument("--storage", type=Path, help="file that keeps the flash")
    parser.add_argument("--image", type=Path, default=IMAGE)
    parser.add_argument("--speed", type=float, default=1.0, help="0: as fast as it goes")
    parser.add_argument("--erase-ms", type=int, default=1000, help="time to erase a sector")
    given = parser.parse_args()
    if why := available():
        print(f"board: {why}", file=sys.stderr)
        return 1
    kept, storage = map_flash(given.storage) if given.storage else (None, None)
    image = given.image.read_bytes()
    board = Board(image, storage, kept=kept, flash_erase_us=1000 * given.erase_ms)
    server = Server(board, given.port, given.speed)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: server.stop())
    print(f"ready {given.port}", flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        server.run()
    server.close()
    if board.complaints:
        print(board.complaints, end="", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
