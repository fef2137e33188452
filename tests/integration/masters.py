# SPDX-License-Identifier: Apache-2.0
"""Four masters that others have written, behind one small interface."""

import ctypes
import ctypes.util
import re
import subprocess
from typing import Protocol

import minimalmodbus
from pymodbus.client import ModbusSerialClient
from pymodbus.pdu import ModbusPDU
from slave import UNIT

READ_FUNCTIONS = {"coil": 1, "discrete": 2, "holding": 3, "input": 4}


MBPOLL_TYPES = {"coil": "0", "discrete": "1", "input": "3", "holding": "4"}
EXCEPTION_TEXTS = {  # of mbpoll and minimalmodbus
    "illegal function": 1,
    "illegal data address": 2,
    "illegal data value": 3,
    "slave device or server is busy": 6,
}


class ExceptionAnswer(Exception):  # noqa: N818
    """The slave answered a Modbus exception."""

    def __init__(self, code: int) -> None:
        super().__init__(f"Modbus exception {code:02d}")
        self.code = code


class Master(Protocol):
    """What every master can do. Bits are read as 0 and 1."""

    def __init__(self, port: str) -> None: ...

    def read(self, space: str, address: int, count: int) -> list[int]:
        """FC01 to FC04."""
        ...

    def write(self, address: int, words: list[int]) -> None:
        """FC06 or FC16, whichever this master uses."""
        ...

    def close(self) -> None: ...


class Pymodbus:
    def __init__(self, port: str) -> None:
        self.client = ModbusSerialClient(port, baudrate=19200, parity="N", timeout=2, retries=0)
        assert self.client.connect()

    def _checked(self, answer: ModbusPDU) -> ModbusPDU:
        if answer.isError():
            raise ExceptionAnswer(answer.exception_code)
        return answer

    def read(self, space: str, address: int, count: int) -> list[int]:
        function = {
            "coil": self.client.read_coils,
            "discrete": self.client.read_discrete_inputs,
            "holding": self.client.read_holding_registers,
            "input": self.client.read_input_registers,
        }[space]
        answer = self._checked(function(address, count=count, device_id=UNIT))
        if space in ("coil", "discrete"):
            return [int(bit) for bit in answer.bits[:count]]
        return answer.registers

    def write(self, address: int, words: list[int]) -> None:
        self._checked(self.client.write_registers(address, words, device_id=UNIT))

    def close(self) -> None:
        self.client.close()


class Libmodbus:
    """The library of the C client, without the C client."""

    EXCEPTION_BASE = 112345678  # MODBUS_ENOBASE

    def __init__(self, port: str) -> None:
        name = ctypes.util.find_library("modbus")
        assert name, "libmodbus is not installed"
        self.library = ctypes.CDLL(name, use_errno=True)
        self.library.modbus_new_rtu.restype = ctypes.c_void_p
        parity = ctypes.c_char(b"N")
        self.context = ctypes.c_void_p(
            self.library.modbus_new_rtu(port.encode(), 19200, parity, 8, 1)
        )
        assert self.library.modbus_set_slave(self.context, UNIT) == 0
        assert self.library.modbus_set_response_timeout(self.context, 2, 0) == 0
        assert self.library.modbus_connect(self.context) == 0

    def _check(self, result: int, expected: int) -> None:
        code = ctypes.get_errno() - self.EXCEPTION_BASE
        if result == -1 and 0 < code < 16:
            raise ExceptionAnswer(code)
        assert result == expected, (result, ctypes.get_errno())

    def read(self, space: str, address: int, count: int) -> list[int]:
        bits = space in ("coil", "discrete")
        values = ((ctypes.c_uint8 if bits else ctypes.c_uint16) * count)()
        function = {
            "coil": self.library.modbus_read_bits,
            "discrete": self.library.modbus_read_input_bits,
            "holding": self.library.modbus_read_registers,
            "input": self.library.modbus_read_input_registers,
        }[space]
        self._check(function(self.context, address, count, values), count)
        return list(values)

    def write(self, address: int, words: list[int]) -> None:
        values = (ctypes.c_uint16 * len(words))(*words)
        result = self.library.modbus_write_registers(self.context, address, len(words), values)
        self._check(result, len(words))

    def report_server_id(self) -> bytes:
        """FC17."""
        answer = (ctypes.c_uint8 * 260)()
        length = self.library.modbus_report_slave_id(self.context, len(answer), answer)
        assert length > 0, ctypes.get_errno()
        return bytes(answer[:length])

    def mask_write(self, address: int, and_mask: int, or_mask: int) -> int:
        """FC22."""
        return self.library.modbus_mask_write_register(self.context, address, and_mask, or_mask)

    def write_and_read(
        self, address: int, words: list[int], read_address: int, count: int
    ) -> list[int]:
        """FC23."""
        values = (ctypes.c_uint16 * len(words))(*words)
        answer = (ctypes.c_uint16 * count)()
        result = self.library.modbus_write_and_read_registers(
            self.context, address, len(words), values, read_address, count, answer
        )
        self._check(result, count)
        return list(answer)

    def close(self) -> None:
        self.library.modbus_close(self.context)
        self.library.modbus_free(self.context)


class Mbpoll:
    """A program: one process for each request."""

    def __init__(self, port: str) -> None:
        self.port = port

    def _run(self, *options: str, write: list[int] | None = None) -> str:
        done = subprocess.run(
            [
                *("mbpoll", "-m", "rtu", "-a", str(UNIT), "-b", "19200", "-P", "none", "-0", "-1"),
                *("-q", "-o", "2", *options, self.port, *map(str, write or [])),
            ],
            capture_output=True,
            text=True,
            timeout=20,
            check=False,
        )
        output = done.stdout + done.stderr
        for text, code in EXCEPTION_TEXTS.items():
            if text in output.lower():
                raise ExceptionAnswer(code)
        assert done.returncode == 0, output
        return output

    def read(self, space: str, address: int, count: int) -> list[int]:
        output = self._run("-t", MBPOLL_TYPES[space], "-r", str(address), "-c", str(count))
        found = re.findall(r"^\[(\d+)\]:\s+(\d+)", output, re.M)
        assert [int(at) for at, _ in found] == list(range(address, address + count)), output
        return [int(value) for _, value in found]

    def write(self, address: int, words: list[int]) -> None:
        self._run("-t", "4", "-r", str(address), write=words)

    def close(self) -> None:
        """Nothing stays open between requests."""


class Minimalmodbus:
    def __init__(self, port: str) -> None:
        self.instrument = minimalmodbus.Instrument(port, UNIT)
        self.instrument.serial.timeout = 0.7  # waited for in vain after every exception

    def _raise(self, error: minimalmodbus.SlaveReportedException) -> None:
        if isinstance(error, minimalmodbus.SlaveDeviceBusyError):
            raise ExceptionAnswer(6) from error
        for text, code in EXCEPTION_TEXTS.items():
            if text in str(error).lower():
                raise ExceptionAnswer(code) from error
        raise error

    def read(self, space: str, address: int, count: int) -> list[int]:
        read = (
            self.instrument.read_bits
            if space in ("coil", "discrete")
            else self.instrument.read_registers
        )
        try:
            return read(address, count, READ_FUNCTIONS[space])
        except minimalmodbus.SlaveReportedException as error:
            self._raise(error)
            raise

    def write(self, address: int, words: list[int]) -> None:
        try:
            self.instrument.write_registers(address, words)
        except minimalmodbus.SlaveReportedException as error:
            self._raise(error)

    def close(self) -> None:
        self.instrument.serial.close()


MASTERS: list[type[Master]] = [Pymodbus, Libmodbus, Mbpoll, Minimalmodbus]
