"""A connection that comes back: opens, greets, keeps itself alive, waits, and opens again."""

import asyncio
import logging
import secrets
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from random import Random
from typing import Any

from msgspec.structs import replace
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from agent_server import __version__
from agent_server.client.backoff import CAP_S, Backoff
from agent_server.client.once import ConnectionFailed, socket_address
from agent_server.clock import Clock, SystemClock
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.clock_estimate import ClockEstimate
from agent_server.protocol.codec import CODECS
from agent_server.protocol.codes import (
    CLOSE_CODES,
    CLOSE_NORMAL,
    CLOSE_WRONG_VERSION,
    Retry,
)
from agent_server.protocol.connection import HEARTBEAT, SILENT_HEARTBEATS
from agent_server.protocol.convert import unpack_pose_stream
from agent_server.protocol.inputs import packed

log = logging.getLogger(__name__)

WELCOME_WITHIN_S = 10.0
MAX_WAITING = 256
TICK_S = 0.01
CLOSE_ABNORMAL = 1006
_RETRY = {code.code: code.retry for code in CLOSE_CODES}


class Phase(StrEnum):
    """Life of a link (docs/clients.md)."""

    STOPPED = "stopped"
    OPENING = "opening"
    GREETING = "greeting"
    LIVE = "live"
    WAITING = "waiting"


@dataclass(frozen=True, slots=True)
class Options:
    """What a client is and says of itself.

    Attributes:
        url: Address of the server, ``ws://`` or ``http://``.
        session: Id of the session.
        client: What it is called, for people.
        client_version: Its version, for people.
        token: Secret that admits it, where one is needed.
        subprotocol: Which coding to speak.
        take_over: Replace the sensor or acting renderer that is there.
        hello: Fields of hello beside these, by name.
    """

    url: str
    session: str
    client: str = "agent-server-client"
    client_version: str = __version__
    token: str | None = None
    subprotocol: str = m.SUBPROTOCOL_JSON
    take_over: bool = False
    hello: dict[str, Any] = field(default_factory=dict)


class Link:
    """One role's connection to a session, again and again.

    Args:
        options: What the client is.
        role: What it comes as.
        resume: Fields of hello that say what is known from before.
        welcomed: Called with each welcome, before any other message of its connection.
        received: Called with each message of the session.
        capabilities: What the client can do, beside answering pings.
        clock: Where to read the time.
        random: Where waiting times come from.

    Attributes:
        role: What it comes as.
        phase: Where it is in its life.
        fault: Why the last connection ended, in words; empty while all is well.
        clock_estimate: The server's clock and how far away it is.
        connections: How many were welcomed.
    """

    def __init__(
        self,
        options: Options,
        role: m.Role,
        *,
        welcomed: Callable[[m.Welcome], None],
        received: Callable[[m.Message], None],
        resume: Callable[[], dict[str, Any]] = dict,
        capabilities: tuple[str, ...] = (),
        clock: Clock | None = None,
        random: Random | None = None,
    ) -> None:
        self._options = options
        self.role: m.Role = role
        self._codec = CODECS[options.subprotocol]
        self._welcomed = welcomed
        self._received = received
        self._resume = resume
        self._capabilities = [HEARTBEAT, *capabilities]
        self._clock = clock or SystemClock()
        self._backoff = Backoff((random or Random()).random)  # noqa: S311 - it spreads load
        self._instance = secrets.token_hex(8)
        self._epoch: str | None = None
        self._heard_ns = 0
        self._socket: ClientConnection | None = None
        self._waiting: asyncio.Queue[m.Message] = asyncio.Queue(MAX_WAITING)
        self.phase = Phase.STOPPED
        self.fault = ""
        self.clock_estimate = ClockEstimate()
        self.connections = 0

    async def run(self) -> None:
        """Keep connected until cancelled, which says goodbye.

        Raises:
            ConnectionFailed: If the server says that coming back is of no use.
        """
        loop = asyncio.get_running_loop()
        try:
            while True:
                retry = await self._connect()
                if retry is Retry.NEVER:
                    raise ConnectionFailed(f"{self._options.url}: {self.fault}")
                soon_s = self._backoff.next_s(loop.time())
                self.phase = Phase.WAITING
                await asyncio.sleep(CAP_S if retry is Retry.LATER else soon_s)
        finally:
            self.phase = Phase.STOPPED

    async def send(self, message: m.Message) -> bool:
        """Send a message now; False if there is no live connection, and it was not sent."""
        socket = self._socket
        if self.phase is not Phase.LIVE or socket is None:
            return False
        try:
            await socket.send(self._encode(message))
        except ConnectionClosed:
            return False
        return True

    def post(self, message: m.Message) -> bool:
        """Send a message soon, after those posted before; False if it will not be."""
        if self.phase is not Phase.LIVE or self._waiting.full():
            return False
        self._waiting.put_nowait(message)
        return True

    async def _connect(self) -> Retry:
        """One attempt, and the connection that comes of it; tells when to try again."""
        self.phase = Phase.OPENING
        address = socket_address(self._options.url, self._options.session, self.role)
        try:
            socket = await connect(
                address,
                subprotocols=[Subprotocol(self._codec.subprotocol)],
                compression=None,
                max_size=None,
                ping_interval=None,  # the protocol has pings of its own
                close_timeout=1.0,
            )
        except (OSError, WebSocketException, TimeoutError, EOFError) as error:
            self.fault = f"cannot connect to {address}: {error}"
            return Retry.SOON
        try:
            await self._greet(socket)
            await self._live(socket)
        except asyncio.CancelledError:
            await socket.close(CLOSE_NORMAL)
            raise
        except ConnectionClosed as closed:
            self.fault = self.fault or f"the connection was lost: {closed}"
        except _Given as given:
            # No goodbye: the server is to keep the place for the next connection.
            socket.transport.abort()
            self.fault = str(given)
            return given.retry
        finally:
            self._socket = None
            self.phase = Phase.WAITING
        return _retry_after(socket)

    async def _greet(self, socket: ClientConnection) -> None:
        self.phase = Phase.GREETING
        self.fault = ""
        try:
            async with asyncio.timeout(WELCOME_WITHIN_S):
                await socket.send(self._codec.encode(self._hello()))
                while (answer := self._decode(await socket.recv())) is None:
                    pass
                if isinstance(answer, m.ErrorMessage):
                    await socket.wait_closed()
        except TimeoutError:
            raise _Given("no welcome came in time") from None
        match answer:
            case m.Welcome():
                self._enter(socket, answer)
            case m.ErrorMessage(message=message):
                raise _Given(message, _retry_after(socket))
            case _:
                raise _Given("hello was not answered with welcome")

    def _hello(self) -> m.Hello:
        options = self._options
        hello = m.Hello(
            protocol=m.PROTOCOL,
            client=options.client,
            client_version=options.client_version,
            token=options.token,
            session=options.session,
            role=self.role,
            capabilities=self._capabilities,
            instance=self._instance,
            take_over=options.take_over,
            last_epoch=self._epoch,
        )
        return replace(hello, **{**options.hello, **self._resume()})

    def _enter(self, socket: ClientConnection, welcome: m.Welcome) -> None:
        if welcome.protocol.partition(".")[0] != str(m.PROTOCOL_MAJOR):
            raise _Given(
                f"the server speaks protocol {welcome.protocol}, this client {m.PROTOCOL}",
                _RETRY[CLOSE_WRONG_VERSION],
            )
        self._epoch = welcome.epoch
        self._heard_ns = self._clock.now_ns()
        self._waiting = asyncio.Queue(MAX_WAITING)
        # A restarted server may have another clock.
        self.clock_estimate = ClockEstimate()
        self._socket = socket
        self._backoff.reset()
        self.connections += 1
        self.phase = Phase.LIVE
        self._heartbeat_s = welcome.heartbeat_s
        self._welcomed(welcome)

    async def _live(self, socket: ClientConnection) -> None:
        """Read until the connection ends; what keeps it alive lives as long."""
        tasks = (
            asyncio.create_task(self._beat(socket), name="heartbeat"),
            asyncio.create_task(self._watch(socket), name="silence"),
            asyncio.create_task(self._write(socket), name="writer"),
        )
        try:
            while True:
                message = self._decode(await socket.recv())
                if message is not None:
                    self._take(message)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    def _take(self, message: m.Message) -> None:
        now_ns = self._clock.now_ns()
        self._heard_ns = now_ns
        match message:
            case m.Ping(sent_ns=sent_ns):
                self.post(m.Pong(sent_ns, now_ns))
            case m.Pong(sent_ns=sent_ns, time_ns=time_ns):
                jump_ns = self.clock_estimate.push(sent_ns, time_ns, now_ns)
                if jump_ns is not None:
                    log.warning("the server's clock, or this one, jumped by %d ns", jump_ns)
            case m.ErrorMessage(message=sentence, fatal=True):
                self.fault = sentence
                self._received(message)
            case _:
                self._received(message)

    async def _beat(self, socket: ClientConnection) -> None:
        with suppress(ConnectionClosed):
            while True:
                await socket.send(self._codec.encode(m.Ping(self._clock.now_ns())))
                await asyncio.sleep(self._heartbeat_s)

    async def _watch(self, socket: ClientConnection) -> None:
        """Give up a connection on which nothing comes, even while sending is stuck in it."""
        limit_s = SILENT_HEARTBEATS * self._heartbeat_s
        while (silent_s := (self._clock.now_ns() - self._heard_ns) / NS_PER_S) <= limit_s:  # noqa: ASYNC110
            await asyncio.sleep(limit_s - silent_s + TICK_S)
        self.fault = f"nothing was heard for {silent_s:.1f} s"
        socket.transport.abort()

    async def _write(self, socket: ClientConnection) -> None:
        with suppress(ConnectionClosed):
            while True:
                await socket.send(self._encode(await self._waiting.get()))

    def _encode(self, message: m.Message) -> str | bytes:
        if self._codec.subprotocol == m.SUBPROTOCOL_MSGPACK:
            message = packed(message)
        return self._codec.encode(message)

    def _decode(self, data: str | bytes) -> m.Message | None:
        """A message, or None for one that only a newer version knows."""
        try:
            message = self._codec.decode_server(data)
            if isinstance(message, m.PackedPoseStreamMessage):
                message = unpack_pose_stream(message)
            return message
        except InvalidInput as error:
            if error.code == "unknown_type":
                return None
            raise _Given(f"the server sent what cannot be read: {error}") from error


def _retry_after(socket: ClientConnection) -> Retry:
    """When to come back after a connection that has ended."""
    return _RETRY.get(socket.close_code or CLOSE_ABNORMAL, Retry.SOON)


class _Given(Exception):
    """The client gives a connection up."""

    def __init__(self, sentence: str, retry: Retry = Retry.SOON) -> None:
        super().__init__(sentence)
        self.retry = retry
