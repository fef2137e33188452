# SPDX-License-Identifier: Apache-2.0
"""Other people's Modbus RTU servers: `server.py pymodbus|libmodbus PORT` serves until killed."""

import ctypes
import ctypes.util
import errno
import sys

UNIT = 1
FIRST = 0
COUNT = 200
SCRATCH = COUNT - 2
RESPONSE_MAX = 260
FRAME_END_US = 20_000


def libmodbus() -> ctypes.CDLL:
    """The library that host_tools/c is built with."""
    name = ctypes.util.find_library("modbus")
    assert name, "libmodbus is not installed"
    return ctypes.CDLL(name, use_errno=True)


def serve_pymodbus(port: str) -> None:
    """All four spaces, 200 each, and the identification that it has by itself."""
    from pymodbus.datastore import (  # noqa: PLC0415 - libmodbus does not need it
        ModbusDeviceContext,
        ModbusSequentialDataBlock,
        ModbusServerContext,
    )
    from pymodbus.server import StartSerialServer  # noqa: PLC0415

    def block() -> ModbusSequentialDataBlock:
        return ModbusSequentialDataBlock(FIRST + 1, [0] * COUNT)

    device = ModbusDeviceContext(di=block(), co=block(), ir=block(), hr=block())
    StartSerialServer(
        ModbusServerContext(devices={UNIT: device}, single=False),
        port=port,
        baudrate=19200,
        broadcast_enable=True,
        ignore_missing_devices=True,
        trace_connect=lambda connected: print("ready", flush=True),
    )


def serve_libmodbus(port: str) -> None:
    """All four spaces, 200 each. The loop is that of its own example, unit-test-server.c."""
    library = libmodbus()
    library.modbus_new_rtu.restype = library.modbus_mapping_new.restype = ctypes.c_void_p
    context = ctypes.c_void_p(
        library.modbus_new_rtu(port.encode(), 19200, ctypes.c_char(b"N"), 8, 1)
    )
    mapping = ctypes.c_void_p(library.modbus_mapping_new(*[FIRST + COUNT] * 4))
    library.modbus_set_slave(context, UNIT)
    # The half second that it waits by itself, also before every exception, is for slow lines.
    library.modbus_set_response_timeout(context, 0, FRAME_END_US)
    library.modbus_set_byte_timeout(context, 0, FRAME_END_US)
    assert library.modbus_connect(context) == 0
    print("ready", flush=True)
    request = ctypes.create_string_buffer(RESPONSE_MAX)
    while True:
        length = library.modbus_receive(context, request)
        if length > 0:
            library.modbus_reply(context, request, length, mapping)
        elif length < 0 and ctypes.get_errno() in (errno.EIO, errno.EBADF, errno.ENODEV):
            return


if __name__ == "__main__":
    {"pymodbus": serve_pymodbus, "libmodbus": serve_libmodbus}[sys.argv[1]](sys.argv[2])
