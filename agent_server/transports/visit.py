"""A client's stay, from its hello to its end."""

import asyncio
import logging
from dataclasses import dataclass

import msgspec
from fastapi import WebSocketDisconnect

from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import InvalidInput
from agent_server.protocol import codes
from agent_server.protocol import connection as c
from agent_server.protocol import messages as m
from agent_server.protocol.codec import Wire
from agent_server.protocol.pace import Pace
from agent_server.service.audience import Client
from agent_server.service.auth import Access, NotAdmitted
from agent_server.service.hub import Hub, HubFull, HubStopping
from agent_server.service.mailbox import Outbox, Overflow
from agent_server.service.session import Session
from agent_server.transports.link import Link

log = logging.getLogger(__name__)

GOODBYES = (codes.CLOSE_NORMAL, codes.CLOSE_GOING_AWAY)
"""How a client closes that does not mean to come back; a page that is left says the second."""
FAREWELL_S = 2.0


@dataclass(frozen=True, slots=True)
class Entrance:
    """Who is admitted, and what the handshake has shown."""

    access: Access
    token: str | None

    def admit(self, hello: m.Hello, session_id: str, role: m.Role) -> int | None:
        """Until when the client may stay, on the wall clock; None means for good.

        Raises:
            NotAdmitted: If it may not come in.
        """
        admitted = self.access.admit(hello.token or self.token)
        admitted.require(session_id, role)
        return admitted.expires_ns


class Visit:
    """One client's stay.

    Args:
        hub: Where it comes in.
        link: Its connection.
        session_id: The session that it names.
        role: What it comes as.
        entrance: Whether it is admitted.
    """

    def __init__(
        self, hub: Hub, link: Link, session_id: str, role: m.Role, entrance: Entrance
    ) -> None:
        server = hub.settings.server
        self._hub = hub
        self._link = link
        self._session_id = session_id
        self._entrance = entrance
        self._stay_until_ns: int | None = None
        self._pace = Pace(server.max_messages_per_s)
        self._connection = c.ServerConnection(
            session_id,
            role,
            link.codec,
            max_message_bytes=server.max_message_bytes,
            max_image_bytes=server.max_image_bytes,
            max_errors=server.max_errors,
            heartbeat_ns=to_ns(server.heartbeat_s),
        )
        self._said_goodbye = False
        self._outbox = Outbox(server.command_queue)
        self._client: Client | None = None
        self._session: Session | None = None

    async def run(self) -> None:
        """Stay until either side closes the connection."""
        try:
            async with asyncio.TaskGroup() as group:
                writer = group.create_task(self._write())
                timeout = self._hub.settings.server.hello_timeout_s
                reader = group.create_task(self._read(timeout))
                closing = group.create_task(self._outbox.closing())
                heart = group.create_task(self._beat())
                tasks = (reader, writer, closing, heart)
                await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                # Whoever ends first ends the visit; the writer may still send what it has, but
                # a client that takes nothing any more does not keep its place.
                self._outbox.close(codes.CLOSE_NORMAL, "")
                reader.cancel()
                await asyncio.wait((writer,), timeout=FAREWELL_S)
                for task in tasks:
                    task.cancel()
        except* WebSocketDisconnect:
            log.debug("session %s: a %s left", self._session_id, self._connection.role)
        finally:
            self._connection.close()
            if self._session is not None and self._client is not None:
                self._hub.leave(self._session, self._client, for_good=self._said_goodbye)

    async def _read(self, hello_timeout_s: float) -> None:
        try:
            async with asyncio.timeout(hello_timeout_s):
                await self._take(await self._link.receive())
        except TimeoutError:
            self._refuse(
                c.Refused(
                    m.ErrorMessage("no_hello", "no hello came in time", fatal=True),
                    codes.CLOSE_HELLO_TIMEOUT,
                )
            )
        while self._connection.state is c.State.OPEN:
            try:
                data = await self._link.receive()
            except WebSocketDisconnect as disconnect:
                self._said_goodbye = disconnect.code in GOODBYES
                raise
            # Somebody may have taken this client's place while it was sending.
            if self._outbox.close_code is not None:
                return
            await self._take(data)
            wait_ns = self._pace.wait_ns(self._hub.clock.now_ns())
            if wait_ns is not None:
                # Others' turn, however much this client has sent.
                await asyncio.sleep(wait_ns / NS_PER_S)

    async def _take(self, data: Wire) -> None:
        event = self._connection.receive(data, self._hub.clock.now_ns())
        match event:
            case c.Received(message):
                assert self._session is not None  # noqa: S101 - OPEN means that it has joined
                assert self._client is not None  # noqa: S101
                try:
                    self._session.receive(self._client, message)
                except InvalidInput as error:
                    self._refuse(self._connection.refuse(error))
            case c.Reply(message):
                self._post(message)
            case c.ClockJumped(by_ns):
                assert self._session is not None  # noqa: S101
                assert self._client is not None  # noqa: S101
                self._session.warn_of_jump(self._client, by_ns)
            case c.Refused():
                self._refuse(event)
            case c.Greeted(hello):
                self._join(hello)

    def _join(self, hello: m.Hello) -> None:
        role = self._connection.role
        try:
            self._stay(self._entrance.admit(hello, self._session_id, role))
        except NotAdmitted as error:
            log.info("session %s: a %s was refused: %s", self._session_id, role, error.code)
            self._refuse(_not_admitted(error))
            return
        # Nothing from here on needs to know the secret.
        hello = msgspec.structs.replace(hello, token=None)
        client = Client(role, hello, self._outbox, self._connection.clock)
        try:
            session = self._hub.join(self._session_id, client)
        except HubFull as error:
            self._refuse(
                c.Refused(m.ErrorMessage("full", str(error), fatal=True), codes.CLOSE_FULL)
            )
            return
        except HubStopping:
            self._refuse(
                c.Refused(
                    m.ErrorMessage("stopping", "the server is stopping", fatal=True),
                    codes.CLOSE_GOING_AWAY,
                )
            )
            return
        except InvalidInput as error:
            self._refuse(
                c.Refused(
                    m.ErrorMessage(error.code, str(error), error.field, fatal=True),
                    codes.CLOSE_REPLACED,
                )
            )
            return
        self._client, self._session = client, session
        # Before anything that the session has for this client.
        self._outbox.precede(self._hub.welcome(session, client))

    def _stay(self, expires_ns: int | None) -> None:
        """Note when the token expires, by a clock that nobody sets."""
        if expires_ns is not None:
            clock = self._hub.clock
            self._stay_until_ns = clock.now_ns() + expires_ns - clock.wall_ns()

    def _refuse(self, refused: c.Refused) -> None:
        if self._session is not None:
            self._session.counters["rejected_messages"] += 1
        self._post(refused.error)
        if refused.close_code is not None:
            self._outbox.close(refused.close_code, refused.error.message)
            self._connection.close()

    def _post(self, message: m.Message) -> None:
        try:
            self._outbox.post(message)
        except Overflow:
            self._outbox.close(codes.CLOSE_TOO_SLOW, "too many answers wait; read faster")

    async def _beat(self) -> None:
        """Ping the client once it is welcome; only the latest ping waits for a slow one."""
        heartbeat_s = self._hub.settings.server.heartbeat_s
        while True:
            await asyncio.sleep(heartbeat_s)
            if self._connection.state is not c.State.OPEN:
                continue
            now_ns = self._hub.clock.now_ns()
            if self._stay_until_ns is not None and now_ns >= self._stay_until_ns:
                sentence = "the token has expired: come back with a new one"
                self._refuse(_not_admitted(NotAdmitted(sentence, code="token_expired")))
                continue
            match self._connection.beat(now_ns):
                case c.Reply(message):
                    self._outbox.update("ping", message)
                case c.Refused() as refused:
                    self._refuse(refused)

    async def _write(self) -> None:
        while True:
            messages = await self._outbox.take()
            for message in messages:
                await self._link.send(message)
            if not messages and self._outbox.close_code is not None:
                await self._link.close(self._outbox.close_code, self._outbox.close_reason)
                return


def _not_admitted(error: NotAdmitted) -> c.Refused:
    told = m.ErrorMessage(error.code, str(error), error.field, fatal=True)
    return c.Refused(told, codes.CLOSE_NOT_ADMITTED)
