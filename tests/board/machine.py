# SPDX-License-Identifier: Apache-2.0
"""The board of board.h, driven in virtual time: what tests and the demonstration use."""

import ctypes
import functools
import mmap
import os
from ctypes import (
    POINTER,
    c_bool,
    c_char,
    c_char_p,
    c_int,
    c_int32,
    c_int64,
    c_size_t,
    c_uint8,
    c_uint32,
    c_uint64,
    c_void_p,
)
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

import numpy as np
from levelwind.core import layout, native
from slave import crc16, sealed
from world import PDU_MAX, Truth, World, write_requests

ROOT = Path(__file__).parent.parent.parent
IMAGE = Path(
    os.environ.get("LEVELWIND_BOARD_IMAGE", ROOT / "build/nucleo_f446re/zephyr/zephyr.bin")
)
LIBRARY = "liblw_board.so"
FLASH_SIZE = 512 * 1024
STORAGE, SECTOR_SIZE = 0x40000, 0x20000  # in the flash: two sectors
SPOILT_SIZE = 1024
EXCEPTIONS = 113
IRQ0 = 16
HEARD_MAX = 4096
BENCH = 0xF000  # registers of the simulated machine, which the board's harness answers
UNIT = 1
NEVER = (1 << 64) - 1
# As masters do it: what falls into an erasure of the flash, up to 2 s, is lost.
START_S = 0.6
READS, READ_ATTEMPTS = {1, 2, 3, 4, 20}, 4

PA, PB, PC = 0, 1, 2
CHANNEL_A, CHANNEL_B, INDEX = (PA, 0), (PA, 1), (PC, 2)
STEP, DIR, ENABLE, DRIVER_ENABLE = (PB, 0), (PC, 1), (PA, 4), (PA, 8)


class Cut(IntEnum):
    """enum lw_board_cut."""

    NEVER = 0
    BEFORE = 1
    IN = 2
    AFTER = 3


class Config(ctypes.Structure):
    """struct lw_board_config."""

    _fields_ = (
        ("seed", c_uint64),
        ("carriage_um", c_int32),
        ("cycles_permille", c_uint32),
        ("hse_hz", c_uint32),
        ("lsi_hz", c_uint32),
        ("flash_word_ns", c_uint32),
        ("flash_erase_us", c_uint32),
        ("phase_error_permille", c_uint32),
        ("encoder_pulses_per_rev", c_uint32),
        ("line_echo", c_uint32),
        ("button", c_uint32),
    )


class Seen(ctypes.Structure):
    """struct lw_board_seen."""

    _fields_ = (
        ("steps", c_int64),
        ("pulses", c_uint64),
        ("pulse_min_ns", c_uint64),
        ("pulse_max_ns", c_uint64),
        ("space_min_ns", c_uint64),
        ("dir_setup_min_ns", c_uint64),
        ("dir_hold_min_ns", c_uint64),
        ("transitions", c_int64),
        ("edges", c_int64),
        ("transition_spacing_min_ns", c_uint64),
        ("edge_to_step_max_ns", c_uint64),
        ("de_before_min_ns", c_uint64),
        ("de_after_max_ns", c_uint64),
        ("de_after_min_ns", c_uint64),
        ("sent_without_driver", c_uint64),
        ("instructions", c_uint64),
        ("cycles", c_uint64),
        ("stalled_ns", c_uint64),
        ("stall_max_ns", c_uint64),
        ("elapsed_ns", c_uint64),
        ("masked_max_instructions", c_uint64),
        ("flash_operations", c_uint64),
        ("resets", c_uint64 * 3),
    )

    @property
    def resets_power(self) -> int:
        """Starts because the power came."""
        return self.resets[0]

    @property
    def resets_software(self) -> int:
        """Starts that the firmware asked for."""
        return self.resets[1]

    @property
    def resets_watchdog(self) -> int:
        """Starts by the hardware watchdog."""
        return self.resets[2]


class _Cost(ctypes.Structure):
    _fields_ = (
        ("count", c_uint64),
        ("sum_instructions", c_uint64),
        ("min_instructions", c_uint32),
        ("max_instructions", c_uint32),
    )


class _Byte(ctypes.Structure):
    _fields_ = (
        ("start_ns", c_uint64),
        ("end_ns", c_uint64),
        ("baud_millihz", c_uint32),
        ("value", c_uint8),
        ("parity", c_uint8),
        ("stop_bits", c_uint8),
    )


CHANGE = np.dtype(
    {
        "names": ["time_ns", "port", "pin", "level"],
        "formats": ["<u8", "u1", "u1", "u1"],
        "offsets": [0, 8, 9, 10],
        "itemsize": 16,
    }
)


class Cost(NamedTuple):
    """Instructions of an exception from entry to return, without those inside of it."""

    count: int
    min: int
    avg: float
    max: int


@functools.cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(native.find(LIBRARY)))
    layout.check(
        library,
        "lw_layout_board",
        {
            "struct lw_board_config": Config,
            "struct lw_board_seen": Seen,
            "struct lw_board_cost": _Cost,
            "struct lw_board_byte": _Byte,
            "struct lw_board_change": CHANGE,
            "enum lw_board_cut": Cut,
        },
    )
    board = c_void_p
    for name, result, arguments in (
        ("config_default", None, (POINTER(Config),)),
        ("create", board, (POINTER(Config), c_void_p)),
        ("destroy", None, (board,)),
        ("power_on", None, (board,)),
        ("power_off", None, (board,)),
        ("powered", c_bool, (board,)),
        ("save", c_void_p, (board,)),
        ("restore", None, (board, c_void_p)),
        ("forget", None, (c_void_p,)),
        ("run_ns", c_bool, (board, c_uint64)),
        ("run_instructions", c_uint64, (board, c_uint64, c_uint64)),
        ("hang_handler", None, (board,)),
        ("masked", c_bool, (board,)),
        ("run_to_exception", c_bool, (board, c_uint32, c_uint64)),
        ("now_ns", c_uint64, (board,)),
        ("line_settings", None, (board, c_uint32, c_uint32, c_uint32)),
        ("line_send", None, (board, c_char_p, c_size_t)),
        ("line_read", c_size_t, (board, POINTER(_Byte), c_size_t)),
        ("line_idle", c_bool, (board,)),
        ("answer", c_size_t, (board, POINTER(c_uint8), c_size_t, c_uint64, c_uint64)),
        ("bench", c_size_t, (board, c_char_p, c_size_t, POINTER(c_uint8))),
        ("inject", c_int, (board, c_int, c_int32)),
        ("truth", None, (board, POINTER(Truth))),
        ("cut_power", None, (board, c_uint64, c_int)),
        ("seen", None, (board, POINTER(Seen))),
        ("clear_seen", None, (board,)),
        ("cost", None, (board, POINTER(_Cost))),
        ("record", None, (board, c_uint32, c_uint32, c_bool)),
        ("recorded", c_size_t, (board, c_void_p, c_size_t)),
        ("complaints", c_char_p, (board,)),
        ("peek", c_uint32, (board, c_uint32)),
        ("poke", None, (board, c_uint32, c_uint32)),
        ("register", c_uint32, (board, c_uint32)),
        ("set_register", None, (board, c_uint32, c_uint32)),
        ("set_hse", None, (board, c_uint32)),
        ("drive", None, (board, c_uint32, c_uint32, c_uint32)),
        ("pass_filters", None, (board,)),
        ("asleep", c_bool, (board,)),
        ("read_ram", None, (board, c_uint32, c_char_p, c_size_t)),
        ("level", c_bool, (board, c_uint32, c_uint32)),
        ("clock_hz", c_uint32, (board, c_uint32)),
    ):
        function = getattr(library, f"lw_board_{name}")
        function.restype, function.argtypes = result, arguments
    return library


def available() -> str:
    """Why there is no board here; empty if there is one."""
    try:
        native.find(LIBRARY)
    except Exception:
        return "no liblw_board.so: it is built where the Python package unicorn is installed"
    if not IMAGE.is_file():
        return "no image: ./dev firmware nucleo_f446re builds it"
    return ""


READ_STATE = sealed(bytes([UNIT, 4, 0, 100, 0, 1]))


def frame(**values: int) -> bytes:
    """The request that writes registers by name, with its unit and CRC; one run of them."""
    (pdu,) = write_requests(values)
    return sealed(bytes([UNIT]) + pdu)


class NoAnswerError(Exception):
    """The controller has not answered in time."""


class Board(World):
    """A Nucleo that has just been switched on, with a master at its line."""

    def __init__(
        self,
        image: bytes | None = None,
        flash: bytes | None = None,
        start_s: float | None = None,
        kept: mmap.mmap | None = None,
        **config: int,
    ) -> None:
        """`flash`: what its storage begins with. `kept`: where its flash is, to outlive us."""
        self._board = None
        self._states: list[int] = []
        self._library_of_board = _library()
        self.config = Config()
        self._library_of_board.lw_board_config_default(ctypes.byref(self.config))
        for name, value in config.items():
            assert hasattr(self.config, name), name
            setattr(self.config, name, value)
        image = IMAGE.read_bytes() if image is None else image
        assert len(image) <= STORAGE
        flash_type = c_char * FLASH_SIZE
        self.flash = flash_type() if kept is None else flash_type.from_buffer(kept)
        content = image.ljust(STORAGE, b"\xff") + (flash or b"\xff" * (FLASH_SIZE - STORAGE))
        ctypes.memmove(self.flash, content, FLASH_SIZE)
        self._board = self._call("create", ctypes.byref(self.config), self.flash, of=None)
        assert self._board, "no board: no memory, or no emulator"
        self.unit = UNIT
        self.timeout_s = 1.0
        self._buffer = (c_uint8 * 512)()
        self._heard = (_Byte * HEARD_MAX)()
        self.line_settings(19200, "E")
        self._call("power_on")
        if start_s is None:
            # A blank storage is erased for the first journal.
            start_s = START_S + (self.config.flash_erase_us / 1e6 if flash is None else 0)
        self.run(start_s)

    def _call(self, name: str, *arguments: object, of: object = ...) -> object:
        function = getattr(self._library_of_board, f"lw_board_{name}")
        return function(*arguments) if of is None else function(self._board, *arguments)

    def __del__(self) -> None:
        if getattr(self, "_board", None):
            for state in self._states:
                self._call("forget", state, of=None)
            self._call("destroy")

    def save(self) -> int:
        """Keep all as it is; for restore()."""
        state = self._call("save")
        assert state, "no memory"
        self._states.append(state)
        return state

    def forget(self, state: int) -> None:
        """A kept state is not needed any more."""
        self._states.remove(state)
        self._call("forget", state, of=None)

    def restore(self, state: int) -> "Board":
        """As it was then, its time included."""
        self._call("restore", state)
        return self

    # ---- power and time ------------------------------------------------------------------------

    def run(self, seconds: float) -> None:
        """Let virtual time pass."""
        self.run_ns(round(seconds * 1e9))

    def run_ns(self, ns: int) -> bool:
        """Let virtual time pass; False if the power went."""
        return bool(self._call("run_ns", ns))

    def run_instructions(self, count: int, seconds: float) -> int:
        """Run so many instructions, within a time; how many it was."""
        return self._call("run_instructions", count, round(seconds * 1e9))

    def run_to_sleep(self) -> None:
        """Run until no thread and no interrupt is under way."""
        while not self.asleep:
            assert self.run_instructions(1, 1.0), "no power"

    def run_to_exception(self, exception: int, seconds: float) -> bool:
        """Run until its handler is about to begin, at most for a time; whether it has come."""
        return self._call("run_to_exception", exception, round(seconds * 1e9))

    @property
    def now_ns(self) -> int:
        """Virtual time."""
        return self._call("now_ns")

    @property
    def powered(self) -> bool:
        """Has it power?"""
        return self._call("powered")

    def power_on(self) -> None:
        """Give it power."""
        self._call("power_on")

    def power_off(self) -> None:
        """Take its power away."""
        self._call("power_off")

    def power_cycle(self, start_s: float = 0.6) -> None:
        """Off, on, and the time to start."""
        self.power_off()
        self.run(0.1)
        self.power_on()
        self.run(start_s)

    @property
    def stored(self) -> bytes:
        """What stands in the storage sectors."""
        return self.flash.raw[STORAGE:]

    def spoil_free_storage(self) -> None:
        """Let the next save find its log unusable: it erases the other one."""
        for sector in (STORAGE, STORAGE + SECTOR_SIZE):
            used = len(self.flash.raw[sector : sector + SECTOR_SIZE].rstrip(b"\xff"))
            begin = sector + -(-used // 4) * 4
            self.flash[begin : begin + SPOILT_SIZE] = b"\0" * SPOILT_SIZE

    def cut_power(self, operation: int, when: Cut) -> None:
        """Let the power go at an operation of the flash, counted from 1 on, from now on."""
        self._call("cut_power", operation, when)

    # ---- line ----------------------------------------------------------------------------------

    def line_settings(self, baud: int, parity: str = "N", stop_bits: int = 1) -> None:
        """What the master's port is set to; 0 baud: always as the controller's."""
        self.char_ns = (9 + (parity != "N") + stop_bits) * 1_000_000_000 // (baud or 19200)
        self._call("line_settings", baud, "NOE".index(parity), stop_bits)

    @property
    def silence_ns(self) -> int:
        """What ends a frame."""
        return max(1_750_000, 7 * self.char_ns // 2)

    def send(self, frame: bytes) -> None:
        """Bytes of the master."""
        self._call("line_send", frame, len(frame))

    def heard(self) -> list[_Byte]:
        """What the controller has sent."""
        count = self._call("line_read", self._heard, HEARD_MAX)
        return [_Byte.from_buffer_copy(byte) for byte in self._heard[:count]]

    @property
    def line_idle(self) -> bool:
        """Nobody sends: the master's bytes are out, and the controller's."""
        return self._call("line_idle")

    def exchange(self, frame: bytes, timeout_s: float | None = None) -> bytes:
        """Bytes, and the answer to them."""
        self.heard()
        self.send(frame)
        sending_ns = len(frame) * self.char_ns
        limit_ns = sending_ns + round((self.timeout_s if timeout_s is None else timeout_s) * 1e9)
        length = self._call("answer", self._buffer, len(self._buffer), self.silence_ns, limit_ns)
        return bytes(self._buffer[:length])

    def request(self, pdu: bytes) -> bytes:
        """One Modbus request, function code and data, and its answer."""
        if len(pdu) >= 3 and pdu[0] in (3, 4, 6, 16) and pdu[1] >= BENCH >> 8:
            answer = (c_uint8 * PDU_MAX)()
            length = self._call("bench", pdu, len(pdu), answer)
            return bytes(answer[:length])
        for _ in range(READ_ATTEMPTS if pdu[0] in READS else 1):
            answer = self.exchange(sealed(bytes([self.unit]) + pdu))
            if len(answer) >= 4 and crc16(answer) == 0 and answer[0] == self.unit:
                return answer[1:-2]
        raise NoAnswerError(f"answer to {pdu.hex(' ')}: {answer.hex(' ') or 'none'}")

    def line(self, frame: bytes, seconds: float) -> bytes:
        """Bytes on the line, then time; what the slave has sent in it."""
        self.heard()
        self.send(frame)
        self.run(seconds)
        return bytes(byte.value for byte in self.heard())

    # ---- what is seen --------------------------------------------------------------------------

    def inject(self, fault: int, argument: int) -> None:
        """A fault of the machine."""
        status = self._call("inject", fault, argument)
        assert status == 0, f"{fault!r} {argument}: errno {-status}"

    @property
    def truth(self) -> Truth:
        """What is really the case."""
        truth = Truth()
        self._call("truth", ctypes.byref(truth))
        return truth

    @property
    def seen(self) -> Seen:
        """What the pins and the processor have done since clear_seen()."""
        seen = Seen()
        self._call("seen", ctypes.byref(seen))
        return seen

    def clear_seen(self) -> None:
        """Look anew."""
        self._call("clear_seen")

    def costs(self) -> dict[int, Cost]:
        """What exceptions have cost, by number: 16 and more are interrupts."""
        costs = (_Cost * EXCEPTIONS)()
        self._call("cost", costs)
        found = {}
        for number, c in enumerate(costs):
            if c.count:
                average = c.sum_instructions / c.count
                found[number] = Cost(c.count, c.min_instructions, average, c.max_instructions)
        return found

    @property
    def load(self) -> float:
        """Share of the time in which the processor worked."""
        seen = self.seen
        return seen.cycles / (seen.elapsed_ns * 1e-9 * self.clock_hz(0))

    def record(self, pin: tuple[int, int], on: bool = True) -> None:
        """Keep the changes of a pin."""
        self._call("record", *pin, on)

    def recorded(self) -> np.ndarray:
        """The changes since the last call."""
        changes = np.zeros(2_000_000, dtype=CHANGE)
        count = self._call("recorded", changes.ctypes.data, len(changes))
        return changes[:count]

    @property
    def complaints(self) -> str:
        """What the firmware has done that the manual forbids."""
        return self._call("complaints").decode()

    def peek(self, address: int) -> int:
        """A register or memory."""
        return self._call("peek", address)

    def poke(self, address: int, value: int) -> None:
        """Write a register or memory."""
        self._call("poke", address, value)

    def register(self, number: int) -> int:
        """A general register of the processor."""
        return self._call("register", number)

    def set_register(self, number: int, value: int) -> None:
        """Change a general register of the processor."""
        self._call("set_register", number, value)

    def hang_handler(self) -> None:
        """The exception handler that runs now runs for ever."""
        self._call("hang_handler")

    @property
    def masked(self) -> bool:
        """The firmware keeps interrupts away."""
        return self._call("masked")

    def set_hse(self, hse_hz: int) -> None:
        """The external clock comes, or with 0 fails."""
        self._call("set_hse", hse_hz)

    def drive(self, pin: tuple[int, int], level: int | None) -> None:
        """Drive a pin from outside, or let it float."""
        self._call("drive", *pin, 2 if level is None else level)

    def pass_filters(self) -> None:
        """What changed at the inputs of timers has passed their filters now."""
        self._call("pass_filters")

    @property
    def asleep(self) -> bool:
        """The processor sleeps: no thread and no interrupt is under way."""
        return self._call("asleep")

    def ram(self, address: int, size: int) -> bytes:
        """Memory, as a debugger sees it."""
        content = ctypes.create_string_buffer(size)
        self._call("read_ram", address, content, size)
        return content.raw

    def level(self, pin: tuple[int, int]) -> bool:
        """A pin's level."""
        return self._call("level", *pin)

    def clock_hz(self, which: int) -> int:
        """0 HCLK, 1 PCLK1, 2 PCLK2."""
        return self._call("clock_hz", which)
