"""``agent-server replay``."""

import asyncio
import logging
import math
import os
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console

from agent_server import __version__
from agent_server.cli.options import (
    ClassifierOption,
    ConfigOption,
    FuturesOption,
    JsonOption,
    PredictorOption,
    RulesOption,
    run,
    settings_with,
)
from agent_server.cli.status import FAILED
from agent_server.cli.story import Story
from agent_server.client.once import Client, join, send_paced
from agent_server.config import Settings
from agent_server.domain.inputs import SensorInput
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError
from agent_server.protocol import messages as m
from agent_server.protocol.convert import decision_body
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.records import SensorChanged
from agent_server.recording.topics import CORE
from agent_server.service.core import Core
from agent_server.service.decision_log import changes, read_log
from agent_server.service.loading import load_models, load_room
from agent_server.service.recorder import settings_hash
from agent_server.service.replay import replay as replay_recording

log = logging.getLogger(__name__)

TOKEN_VARIABLE = "AGENT_SERVER_TOKEN"  # noqa: S105 - where it stands, not what it is
SETTLE_S = 1.0
"""After the last frame was sent, decisions may still come for this long."""


def replay(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Recording to replay.")],
    speed: Annotated[
        str | None,
        typer.Option(metavar="N|max", help="1 is real time; the default is max, with --to 1."),
    ] = None,
    to: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            help="Send it to a running server instead; AGENT_SERVER_TOKEN holds its token.",
        ),
    ] = None,
    expect: Annotated[
        Path | None,
        typer.Option(
            metavar="LOG",
            help="Print only what differs from this log of replay --json; status 1 if anything, "
            "2 where a file cannot be read.",
        ),
    ] = None,
    config: ConfigOption = None,
    classifier: ClassifierOption = None,
    predictor: PredictorOption = None,
    futures: FuturesOption = None,
    rules: RulesOption = None,
    as_json: JsonOption = False,
) -> None:
    """Replay a recording and show its decisions; with --json one decision a line."""
    recording = open_recording(file)
    show = _print_line if as_json else Story(Console(highlight=False)).tell
    if to is not None:
        factor = _factor(speed or "1")
        if math.isinf(factor):
            raise ConfigError("--speed max and --to do not go together: a live server would skip")
        run(_send(recording, to, factor, show))
        return
    settings = settings_with(
        config, predictor=predictor, classifier=classifier, futures=futures, rules=rules
    )
    if expect is not None:
        _compare(read_log(expect), list(_decide(recording, settings)), as_json=as_json)
        return
    for decision in _paced(_decide(recording, settings), _factor(speed or "max")):
        show(decision)


def _compare(
    expected: list[m.DecisionBody], actual: list[m.DecisionBody], *, as_json: bool
) -> None:
    """Print what has changed; ends the command with status 1 if anything has."""
    found = list(changes(expected, actual))
    same_bytes = expected == actual
    if as_json:
        result = {"decisions": len(actual), "same_bytes": same_bytes, "changes": found}
        print(msgspec.json.encode(result).decode())
    else:
        for change in found:
            print(change)
        rounding = "byte for byte" if same_bytes else "but for rounding"
        print(
            f"{len(actual)} decisions, {len(found)} changes"
            if found
            else f"{len(actual)} decisions, the same {rounding}"
        )
    if found:
        raise typer.Exit(FAILED)


def _factor(speed: str) -> float:
    try:
        factor = math.inf if speed == "max" else float(speed)
    except ValueError:
        factor = math.nan
    if not factor > 0:
        raise ConfigError(f"--speed is {speed!r}: give a number over 0, or max")
    return factor


def _print_line(decision: m.DecisionBody) -> None:
    sys.stdout.buffer.write(msgspec.json.encode(decision) + b"\n")


def _decide(recording: Recording, settings: Settings) -> Iterator[m.DecisionBody]:
    models = load_models(settings)
    recorded = recording.metadata.bundles
    for _, model in models.by_task:
        if recorded.get(model.name, model.sha256) != model.sha256:
            log.warning("recorded with another %s: decisions may differ", model.name)
    if recording.metadata.config not in (None, settings_hash(settings)):
        log.warning("recorded with other settings: decisions may differ")
    core = Core(recording.metadata.session, settings, load_room(settings, models), models)
    return map(decision_body, replay_recording(recording, core, models))


def _paced(decisions: Iterable[m.DecisionBody], speed: float) -> Iterator[m.DecisionBody]:
    """Give each decision when its window would end at this speed."""
    start_s, first_ns = time.monotonic(), None
    for decision in decisions:
        first_ns = decision.end_ns if first_ns is None else first_ns
        due_s = start_s + (decision.end_ns - first_ns) / NS_PER_S / speed
        time.sleep(max(0.0, due_s - time.monotonic()))
        yield decision


async def _send(recording: Recording, url: str, speed: float, show: Story.Teller) -> None:
    token = os.environ.get(TOKEN_VARIABLE)
    watch = m.Hello(m.PROTOCOL, "agent-server-replay", __version__, token=token)
    hello = msgspec.structs.replace(watch, face=_face(recording))
    session = recording.metadata.session
    async with (
        join(url, session, "monitor", hello=watch) as monitor,
        join(url, session, "sensor", hello=hello) as sensor,
    ):
        listener = asyncio.create_task(_listen(monitor, show))
        inputs = (event for event in recording.events() if isinstance(event, SensorInput))
        await send_paced(sensor, inputs, speed)
        await asyncio.sleep(SETTLE_S)
        listener.cancel()


def _face(recording: Recording) -> m.FaceKind:
    """What the recorded sensor said of the face; a live recording has it in its log."""
    if recording.metadata.face is None:
        for record in recording.records((CORE.name,)):
            if isinstance(record.message, SensorChanged):
                return record.message.face
    face: m.FaceKind = msgspec.convert(recording.metadata.face or "expected", m.FaceKind)
    return face


async def _listen(monitor: Client, show: Story.Teller) -> None:
    async for message in monitor:
        if isinstance(message, m.DecisionMessage):
            show(message.decision)
