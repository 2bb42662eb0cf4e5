"""How early and how rightly the agent reacts on labelled streams, all stages together."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from agent_server.config import Settings
from agent_server.domain.inputs import RawInput
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError
from agent_server.recording.reader import open_recording
from agent_server.scene.rulebook import Rules
from agent_server.service.core import Core
from agent_server.service.models import Models
from agent_server.service.replay import replay_stream
from agent_server.synthetic.scenario import SCENARIOS, play

LATE_NS = NS_PER_S
"""A reaction still answers a gesture this long after its end: the window looks back."""


@dataclass(frozen=True, slots=True)
class Stream:
    """What happens in a recording, and what is known about it.

    Attributes:
        face: ``none`` for a sensor that sees no face.
        events: What sensors sent.
        labels: What the person did.
        duration_s: Length.
    """

    face: str | None
    events: tuple[RawInput, ...]
    labels: tuple[Label, ...]
    duration_s: float


@dataclass(frozen=True, slots=True)
class ReactionResult:
    """Reactions against labels.

    Attributes:
        streams: How many were played.
        asked: Labels that ask for a reaction.
        right: Of them, answered by that reaction.
        wrong: Of them, answered by another one.
        missed: Of them, not answered.
        delay_s_p50: Median time from a gesture's onset to the right reaction.
        delay_s_p90: The time that nine in ten stay under.
        false_reactions: Reactions that answer no label.
        quiet_minutes: Minutes in which nothing asked for a reaction.
        false_per_10_minutes: False reactions in ten such minutes.
    """

    streams: int
    asked: int
    right: int
    wrong: int
    missed: int
    delay_s_p50: float | None
    delay_s_p90: float | None
    false_reactions: int
    quiet_minutes: float
    false_per_10_minutes: float


def recorded(folder: Path) -> Iterator[Stream]:
    """The labelled recordings of a folder.

    Raises:
        ConfigError: If there is none.
    """
    paths = sorted(folder.glob("*.mcap"))
    if not paths:
        raise ConfigError(f"{folder} holds no *.mcap: give a folder of labelled recordings")
    for path in paths:
        recording = open_recording(path)
        yield Stream(
            recording.metadata.face,
            tuple(recording.events()),
            recording.labels(),
            recording.summary.duration_s,
        )


def played(seeds: int) -> Iterator[Stream]:
    """The generator's scenarios with other people and other motion than those that ship."""
    for scenario in SCENARIOS:
        for extra in range(1, seeds + 1):
            session = play(replace(scenario, seed=scenario.seed + 100 * extra))
            yield Stream(
                scenario.face, tuple(session.events), tuple(session.labels), scenario.duration_s
            )


def measure_reactions(models: Models, rules: Rules, streams: Iterator[Stream]) -> ReactionResult:
    """Play every stream through a fresh core, and compare its commands with the labels."""
    delays: list[float] = []
    count = asked = wrong = missed = false = 0
    quiet_s = 0.0
    for stream in streams:
        count += 1
        core = Core("bench", Settings(), rules, models)
        core.set_face(stream.face or "expected")
        reactions = [
            (decision.end_ns, decision.command.reaction)
            for decision in replay_stream(core, models, stream.events)
            if decision.command is not None
        ]
        asking = [label for label in stream.labels if label.expected is not None]
        asked += len(asking)
        quiet_s += stream.duration_s - sum(_span_s(label) for label in asking)
        false += sum(not _answers(at_ns, asking) for at_ns, _ in reactions)
        for label in asking:
            given = [(at_ns, name) for at_ns, name in reactions if _answers(at_ns, [label])]
            if not given:
                missed += 1
            elif given[0][1] == label.expected:
                delays.append((given[0][0] - label.onset_ns) / NS_PER_S)
            else:
                wrong += 1
    minutes = quiet_s / 60
    return ReactionResult(
        streams=count,
        asked=asked,
        right=len(delays),
        wrong=wrong,
        missed=missed,
        delay_s_p50=_percentile(delays, 50),
        delay_s_p90=_percentile(delays, 90),
        false_reactions=false,
        quiet_minutes=round(minutes, 1),
        false_per_10_minutes=round(10 * false / minutes, 2) if minutes else 0.0,
    )


def _answers(at_ns: int, labels: Sequence[Label]) -> bool:
    return any(label.onset_ns <= at_ns <= label.offset_ns + LATE_NS for label in labels)


def _span_s(label: Label) -> float:
    return (label.offset_ns + LATE_NS - label.onset_ns) / NS_PER_S


def _percentile(values: list[float], share: float) -> float | None:
    return round(float(np.percentile(values, share)), 2) if values else None
