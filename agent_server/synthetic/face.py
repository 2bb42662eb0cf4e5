"""A made-up person's face: landmarks or blendshapes for a mood, as a camera or a headset has them.

A linear model of real networks' landmarks on generated faces, fitted by
``python -m models export face-shapes``: an expression for each valence and arousal, and
differences between people. Head, place and distance drift; eyes blink; points scatter as those
of the real networks do on a still face in a noisy video.
"""

from dataclasses import dataclass
from functools import cache
from importlib import resources
from math import cos, pi, sin
from typing import Literal

import numpy as np

from agent_server.domain.affect import AFFECT_LIMIT, AffectSample
from agent_server.domain.arrays import Float32, Float64, frozen
from agent_server.domain.face import (
    ARKIT_BLENDSHAPES,
    Face,
    FaceBlendshapes,
    FaceLandmarks,
    FaceLayout,
)
from agent_server.domain.stamp import NS_PER_S
from agent_server.face.layouts import to_dlib68

FaceKind = Literal["mesh478", "mesh468", "dlib68", "blendshapes"]
ASSET = "face_shapes.npz"
IDENTITIES = 12
WIDTH, HEIGHT = 640, 480
EYES_PX = (52.0, 78.0)
"""Distance of the eyes in the image: somebody at a desk, half a metre to a metre away."""
EXPRESSIVENESS = 1.25
"""The mean of many faces is tamer than any of them, so moods are shown by a quarter stronger."""
SCATTER = 0.04
"""From picture to picture, of how people differ: neighbouring points scatter together, by 0.13 px
where the eyes are 65 px apart."""
JITTER_PX = 0.04
"""Of each point by itself."""
SHAPE_SCATTER = 0.008
"""Of the square roots of blendshapes."""
SHAPE_DECIMALS = 3
BLINK_S = 0.15
_DRIFT_HZ = (0.05, 0.12, 0.21)
_BLINKS = tuple(ARKIT_BLENDSHAPES.index(f"eyeBlink{side}") for side in ("Left", "Right"))
_LIDS = (
    ((159, 145), (158, 153), (160, 144), (157, 154), (161, 163)),
    ((386, 374), (385, 380), (387, 373), (384, 381), (388, 390)),
)
"""Points of the upper and the lower lid of each eye."""


@dataclass(frozen=True, slots=True)
class FaceShapes:
    """The linear model.

    Attributes:
        expression: Shape (10, 478, 3): points for each term of a mood; front view, the eyes one
            unit apart.
        identity: Shape (12, 478, 3): how people differ, each a standard deviation.
        shapes: Shape (10, 52): square roots of the blendshapes for each term.
        shape_identity: Shape (12, 52): how people differ in them, each a standard deviation.
    """

    expression: Float64
    identity: Float64
    shapes: Float64
    shape_identity: Float64


@cache
def face_shapes() -> FaceShapes:
    """The model that ships."""
    with resources.files("agent_server.synthetic").joinpath(ASSET).open("rb") as file:
        kept = np.load(file, allow_pickle=False)
        return FaceShapes(
            **{name: kept[name].astype(np.float64) for name in FaceShapes.__dataclass_fields__}
        )


def mood_terms(affect: Float64) -> Float64:
    """Products of valence and arousal (..., 2), on [-1, 1], up to the third power: (..., 10)."""
    v, a = affect[..., 0], affect[..., 1]
    powers = [v ** (degree - i) * a**i for degree in range(4) for i in range(degree + 1)]
    return np.stack(powers, axis=-1)


class SyntheticFace:
    """One person's face.

    Args:
        rng: Where all variation comes from.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._shapes = face_shapes()
        look, habit = np.clip(rng.normal(0, 0.6, (2, IDENTITIES)), -1.2, 1.2)
        self._person = np.tensordot(look, self._shapes.identity, axes=1)  # (478, 3)
        self._habit = habit @ self._shapes.shape_identity  # (52,)
        self._eyes_px = float(rng.uniform(*EYES_PX))
        self._centre = (WIDTH / 2 + rng.normal(0, 40), HEIGHT * 0.45 + rng.normal(0, 20))
        # Yaw, pitch, roll in radians, then x, y in pixels, and the logarithm of the size.
        sizes = np.array((0.07, 0.05, 0.04, 9.0, 5.0, 0.03))
        self._drift = rng.normal(0, 1, (len(_DRIFT_HZ), 6)) * sizes / len(_DRIFT_HZ) ** 0.5
        self._phases = rng.uniform(0, 2 * pi, (len(_DRIFT_HZ), 6))
        self._next_blink_s = float(rng.uniform(0.5, 4.0))

    def show(self, mood: AffectSample, kind: FaceKind) -> Face:
        """The face at the time of ``mood``; times ascend."""
        time_s = mood.originating_ns / NS_PER_S
        shown = EXPRESSIVENESS / AFFECT_LIMIT * np.array((mood.valence, mood.arousal))
        terms = mood_terms(np.clip(shown, -1, 1))
        shut = self._blink(time_s)
        if kind == "blendshapes":
            return FaceBlendshapes(mood.originating_ns, self._blendshapes(terms, shut))
        mesh = self._mesh(terms, shut, time_s)
        layout = FaceLayout(kind)
        points = to_dlib68(mesh) if layout is FaceLayout.DLIB68 else mesh[: layout.points]
        return FaceLandmarks(
            mood.originating_ns, layout, frozen(points, points.shape), WIDTH, HEIGHT
        )

    def _blendshapes(self, terms: Float64, shut: float) -> Float32:
        values = terms @ self._shapes.shapes + self._habit
        values += self._rng.normal(0, SHAPE_SCATTER, len(values))
        values = np.square(np.clip(values, 0, 1))
        values[list(_BLINKS)] += shut
        return frozen(np.clip(values, 0, 1).round(SHAPE_DECIMALS), (len(values),))

    def _mesh(self, terms: Float64, shut: float, time_s: float) -> Float32:
        scatter = self._rng.normal(0, SCATTER, IDENTITIES)
        points = np.tensordot(terms, self._shapes.expression, axes=1) + self._person
        points += np.tensordot(scatter, self._shapes.identity, axes=1)
        for lids in _LIDS:
            for upper, lower in lids:
                points[upper] += shut * 0.9 * (points[lower] - points[upper])
        waves = np.sin(2 * pi * np.array(_DRIFT_HZ)[:, None] * time_s + self._phases)
        yaw, pitch, roll, x, y, growth = (self._drift * waves).sum(axis=0)
        size = self._eyes_px * float(np.exp(growth))
        turned = points @ _turn(yaw, pitch, roll).T * size
        turned[:, :2] += np.add(self._centre, (x, y))
        turned += self._rng.normal(0, JITTER_PX, turned.shape)
        return turned.astype(np.float32)

    def _blink(self, time_s: float) -> float:
        """How far the eyes are shut, in [0, 1]."""
        while time_s > self._next_blink_s + BLINK_S:
            self._next_blink_s += float(self._rng.uniform(1.5, 6.0))
        phase = (time_s - self._next_blink_s) / BLINK_S
        return sin(pi * phase) if 0 <= phase <= 1 else 0.0


def _turn(yaw: float, pitch: float, roll: float) -> Float64:
    """Rotation by three angles, roll last; image axes: x right, y down, z away."""
    cy, sy, cp, sp, cr, sr = cos(yaw), sin(yaw), cos(pitch), sin(pitch), cos(roll), sin(roll)
    about_y = np.array(((cy, 0, sy), (0, 1, 0), (-sy, 0, cy)))
    about_x = np.array(((1, 0, 0), (0, cp, -sp), (0, sp, cp)))
    about_z = np.array(((cr, -sr, 0), (sr, cr, 0), (0, 0, 1)))
    turned: Float64 = about_z @ about_x @ about_y
    return turned
