"""What is exported: what the sensors saw, and what the models in use make of it."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.affect import AffectSample
from agent_server.domain.arrays import Float32
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.qa.setup import Setup
from agent_server.qa.watch import Sight
from agent_server.recording.reader import open_recording
from agent_server.service.replay import replay
from agent_server.skeleton.formats import get_format


@dataclass(frozen=True, slots=True)
class Content:
    """A recording and its replay.

    Attributes:
        path: The recording.
        session: Its session.
        frames: Skeletons as they were sent.
        affect: Valence and arousal as they were sent or read from the face.
        labels: Ground truth.
        sights: Windows, forecasts and decisions.
    """

    path: Path
    session: str
    frames: list[SkeletonFrame]
    affect: list[AffectSample]
    labels: tuple[Label, ...]
    sights: list[Sight]


def gather(path: Path, setup: Setup) -> Content:
    """Read and replay a recording.

    Raises:
        AgentServerError: If it cannot be replayed.
        InvalidInput: If it shows no body.
    """
    recording = open_recording(path)
    core = setup.core(recording.metadata.session)
    for _ in replay(recording, core, setup.models):
        pass
    frames = [event for event in recording.events() if isinstance(event, SkeletonFrame)]
    if not frames:
        raise InvalidInput(f"{path} shows no body: there is nothing to export")
    return Content(
        path, recording.metadata.session, frames, core.affect, recording.labels(), core.sights
    )


def in_camera(frame: SkeletonFrame) -> Float32:
    """A skeleton's joints, shape (J, 4): x, y, z in metres in the camera frame, confidence."""
    table = get_format(frame.format)
    scale = np.array([*(table.unit_m * axis for axis in table.axes), 1.0], np.float32)
    scaled: Float32 = frame.joints * scale
    return scaled
