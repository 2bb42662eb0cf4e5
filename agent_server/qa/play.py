"""One recording of a suite through the core: clean, or under a fault."""

import hashlib
import time
from collections.abc import Iterator
from zlib import crc32

import msgspec
import numpy as np

from agent_server.domain.command import Ack
from agent_server.domain.decision import Decision, Outcome
from agent_server.domain.gesture import IDLE
from agent_server.domain.inputs import SensorInput
from agent_server.domain.label import Label
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import AgentServerError
from agent_server.protocol import messages as m
from agent_server.qa.faults.base import Arrival, Fault
from agent_server.qa.faulty import replay_arrivals
from agent_server.qa.judge import Judgement, Reaction, judge
from agent_server.qa.result import CaseResult, ForecastError, Moment, Status, Step, Stretch
from agent_server.qa.setup import Setup
from agent_server.qa.suite import Case
from agent_server.qa.watch import Sight, Track
from agent_server.recording import topics
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.records import SensorChanged
from agent_server.service.replay import replay

MAX_MOMENTS = 12
_TOLD = (Outcome.COMMAND, Outcome.GATED, Outcome.BUSY, Outcome.NOTHING_TO_DO)
"""Outcomes whose reason is worth keeping."""


def examine(case: Case, setup: Setup, fault: Fault | None = None) -> CaseResult:
    """Replay one recording and judge what the agent does.

    Without a fault it is the replay of ``agent-server replay``, and a reaction counts from the
    end of its window. Under one, the raw input goes in as it arrives, inputs that the core
    refuses are passed over as a live server does, and a reaction counts from the arrival of
    what completed its window, on the undisturbed time line.
    """
    began = time.perf_counter()
    try:
        result = _examine(case, setup, fault)
    except AgentServerError as error:
        return CaseResult(case.name, "", "error", str(error))
    return msgspec.structs.replace(result, seconds=round(time.perf_counter() - began, 3))


def _examine(case: Case, setup: Setup, fault: Fault | None) -> CaseResult:
    recording = open_recording(case.path)
    labels = recording.labels()
    core = setup.core(recording.metadata.session)
    refused = 0
    if fault is None:
        taken = [(_ms(d.end_ns), d) for d in replay(recording, core, setup.models)]
    else:
        taken, refused = _under(fault, recording, setup)
    steps = [_step(at_ms, decision) for at_ms, decision in taken]
    reactions = [Reaction(step.at_ms, step.reaction) for step in steps if step.reaction]
    duration_ms = _ms(recording.summary.end_ns)
    judgement = judge(reactions, labels, case.terms, duration_ms)
    is_clean = fault is None
    track = Track(core.sights) if is_clean else Track([])
    return CaseResult(
        name=case.name,
        sha256=hashlib.sha256(case.path.read_bytes()).hexdigest(),
        status=_status(judgement),
        origin=recording.metadata.origin or "",
        duration_ms=duration_ms,
        judged_ms=judgement.judged_ms,
        checks=judgement.checks,
        false_at_ms=judgement.false_at_ms,
        labels=[_stretch(label) for label in labels],
        steps=steps,
        forecast=_forecast(track, core.sights, labels) if is_clean else {},
        moments=_moments(track, core.sights, labels, judgement) if is_clean else [],
        recorded_latency_ms=list(_latencies(recording)) if is_clean else [],
        refused=refused,
    )


def _under(
    fault: Fault, recording: Recording, setup: Setup
) -> tuple[list[tuple[int, Decision]], int]:
    """Decisions with the time at which they come, and how many inputs were refused."""
    inputs = [event for event in recording.events() if not isinstance(event, Ack)]
    given = [Arrival(_stamp(event), event) for event in inputs]
    rng = np.random.default_rng(crc32(f"{recording.path.name}/{fault.name}".encode()))
    arrivals = sorted(fault.apply(given, rng), key=lambda arrival: arrival.at_ns)
    taken, refused = replay_arrivals(recording.metadata.session, setup, _face(recording), arrivals)
    return [(_ms(at_ns), decision) for at_ns, decision in taken], refused


def _face(recording: Recording) -> str:
    """What the sensor said of the face; a live recording has it in its log."""
    if recording.metadata.face is None:
        for record in recording.records((topics.CORE.name,)):
            if isinstance(record.message, SensorChanged):
                return record.message.face
    return recording.metadata.face or "expected"


def _stamp(event: SensorInput | ObjectChanged) -> int:
    return event.stamp_ns if isinstance(event, ObjectChanged) else event.originating_ns


def _step(at_ms: int, decision: Decision) -> Step:
    best, probability = max(decision.probabilities.items(), key=lambda item: item[1])
    return Step(
        window=decision.window,
        at_ms=at_ms,
        best=best,
        probability=probability,
        gesture=decision.gesture,
        outcome=decision.outcome.value,
        reaction=None if decision.command is None else decision.command.reaction,
        valence=decision.gate.valence,
        arousal=decision.gate.arousal,
        reason=decision.reason if decision.outcome in _TOLD else "",
    )


def _stretch(label: Label) -> Stretch:
    onset, offset = _ms(label.onset_ns), _ms(label.offset_ns)
    return Stretch(label.gesture, onset, offset, label.expected, label.quiet)


def _status(judgement: Judgement) -> Status:
    if not judgement.checks:
        return "skipped"
    return "passed" if all(check.passed for check in judgement.checks) else "failed"


def _forecast(
    track: Track, sights: list[Sight], labels: tuple[Label, ...]
) -> dict[str, ForecastError]:
    """Errors in the windows that end in a gesture, and in all others."""
    moving = [label for label in labels if label.gesture != IDLE]
    split: dict[str, list[Sight]] = {"gesture": [], "idle": []}
    for sight in sights:
        end_ns = sight.window.end_ns
        is_moving = any(label.onset_ns <= end_ns <= label.offset_ns for label in moving)
        split["gesture" if is_moving else "idle"].append(sight)
    return {name: track.errors(part) for name, part in split.items()}


def _moments(
    track: Track, sights: list[Sight], labels: tuple[Label, ...], judgement: Judgement
) -> list[Moment]:
    """False reactions first, then each gesture where it was answered or most probable."""
    wanted: list[tuple[Sight, str]] = []
    for sight in sights:
        command = sight.decision.command
        if command is not None and _ms(sight.decision.end_ns) in judgement.false_at_ms:
            wanted.append((sight, f"{command.reaction}, which nothing asked for"))
    for label in labels:
        if label.gesture == IDLE:
            continue
        during = [s for s in sights if label.onset_ns <= s.window.end_ns <= label.offset_ns]
        if not during:
            continue
        answered = next((s for s in during if s.decision.command is not None), None)
        probable = max(during, key=lambda s: s.decision.probabilities.get(label.gesture, 0.0))
        chosen = answered or probable
        share = chosen.decision.probabilities.get(label.gesture, 0.0)
        came = "" if answered is None else ", where the reaction came"
        wanted.append((chosen, f"{label.gesture} with probability {share:.2f}{came}"))
    return [track.moment(sight, title) for sight, title in wanted[:MAX_MOMENTS]]


def _latencies(recording: Recording) -> Iterator[float]:
    for record in recording.records((topics.DECISION.name,)):
        if isinstance(record.message, m.DecisionMessage):
            yield round(record.message.timing.total_ms, 2)


def _ms(stamp_ns: int) -> int:
    return round(stamp_ns / NS_PER_MS)
