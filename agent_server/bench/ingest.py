"""What one skeleton frame costs on its way from the wire into a window."""

import time
from dataclasses import dataclass

from agent_server.bench.stream import recorded_frames
from agent_server.config import Settings
from agent_server.domain.stamp import to_ns
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.connection import Received, ServerConnection
from agent_server.protocol.convert import pack_skeleton, skeleton_from_message, skeleton_to_message
from agent_server.stages.perceive import Perception


@dataclass(frozen=True, slots=True)
class IngestResult:
    """Time to decode, validate, retarget, resample and window one frame.

    Attributes:
        us_per_frame: Median over the rounds, JSON, in microseconds.
        us_per_frame_msgpack: The same with MessagePack.
        frames: Frames a round.
        rounds: Number of rounds.
        joints: Joints a frame.
    """

    us_per_frame: float
    us_per_frame_msgpack: float
    frames: int
    rounds: int
    joints: int


def measure_ingest(rounds: int) -> IngestResult:
    """Send a synthetic stream through the ingest path, again and again."""
    frames = [frame for frame in recorded_frames("demo") if frame.body_id == 0] or recorded_frames(
        "demo"
    )
    messages = [skeleton_to_message(frame) for frame in frames]
    text = [CODECS[m.SUBPROTOCOL_JSON].encode(message) for message in messages]
    packed = [CODECS[m.SUBPROTOCOL_MSGPACK].encode(pack_skeleton(one)) for one in messages]
    return IngestResult(
        us_per_frame=_median_us(m.SUBPROTOCOL_JSON, text, rounds),
        us_per_frame_msgpack=_median_us(m.SUBPROTOCOL_MSGPACK, packed, rounds),
        frames=len(frames),
        rounds=rounds,
        joints=len(frames[0].joints),
    )


def _median_us(subprotocol: str, wire: list[str | bytes], rounds: int) -> float:
    times = sorted(_round_us(subprotocol, wire) for _ in range(rounds))
    return round(times[len(times) // 2], 2)


def _round_us(subprotocol: str, wire: list[str | bytes]) -> float:
    settings = Settings()
    codec = CODECS[subprotocol]
    connection = ServerConnection(
        "bench",
        "sensor",
        codec,
        max_message_bytes=settings.server.max_message_bytes,
        max_image_bytes=settings.server.max_image_bytes,
        max_errors=1,
        heartbeat_ns=to_ns(settings.server.heartbeat_s),
    )
    connection.receive(codec.encode(m.Hello(m.PROTOCOL, "bench")), 0)
    perception = Perception(settings.window, settings.subject)
    found = 0
    start = time.perf_counter_ns()
    for data in wire:
        event = connection.receive(data, 0)
        if isinstance(event, Received) and isinstance(event.message, m.Skeleton | m.PackedSkeleton):
            found += len(perception.push(skeleton_from_message(event.message)))
    elapsed = time.perf_counter_ns() - start
    if not found:
        raise RuntimeError("the stream gave no window, so nothing was measured")
    return elapsed / len(wire) / 1000
