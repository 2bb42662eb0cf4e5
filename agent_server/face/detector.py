"""Finding faces in an image: BlazeFace, short range (Bazarevsky et al. 2019).

The network gives a box and six key points for each of 896 anchors; boxes that overlap are
averaged by their scores.
"""

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.model import FaceNetwork
from agent_server.face.image import Pixels
from agent_server.face.regions import Region, region_of_box

MIN_SCORE = 0.5
MIN_OVERLAP = 0.3
_GRIDS = ((16, 2), (8, 6))
"""Cells a side and anchors a cell of the two feature maps."""
_RIGHT_EYE, _LEFT_EYE = 0, 1


@dataclass(frozen=True, slots=True)
class Detection:
    """A face in an image.

    Attributes:
        low: Left upper corner of its box, (2,) in pixels.
        high: Right lower corner.
        keypoints: Eyes, nose, mouth and ears of the person, the right one first: (6, 2).
        score: How sure it is a face, in [0, 1].
    """

    low: Float32
    high: Float32
    keypoints: Float32
    score: float

    @property
    def area(self) -> float:
        """Of the box, in square pixels."""
        return float(np.prod(self.high - self.low))

    @property
    def region(self) -> Region:
        """Where to look at the face."""
        return region_of_box(
            self.low, self.high, self.keypoints[_RIGHT_EYE], self.keypoints[_LEFT_EYE]
        )


class FaceDetector:
    """Finds faces.

    Args:
        network: A network of the role ``detector``.
    """

    def __init__(self, network: FaceNetwork) -> None:
        self._network = network
        self._side = network.input_shape[1]

    def detect(self, image: Pixels) -> list[Detection]:
        """All faces of an image, the largest first.

        Raises:
            InferenceError: If the network fails.
        """
        given, scale, offset = self._letterbox(image)
        found = self._network.run(given)
        scores = _logistic(found["scores"][0, :, 0])
        sure = scores > MIN_SCORE
        values = found["boxes"][0, sure] / self._side  # (K, 16)
        anchors = _anchors()[sure]
        centre, size = values[:, :2] + anchors, values[:, 2:4]
        keypoints = values[:, 4:].reshape(-1, 6, 2) + anchors[:, None]
        # low, high and key points: (K, 8, 2) in pixels of the image.
        corners = np.stack((centre - size / 2, centre + size / 2), axis=1)
        places = (np.concatenate((corners, keypoints), axis=1) * self._side - offset) / scale
        merged = _merge(places.astype(np.float32), scores[sure])
        return sorted(merged, key=lambda detection: -detection.area)

    def _letterbox(self, image: Pixels) -> tuple[Float32, float, Float32]:
        """The whole image as input of the network, with the scale and the offset used."""
        side = self._side
        height, width = image.shape[:2]
        scale = side / max(height, width)
        offset = (side - scale * np.array((width, height))) / 2
        x, y = -offset / scale
        back = np.array(((1 / scale, 0, x), (0, 1 / scale, y)), dtype=np.float32)
        # Corner to corner and without smoothing, as the network knows it from MediaPipe.
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        small = cv2.warpAffine(image, back, (side, side), flags=flags)
        given = np.multiply(small, np.float32(1 / 127.5), dtype=np.float32)[None] - 1
        return given, scale, offset.astype(np.float32)


def _merge(places: Float32, scores: Float32) -> list[Detection]:
    """Weighted non-maximum suppression: what overlaps the best is averaged into it."""
    detections = []
    left = np.argsort(-scores)
    while len(left):
        overlaps = _overlap(places[left[0], :2], places[left, :2])
        overlaps[0] = 1.0  # the best with itself, even if it has no area
        same = left[overlaps > MIN_OVERLAP]
        weights = scores[same] / scores[same].sum()
        low, high, *keypoints = np.einsum("k,kpa->pa", weights, places[same])
        detections.append(Detection(low, high, np.array(keypoints), float(scores[left[0]])))
        left = left[overlaps <= MIN_OVERLAP]
    return detections


def _overlap(box: Float32, boxes: Float32) -> Float32:
    """Intersection over union of one box (2, 2) with each of (K, 2, 2)."""
    low = np.maximum(box[0], boxes[:, 0])
    high = np.minimum(box[1], boxes[:, 1])
    shared = np.clip(high - low, 0, None).prod(axis=1)
    areas = (boxes[:, 1] - boxes[:, 0]).prod(axis=1)
    own = (box[1] - box[0]).prod()
    union = own + areas - shared
    result: Float32 = np.divide(shared, union, out=np.zeros_like(shared), where=union > 0)
    return result


def _logistic(values: Float32) -> Float32:
    result = 1 / (1 + np.exp(-np.clip(values, -80, 80)))
    return result.astype(np.float32)


@cache
def _anchors() -> Float32:
    """Centres of the anchors in shares of the image, (896, 2)."""
    rows = []
    for cells, count in _GRIDS:
        centres = (np.arange(cells) + 0.5) / cells
        y, x = np.meshgrid(centres, centres, indexing="ij")
        rows.append(np.repeat(np.stack((x.ravel(), y.ravel()), axis=1), count, axis=0))
    return np.concatenate(rows).astype(np.float32)
