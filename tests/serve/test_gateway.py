# SPDX-License-Identifier: Apache-2.0
"""Modbus TCP: the same bytes as the serial line, fairly, and whatever comes."""

import ctypes
import random
import statistics
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command, Event
from levelwind.serve.gateway import is_whole, only_reads
from levelwind.simulate import simulator
from masters import Libmodbus, Pymodbus
from pymodbus.client import ModbusTcpClient
from served import RawTcp, Served, free_port, wait
from slave import RawLine
from test_masters import read_everything

Start = Callable[..., Served]
PITCH = POINTS["pitch_um"].address
PULSES = POINTS["encoder_pulses_per_rev"].address
READ_LIVE = bytes([4, 0, 100, 0, 20])


class PymodbusTcp(Pymodbus):
    def __init__(self, port: int) -> None:
        self.client = ModbusTcpClient("127.0.0.1", port=port, timeout=3, retries=0)
        assert self.client.connect()


class LibmodbusTcp(Libmodbus):
    def __init__(self, port: int) -> None:
        self.library = ctypes.CDLL(ctypes.util.find_library("modbus"), use_errno=True)
        self.library.modbus_new_tcp.restype = ctypes.c_void_p
        self.context = ctypes.c_void_p(self.library.modbus_new_tcp(b"127.0.0.1", port))
        assert self.library.modbus_set_slave(self.context, 1) == 0
        assert self.library.modbus_set_response_timeout(self.context, 3, 0) == 0
        assert self.library.modbus_connect(self.context) == 0


# Every function code, in order and refused. None depends on the time; counters are not read.
REQUESTS = [
    *(bytes([function, 0, 0, 0, 9]) for function in (1, 2)),
    *(bytes([3, PITCH >> 8, PITCH & 255, 0, n]) for n in (1, 2, 3, 0, 126)),
    bytes([4, 0, 0, 0, 10]),
    bytes([4, 0, 50, 0, 1]),
    *(bytes([5, 0, 200, 255, 0]), bytes([5, 0, 4, 255, 0])),  # no such coil; revert
    *(bytes([6, PULSES >> 8, PULSES & 255, n >> 8, n & 255]) for n in (0, 500)),
    *(bytes([8, 0, n, 0x12, 0x34]) for n in (0, 99)),
    bytes([15, 0, 200, 0, 1, 1, 1]),
    bytes([16, PITCH >> 8, PITCH & 255, 0, 2, 4, 0, 0, 0x2A, 0xF8]),
    bytes([16, PITCH >> 8, PITCH & 255, 0, 2, 4, 0, 0, 0, 0]),
    bytes([17]),
    bytes([20, 7, 6, 0, 1, 0, 0, 0, 4]),
    bytes([20, 14, 6, 0, 1, 0, 0, 0, 4, 6, 0, 1, 0, 16, 0, 4]),
    bytes([20, 7, 6, 0, 9, 0, 0, 0, 4]),
    bytes([21, 9, 6, 0, 9, 0, 0, 0, 1, 1, 1]),
    bytes([22, PULSES >> 8, PULSES & 255, 0xFF, 0, 0, 0x42]),
    bytes([23, PULSES >> 8, PULSES & 255, 0, 1, PULSES >> 8, PULSES & 255, 0, 1, 2, 2, 0]),
    *(bytes([43, 14, code, 0]) for code in (1, 2, 3, 4)),
    bytes([43, 13, 0, 0]),
    *(bytes([function, 1, 2, 3]) for function in (9, 65, 100, 127)),
    *(bytes([function]) for function in (7, 11, 12, 24)),
]


def rest(request: Callable[[bytes], bytes]) -> None:
    """Until the drum counts as at rest, after the power-up."""
    wait(lambda: request(bytes([2, 0, 4, 0, 1])) == b"\x02\x01\x01", what="rest")


def over_tcp(port: int) -> list[bytes]:
    raw = RawTcp(port)
    rest(raw.request)
    answers = [raw.request(pdu) for pdu in REQUESTS]
    raw.close()
    return answers


def without_time(answers: list[bytes]) -> list[bytes]:
    """The event log's records carry the time of an event, in ms since power-up."""
    return [a[:4] + a[16:] if a[:1] == b"\x14" else a for a in answers]


def test_every_function_is_the_line_byte_for_byte(start: Start, tmp_path: Path) -> None:
    """Three fresh machines, the same requests: by the line, by the gateway, by sim --tcp."""
    port = str(tmp_path / "line")
    with simulator.Simulator(simulator.arguments(port)):
        line = RawLine(port)
        rest(line.request)
        by_line = [line.request(pdu) for pdu in REQUESTS if is_whole(pdu)]
        line.close()
    served = start()
    by_gateway = over_tcp(served.gate)
    with simulator.Simulator(simulator.arguments(None, tcp=f"127.0.0.1:{free_port()}")) as running:
        by_simulator = over_tcp(int(running.port.rpartition(":")[2]))
    whole = [is_whole(pdu) for pdu in REQUESTS]
    assert without_time(by_line) == without_time(
        [answer for answer, ok in zip(by_gateway, whole, strict=True) if ok]
    )
    assert without_time(by_gateway) == without_time(by_simulator)
    assert sum(not answer[0] & 0x80 for answer in by_line) > 15


def test_masters_of_others_read_what_the_line_says(start: Start) -> None:
    served = start()
    served.index()
    read = []
    for master in (PymodbusTcp(served.gate), LibmodbusTcp(served.gate), PymodbusTcp(served.gate)):
        read.append(read_everything(master))
        master.close()
    assert served.stop() in (0, 130)
    line = Pymodbus(str(served.port))
    read.append(read_everything(line))
    line.close()
    steady = {at: value for at, value in read[0].items() if read[2][at] == read[3][at] == value}
    assert len(steady) > 0.9 * len(read[0])
    assert {at: read[1][at] for at in steady} == steady


def test_libmodbus_writes_through_the_gateway(start: Start) -> None:
    served = start()
    master = LibmodbusTcp(served.gate)
    master.write(PITCH, [0, 11_000])
    assert master.read("holding", PITCH, 2) == [0, 11_000]
    assert master.mask_write(PULSES, 0xFF00, 0x0042) == 1
    assert master.write_and_read(PULSES, [500], PULSES, 1) == [500]
    assert master.report_server_id()[:1] == b"L"
    master.close()


def test_the_simulator_listens_where_it_is_told_or_says_why_not(
    capfd: pytest.CaptureFixture[str],
) -> None:
    """A port beyond 65535 was taken modulo 65536."""
    for bad in ("127.0.0.1:65536", "127.0.0.1:99999", "127.0.0.1:", ":1502", "127.0.0.1"):
        with pytest.raises(ToolError):
            simulator.Simulator(simulator.arguments(None, tcp=bad)).end()
        assert f"{bad}: give ADDRESS:PORT" in capfd.readouterr().err


def test_transactions_and_order(start: Start) -> None:
    raw = RawTcp(start().gate)
    for number in (0xFFFF, 0, 7, 7, 3):
        raw.send(READ_LIVE, transaction=number)
    assert [raw.receive()[0] for _ in range(5)] == [0xFFFF, 0, 7, 7, 3]
    raw.close()


def test_path_unavailable_and_no_answer(start: Start) -> None:
    served = start("--timeout", "0.3")
    raw = RawTcp(served.gate)
    assert raw.request(READ_LIVE)[0] == 4
    assert raw.request(READ_LIVE, unit=9) == b"\x84\x0b"
    began = time.monotonic()
    assert [raw.request(READ_LIVE, unit=n) for n in range(10, 40)] == [b"\x84\x0b"] * 30
    assert time.monotonic() - began < 1, "units that are not there hold up the line"
    assert raw.request(READ_LIVE, unit=255) == b"\x84\x0a"
    assert raw.request(READ_LIVE, unit=0) == b"\x84\x0a"
    served.simulator.end()
    wait(lambda: raw.request(READ_LIVE) == b"\x84\x0a", what="0A")
    served.start_simulator()
    wait(lambda: raw.request(READ_LIVE)[0] == 4, what="it is back")
    raw.close()


def test_broadcast(start: Start) -> None:
    served = start()
    raw = RawTcp(served.gate)
    raw.send(bytes([16, PITCH >> 8, PITCH & 255, 0, 2, 4, 0, 0, 0x2A, 0xF8]), unit=0)
    sent = raw.send(bytes([3, PITCH >> 8, PITCH & 255, 0, 2]))
    number, unit, answer = raw.receive()
    assert (number, unit) == (sent, 1)
    assert answer == bytes([3, 4, 0, 0, 0x2A, 0xF8])
    raw.close()


def test_read_only_means_read_only(start: Start) -> None:
    """Every function code with bodies that fit, from a client that may not write."""
    served = start(write=False)
    chosen = random.Random(3)
    raw = RawTcp(served.gate)
    bodies = [pdu[1:] for pdu in REQUESTS]
    bodies += [chosen.randbytes(chosen.randrange(0, 30)) for _ in range(40)]
    before = raw.request(bytes([3, 0, 110, 0, 60]))
    allowed = set()
    for function in range(256):
        for body in bodies:
            pdu = bytes([function]) + body
            answer = raw.request(pdu)
            if not only_reads(pdu):
                assert answer == bytes([function | 0x80, 1]), pdu.hex()
            elif not answer[0] & 0x80:
                allowed.add(function)
    assert allowed == {1, 2, 3, 4, 8, 17, 20, 43}
    assert raw.request(bytes([3, 0, 110, 0, 60])) == before
    raw.close()
    with served.device() as device:
        assert device.value("command_sequence") == 0
        with pytest.raises(ToolError, match="illegal function"):
            device.command(Command.INDEX)


def test_every_command_over_tcp_and_over_a_serial_gateway(start: Start, tmp_path: Path) -> None:
    """What `levelwind --port` takes: the tool's own device over both."""
    served = start()
    with served.device() as device:
        assert device.value("self_test")
        assert device.read_file(1, 0, 4)
    port = str(tmp_path / "line")
    with (
        simulator.Simulator(simulator.arguments(port)),
        SerialGateway(port) as number,
        Device(Line(f"rtu+tcp://127.0.0.1:{number}")) as device,
    ):
        wait(lambda: device.value("drum_at_rest"))
        device.command(Command.INDEX, limit_s=60)
        assert device.value("indexed") == 1


class SerialGateway:
    """Hands bytes on between a connection and a port, as a terminal server does."""

    def __init__(self, port: str) -> None:
        import socket  # noqa: PLC0415

        import serial  # noqa: PLC0415

        self.line = serial.Serial(port, timeout=0.02)
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self._run)

    def __enter__(self) -> int:
        self.thread.start()
        return self.listening.getsockname()[1]

    def _run(self) -> None:
        connection, _ = self.listening.accept()
        connection.settimeout(0.005)
        while not self.ended.is_set():
            try:
                data = connection.recv(300)
                if not data:
                    break
                self.line.write(data)
            except TimeoutError:
                pass
            connection.sendall(self.line.read(self.line.in_waiting or 1))
        connection.close()

    def __exit__(self, *_: object) -> None:
        self.ended.set()
        self.thread.join()
        self.line.close()
        self.listening.close()


def latencies_ms(ask: Callable[[], object], count: int) -> list[float]:
    taken = []
    for _ in range(count):
        began = time.perf_counter()
        ask()
        taken.append(1000 * (time.perf_counter() - began))
    return sorted(taken)


def test_what_the_gateway_adds(start: Start, tmp_path: Path) -> None:
    """A read of 20 registers, one client: median beside the line's own. The page polls."""
    port = str(tmp_path / "line")
    with simulator.Simulator(simulator.arguments(port)), Device(Line(port)) as device:
        points = [p for p in POINTS.values() if p.space == "input" and 100 <= p.address < 120]
        device.read(points)
        by_line = latencies_ms(lambda: device.read(points), 300)
    served = start()
    raw = RawTcp(served.gate)
    by_gateway = latencies_ms(lambda: raw.request(READ_LIVE), 300)
    raw.close()
    added = statistics.median(by_gateway) - statistics.median(by_line)
    print(
        f"line {statistics.median(by_line):.2f} ms, gateway {statistics.median(by_gateway):.2f} ms"
    )
    assert added <= 5


def test_eight_clients_are_served_alike_and_the_page_not_forgotten(start: Start) -> None:
    served = start()
    wait(served.sees)
    counts, ended = [0] * 8, threading.Event()
    worst_ms = [0.0] * 8

    def ask(index: int) -> None:
        raw = RawTcp(served.gate)
        while not ended.is_set():
            began = time.perf_counter()
            raw.request(READ_LIVE)
            worst_ms[index] = max(worst_ms[index], 1000 * (time.perf_counter() - began))
            counts[index] += 1
        raw.close()

    threads = [threading.Thread(target=ask, args=(index,)) for index in range(8)]
    for thread in threads:
        thread.start()
    oldest_s = 0.0
    end = time.monotonic() + 6
    while time.monotonic() < end:
        oldest_s = max(oldest_s, served.status()["age_s"])
        time.sleep(0.05)
    ended.set()
    for thread in threads:
        thread.join()
    print(
        f"requests {counts}, worst {max(worst_ms):.0f} ms, page's data at most {oldest_s:.2f} s old"
    )
    assert min(counts) > 50
    assert max(counts) <= 1.1 * min(counts)
    assert oldest_s < 0.7


def hostile(chosen: random.Random) -> bytes:
    """A frame cut, glued, of a wrong length or protocol, or any bytes."""
    good = chosen.choice(REQUESTS)
    length = chosen.choice([len(good) + 1, 0, 1, 255, 256, 65535, chosen.randrange(65536)])
    protocol = chosen.choice([0, 0, 0, 1, 65535])
    head = chosen.randbytes(2) + protocol.to_bytes(2, "big") + length.to_bytes(2, "big")
    frame = head + bytes([chosen.choice([1, 1, 0, 247, 255])]) + good
    kind = chosen.randrange(4)
    if kind == 0:
        return frame[: chosen.randrange(len(frame) + 1)]
    if kind == 1:
        return frame + chosen.randbytes(chosen.randrange(20))
    return frame if kind == 2 else chosen.randbytes(chosen.randrange(1, 300))


FRAMES = 100_000


def test_hostile_frames(start: Start) -> None:
    """100,000 of them, in lots; a good client beside them always has the right answer, in time."""
    served = start("--timeout", "0.2", write=False)
    good = RawTcp(served.gate)
    expected = good.request(bytes([3, 0, 110, 0, 40]))
    chosen = random.Random(7)
    slowest_s, sent, lots = 0.0, 0, 0
    while sent < FRAMES:
        bad = RawTcp(served.gate)
        lot = chosen.randrange(1, 200)
        bad.socket.settimeout(0.002)
        try:
            for _ in range(lot):
                bad.socket.sendall(hostile(chosen))
                sent += 1
            bad.socket.recv(4096)
        except OSError:
            pass
        bad.close()
        lots += 1
        if lots % 10 == 0:
            began = time.monotonic()
            assert good.request(bytes([3, 0, 110, 0, 40])) == expected
            slowest_s = max(slowest_s, time.monotonic() - began)
    print(f"{sent} frames in {lots} connections, a good client waited {slowest_s:.2f} s at most")
    assert slowest_s < 2
    assert served.status()["age_s"] < 1
    good.close()


def test_a_client_that_stops_in_a_frame_stops_nobody(start: Start) -> None:
    served = start()
    half = RawTcp(served.gate)
    half.socket.sendall(b"\x00\x01\x00\x00\x00\x06\x01")
    raw = RawTcp(served.gate)
    assert raw.request(READ_LIVE)[0] == 4
    half.close()
    raw.close()


def test_power_up_is_one_event(start: Start) -> None:
    """FC20 through the gateway gives the log in words."""
    from levelwind.line import event_log  # noqa: PLC0415

    with start().device() as device:
        assert event_log.read(device)[0].event == Event.POWER_UP
