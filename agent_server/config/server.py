"""The process: what it listens on, whom it admits, and what it takes."""

import re
from collections.abc import Iterator
from typing import Literal

from agent_server.config.section import Section, unless

_POSITIVE = (
    "max_sessions",
    "max_errors",
    "hello_timeout_s",
    "heartbeat_s",
    "max_clients",
    "max_connections",
    "max_connections_per_address",
    "max_messages_per_s",
    "handshake_timeout_s",
    "watchdog_s",
    "drain_s",
)
_ORIGIN = re.compile(r"https?://[^/\s@?#]+")


class ServerSettings(Section, frozen=True):
    """The process and what it takes from clients.

    Attributes:
        host: Address to listen on.
        port: Port to listen on; 0 lets the system choose.
        max_sessions: Sessions at once; more are refused.
        max_message_bytes: A longer message is refused ...
        max_image_bytes: ... but for an image, which may have this many.
        max_errors: Bad messages that a connection may have open; good ones pay them back.
        hello_timeout_s: A client that has not said hello by then is sent away.
        heartbeat_s: How often either side pings.
        command_queue: Commands that may wait for a slow renderer.
        session_linger_s: A session without connections is kept this long.
        resume_s: A renderer whose connection broke keeps its place this long.
        state: Folder in which sessions are remembered over a restart; None keeps them in memory.
        streams: Folder of recordings that the page may play, for whoever is admitted, and whose
            labels an operator may save; None means those that ship, which stay as they are.
        tls_cert: File with the certificate chain (PEM) for ``https`` and ``wss``; None serves
            without TLS.
        tls_key: File with the certificate's private key (PEM).
        max_clients: Connections of one session at once; more are refused.
        max_connections: Connections at once, of whatever kind.
        max_connections_per_address: Of one address, but for those in ``trusted_proxies``.
        max_messages_per_s: A client that sends faster is read no faster, and so slows itself down.
        handshake_timeout_s: A connection that has made no whole request by then is cut.
        watchdog_s: An event loop or inference that is stuck for this long is logged and counted,
            and the server is not ready.
        drain_s: A server that is asked to stop lets clients read what waits for them this long.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    max_sessions: int = 256
    max_message_bytes: int = 64 * 1024
    max_image_bytes: int = 512 * 1024
    max_errors: int = 20
    hello_timeout_s: float = 10.0
    heartbeat_s: float = 4.0
    command_queue: int = 64
    session_linger_s: float = 60.0
    resume_s: float = 10.0
    state: str | None = None
    streams: str | None = None
    tls_cert: str | None = None
    tls_key: str | None = None
    max_clients: int = 32
    max_connections: int = 1024
    max_connections_per_address: int = 64
    max_messages_per_s: int = 1000
    handshake_timeout_s: float = 5.0
    watchdog_s: float = 2.0
    drain_s: float = 3.0

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(0 <= self.port <= 65535, "port must lie in 0..65535")
        yield from unless(self.max_message_bytes >= 4096, "max_message_bytes must be at least 4096")
        yield from unless(
            self.max_image_bytes >= self.max_message_bytes,
            "max_image_bytes must be at least max_message_bytes",
        )
        for name in _POSITIVE:
            yield from unless(getattr(self, name) > 0, f"{name} must be positive")
        yield from unless(self.command_queue >= 1, "command_queue must be at least 1")
        for name in ("session_linger_s", "resume_s"):
            yield from unless(getattr(self, name) >= 0, f"{name} must not be negative")
        yield from unless(
            self.drain_s <= 5, "drain_s must be at most 5, so that a stop takes under 10 s"
        )
        yield from unless(self.state != "", "state must name a folder")
        yield from unless(
            (self.tls_cert is None) == (self.tls_key is None), "tls_cert goes with tls_key"
        )


class AccessSettings(Section, frozen=True):
    """Who is admitted. Secrets stand in files and in the environment, never here.

    Attributes:
        secret_file: File with the secret that tokens are signed with: 32 bytes or more of text
            (HS256), or an Ed25519 key in PEM (EdDSA), of which the public half will do. The
            environment variable AGENT_SERVER_SECRET takes its place.
        keys_file: TOML file with the hashes of API keys; ``agent-server token --api-key`` writes
            it. The environment variable AGENT_SERVER_API_KEY holds one more, that may do
            everything.
        origins: Pages of other servers whose scripts may connect, as ``https://host:port``.
        trusted_proxies: Addresses whose ``X-Forwarded-For`` and ``-Proto`` are believed, and
            whose connections are not counted by address.
        insecure: Whether to listen beyond this machine without tokens. Anybody who reaches the
            port may then send frames, see the person and command the agent.
    """

    secret_file: str | None = None
    keys_file: str | None = None
    origins: tuple[str, ...] = ()
    trusted_proxies: tuple[str, ...] = ("127.0.0.1", "::1")
    insecure: bool = False

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(self.secret_file != "", "secret_file must name a file")
        yield from unless(self.keys_file != "", "keys_file must name a file")
        for origin in self.origins:
            yield from unless(
                _ORIGIN.fullmatch(origin) is not None,
                f"origins holds {origin!r}: write scheme, host and port alone, as in "
                "https://example.org or http://192.168.1.7:8000",
            )


class VmcSettings(Section, frozen=True):
    """Whether and where an avatar program gets a body to show, by the VMC protocol.

    Attributes:
        enabled: Whether anything is sent.
        host: Address of the program, best as a number. What is sent is personal data, not
            encrypted.
        port: UDP port at which it listens.
        show: The body as it is ``observed``, or as it is ``predicted`` to be a moment later.
        lead_ms: How much later, where it is predicted.
        session: Which session is shown; empty takes the first that has a body, until it has
            none any more.
    """

    enabled: bool = False
    host: str = "127.0.0.1"
    port: int = 39539
    show: Literal["observed", "predicted"] = "observed"
    lead_ms: int = 500
    session: str = ""

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(self.host != "", "host must name the machine of the avatar program")
        yield from unless(1 <= self.port <= 65535, "port must lie in 1..65535")
        yield from unless(40 <= self.lead_ms <= 1000, "lead_ms must lie in 40..1000")
