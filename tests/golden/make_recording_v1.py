"""Makes recording_v1.mcap, a small session with every kind of record, in format version 1.

    python tests/golden/make_recording_v1.py

The file shows that recordings of version 1 stay readable: it is made once and kept.
"""

import math
from pathlib import Path

import numpy as np

from agent_server.domain.affect import AffectSample
from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.label import Label
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS
from agent_server.protocol import messages as m
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import (
    BodyGone,
    RendererChanged,
    SensorChanged,
    Tick,
    WindowDone,
    WindowSkipped,
)
from agent_server.recording.writer import RecordingWriter

GOLDEN = Path(__file__).with_name("recording_v1.mcap")
METADATA = RecordingMetadata(
    session="golden",
    server_version="0.1.0",
    face="expected",
    joint_format="core9",
    bundles={"predictor": "0" * 64, "classifier": "1" * 64},
    created="2025-01-31T12:00:00Z",
    description="Every kind of record once at least.",
    licence="Apache-2.0",
    origin="tests/golden/make_recording_v1.py",
)
FRAMES = 60
PERIOD_NS = 33_333_333


def body(index: int, body_id: int) -> SkeletonFrame:
    """Nine joints on slow circles, rounded as at ingest; one of them is not tracked."""
    joints = np.empty((9, 4))
    for joint in range(9):
        phase = 0.05 * index + joint + body_id
        joints[joint] = math.cos(phase), math.sin(phase), 2.0 + 0.1 * joint, 1.0
    joints[4, 3] = 0.0
    rounded = joints.round(4).astype(np.float32)
    return SkeletonFrame(index * PERIOD_NS, body_id, "core9", rounded)


def decision() -> m.DecisionMessage:
    """A decision that came to a command."""
    steps = [m.StepMessage("stand_up", 1.5), m.StepMessage("close", 2.0, "window")]
    command = m.CommandBody(
        id="golden-1",
        sequence=1,
        reaction="close_window",
        cause="cold",
        steps=steps,
        priority=10,
        preempts=None,
        originating_ns=40 * PERIOD_NS,
        issued_ns=40 * PERIOD_NS + 8 * NS_PER_MS,
        ttl_ms=3000,
    )
    body = m.DecisionBody(
        id="golden-d0",
        index=0,
        window=0,
        start_ns=15 * PERIOD_NS,
        end_ns=40 * PERIOD_NS,
        body_id=1,
        models={"predictor": "000000000000", "classifier": "111111111111"},
        quality=m.QualityBody(0.96, 0.04, 0.02, ["occluded"]),
        forecast="predictor",
        forecast_failure=None,
        probabilities={"cold": 0.875, "idle": 0.125},
        gesture="cold",
        gate=m.GateBody("required", True, "unpleasant and excited", -5.0, 4.5, 12.5),
        scene=m.SceneBody("working", "close_window", "window = open", True, "it is open"),
        outcome="command",
        reason="cold at 0.88: close_window",
        command=command,
    )
    return m.DecisionMessage(
        decision=body,
        timing=m.Timing("2025-01-31T12:00:01Z", 0.5, 0.8, 0.5, 0.1, 1.9),
    )


def append_all(writer: RecordingWriter) -> None:
    """Append the whole session."""
    writer.append_core(SensorChanged(0, open=True))
    writer.append_core(RendererChanged(0, attached=True))
    for index in range(FRAMES):
        stamp = index * PERIOD_NS
        writer.append_input(body(index, 1))
        if index % 10 == 0:
            writer.append_input(body(index, 2))
        if index % 3 == 0:
            writer.append_input(AffectSample(stamp, -5.25, 4.5))
        if index == 10:
            writer.append_input(ObjectChanged(stamp, "window", "open"))
            writer.append_output(m.SceneState("working", {"window": "open"}), stamp)
        if index == 30:
            writer.append_core(WindowSkipped(stamp, index=1))
            writer.append_core(Tick(stamp))
        if index == 40:
            message = decision()
            decided = message.decision.command
            assert decided is not None
            writer.append_core(WindowDone(decided.issued_ns, index=0))
            writer.append_output(message, decided.issued_ns)
            writer.append_output(
                m.CommandMessage(
                    id=decided.id,
                    sequence=decided.sequence,
                    epoch="e1",
                    reaction=decided.reaction,
                    cause=decided.cause,
                    steps=decided.steps,
                    priority=decided.priority,
                    originating_ns=decided.originating_ns,
                    issued_ns=decided.issued_ns,
                    ttl_ms=decided.ttl_ms,
                ),
                decided.issued_ns,
            )
        if index == 45:
            writer.append_input(Ack(stamp, "golden-1", AckStatus.STARTED, step=0))
            writer.append_input(Ack(stamp + 1, "golden-1", AckStatus.FAILED, reason="no window"))
    end = FRAMES * PERIOD_NS
    writer.append_core(WindowDone(end, index=2, failure="InferenceError: out of memory"))
    writer.append_core(BodyGone(end, body_id=1))
    writer.append_core(SensorChanged(end, open=False))
    cold = Label("cold", 10 * PERIOD_NS, 50 * PERIOD_NS, "golden", "close_window", quiet=False)
    idle = Label("idle", 0, 10 * PERIOD_NS, "golden", None, quiet=True)
    writer.append_label(cold)
    writer.append_label(idle, tag="G2")


def main() -> None:
    """Write the file; it must not exist."""
    with RecordingWriter(GOLDEN, METADATA) as writer:
        append_all(writer)


if __name__ == "__main__":
    main()
