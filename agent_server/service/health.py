"""How each session fares, in a word and a sentence, for those who look after the server."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.service.session import Session

State = Literal["good", "quiet", "amiss"]
SILENT_S = 2.0
"""A sensor sends 15 frames a second or more; one that is silent for so long has a fault."""
SLOW_MS = 50.0
BACKLOG = 16
"""Messages that wait for a client before it is called slow; it is closed at 64 commands."""


@dataclass(frozen=True, slots=True)
class SessionHealth:
    """One session.

    Attributes:
        id: Its id.
        state: ``good``, ``quiet`` (nothing to do) or ``amiss``.
        words: Why, in a sentence.
        room: What the agent does.
        frames: Frames that have come, so that two looks give a rate.
        decisions: Decisions that were made.
        commands: Commands that were issued.
        dropped: Windows and images that were overtaken, and messages that were refused.
        gesture: What is held to be going on, if anything was decided.
        outcome: What the last decision came to.
        reason: ... and why.
        gate: Whether the gate was open then.
        latency_ms: Of the last decisions, oldest first, each from its last frame on.
        p50_ms: Their median.
        worst_ms: Their longest.
        clients: Who is connected, as monitors are told.
    """

    id: str
    state: State
    words: str
    room: str
    frames: int
    decisions: int
    commands: int
    dropped: int
    gesture: str | None
    outcome: str | None
    reason: str | None
    gate: bool | None
    latency_ms: list[float]
    p50_ms: float | None
    worst_ms: float | None
    clients: list[m.ClientStats]


def health_of(session: Session, now_ns: int) -> SessionHealth:
    """Look at a session.

    Args:
        session: The session.
        now_ns: The server's clock.
    """
    counters = session.counters
    last = session.recent[-1].decision if session.recent else None
    latency_ms = [round(seen.total_s * 1000, 2) for seen in session.recent]
    fault = next(_faults(session, latency_ms, now_ns), None)
    has_sensor = any(session.audience.having("sensor"))
    state: State = "amiss" if fault else "good" if has_sensor else "quiet"
    words = fault or ("frames come and are answered" if has_sensor else "no sensor is connected")
    return SessionHealth(
        id=session.id,
        state=state,
        words=words,
        room=session.delivery.scene().mode,
        frames=counters["frames"],
        decisions=counters["decisions"],
        commands=counters["commands"],
        dropped=sum(
            counters[name]
            for name in ("skipped_windows", "skipped_images", "skipped_faces", "rejected_messages")
        ),
        gesture=None if last is None else last.gesture,
        outcome=None if last is None else last.outcome.value,
        reason=None if last is None else last.reason,
        gate=None if last is None else last.gate.is_open,
        latency_ms=latency_ms,
        p50_ms=round(float(np.median(latency_ms)), 2) if latency_ms else None,
        worst_ms=max(latency_ms, default=None),
        clients=[client.stats() for client in session.audience.clients],
    )


def _faults(session: Session, latency_ms: list[float], now_ns: int) -> Iterator[str]:
    """What is amiss, the gravest first."""
    for client in session.audience.clients:
        if client.outbox.waiting >= BACKLOG:
            yield (
                f"{client.outbox.waiting} messages wait for {client.role} "
                f"{client.hello.client!r}: it reads too slowly"
            )
    if not any(session.audience.having("sensor")):
        return
    silent_s = session.silent_ns(now_ns) / NS_PER_S
    if not session.counters["frames"]:
        yield "a sensor is connected and has not sent a frame yet"
    elif silent_s > SILENT_S:
        yield f"nothing has come from the sensor for {silent_s:.0f} s"
    if session.recent and (failure := session.recent[-1].decision.forecast_failure) is not None:
        yield f"the predictor fails: {failure}"
    if latency_ms and float(np.median(latency_ms)) > SLOW_MS:
        yield f"half of its decisions take more than {SLOW_MS:.0f} ms"
