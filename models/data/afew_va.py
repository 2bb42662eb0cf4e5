"""AFEW-VA as published (Kossaifi et al. 2017): film clips with 68 points, valence and arousal.

A JSON file a clip: ``video_id``, ``actor``, and ``frames`` = name -> ``landmarks`` (68 x, y in
pixels), ``valence`` and ``arousal`` in [-10, 10]. The pictures beside it are not needed.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput

POINTS = 68
LIMIT = 10.0
Level = Annotated[float, Meta(ge=-LIMIT, le=LIMIT)]
Point = tuple[float, float]


class _Frame(msgspec.Struct, frozen=True):
    landmarks: Annotated[list[Point], Meta(min_length=POINTS, max_length=POINTS)]
    valence: Level
    arousal: Level


class _Clip(msgspec.Struct, frozen=True):
    video_id: str
    actor: str
    frames: dict[str, _Frame]


@dataclass(frozen=True, slots=True)
class AfewVa:
    """All frames of all clips.

    Attributes:
        points: Shape (N, 68, 2), in pixels, dlib's order.
        affect: Shape (N, 2): valence and arousal on [-1, 1].
        clips: Of each frame its clip.
        actors: Of each frame who acts.
    """

    points: Float32
    affect: Float32
    clips: tuple[str, ...]
    actors: tuple[str, ...]


def read_afew_va(folder: Path) -> AfewVa:
    """Read all clips below a folder.

    Raises:
        InvalidInput: If there are none, or one is not as published; the text names the file.
    """
    paths = sorted(folder.rglob("*.json"))
    clips = [_read(path) for path in paths]
    if not clips:
        raise InvalidInput(f"{folder} holds no clip of AFEW-VA: a JSON file a clip is expected")
    frames = [(clip, clip.frames[name]) for clip in clips for name in sorted(clip.frames)]
    return AfewVa(
        np.array([frame.landmarks for _, frame in frames], dtype=np.float32),
        np.array([(f.valence, f.arousal) for _, f in frames], dtype=np.float32) / LIMIT,
        tuple(clip.video_id for clip, _ in frames),
        tuple(clip.actor for clip, _ in frames),
    )


def _read(path: Path) -> _Clip:
    try:
        return msgspec.json.decode(path.read_bytes(), type=_Clip)
    except msgspec.MsgspecError as error:
        raise InvalidInput(f"{path} is no clip of AFEW-VA: {error}") from error
