"""Between the wire and the domain. Everything that comes from outside is checked here."""

import struct
from collections.abc import Iterable
from functools import lru_cache
from itertools import chain

import numpy as np

from agent_server.domain.affect import AffectSample
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.command import Ack, AckStatus, Command
from agent_server.domain.decision import Decision, SceneVerdict
from agent_server.domain.gesture import Spread
from agent_server.domain.motion import RATE_HZ, Forecast, ForecastFigures, Futures
from agent_server.domain.reaction import Stretch
from agent_server.domain.scene import SceneSnapshot
from agent_server.domain.skeleton import CoreFrame, SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.skeleton.formats import get_format
from agent_server.skeleton.pair import JOINT_NAMES

JOINT_DECIMALS = 4
"""Joints are rounded to this many decimals of their unit (0.1 mm of metres) before anything
sees them: a twentieth of a sensor's noise, and it makes the wire, the stages and a recording
agree to the bit."""

FUTURES_EVERY = 5
"""Of futures beside the forecast monitors get every fifth frame: they are drawn faintly."""

MAX_COORDINATE_M = 50.0
"""No joint is farther from its sensor."""


def skeleton_from_message(
    message: m.Skeleton | m.PackedSkeleton, stamp_ns: int | None = None
) -> SkeletonFrame:
    """Check a skeleton message and turn it into a frame.

    Args:
        message: As decoded.
        stamp_ns: Its stamp on the session's time line; None keeps the sender's.

    Raises:
        InvalidInput: If the format is unknown, the number of joints does not fit it, or a
            number is not finite or out of range.
    """
    wanted, limit = _expectation(message.format)
    joints = message.joints
    if isinstance(joints, bytes):
        if len(joints) != 16 * wanted:
            raise _wrong_count(message.format, wanted, len(joints) / 16)
        values = np.frombuffer(joints, dtype="<f4").astype(np.float64)
    else:
        if len(joints) != wanted:
            raise _wrong_count(message.format, wanted, len(joints))
        values = np.fromiter(chain.from_iterable(joints), np.float64, 4 * wanted)
    confidence = values[3::4].tolist()
    # A sum of squares within the limit has no term beyond it, and one call tells; a body far
    # from its sensor, and NaN, for which every comparison is false, are looked at one by one.
    if not values.dot(values) <= limit * limit or min(confidence) < 0.0 or max(confidence) > 1.0:
        _check_each(values.reshape(wanted, 4), limit)
    table = values.round(JOINT_DECIMALS).reshape(wanted, 4)
    return SkeletonFrame(
        originating_ns=message.originating_ns if stamp_ns is None else stamp_ns,
        body_id=message.body_id,
        format=message.format,
        joints=_read_only(table.astype(np.float32)),
    )


def skeleton_to_message(frame: SkeletonFrame) -> m.Skeleton:
    """A frame as a JSON-coded message."""
    joints = frame.joints.astype(np.float64).round(JOINT_DECIMALS)
    return m.Skeleton(
        originating_ns=frame.originating_ns,
        body_id=frame.body_id,
        format=frame.format,
        joints=list(map(tuple, joints.tolist())),
    )


def pack_skeleton(message: m.Skeleton) -> m.PackedSkeleton:
    """A JSON-coded skeleton as a MessagePack-coded one."""
    flat = tuple(chain.from_iterable(message.joints))
    return m.PackedSkeleton(
        originating_ns=message.originating_ns,
        body_id=message.body_id,
        format=message.format,
        joints=struct.pack(f"<{len(flat)}f", *flat),
    )


def affect_from_message(message: m.Affect, stamp_ns: int | None = None) -> AffectSample:
    """An affect message as a sample. Its ranges were checked when it was decoded."""
    stamp_ns = message.originating_ns if stamp_ns is None else stamp_ns
    return AffectSample(stamp_ns, message.valence, message.arousal)


def affect_to_message(sample: AffectSample) -> m.Affect:
    """A sample as a message."""
    return m.Affect(sample.originating_ns, sample.valence, sample.arousal)


def affect_telemetry(sample: AffectSample) -> m.AffectTelemetry:
    """The affect that the gate goes by, for a monitor."""
    return m.AffectTelemetry(
        sample.originating_ns,
        sample.valence,
        sample.arousal,
        sample.valence_sd,
        sample.arousal_sd,
        sample.source,
        sample.delay_ms,
    )


def ack_from_message(message: m.AckMessage, stamp_ns: int) -> Ack:
    """A renderer's word, stamped with its arrival on the session's time line."""
    return Ack(
        stamp_ns, message.command_id, AckStatus(message.status), message.step, message.reason
    )


def pose_message(frame: CoreFrame) -> m.PoseMessage:
    """The observed core joints for a monitor."""
    rows = np.column_stack((frame.positions, frame.confidence)).astype(np.float64)
    joints = rows.round(JOINT_DECIMALS).tolist()
    return m.PoseMessage(frame.stamp_ns, frame.body_id, list(map(tuple, joints)))


def forecast_message(window: int, end_ns: int, forecast: Forecast) -> m.ForecastMessage:
    """The expected motion for a monitor, and others that may come, rounded to a millimetre."""
    positions = forecast.positions.astype(np.float64).round(3).tolist()
    futures = forecast.futures
    others = [] if futures is None else _future_bodies(futures)
    return m.ForecastMessage(window, end_ns, forecast.source, positions, others)


def _future_bodies(futures: Futures) -> list[m.FutureBody]:
    some = futures.positions[:, FUTURES_EVERY - 1 :: FUTURES_EVERY].astype(np.float64).round(3)
    quality = futures.quality.astype(np.float64).round(4)
    return [m.FutureBody(*each) for each in zip(quality.tolist(), some.tolist(), strict=True)]


def forecast_score_body(figures: ForecastFigures | None) -> m.ForecastScoreBody | None:
    """How good forecasts were, for a monitor; None before any truth has come."""
    if figures is None:
        return None
    return m.ForecastScoreBody(figures.error_mm, figures.zero_velocity_mm, figures.forecasts)


def scene_message(snapshot: SceneSnapshot) -> m.SceneState:
    """The room for a client."""
    return m.SceneState(snapshot.mode.value, dict(snapshot.objects), snapshot.command_id)


def command_body(command: Command) -> m.CommandBody:
    """A command as a decision log holds it."""
    return m.CommandBody(
        id=command.id,
        sequence=command.sequence,
        reaction=command.reaction,
        cause=command.cause,
        steps=_steps(command),
        priority=command.priority,
        preempts=command.preempts,
        originating_ns=command.originating_ns,
        issued_ns=command.issued_ns,
        ttl_ms=command.ttl_ms,
        motion=command.motion.value,
    )


def command_message(command: Command, epoch: str, server_ns: int) -> m.CommandMessage:
    """A command as a renderer gets it.

    Args:
        command: The command.
        epoch: Epoch in which it is sent.
        server_ns: The server's monotonic clock when it was decided.
    """
    return m.CommandMessage(
        id=command.id,
        sequence=command.sequence,
        epoch=epoch,
        reaction=command.reaction,
        cause=command.cause,
        steps=_steps(command),
        priority=command.priority,
        originating_ns=command.originating_ns,
        issued_ns=command.issued_ns,
        ttl_ms=command.ttl_ms,
        preempts=command.preempts,
        server_ns=server_ns,
        motion=command.motion.value,
    )


def pose_stream_message(command_id: str, stretch: Stretch) -> m.PoseStreamMessage:
    """A stretch of a generated motion for a renderer, rounded to a tenth of a millimetre."""
    return m.PoseStreamMessage(
        command_id,
        stretch.first_frame,
        float(RATE_HZ),
        list(JOINT_NAMES),
        stretch.positions.astype(np.float64).round(JOINT_DECIMALS).tolist(),
        stretch.is_last,
        stretch.refused,
    )


def pack_pose_stream(message: m.PoseStreamMessage) -> m.PackedPoseStreamMessage:
    """A JSON-coded stretch as a MessagePack-coded one."""
    flat = tuple(chain.from_iterable(chain.from_iterable(message.positions)))
    return m.PackedPoseStreamMessage(
        message.command_id,
        message.first_frame,
        message.rate_hz,
        message.joints,
        struct.pack(f"<{len(flat)}f", *flat),
        message.is_last,
        message.fallback,
    )


def unpack_pose_stream(message: m.PackedPoseStreamMessage) -> m.PoseStreamMessage:
    """A MessagePack-coded stretch as a JSON-coded one.

    Raises:
        InvalidInput: If the bytes are no whole number of frames.
    """
    frame_bytes = 12 * len(message.joints)
    size = len(message.positions)
    if frame_bytes == 0 or size % frame_bytes:
        raise InvalidInput(
            f"positions has {size} bytes: with {len(message.joints)} joints a frame has "
            f"{frame_bytes}, three float32 each",
            field="positions",
            code="wrong_point_count",
        )
    flat = np.frombuffer(message.positions, "<f4").astype(np.float64).round(JOINT_DECIMALS)
    frames = flat.reshape(-1, len(message.joints), 3).tolist()
    return m.PoseStreamMessage(
        message.command_id,
        message.first_frame,
        message.rate_hz,
        message.joints,
        [[(x, y, z) for x, y, z in frame] for frame in frames],
        message.is_last,
        message.fallback,
    )


def decision_body(decision: Decision) -> m.DecisionBody:
    """A decision as a log holds it."""
    quality, gate, scene = decision.quality, decision.gate, decision.scene
    return m.DecisionBody(
        id=decision.id,
        index=decision.index,
        window=decision.window,
        start_ns=decision.start_ns,
        end_ns=decision.end_ns,
        body_id=decision.body_id,
        models=dict(decision.models),
        quality=m.QualityBody(
            round(float(quality.measured), 4),
            round(float(quality.filled), 4),
            round(float(quality.bone_deviation), 4),
            list(quality.warnings),
        ),
        forecast=decision.forecast,
        forecast_failure=decision.forecast_failure,
        probabilities=dict(decision.probabilities),
        gesture=decision.gesture,
        gate=m.GateBody(
            mode=gate.mode,
            is_open=gate.is_open,
            reason=gate.reason,
            valence=gate.valence,
            arousal=gate.arousal,
            age_ms=gate.age_ms,
            face=gate.face.value,
            source=gate.source,
            gaze_deg=gate.gaze_deg,
        ),
        scene=None if scene is None else _scene_body(scene),
        outcome=decision.outcome.value,
        reason=decision.reason,
        command=None if decision.command is None else command_body(decision.command),
        futures=(
            None
            if decision.spread is None
            else _futures_body(decision.spread, decision.probabilities)
        ),
    )


def _futures_body(spread: Spread, labels: Iterable[str]) -> m.FuturesBody:
    rows = zip(labels, spread.deviations, strict=True)
    return m.FuturesBody(
        spread.futures, spread.left_out, {label: round(float(sd), 4) for label, sd in rows}
    )


def _scene_body(verdict: SceneVerdict) -> m.SceneBody:
    return m.SceneBody(
        verdict.mode, verdict.rule, verdict.precondition, verdict.met, verdict.reason
    )


def _steps(command: Command) -> list[m.StepMessage]:
    return [m.StepMessage(s.action, s.duration_s, s.target) for s in command.steps]


@lru_cache(maxsize=64)
def _expectation(name: str) -> tuple[int, float]:
    table = get_format(name)
    return len(table.names), MAX_COORDINATE_M / table.unit_m


def _wrong_count(name: str, wanted: int, got: float) -> InvalidInput:
    return InvalidInput(
        f"format {name} has {wanted} joints, got {got:g}: send every joint of the table, with "
        "confidence 0 where it is not tracked",
        field="joints",
        code="wrong_joint_count",
    )


def _check_each(table: Float64, limit: float) -> None:
    """Find the number that cannot be true, if there is one."""
    for (joint, axis), value in np.ndenumerate(table):
        field = f"joints[{joint}][{axis}]"
        if not np.isfinite(value):
            raise InvalidInput(
                f"{field} is {value}: send finite numbers, with confidence 0 for a joint that is "
                "not tracked",
                field=field,
                code="not_finite",
            )
        if axis == 3 and not 0.0 <= value <= 1.0:
            raise InvalidInput(
                f"{field} is {value:g}: a confidence lies in 0..1", field=field, code="out_of_range"
            )
        if abs(value) > limit:
            raise InvalidInput(
                f"{field} is {value:g}, beyond {limit:g}: is the unit the one of the format?",
                field=field,
                code="out_of_range",
            )


def _read_only(array: Float32) -> Float32:
    array.flags.writeable = False
    return array
