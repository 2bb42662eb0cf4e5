"""A recording for the Rerun viewer, which is an optional extra: ``pip install .[rerun]``."""

from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_BONES
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError, InvalidInput
from agent_server.qa.export.content import Content, in_camera
from agent_server.skeleton.formats import get_format

_TIME = "session"
_AHEAD = (9, 19, 29, 39, 49)
_SEEN, _FORECAST = (235, 235, 240), (90, 150, 255)


def write_rerun(content: Content, path: Path) -> None:
    """Write bodies and forecasts in three dimensions, probabilities, affect and decisions.

    Raises:
        ConfigError: If Rerun is not installed.
        InvalidInput: If the file cannot be written.
    """
    try:
        import rerun as rr  # noqa: PLC0415 - an extra, and heavy
    except ImportError:
        raise ConfigError(
            "--rerun needs the Rerun SDK: pip install 'agent-server[rerun]', or pip install "
            "rerun-sdk"
        ) from None
    stream: Any = rr.RecordingStream("agent-server", recording_id=content.session)
    try:
        stream.save(str(path))
    except Exception as error:  # the SDK raises what its core raises
        raise InvalidInput(f"{path} cannot be written: {error}") from error
    stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Y_UP, static=True)
    for frame in content.frames:
        _at(stream, frame.originating_ns)
        joints = in_camera(frame)[:, :3]
        bones = _strips(joints, get_format(frame.format).bones)
        stream.log(f"bodies/{frame.body_id}", rr.LineStrips3D(bones, colors=[_SEEN], radii=[0.012]))
    for sample in content.affect:
        _at(stream, sample.originating_ns)
        stream.log("affect/valence", rr.Scalars(sample.valence))
        stream.log("affect/arousal", rr.Scalars(sample.arousal))
    for sight in content.sights:
        decision = sight.decision
        _at(stream, decision.end_ns)
        strips = [s for i in _AHEAD for s in _strips(sight.forecast.positions[i], CORE_BONES)]
        stream.log("forecast", rr.LineStrips3D(strips, colors=[_FORECAST], radii=[0.006]))
        for name, probability in decision.probabilities.items():
            stream.log(f"probability/{name}", rr.Scalars(probability))
        stream.log("decisions", rr.TextLog(decision.reason, level=_level(decision.command)))
    for label in content.labels:
        _at(stream, label.onset_ns)
        then = label.expected or ("stay quiet" if label.quiet else "as it likes")
        stream.log("labels", rr.TextLog(f"{label.gesture}: {then}"))
    stream.disconnect()


def _at(stream: Any, stamp_ns: int) -> None:
    stream.set_time(_TIME, duration=stamp_ns / NS_PER_S)


def _strips(pose: Float32, bones: tuple[tuple[int, int], ...]) -> list[Float32]:
    return [np.stack([pose[parent], pose[child]]) for parent, child in bones]


def _level(command: object) -> str:
    return "DEBUG" if command is None else "INFO"
