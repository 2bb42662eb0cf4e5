"""A recording with the bodies as scenes for the 3D panel of Foxglove and its kin.

Recordings open in Foxglove as they are; this adds ``/scene3d`` (``foxglove.SceneUpdate``) and
``/tf`` (``foxglove.FrameTransform``), which turns the camera's y up into the panel's z up.
Layout of both: https://docs.foxglove.dev/docs/sdk/schemas
"""

from contextlib import closing
from pathlib import Path
from typing import Any

import msgspec
from mcap.exceptions import McapError
from mcap.reader import make_reader

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_BONES
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import RecordingError
from agent_server.qa.export.content import Content, in_camera
from agent_server.recording.sink import AT_ONCE, McapSink
from agent_server.recording.whole import whole_file
from agent_server.skeleton.formats import get_format

SCENE_TOPIC, TRANSFORM_TOPIC = "/scene3d", "/tf"
CAMERA, ROOM = "camera", "room"
_LINE_LIST = 2
_BODY_NS, _FORECAST_NS = 150 * NS_PER_MS, 250 * NS_PER_MS
"""How long a body, and a forecast, is shown unless a newer one comes."""
_AHEAD = (9, 19, 29, 39, 49)
_SEEN_COLOUR, _FORECAST_COLOUR = (0.93, 0.93, 0.95), (0.35, 0.6, 1.0)
_QUARTER_TURN = 0.7071067811865476


def write_foxglove(content: Content, output: Path) -> None:
    """Copy a recording, and add its bodies and forecasts as scenes.

    Args:
        content: The recording.
        output: File to create; it must not exist.

    Raises:
        RecordingError: If a file cannot be read or written.
    """
    with whole_file(output) as part, closing(McapSink(part, AT_ONCE)) as sink:
        sequence = _copy(content.path, sink)
        transform = sink.channel(TRANSFORM_TOPIC, "json", _schema("foxglove.FrameTransform"))
        sink.message(transform, 0, sequence, msgspec.json.encode(_upright()))
        scene = sink.channel(SCENE_TOPIC, "json", _schema("foxglove.SceneUpdate"))
        updates = [(frame.originating_ns, _body(frame)) for frame in content.frames]
        for sight in content.sights:
            window = sight.window
            futures = [sight.forecast.positions[index] for index in _AHEAD]
            updates.append((window.end_ns, _forecast(window.end_ns, window.body_id, futures)))
        updates.sort(key=lambda update: update[0])
        for index, (stamp_ns, entity) in enumerate(updates, sequence + 1):
            update = {"deletions": [], "entities": [entity]}
            sink.message(scene, stamp_ns, index, msgspec.json.encode(update))


def _copy(source: Path, sink: McapSink) -> int:
    """Copy all records and metadata as they are; gives the next sequence number."""
    channels: dict[int, int] = {}
    sequence = 0
    try:
        with source.open("rb") as file:
            reader = make_reader(file)
            for metadata in reader.iter_metadata():
                sink.metadata(metadata.name, metadata.metadata)
            for schema, channel, message in reader.iter_messages(log_time_order=False):
                if channel.id not in channels:
                    named = ("", "", b"") if schema is None else (
                        schema.name, schema.encoding, schema.data
                    )  # fmt: skip
                    channels[channel.id] = sink.channel(
                        channel.topic, channel.message_encoding, named
                    )
                sink.message(channels[channel.id], message.log_time, sequence, message.data)
                sequence += 1
    except (OSError, McapError) as error:
        raise RecordingError(f"{source} cannot be copied: {error}") from error
    return sequence


def _body(frame: Any) -> dict[str, Any]:
    joints = in_camera(frame)
    bones = get_format(frame.format).bones
    lines = _lines(joints[:, :3], bones, (*_SEEN_COLOUR, 1.0), 0.03)
    return _entity(frame.originating_ns, f"body {frame.body_id}", _BODY_NS, [lines])


def _forecast(stamp_ns: int, body_id: int, futures: list[Float32]) -> dict[str, Any]:
    """The expected body at five times, the later the fainter."""
    lines = [
        _lines(pose, CORE_BONES, (*_FORECAST_COLOUR, 0.9 - 0.17 * index), 0.018)
        for index, pose in enumerate(futures)
    ]
    return _entity(stamp_ns, f"forecast of {body_id}", _FORECAST_NS, lines)


def _entity(stamp_ns: int, name: str, lifetime_ns: int, lines: list[Any]) -> dict[str, Any]:
    shapes = ("arrows", "cubes", "spheres", "cylinders", "triangles", "texts", "models")
    return {
        "timestamp": _time(stamp_ns),
        "frame_id": CAMERA,
        "id": name,
        "lifetime": _time(lifetime_ns),
        "frame_locked": False,
        "metadata": [],
        "lines": lines,
        **{shape: [] for shape in shapes},
    }


def _lines(
    pose: Float32,
    bones: tuple[tuple[int, int], ...],
    colour: tuple[float, float, float, float],
    thickness: float,
) -> dict[str, Any]:
    points = [_vector(*pose[joint].tolist()) for bone in bones for joint in bone]
    return {
        "type": _LINE_LIST,
        "pose": {"position": _vector(0, 0, 0), "orientation": {**_vector(0, 0, 0), "w": 1}},
        "thickness": thickness,
        "scale_invariant": False,
        "points": points,
        "color": dict(zip("rgba", colour, strict=True)),
        "colors": [],
        "indices": [],
    }


def _upright() -> dict[str, Any]:
    return {
        "timestamp": _time(0),
        "parent_frame_id": ROOM,
        "child_frame_id": CAMERA,
        "translation": _vector(0, 0, 1),
        "rotation": {**_vector(_QUARTER_TURN, 0, 0), "w": _QUARTER_TURN},
    }


def _vector(x: float, y: float, z: float) -> dict[str, float]:
    return {"x": round(x, 4), "y": round(y, 4), "z": round(z, 4)}


def _time(stamp_ns: int) -> dict[str, int]:
    return {"sec": stamp_ns // NS_PER_S, "nsec": stamp_ns % NS_PER_S}


def _schema(name: str) -> tuple[str, str, bytes]:
    """Viewers know these messages by their name; the text holds what is written here."""
    time = {
        "type": "object",
        "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}},
    }
    fields: dict[str, Any] = {
        "foxglove.SceneUpdate": {
            "deletions": {"type": "array", "items": {"type": "object", "properties": {}}},
            "entities": {
                "type": "array",
                "items": {
                    "type": "object",
                    "properties": {
                        "timestamp": time,
                        "frame_id": {"type": "string"},
                        "id": {"type": "string"},
                        "lifetime": time,
                        "frame_locked": {"type": "boolean"},
                    },
                },
            },
        },
        "foxglove.FrameTransform": {
            "timestamp": time,
            "parent_frame_id": {"type": "string"},
            "child_frame_id": {"type": "string"},
        },
    }
    schema = {"title": name, "type": "object", "properties": fields[name]}
    return name, "jsonschema", msgspec.json.encode(schema)
