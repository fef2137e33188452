# SPDX-License-Identifier: Apache-2.0
"""Modbus TCP to the one line: whole PDUs go through untouched, whatever their function."""

import asyncio
import ipaddress
import time
from contextlib import suppress

from levelwind.errors import ToolError
from levelwind.line.rtu import EXCEPTION_BIT
from levelwind.line.tcp import GATEWAY_EXCEPTIONS, HEAD, LENGTH_MAX
from levelwind.serve.owner import Answer, Outcome, PortOwner

Network = ipaddress.IPv4Network | ipaddress.IPv6Network
CLIENTS_MAX = 64
IDLE_S = 600.0
"""A client that has said nothing for so long is gone: a cable pulled tells nobody."""
FRAME_S = 10.0
"""A frame that has begun must end within this."""
WRITE_S = 10.0
MAPPED_BITS = 96
"""Before an IPv4 address that is written as one of IPv6: clients are known by the former."""
READING = frozenset({1, 2, 3, 4, 7, 11, 12, 17, 20, 24})
READING_DIAGNOSTICS = frozenset({0, 2, *range(11, 19)})
ILLEGAL_FUNCTION = 0x01
ILLEGAL_VALUE = 0x03
PATH_UNAVAILABLE, TARGET_SILENT = GATEWAY_EXCEPTIONS


def only_reads(pdu: bytes) -> bool:
    """Does this request surely change nothing?"""
    function = pdu[0]
    if function == 8:
        return len(pdu) >= 3 and int.from_bytes(pdu[1:3], "big") in READING_DIAGNOSTICS
    return function in READING or pdu[:2] == bytes([43, 14])


def networks(given: list[str]) -> list[Network]:
    """ADDRESS or ADDRESS/MASK; ToolError if one is neither."""
    return [_network(text) for text in given]


def _network(text: str) -> Network:
    try:
        network = ipaddress.ip_network(text)
    except ValueError as error:
        raise ToolError(
            f"--write-from: {error}. Give one as 192.168.1.7, a network as 192.168.1.0/24."
        ) from None
    mapped = getattr(network.network_address, "ipv4_mapped", None)
    if mapped is not None and network.prefixlen >= MAPPED_BITS:
        return ipaddress.ip_network((mapped, network.prefixlen - MAPPED_BITS))
    return network


def is_whole(pdu: bytes) -> bool:
    """Has this request the length that its function says?

    One that has not could be taken for another unit's answer, and be waited for in vain.
    """
    function, size = pdu[0], len(pdu)
    if function in (1, 2, 3, 4, 5, 6):
        return size == 5
    if function in (7, 11, 12, 17):
        return size == 1
    count_at = {15: 5, 16: 5, 20: 1, 21: 1, 23: 9}.get(function)
    if count_at is not None:
        return size > count_at and size == 1 + count_at + pdu[count_at]
    return size >= 3 if function == 8 else size == {22: 7}.get(function, size)


class Gateway:
    """The server for Modbus TCP. A client has one request under way; the next waits in its pipe."""

    def __init__(self, owner: PortOwner, write_from: list[Network]) -> None:
        self._owner, self._write_from = owner, write_from
        self._server: asyncio.Server | None = None
        self._serving: dict[asyncio.Task[None], float] = {}
        """And when each was last asked something."""

    @property
    def clients(self) -> int:
        """How many are connected."""
        return len(self._serving)

    async def start(self, host: str, port: int) -> int:
        """Listen; the TCP port. ToolError says why not."""
        try:
            self._server = await asyncio.start_server(self._serve, host, port, limit=4096)
        except OSError as error:
            raise ToolError(f"--modbus-tcp {host}:{port}: {error.strerror or error}.") from error
        return int(self._server.sockets[0].getsockname()[1])

    async def close(self) -> None:
        """Hang up."""
        if self._server is not None:
            self._server.close()
        for task in list(self._serving):
            task.cancel()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        if len(self._serving) >= CLIENTS_MAX:
            # As the implementation guide of Modbus TCP has it: one that has gone without a word,
            # or a program that forgets to close, must not keep a PLC out.
            oldest = min(self._serving, key=lambda one: self._serving[one])
            del self._serving[oldest]
            oldest.cancel()
        self._serving[task] = time.monotonic()
        client = object()
        may_write = self._may_write(writer.get_extra_info("peername"))
        try:
            while await self._exchange(client, may_write, reader, writer):
                self._serving[task] = time.monotonic()
        except (OSError, EOFError, TimeoutError, asyncio.TimeoutError, asyncio.CancelledError):
            pass
        finally:
            self._serving.pop(task, None)
            self._owner.forget(client)
            with suppress(OSError):
                writer.close()

    def _may_write(self, peer: tuple[str, int] | None) -> bool:
        if not peer:
            return False
        address = ipaddress.ip_address(peer[0].partition("%")[0])
        mapped = getattr(address, "ipv4_mapped", None)
        return any((mapped or address) in network for network in self._write_from)

    async def _exchange(
        self,
        client: object,
        may_write: bool,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
    ) -> bool:
        """One request and its answer; False where what comes is no Modbus TCP."""
        first = await asyncio.wait_for(reader.readexactly(1), IDLE_S)
        head = first + await asyncio.wait_for(reader.readexactly(HEAD.size - 1), FRAME_S)
        transaction, protocol, length, unit = HEAD.unpack(head)
        if protocol != 0 or not 2 <= length <= LENGTH_MAX:
            return False  # where the next frame begins nobody knows
        pdu = await asyncio.wait_for(reader.readexactly(length - 1), FRAME_S)
        exception = self._refusal(may_write, unit, pdu)
        if exception:
            answer = bytes([pdu[0] | EXCEPTION_BIT, exception])
        else:
            answer = await self._ask(client, unit, pdu)
        if answer:
            writer.write(HEAD.pack(transaction, 0, len(answer) + 1, unit) + answer)
            await asyncio.wait_for(writer.drain(), WRITE_S)
        return True

    def _refusal(self, may_write: bool, unit: int, pdu: bytes) -> int:
        """The exception that is answered without asking the line; 0: none."""
        if not 0 < pdu[0] < EXCEPTION_BIT or not (may_write or only_reads(pdu)):
            return ILLEGAL_FUNCTION
        if not is_whole(pdu):
            return ILLEGAL_VALUE
        return PATH_UNAVAILABLE if unit == 0 and only_reads(pdu) else 0

    async def _ask(self, client: object, unit: int, pdu: bytes) -> bytes:
        loop = asyncio.get_running_loop()
        coming: asyncio.Future[Answer] = loop.create_future()

        def take(answer: Answer) -> None:
            if not coming.done():
                coming.set_result(answer)

        def done(answer: Answer) -> None:
            loop.call_soon_threadsafe(take, answer)

        self._owner.submit(client, unit, pdu, done)
        answer = await coming
        if answer.outcome is Outcome.ANSWERED:
            return answer.pdu
        if unit == 0:
            return b""  # a broadcast
        silent = answer.outcome is Outcome.NO_ANSWER
        return bytes([pdu[0] | EXCEPTION_BIT, TARGET_SILENT if silent else PATH_UNAVAILABLE])
