# SPDX-License-Identifier: Apache-2.0
"""A controller that is a dictionary of registers."""

from types import SimpleNamespace
from typing import Any

from levelwind.line.points import encode
from levelwind.line.port import Line
from levelwind.line.rtu import Heard
from levelwind.map_table import POINTS, Reason, Result
from pymodbus.exceptions import ModbusIOException

OVERFLOW = 100_001  # a pitch that the fake refuses


class FakeClient:
    """Registers in a dictionary; refuses one value; runs commands with a result to choose."""

    def __init__(self, line: Line) -> None:
        self.line_echoes = False
        self.heard = Heard.NOTHING
        self.other_units: set[int] = set()
        self.registers: dict[tuple[str, int], int] = {}
        self.writes: list[tuple[int, list[int]]] = []
        self.silent_reads = 0
        self.result = Result.DONE
        self.reason = Reason.NONE

    def connect(self) -> bool:
        return True

    def close(self) -> None:
        pass

    def put(self, name: str, value: int) -> None:
        point = POINTS[name]
        for i, word in enumerate(encode(point, value)):
            self.registers[point.space, point.address + i] = word

    def _read(self, space: str, address: int, count: int) -> Any:
        if self.silent_reads:
            self.silent_reads -= 1
            raise ModbusIOException("no answer")
        function = 4 if space == "input" else 3
        words = [self.registers.get((space, address + i), 0) for i in range(count)]
        return SimpleNamespace(function_code=function, registers=words, isError=lambda: False)

    def read_input_registers(self, address: int, count: int, device_id: int) -> Any:
        return self._read("input", address, count)

    def read_holding_registers(self, address: int, count: int, device_id: int) -> Any:
        return self._read("holding", address, count)

    read_coils = read_discrete_inputs = None

    def write_registers(self, address: int, values: list[int], **_: Any) -> Any:
        self.writes.append((address, values))
        if address == POINTS["pitch_um"].address and values[:2] == encode(
            POINTS["pitch_um"], OVERFLOW
        ):
            self.put("last_error_reason", Reason.OUT_OF_RANGE)
            self.put("last_error_exception", 3)
            self.put("last_error_address", address)
            self.put("last_error_value", OVERFLOW)
            self.put("last_error_limit", 100_000)
            return SimpleNamespace(function_code=0x90, isError=lambda: True, exception_code=3)
        for i, word in enumerate(values):
            self.registers["holding", address + i] = word
        if address == POINTS["command"].address:
            sequence = POINTS["command_sequence"].address
            self.registers["input", sequence] = self.registers.get(("input", sequence), 0) + 1
            self.put("command_code", values[0])
            self.put("command_result", self.result)
            self.put("command_reason", self.reason)
        return SimpleNamespace(
            function_code=16, address=address, count=len(values), isError=lambda: False
        )
