"""All sessions of a server."""

import asyncio
import logging
import secrets
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager, suppress

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.config import Settings
from agent_server.domain.gesture import IDLE
from agent_server.errors import InferenceError
from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_GOING_AWAY, CLOSE_INTERNAL
from agent_server.scene.rulebook import Rules
from agent_server.service.audience import Client
from agent_server.service.avatar import Avatar, NoAvatar
from agent_server.service.camera import Eyes
from agent_server.service.journal import Journal
from agent_server.service.journals import Journals
from agent_server.service.load import Load, LoadGauge
from agent_server.service.loop_lag import measure_lag
from agent_server.service.metrics import Metrics
from agent_server.service.models import Models
from agent_server.service.session import Opening, Session
from agent_server.service.store import MemoryStore, SessionStore
from agent_server.service.warm_up import warm_up
from agent_server.service.watchdog import Watchdog
from agent_server.service.watching import DecisionLog, Watcher
from agent_server.service.worker import InferenceWorker

log = logging.getLogger(__name__)


_LEFT_OUT = {
    Load.NONE: "the event loop is in time again, nothing is left out",
    Load.TELEMETRY: "the event loop is late, telemetry is left out",
    Load.WINDOWS: "the event loop is very late, telemetry and every other window are left out",
}


class HubFull(Exception):
    """No further session, or client of a session, is admitted; the text says which."""


class HubStopping(Exception):
    """The server is stopping and admits nobody."""


class Hub:
    """Opens sessions when their first client comes and closes them some time after the last left.

    Args:
        settings: All settings.
        rules: The room's rules, the same for all sessions.
        models: The models, shared by all sessions.
        clock: Where to read the time.
        open_journal: Where a session of a given id is written down; None writes nothing.
        store: Where sessions are remembered over a restart; None remembers them in memory.
        avatar: Where persons are shown; None shows nobody. It is closed with the hub.
        watchers: Who is told of decisions, beside the log and the figures.

    Attributes:
        metrics: Figures of all sessions.
        warm: Set when the models have seen their first windows.
    """

    def __init__(
        self,
        settings: Settings,
        rules: Rules,
        models: Models,
        clock: Clock,
        open_journal: Callable[[str], Journal] | None = None,
        store: SessionStore | None = None,
        avatar: Avatar | None = None,
        watchers: Sequence[Watcher] = (),
    ) -> None:
        self.settings = settings
        self.clock = clock
        self._rules = rules
        self._store = store or MemoryStore()
        self._avatar = avatar or NoAvatar()
        self._worker = InferenceWorker(models)
        self._eyes = None if models.face is None else Eyes(models.face)
        self._sessions: dict[str, Session] = {}
        self.watchdog = Watchdog(settings.server.watchdog_s, lambda: self._worker.busy_since_s)
        self.metrics = Metrics(self._sessions, self._worker, self.watchdog)
        self._watchers = (self.metrics, DecisionLog(), *watchers)
        self.warm = asyncio.Event()
        self.gauge = LoadGauge()
        self._clients = 0
        self._empty = asyncio.Event()
        self._empty.set()
        self._journals = Journals(open_journal)
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._endings: dict[str, asyncio.TimerHandle] = {}
        self._group: asyncio.TaskGroup | None = None

    @property
    def sessions(self) -> Mapping[str, Session]:
        """Open sessions by id."""
        return self._sessions

    @property
    def rules(self) -> Rules:
        """The room's rules, the same for all sessions."""
        return self._rules

    @property
    def models(self) -> Models:
        """The models, shared by all sessions."""
        return self._worker.models

    def use_models(self, models: Models) -> None:
        """Let other models decide from the next batch on."""
        self._worker.models = models

    @property
    def is_running(self) -> bool:
        """Whether sessions can be opened."""
        return self._group is not None

    @property
    def is_ready(self) -> bool:
        """Whether a session would be served at full speed: warm, nothing stuck, not stopping."""
        return self.is_running and self.warm.is_set() and self.watchdog.is_well

    @asynccontextmanager
    async def run(self) -> AsyncIterator[None]:
        """Serve while the context lasts."""
        async with asyncio.TaskGroup() as group:
            self._group = group
            worker = group.create_task(self._worker.run(), name="inference")
            lag = group.create_task(measure_lag(self._take_lag), name="loop lag")
            warming = group.create_task(self._warm_up(), name="warm-up")
            self.watchdog.start()
            try:
                yield
            finally:
                self.watchdog.stop()
                self.stop()
                self._avatar.close()
                for watcher in self._watchers:
                    watcher.close()
                await self._journals.end()
                for task in (worker, lag, warming):
                    task.cancel()
                if self._eyes is not None:
                    self._eyes.close()

    async def _warm_up(self) -> None:
        try:
            await warm_up(self._worker, self.settings, self._rules)
        except InferenceError as error:
            log.error("the models failed on the first windows: %s", error)
        self.warm.set()

    def _take_lag(self, lag_s: float) -> None:
        self.metrics.lagged(lag_s)
        self.watchdog.beat()
        if self.gauge.push(lag_s):
            log.warning("load: %s", _LEFT_OUT[self.gauge.load])

    async def drain(self) -> None:
        """Stop, and let clients read what waits for them, but not for long."""
        self.stop()
        with suppress(TimeoutError):
            async with asyncio.timeout(self.settings.server.drain_s):
                await self._empty.wait()

    def stop(self) -> None:
        """Send everybody away and admit nobody any more."""
        self._group = None
        for ending in self._endings.values():
            ending.cancel()
        for session in list(self._sessions):
            self._close(session, CLOSE_GOING_AWAY, "the server is stopping")

    def join(self, session_id: str, client: Client) -> Session:
        """Bring a client into its session, which is opened if need be.

        Raises:
            HubFull: If there are too many sessions, or clients of this one.
            HubStopping: If the server is stopping.
            InvalidInput: If the session refuses the client.
        """
        session = self._sessions.get(session_id)
        if session is None:
            session = self._open(session_id)
        elif len(session.audience.clients) >= self.settings.server.max_clients:
            raise HubFull(
                f"{self.settings.server.max_clients} clients are in this session and no more are "
                "admitted"
            )
        ending = self._endings.pop(session_id, None)
        if ending is not None:
            ending.cancel()
        try:
            session.join(client)
        finally:
            self._end_if_empty(session)
        self._clients += 1
        self._empty.clear()
        return session

    def leave(self, session: Session, client: Client, *, for_good: bool) -> None:
        """A client's connection is over, for good if it said goodbye."""
        self._clients -= 1
        if self._clients == 0:
            self._empty.set()
        if client in session.audience.clients:
            session.leave(client, for_good=for_good)
        if self._sessions.get(session.id) is session:
            self._end_if_empty(session)

    def welcome(self, session: Session, client: Client) -> m.Welcome:
        """What a client is told when it may stay."""
        gate, server, decide = self.settings.gate, self.settings.server, self.settings.decide
        models = self.models
        return m.Welcome(
            protocol=m.PROTOCOL,
            server="agent-server",
            server_version=__version__,
            session=session.id,
            role=client.role,
            epoch=session.delivery.epoch,
            ledger=session.delivery.ledger,
            resumed=client.hello.ledger == session.delivery.ledger,
            sequence=session.delivery.sequence,
            heartbeat_s=server.heartbeat_s,
            labels=list(models.classifier.labels),
            gate=m.GateLevels(
                gate.mode,
                gate.enter_valence,
                gate.enter_arousal,
                gate.leave_valence,
                gate.leave_arousal,
            ),
            decide=m.DecideLevels(
                {
                    label: decide.enter if self._rules.is_gated(label) else decide.enter_ungated
                    for label in models.classifier.labels
                    if label != IDLE
                },
                decide.leave,
            ),
            limits=m.Limits(server.max_message_bytes, server.max_image_bytes, server.max_errors),
            models=[m.ModelInfo(model.name, task, model.sha256) for task, model in models.by_task],
            scene=session.delivery.scene(),
            differences=client.differences,
        )

    def _open(self, session_id: str) -> Session:
        if self._group is None:
            raise HubStopping
        if len(self._sessions) >= self.settings.server.max_sessions:
            raise HubFull(
                f"{self.settings.server.max_sessions} sessions are open and no more are admitted"
            )
        if self.gauge.load >= Load.WINDOWS:
            raise HubFull("the server is overloaded and opens no new session now")
        saved = self._store.load(session_id)
        session = Session(
            session_id,
            self.settings,
            self._rules,
            self._worker,
            self.clock,
            Opening(
                # A session that is opened anew counts its commands anew.
                ledger=secrets.token_hex(8) if saved is None else saved.ledger,
                epoch=secrets.token_hex(4),
                saved=saved,
            ),
            self._journals.open(session_id),
            self._store,
            self._avatar,
            self._eyes,
            gauge=self.gauge,
            watchers=self._watchers,
        )
        self._sessions[session_id] = session
        self._tasks[session_id] = self._group.create_task(
            self._guard(session), name=f"session {session_id}"
        )
        log.info("session %s: opened", session_id)
        return session

    async def _guard(self, session: Session) -> None:
        """Keep a fault of one session from ending the others."""
        try:
            await session.run()
        except* Exception:  # isolation of sessions: whatever it was, the others go on
            log.exception("session %s: failed and is closed", session.id)
            self._close(session.id, CLOSE_INTERNAL, "the session failed; connect again")

    def _end_if_empty(self, session: Session) -> None:
        if session.audience.clients or session.id in self._endings or self._group is None:
            return
        self._endings[session.id] = asyncio.get_running_loop().call_later(
            self.settings.server.session_linger_s,
            self._end,
            session.id,
        )

    def _end(self, session_id: str) -> None:
        """A session that nobody came back to is over, and not remembered."""
        self._close(session_id, CLOSE_GOING_AWAY, "the session was empty")
        self._store.forget(session_id)

    def _close(self, session_id: str, code: int, reason: str) -> None:
        session = self._sessions.pop(session_id)
        self._endings.pop(session_id, None)
        session.close(code, reason)
        self._journals.close(session_id)
        self.metrics.closed(session)
        self._tasks.pop(session_id).cancel()
        self._store.release(session_id)
        log.info("session %s: closed: %s", session_id, reason)
