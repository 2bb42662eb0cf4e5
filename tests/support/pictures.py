"""Pictures of faces: DiffusionFER's, where they are, on a grey ground."""

import csv
import os
from pathlib import Path

import cv2
import numpy as np
import pytest

DATA = os.environ.get("AGENT_SERVER_DATA", "")
FACES = Path(DATA) / "diffusionfer"
needs_faces = pytest.mark.skipif(
    not (DATA and (FACES / "labels.csv").exists()), reason="AGENT_SERVER_DATA has no diffusionfer"
)


def labelled(count, *, valence=(-1, 1), arousal=(-1, 1)):
    """Files of some faces whose labels lie in these ranges."""
    with (FACES / "labels.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    found = [
        row["file"]
        for row in rows
        if valence[0] <= float(row["valence"]) <= valence[1]
        and arousal[0] <= float(row["arousal"]) <= arousal[1]
    ]
    return found[:: max(1, len(found) // count)][:count]


def picture(file, side=224):
    """A face, RGB."""
    image = cv2.imread(str(FACES / file), cv2.IMREAD_COLOR_RGB)
    return cv2.resize(image, (side, side), interpolation=cv2.INTER_AREA if side < 224 else 1)


def framed(face, width=640, height=480, x=None, y=None):
    """A face in a larger, grey picture; at its centre if not said where."""
    ground = np.full((height, width, 3), 90, dtype=np.uint8)
    rows, columns = face.shape[:2]
    x = (width - columns) // 2 if x is None else x
    y = (height - rows) // 2 if y is None else y
    ground[y : y + rows, x : x + columns] = face
    return ground


def jpeg(image, quality=90):
    """A picture as JPEG."""
    ok, data = cv2.imencode(
        ".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, quality]
    )
    assert ok
    return data.tobytes()
