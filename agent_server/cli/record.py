"""``agent-server record``."""

import asyncio
import os
from collections import Counter
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console

from agent_server.cli.options import (
    ConfigOption,
    ConsentOption,
    JsonOption,
    ParticipantOption,
    run,
    settings_with,
)
from agent_server.client import Monitor, Options
from agent_server.clock import Clock, SystemClock
from agent_server.config import RecordingSettings
from agent_server.domain.affect import AffectSample
from agent_server.domain.arrays import frozen
from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.protocol import messages as m
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.retention import recording_name
from agent_server.service.recorder import Recorder

TOPICS: tuple[m.Topic, ...] = ("pose", "affect", "scene", "decision", "command", "ack")
TOKEN_VARIABLE = "AGENT_SERVER_TOKEN"  # noqa: S105 - where it stands, not what it is
ORIGIN = (
    "agent-server record: what a monitor was told, so the body as the nine core joints at 25 Hz "
    "and valence and arousal instead of the face"
)


def record(
    url: Annotated[str, typer.Argument(metavar="URL", help="Address of a running server.")],
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder to record into.")],
    session: Annotated[str, typer.Option(help="Session to record.")] = "default",
    seconds: Annotated[
        float | None, typer.Option(min=0.1, help="For how long; else until Ctrl+C.")
    ] = None,
    participant: ParticipantOption = None,
    consent: ConsentOption = None,
    config: ConfigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Record a session of a running server as a monitor of it; AGENT_SERVER_TOKEN admits it."""
    settings = settings_with(config, participant=participant, consent=consent)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordingError(f"{folder} cannot be made: {error.strerror or error}") from error
    watch = _Watch(folder, session, SystemClock(), settings.recording)
    try:
        run(_record(url, session, watch, seconds), interrupted_status=0)
    finally:
        watch.close()
        if as_json:
            print(msgspec.json.encode(watch.report()).decode())
        else:
            told = ", ".join(f"{n} {name}" for name, n in sorted(watch.counts.items()))
            Console(highlight=False).print(f"{watch.path or 'nothing'}: {told or 'nothing came'}")


class _Watch:
    """Takes down what a monitor is told.

    Attributes:
        path: The file, or its first part; None before the server has welcomed.
        counts: How many messages of each kind came; ``missed`` are those that never did.
    """

    def __init__(
        self, folder: Path, session: str, clock: Clock, settings: RecordingSettings
    ) -> None:
        self._folder = folder
        self._session = session
        self._clock = clock
        self._settings = settings
        self._recorder: Recorder | None = None
        self._latest_ns = 0
        self.path: Path | None = None
        self.counts: Counter[str] = Counter()

    def take(self, message: m.Message) -> None:
        """Take one message.

        Raises:
            RecordingError: If nothing can be written any more.
        """
        arrival_ns = self._clock.now_ns()
        if isinstance(message, m.Welcome) and self._recorder is None:
            self._recorder = self._begin(message)
        recorder = self._recorder
        if recorder is None:
            return
        match message:
            case m.Welcome(scene=scene):
                recorder.append_output(scene, self._latest_ns)
            case m.PoseMessage():
                self._latest_ns = max(self._latest_ns, message.originating_ns)
                joints = frozen(message.joints, (None, 4))
                frame = SkeletonFrame(message.originating_ns, message.body_id, "core9", joints)
                recorder.append_input(frame, arrival_ns)
            case m.AffectTelemetry():
                sample = AffectSample(message.originating_ns, message.valence, message.arousal)
                recorder.append_input(sample, arrival_ns)
            case m.AckTelemetry(status=status) if status in _ACKS:
                ack = Ack(
                    self._latest_ns,
                    message.command_id,
                    AckStatus(status),
                    message.step,
                    message.reason,
                )
                recorder.append_input(ack, arrival_ns)
            case m.SceneState():
                recorder.append_output(message, self._latest_ns)
            case m.DecisionMessage():
                recorder.append_output(message, message.decision.end_ns)
            case m.CommandMessage():
                recorder.append_output(message, message.issued_ns)
            case m.Missed(topics=topics):
                self.counts["missed"] += sum(topics.values())
                return
            case _:
                return
        self.counts[str(message.__struct_config__.tag)] += 1
        if (failure := recorder.take_failure()) is not None:
            raise RecordingError(failure)

    def report(self) -> dict[str, object]:
        """What came of it."""
        return {"path": self.path and str(self.path), "messages": dict(self.counts)}

    def close(self) -> None:
        """Finish the file."""
        if self._recorder is not None:
            self._recorder.close()

    def _begin(self, welcome: m.Welcome) -> Recorder:
        wall = self._clock.wall()
        metadata = RecordingMetadata(
            session=self._session,
            server_version=welcome.server_version,
            joint_format="core9",
            bundles={model.name: model.sha256 for model in welcome.models},
            created=wall,
            origin=ORIGIN,
            participant=self._settings.participant or None,
            consent=self._settings.consent,
        )
        self.path = self._folder / recording_name(self._session, wall)
        return Recorder(self.path, metadata, self._clock, self._settings)


_ACKS = frozenset(status.value for status in AckStatus)


async def _record(url: str, session: str, watch: _Watch, seconds: float | None) -> None:
    options = Options(
        url, session, client="agent-server-record", token=os.environ.get(TOKEN_VARIABLE)
    )
    try:
        async with asyncio.timeout(seconds), Monitor(options, TOPICS) as monitor:
            async for message in monitor:
                watch.take(message)
    except TimeoutError:
        return
