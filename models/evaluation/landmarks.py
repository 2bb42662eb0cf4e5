"""Our face pipeline against the real MediaPipe: the same pictures, the same thread, the same run.

MediaPipe lives in an environment that is made for the comparison and thrown away; neither the
server nor training needs it.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import BundleError
from agent_server.face.blendshapes import FaceBlendshaper
from agent_server.face.features import mesh_features
from agent_server.face.image import Pixels
from agent_server.face.tracker import FaceTracker
from agent_server.inference.manifest import MODEL_FILE
from models.affect.views import Network
from models.data.labelled_faces import LabelledFaces
from models.ops.session import OnnxModel

PACKAGES = ("mediapipe", "scikit-image")
PICTURES = 100
FRAMES = 200
WIDTH, HEIGHT = 640, 480
FACE_PX = 400
RIGHT_IRIS, LEFT_IRIS = 468, 473
SCRIPT = Path(__file__).with_name("mediapipe_side.py")


def compare_with_mediapipe(faces: LabelledFaces, bundles: Path, task_file: bytes) -> dict[str, Any]:
    """Differences of landmarks and blendshapes, faces found, and times of a tracked frame.

    Args:
        faces: The first hundred of them are looked at.
        bundles: Folder of our bundles.
        task_file: MediaPipe's models, the file that ours were converted from.

    Raises:
        BundleError: If MediaPipe cannot be installed or does not run.
    """
    count = min(PICTURES, len(faces.files))
    chosen = np.linspace(0, len(faces.files) - 1, count).astype(int)
    pictures = [_video_frame(faces.picture(0)), *(faces.picture(int(i)) for i in chosen)]
    with tempfile.TemporaryDirectory() as folder:
        theirs = _their_side(Path(folder), pictures, task_file)
    pictures.append(theirs["astronaut"].astype(np.uint8))
    ours = _Ours(bundles)
    apart, shapes_apart, found, found_by_them = [], [], 0, 0
    # The first picture is the frame of the video, which is measured for its time alone.
    for index, picture in enumerate(pictures[1:], start=1):
        points, reference = ours.look(picture), theirs[f"points_{index}"]
        found += points is not None
        found_by_them += len(reference) > 0
        if points is None or len(reference) == 0:
            continue
        pupils = np.linalg.norm(reference[RIGHT_IRIS, :2] - reference[LEFT_IRIS, :2])
        distance = np.linalg.norm(points[:, :2] - reference[:, :2], axis=1).mean()
        apart.append(float(distance / pupils))
        # Ours leave out how neutral the face is and add the tongue.
        difference = ours.shapes(points)[:-1] - theirs[f"shapes_{index}"][1:]
        shapes_apart.append(float(np.abs(difference).max()))
    mediapipe_ms = float(np.median(theirs["ms"][FRAMES // 4 :]))
    full_ms, fast_ms = ours.full_ms(pictures[0]), ours.fast_ms(pictures[0])
    looked_at = len(pictures) - 1
    return {
        "pictures": looked_at,
        "faces_found": round(found / looked_at, 4),
        "faces_found_by_mediapipe": round(found_by_them / looked_at, 4),
        "landmarks_percent_of_pupil_distance": {
            "mean": round(100 * float(np.mean(apart)), 3),
            "largest": round(100 * float(np.max(apart)), 3),
            "astronaut": round(100 * apart[-1], 3),
        },
        "blendshapes_apart": {
            "mean_of_largest": round(float(np.mean(shapes_apart)), 4),
            "largest": round(float(np.max(shapes_apart)), 4),
        },
        "tracked_frame_ms": {
            "mediapipe": round(mediapipe_ms, 2),
            "full_mesh_blendshapes_affect": round(full_ms, 2),
            "fast_mesh_affect": round(fast_ms, 2),
        },
        "ratio": {
            "full": round(full_ms / mediapipe_ms, 3),
            "fast": round(fast_ms / mediapipe_ms, 3),
        },
    }


class _Ours:
    """Our pipeline, as the server runs it: one thread."""

    def __init__(self, bundles: Path) -> None:
        self._detector = Network(bundles / "face_detector")
        self._mesh = Network(bundles / "face_mesh")
        self._fast = Network(bundles / "face_mesh_fast")
        self._blendshaper = FaceBlendshaper(Network(bundles / "face_blendshapes"))
        self._affect = OnnxModel(bundles / "affect_mesh" / MODEL_FILE)

    def look(self, picture: Pixels) -> Float32 | None:
        """Points of the face in a picture that is looked at once."""
        found = FaceTracker(self._detector, self._mesh).look(picture)
        return None if found is None else found.points

    def shapes(self, points: Float32) -> Float32:
        """Blendshapes of a mesh."""
        return self._blendshaper.read(points)

    def full_ms(self, frame: Pixels) -> float:
        """Median time of a tracked frame with 478 points, blendshapes and affect."""
        return self._time(frame, self._mesh, with_shapes=True)

    def fast_ms(self, frame: Pixels) -> float:
        """Median time of a tracked frame with 468 points and affect."""
        return self._time(frame, self._fast, with_shapes=False)

    def _time(self, frame: Pixels, mesh: Network, *, with_shapes: bool) -> float:
        cv2.setNumThreads(1)
        tracker = FaceTracker(self._detector, mesh)
        times = []
        for _ in range(FRAMES):
            began = time.perf_counter()
            found = tracker.look(frame)
            if found is None:
                raise BundleError("no face was found in the frame that is timed")
            if with_shapes:
                self._blendshaper.read(found.points)
            self._affect(mesh_features(found.points)[None])
            times.append(1000 * (time.perf_counter() - began))
        return float(np.median(times[FRAMES // 4 :]))


def _video_frame(face: Pixels) -> Pixels:
    frame = np.full((HEIGHT, WIDTH, 3), 90, dtype=np.uint8)
    x, y = (WIDTH - FACE_PX) // 2, (HEIGHT - FACE_PX) // 2
    frame[y : y + FACE_PX, x : x + FACE_PX] = cv2.resize(face, (FACE_PX, FACE_PX))
    return frame


def _their_side(folder: Path, pictures: list[Pixels], task_file: bytes) -> Mapping[str, Any]:
    """What MediaPipe makes of the pictures, on the one core that this process runs on."""
    task, given, found = folder / "face.task", folder / "given.npz", folder / "found.npz"
    task.write_bytes(task_file)
    arrays: dict[str, Any] = {str(index): picture for index, picture in enumerate(pictures)}
    np.savez(given, **arrays)
    python = folder / "venv" / "bin" / "python"
    _run([sys.executable, "-m", "venv", str(folder / "venv")])
    _run([str(python), "-m", "pip", "install", "--quiet", *PACKAGES])
    _run([str(python), str(SCRIPT), str(task), str(given), str(found), str(FRAMES)])
    with np.load(found) as results:
        return {name: results[name] for name in results.files}


def _run(command: list[str]) -> None:
    process = subprocess.run(command, check=False, capture_output=True, text=True)  # noqa: S603
    if process.returncode != 0:
        raise BundleError(
            f"{' '.join(command[:4])} ... failed: {process.stderr.strip()[-400:]}; MediaPipe may "
            "need the system libraries libgl1 and libegl1"
        )


def on_one_core() -> None:
    """Keep this process, and what it starts, on one core, where the system lets one choose."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
