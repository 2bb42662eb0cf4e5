"""The other side of the comparison with MediaPipe: run by an interpreter that has it.

    python mediapipe_side.py TASK_FILE PICTURES.npz FOUND.npz FRAMES

It knows nothing of this project. Pictures are RGB arrays ``0``, ``1``, ...; what is found is
``points_0`` (478, 3) in pixels and ``shapes_0`` (52,), empty without a face; ``astronaut`` is
scikit-image's picture, which is looked at last; ``ms`` are times of tracked frames of picture 0.
"""

import sys
import time
from typing import Any

import mediapipe as mp
import numpy as np
from mediapipe.tasks.python import BaseOptions, vision
from skimage import data


def landmarker(task_file: str, mode: Any) -> Any:
    """MediaPipe's Face Landmarker for one face, with blendshapes."""
    options = vision.FaceLandmarkerOptions(
        base_options=BaseOptions(model_asset_path=task_file),
        running_mode=mode,
        num_faces=1,
        output_face_blendshapes=True,
    )
    return vision.FaceLandmarker.create_from_options(options)


def main(task_file: str, given: str, found: str, frames: str) -> None:
    """Look at every picture, and time a video of the first one."""
    with np.load(given) as kept:
        pictures = [kept[str(index)] for index in range(len(kept.files))]
    astronaut = data.astronaut()
    results: dict[str, Any] = {"astronaut": astronaut}
    look = landmarker(task_file, vision.RunningMode.IMAGE)
    for index, picture in enumerate([*pictures, astronaut]):
        height, width = picture.shape[:2]
        image = mp.Image(image_format=mp.ImageFormat.SRGB, data=np.ascontiguousarray(picture))
        seen = look.detect(image)
        points = seen.face_landmarks[0] if seen.face_landmarks else []
        shapes = seen.face_blendshapes[0] if seen.face_blendshapes else []
        results[f"points_{index}"] = np.array(
            [(p.x * width, p.y * height, p.z * width) for p in points]
        )
        results[f"shapes_{index}"] = np.array([shape.score for shape in shapes])
    video = landmarker(task_file, vision.RunningMode.VIDEO)
    image = mp.Image(image_format=mp.ImageFormat.SRGB, data=np.ascontiguousarray(pictures[0]))
    times = []
    for frame in range(int(frames)):
        began = time.perf_counter()
        video.detect_for_video(image, 40 * frame)
        times.append(1000 * (time.perf_counter() - began))
    np.savez(found, ms=np.array(times), **results)


if __name__ == "__main__":
    main(*sys.argv[1:])
