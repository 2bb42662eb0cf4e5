"""A TCP proxy that breaks websocket connections where it hurts, by a plan.

Each connection gets one :class:`~tests.support.faults.Fault` or none. What is not cut passes
unchanged. Only a cut of a connection that was open on both sides counts.
"""

import asyncio
import socket
import struct
import time
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, replace
from enum import Enum, auto
from random import Random

from tests.support.faults import Delay, How, Where
from tests.support.websocket_pieces import Form, Pieces

LINGER_S = 2.0
"""How long the other side may still speak after one side has ended."""
WAITING_PIECES = 4096
_RESET = struct.pack("ii", 1, 0)


@dataclass(frozen=True, slots=True)
class Cut:
    """A connection that was cut.

    Attributes:
        at_ns: When, on the monotonic clock.
        connection: Which one.
        where: What was hit.
        how: How it ended.
        passed: Bytes that passed of what was hit; 0 between two frames.
        size: How many it has; 0 between two frames.
        type: Type of the message that was hit, if it was one.
    """

    at_ns: int
    connection: int
    where: Where
    how: How
    passed: int = 0
    size: int = 0
    type: str = ""


@dataclass(slots=True)
class Connection:
    """What became of one connection.

    Attributes:
        index: Counts them from 0.
        opened_ns: When the client came, on the monotonic clock.
        welcomed_ns: When the whole welcome had passed, or None.
        ended_by: ``cut``, ``client``, ``server``, or ``refused`` where there was no server; empty
            as long as it is open.
        ended_ns: When it has ended, or None.
        close_code: Code of the close frame that passed last, or None.
    """

    index: int
    opened_ns: int
    welcomed_ns: int | None = None
    ended_by: str = ""
    ended_ns: int | None = None
    close_code: int | None = None

    @property
    def is_live(self):
        """Whether it was welcomed and has not ended."""
        return self.welcomed_ns is not None and not self.ended_by

    def end(self, by, now_ns):
        self.ended_by, self.ended_ns = by, now_ns


class FaultProxy:
    """Stands between clients and a server on this machine.

    Args:
        port: The server's port.
        plan: Gives the fault of the next connection, or None to leave it alone.
        delay: How late bytes pass.
        seed: Of the delays.

    Attributes:
        is_open: Whether connections are let through; else it is as if there were no server.
        cuts: All cuts, in order.
        connections: All connections, in order.
    """

    def __init__(self, port, plan=lambda: None, delay=None, seed=0):
        self.is_open = True
        self.cuts = []
        self.connections = []
        self._port = port
        self._plan = plan
        self._delay = delay or Delay()
        self._random = Random(seed)

    @asynccontextmanager
    async def serving(self):
        """Take connections while the context lasts; gives the port."""
        listener = socket.socket()
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        listener.setblocking(False)
        try:
            async with asyncio.TaskGroup() as group:
                accepting = group.create_task(self._accept(listener))
                yield listener.getsockname()[1]
                accepting.cancel()
        finally:
            listener.close()

    async def _accept(self, listener):
        loop = asyncio.get_running_loop()
        async with asyncio.TaskGroup() as group:
            while True:
                client, _ = await loop.sock_accept(listener)
                record = Connection(len(self.connections), time.monotonic_ns())
                self.connections.append(record)
                group.create_task(self._serve(client, record))

    async def _serve(self, client, record):
        server = socket.socket()
        try:
            for side in (client, server):
                side.setblocking(False)
                side.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            if not (self.is_open and await self._reaches(server)):
                record.end("refused", time.monotonic_ns())
                _reset(client)
                return
            fault = self._plan()
            end = await _Relay(client, server, fault, record, self._delay, self._random).run()
            if isinstance(end, Cut):
                record.end("cut", end.at_ns)
                self.cuts.append(end)
                await _end(client, server, fault)
            elif end is _End.RESET:
                _reset(client)
                _reset(server)
        finally:
            client.close()
            server.close()

    async def _reaches(self, server):
        try:
            await asyncio.get_running_loop().sock_connect(server, ("127.0.0.1", self._port))
        except OSError:
            return False
        return True


class _End(Enum):
    """How a side has ended by itself."""

    FIN = auto()
    RESET = auto()


class _Relay:
    """Passes one connection's bytes on, both ways, until it ends or is to be cut."""

    def __init__(self, client, server, fault, record, delay, random):
        self._client, self._server = client, server
        self._fault = fault
        self._record = record
        self._delay, self._random = delay, random
        self._fitting = 0
        self._is_upgraded = asyncio.Event()

    async def run(self):
        """The cut that is due, or how the connection has ended by itself."""
        pumps = {
            asyncio.create_task(self._pump(self._client, self._server, is_up=True)): "client",
            asyncio.create_task(self._pump(self._server, self._client, is_up=False)): "server",
        }
        timer = asyncio.create_task(self._wait())
        try:
            done, _ = await asyncio.wait({*pumps, timer}, return_when=asyncio.FIRST_COMPLETED)
            ends = [task.result() for task in done]
            if cuts := [end for end in ends if isinstance(end, Cut)]:
                return cuts[0]
            by = next(pumps[task] for task in done)
            self._record.end(by, time.monotonic_ns())
            self._fault = None
            if _End.RESET not in ends:
                done, _ = await asyncio.wait(pumps, timeout=LINGER_S)
                ends = [task.result() for task in done]
            return _End.RESET if _End.RESET in ends else _End.FIN
        finally:
            # A socket must not be closed while the loop still watches it.
            for task in (*pumps, timer):
                task.cancel()
            await asyncio.gather(*pumps, timer, return_exceptions=True)

    async def _wait(self):
        """The cut between two frames."""
        await self._is_upgraded.wait()
        if self._fault is None:
            await asyncio.Event().wait()
        await asyncio.sleep(self._fault.after_s)
        return self._cut(replace(self._fault, where=Where.BETWEEN))

    def _cut(self, fault, passed=0, piece=None):
        size, kind = (0, "") if piece is None else (len(piece.raw), piece.type)
        now_ns = time.monotonic_ns()
        return Cut(now_ns, self._record.index, fault.where, fault.how, passed, size, kind)

    async def _pump(self, source, sink, *, is_up):
        """Pass bytes on until one side ends, or up to the place of the fault."""
        async with asyncio.TaskGroup() as group:
            waiting = asyncio.Queue(WAITING_PIECES)
            reading = group.create_task(self._read(source, waiting))
            try:
                end = await self._write(sink, waiting, is_up=is_up)
            except OSError:
                end = _End.RESET  # the sink is gone
            reading.cancel()
        return end

    async def _read(self, source, waiting):
        """Queue what comes with the time at which it is to pass, and the end of the source."""
        loop = asyncio.get_running_loop()
        pieces = Pieces()
        try:
            while data := await loop.sock_recv(source, 65536):
                due_s = loop.time() + self._delay.draw(self._random)
                for piece in pieces.push(data):
                    await waiting.put((due_s, piece.raw, piece))
            end = _End.FIN
        except OSError:
            end = _End.RESET
        due_s = loop.time() + self._delay.draw(self._random)
        if rest := pieces.flush():
            await waiting.put((due_s, rest, None))
        await waiting.put((due_s, end, None))

    async def _write(self, sink, waiting, *, is_up):
        loop = asyncio.get_running_loop()
        while True:
            due_s, raw, piece = await waiting.get()
            if (wait_s := due_s - loop.time()) > 0:
                await asyncio.sleep(wait_s)
            if isinstance(raw, _End):
                if raw is _End.FIN:
                    sink.shutdown(socket.SHUT_WR)
                return raw
            fault = self._fault
            if fault is not None and piece is not None and fault.fits(piece, is_up):
                self._fitting += 1
                if self._fitting == (1 if piece.form is Form.HEAD else fault.nth):
                    passed = fault.passing(len(raw))
                    await loop.sock_sendall(sink, raw[:passed])
                    return self._cut(fault, passed, piece)
            await loop.sock_sendall(sink, raw)
            if piece is not None:
                self._note(piece, is_up)

    def _note(self, piece, is_up):
        if piece.form is Form.HEAD and not is_up:
            self._is_upgraded.set()
        if piece.type == "welcome":
            self._record.welcomed_ns = time.monotonic_ns()
        if piece.code is not None:
            self._record.close_code = piece.code


def _reset(side):
    """Close so that the other end gets a RST."""
    side.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET)
    side.close()


async def _end(client, server, fault):
    if fault.how is How.FIN:
        with suppress(OSError):
            for side in (client, server):
                side.shutdown(socket.SHUT_WR)
            # A socket that is closed with unread bytes would send a RST.
            async with asyncio.timeout(LINGER_S):
                await asyncio.gather(_drain(client), _drain(server))
        return
    if fault.how is How.HOLE:
        await asyncio.sleep(fault.hold_s)
    _reset(client)
    _reset(server)


async def _drain(side):
    """Read to the end."""
    with suppress(OSError):
        while await asyncio.get_running_loop().sock_recv(side, 65536):
            pass
