"""A small recording with every kind of record, and how it is told apart from another."""

import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol.messages import PoseStreamMessage
from agent_server.recording.writer import RecordingWriter
from tests.support.faces import FACES

MOTION = PoseStreamMessage("s/c1", 0, 25.0, ["head", "neck"], [[[0.0, 1.5, 0.0], [0.0, 1.3, 0.0]]])
GOLDEN_DIR = Path(__file__).parents[2] / "golden"


@pytest.fixture(scope="session")
def session() -> ModuleType:
    """The script that made the golden file: METADATA, append_all, GOLDEN."""
    spec = importlib.util.spec_from_file_location(
        "make_recording_v1", GOLDEN_DIR / "make_recording_v1.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def write(session: ModuleType, tmp_path: Path) -> Callable[[str], Path]:
    """Writes the small recording under a name; with what came after version 1 if asked to."""

    def write_it(name: str, *, with_later: bool = False) -> Path:
        path = tmp_path / name
        with RecordingWriter(path, session.METADATA) as writer:
            session.append_all(writer)
            for value in FACES if with_later else ():
                writer.append_input(value, (5, 7))
            if with_later:
                writer.append_image(b"\xff\xd8 jpeg", 3_000_000_007)
                writer.append_output(MOTION, 3_000_000_008)
        return path

    return write_it


@pytest.fixture
def session_frames(session: ModuleType) -> list[SkeletonFrame]:
    """One body's frames at 30 Hz."""
    return [session.body(index, 1) for index in range(session.FRAMES)]
