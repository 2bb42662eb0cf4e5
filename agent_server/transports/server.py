"""Running the application under uvicorn."""

import asyncio
import logging
import os
import signal
import socket
import ssl
import sys
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import uvicorn

from agent_server import assets
from agent_server.clock import SystemClock
from agent_server.config import Settings
from agent_server.errors import BundleError, ConfigError
from agent_server.service.auth import OPEN, Access
from agent_server.service.hub import Hub
from agent_server.service.journal import Journal
from agent_server.service.loading import bundle_folders, load_room, rule_file
from agent_server.service.models import Models
from agent_server.service.recorder import recorder
from agent_server.service.store import FolderStore
from agent_server.service.swap import Swapper
from agent_server.service.tracing import open_traces
from agent_server.service.vmc import open_avatar
from agent_server.transports.app import create_app
from agent_server.transports.door import Door
from agent_server.transports.guard import is_loopback

log = logging.getLogger(__name__)


def build_hub(settings: Settings, models: Models, record_to: Path | None = None) -> Hub:
    """Put the sessions' hub together.

    Args:
        settings: All settings.
        models: The models.
        record_to: Folder for a recording of every session; None records nothing.

    Raises:
        RuleError: If the rule file is wrong.
        ConfigError: If the folder of sessions or of recordings cannot be written, the avatar
            program's host has no address, or traces are asked for and cannot be made.
    """
    clock = SystemClock()
    room = load_room(settings, models)
    open_journal: Callable[[str], Journal] | None = None
    if record_to is not None:
        try:
            record_to.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ConfigError(
                f"{record_to} cannot be made to record into: {error.strerror or error}; name "
                "another folder with --record"
            ) from error
        rule_text = rule_file(settings).read_bytes()

        def open_journal(session: str) -> Journal:
            # Those in use when the session is opened, which need not be those of the start.
            return recorder(record_to, session, hub.models, clock, settings, rule_text)

    state = settings.server.state
    store = None if state is None else FolderStore(Path(state), clock.wall_ns())
    avatar = open_avatar(settings.vmc)
    traces = open_traces(os.environ, clock)
    watchers = () if traces is None else (traces,)
    hub = Hub(settings, room, models, clock, open_journal, store, avatar, watchers)
    return hub  # the journals look at it


def bind(settings: Settings) -> socket.socket:
    """Take the configured address.

    Raises:
        ConfigError: If it is not to be had.
    """
    server = settings.server
    family = socket.AF_INET6 if ":" in server.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((server.host, server.port))
    except OSError as error:
        listener.close()
        raise ConfigError(
            f"cannot listen on {server.host}:{server.port}: {error.strerror}; choose another with "
            "--port, or --port 0 for any"
        ) from error
    return listener


def address(listener: socket.socket, *, is_secure: bool = False) -> str:
    """The HTTP address of a bound socket, with TLS or without."""
    host, port = listener.getsockname()[:2]
    scheme = "https" if is_secure else "http"
    return f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"


def check_exposure(settings: Settings, access: Access) -> None:
    """Refuse to listen beyond this machine without tokens, unless that is said to be meant.

    Raises:
        ConfigError: With the ways out; also if the certificate cannot be used.
    """
    server = settings.server
    if server.tls_cert is not None and server.tls_key is not None:
        try:
            ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(
                server.tls_cert, server.tls_key
            )
        except OSError as error:
            raise ConfigError(
                f"TLS cannot be served with {server.tls_cert} and {server.tls_key}: {error}; give "
                "a certificate chain and its key in PEM, without a password"
            ) from error
    if access.is_guarded or settings.access.insecure or is_loopback(server.host):
        return
    raise ConfigError(
        f"{server.host} can be reached from other machines, and no tokens are asked for: anybody "
        "could send frames, see the person and command the agent. Name a secret or keys "
        "(`agent-server token --new-secret FILE`, then --secret-file FILE), listen on 127.0.0.1, "
        "or say --insecure if that is meant"
    )


class _Server(uvicorn.Server):
    """Lets the hub say goodbye before uvicorn cuts the connections."""

    def __init__(self, hub: Hub, config: uvicorn.Config) -> None:
        super().__init__(config)
        self._hub = hub

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Let a stop that was asked for be no failure: the process goes on to its own end."""
        with super().capture_signals():
            yield
            # uvicorn would raise it again now, and the process die of it. An interruption goes on:
            # what is said of it, and its status, are the command's.
            while signal.SIGTERM in self._captured_signals:
                self._captured_signals.remove(signal.SIGTERM)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop in order: first the sessions, then the connections."""
        await self._hub.drain()
        await super().shutdown(sockets)


@contextmanager
def _rereading(swapper: Swapper) -> Iterator[None]:
    """Let the signal HUP mean that the bundles are read again."""
    if sys.platform == "win32" or threading.current_thread() is not threading.main_thread():
        yield
        return
    loop, tasks = asyncio.get_running_loop(), set[asyncio.Task[None]]()

    def reread() -> None:
        task = asyncio.create_task(_reread(swapper), name="reread models")
        tasks.add(task)
        task.add_done_callback(tasks.discard)

    loop.add_signal_handler(signal.SIGHUP, reread)
    try:
        yield
    finally:
        loop.remove_signal_handler(signal.SIGHUP)


async def _reread(swapper: Swapper) -> None:
    try:
        await swapper.reread()
    except BundleError as error:
        log.error("the models stay as they are: %s", error)


@asynccontextmanager
async def serving(
    hub: Hub, listener: socket.socket, access: Access = OPEN
) -> AsyncIterator[asyncio.Task[None]]:
    """Serve while the context lasts; entered when connections are taken.

    Args:
        hub: The sessions.
        listener: Where connections come in.
        access: Who is admitted.

    Yields:
        A task that ends when the process is asked to stop by a signal.
    """
    settings = hub.settings
    http, websocket = Door(settings).protocols()
    folder = settings.models.folder
    swapper = Swapper(
        hub, bundle_folders(settings), allowed=None if folder is None else Path(folder)
    )
    server = _Server(
        hub,
        uvicorn.Config(
            create_app(hub, assets.page(), access, swapper),
            http=http,
            ws=websocket,
            ssl_certfile=settings.server.tls_cert,
            ssl_keyfile=settings.server.tls_key,
            forwarded_allow_ips=list(settings.access.trusted_proxies),
            server_header=False,
            # The protocol's own limit answers with a sentence; this one only guards memory.
            ws_max_size=2 * hub.settings.server.max_image_bytes,
            ws_per_message_deflate=False,
            log_config=None,
            log_level="warning",
            lifespan="on",
            timeout_graceful_shutdown=2,
        ),
    )
    task = asyncio.create_task(server.serve(sockets=[listener]), name="uvicorn")
    try:
        # uvicorn announces its start by an attribute alone.
        while not server.started and not task.done():  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        with _rereading(swapper):
            yield task
    finally:
        server.should_exit = True
        await task
