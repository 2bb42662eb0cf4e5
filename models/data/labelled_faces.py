"""Pictures of faces with valence and arousal: a folder of images beside a ``labels.csv``.

This is how DiffusionFER is laid out here (1,032 generated faces, CC0). Its test fifth is chosen
by the hash of each file's name, so that it stays what it is whatever the order.
"""

import csv
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput
from agent_server.face.image import Pixels

SOURCE = "DiffusionFER, faces made by a diffusion model and labelled by people"
LICENCE = "CC0"
FOLDER = "diffusionfer"
LABELS = "labels.csv"
COLUMNS = ("file", "valence", "arousal")
TRAINED_ON = "4fc40e92"
"""Begins the SHA-256 of the labels that the shipped models were trained with."""


@dataclass(frozen=True, slots=True)
class LabelledFaces:
    """Faces and what people saw in them.

    Attributes:
        folder: Where the pictures are.
        files: Path of each within the folder.
        affect: Shape (N, 2): valence and arousal on [-1, 1].
    """

    folder: Path
    files: tuple[str, ...]
    affect: Float32

    def take(self, indices: Sequence[int]) -> "LabelledFaces":
        """Some of the faces."""
        files = tuple(self.files[index] for index in indices)
        return LabelledFaces(self.folder, files, self.affect[list(indices)])

    def picture(self, index: int) -> Pixels:
        """One picture, RGB.

        Raises:
            InvalidInput: If the file is missing or no picture.
        """
        path = self.folder / self.files[index]
        image = cv2.imread(str(path), cv2.IMREAD_COLOR_RGB)
        if image is None:
            raise InvalidInput(f"{path} is missing or no picture", field=f"files[{index}]")
        return image.astype(np.uint8, copy=False)


def read_faces(data: Path) -> LabelledFaces:
    """Read the labels of a folder.

    Args:
        data: Folder with ``labels.csv``, or one that holds such a folder ``diffusionfer``.

    Raises:
        InvalidInput: If there are no labels, or a row is wrong; the text names the line.
    """
    folder = data if (data / LABELS).exists() else data / FOLDER
    path = folder / LABELS
    try:
        with path.open(newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [name for name in COLUMNS if name not in (reader.fieldnames or ())]
            if missing:
                raise InvalidInput(f"{path} has no column {', '.join(missing)}", field="labels")
            rows = [_row(path, reader.line_num, row) for row in reader]
    except OSError as error:
        raise InvalidInput(
            f"{path} cannot be read ({error.strerror}): give a folder of pictures with a "
            f"{LABELS} that has the columns {', '.join(COLUMNS)}"
        ) from error
    if not rows:
        raise InvalidInput(f"{path} has no rows", field="labels")
    files = tuple(file for file, _, _ in rows)
    return LabelledFaces(folder, files, np.array([row[1:] for row in rows], dtype=np.float32))


def _row(path: Path, line: int, row: dict[str, str]) -> tuple[str, float, float]:
    values = []
    for name in COLUMNS[1:]:
        try:
            value = float(row[name])
        except (TypeError, ValueError):
            raise InvalidInput(f"{path}, line {line}: {name} is {row[name]!r}, no number") from None
        if not -1.0 <= value <= 1.0:
            raise InvalidInput(f"{path}, line {line}: {name} is {value:g}, outside -1..1")
        values.append(value)
    return row["file"], values[0], values[1]


def test_split(faces: LabelledFaces) -> tuple[list[int], list[int]]:
    """Indices of the training four fifths and of the test fifth."""
    train: list[int] = []
    test: list[int] = []
    for index, file in enumerate(faces.files):
        digest = int(hashlib.sha256(file.encode()).hexdigest(), 16)
        (test if digest % 5 == 0 else train).append(index)
    return train, test


def is_training_set(faces: LabelledFaces) -> bool:
    """Whether these are the faces that the shipped models were trained on, by their labels."""
    data = (faces.folder / LABELS).read_bytes()
    return hashlib.sha256(data).hexdigest().startswith(TRAINED_ON)
