"""The picture of the skin: a painted face, unrolled around the head and the same on both sides."""

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, MakeHuman, sampled
from agent_server.web.tools.human.noise import bump, noise, step
from agent_server.web.tools.human.scalp import AXIS, above_eyes, above_hairline, around

Mix = Callable[[str, Array], None]
"""Lays a colour, ``#rrggbb``, over the picture, 0 to 1 thick at each pixel."""
SIZE = 1024
TOP, BOTTOM = 0.105, -0.20
"""What the picture shows, metres above the eyes."""
PLAIN = (0.5, 0.004)
"""Texture coordinates of bare skin, for all that is no head."""
SKIN, BLUSH, LIPS, LIP_LINE = "#c4957a", "#b5715f", "#a8645a", "#6b3a35"
HAIR, STUBBLE, SOCKET, WATERLINE = "#2c211b", "#8f7a70", "#a4705f", "#b8796b"
BROW_FROM, BROW_PEAK, BROW_TO = (0.0125, 0.0170), (0.044, 0.0238), (0.060, 0.0165)
"""The line of an eyebrow: metres from the middle of the face, and above the eyes."""
LIPS_MEET = -0.0735
"""Where the lips meet, metres above the eyes."""
QUALITY = 88


@dataclass(frozen=True)
class Chart:
    """What lies under each pixel of the picture.

    Attributes:
        points: Positions on the skin, metres, (SIZE, SIZE, 3).
        lips: MakeHuman's mask of the lips, 0 to 1, (SIZE, SIZE).
        lids: And of the edges of the eyelids.
        covered: Where there is skin.
    """

    points: Array
    lips: Array
    lids: Array
    covered: NDArray[np.bool_]


def unrolled(points: Array, figure: Figure) -> Array:
    """Texture coordinates of places on the head, v down, (..., 2)."""
    share = around(points) / np.pi
    u = share * (1.6 - 0.6 * share)  # the face gets more room than the nape
    v = (TOP - above_eyes(points, figure)) / (TOP - BOTTOM)
    return np.clip(np.stack([u, v], axis=-1), 0, 1)


def skin_picture(data: MakeHuman, figure: Figure) -> bytes:
    """Paint the face.

    Returns:
        A JPEG file.
    """
    colours = _painted(_chart(data, figure), figure)
    picture = np.round(255 * np.clip(colours, 0, 1)).astype(np.uint8)[..., ::-1]
    done, packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    if not done:
        raise RuntimeError("the picture of the skin could not be packed")
    return packed.tobytes()


def _chart(data: MakeHuman, figure: Figure) -> Chart:
    faces = data.groups["body"]
    head = (above_eyes(figure.positions[faces.vertices], figure).min(1) > BOTTOM) & (
        figure.positions[faces.vertices][..., 0].min(1) > -1e-6
    )
    quads, uv = faces.vertices[head], faces.uv[head]
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    corner_uv = np.concatenate([uv[:, [0, 1, 2]], uv[:, [0, 2, 3]]])
    points = figure.positions[corners]
    values = np.concatenate([points, corner_uv], axis=2)
    flat = unrolled(points, figure) * SIZE
    radius = np.hypot(points[..., 0], points[..., 2] - AXIS).mean(1)
    canvas = np.zeros((SIZE, SIZE, 5))
    covered = np.zeros((SIZE, SIZE), dtype=bool)
    for k in np.argsort(radius, kind="stable"):  # the outermost is drawn last
        _fill(canvas, covered, flat[k], values[k])
    lips, lids = (
        np.asarray(cv2.GaussianBlur(sampled(data.mask(name), canvas[..., 3:]), (0, 0), 1.5), float)
        for name in ("lips", "eyelids")
    )
    return Chart(canvas[..., :3], lips, lids, covered)


def _fill(canvas: Array, covered: NDArray[np.bool_], corners: Array, values: Array) -> None:
    """Draw a triangle, a little larger than it is."""
    low = np.clip(np.floor(corners.min(0)) - 1, 0, SIZE - 1).astype(int)
    high = np.clip(np.ceil(corners.max(0)) + 2, 0, SIZE).astype(int)
    sides = np.stack([corners[1] - corners[0], corners[2] - corners[0]], axis=1)
    if abs(np.linalg.det(sides)) < 1e-9:
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    local = np.stack([x - corners[0, 0], y - corners[0, 1]], axis=-1) @ np.linalg.inv(sides).T
    shares = np.concatenate([1 - local.sum(-1, keepdims=True), local], axis=-1)
    slack = 0.8 * np.abs(np.linalg.inv(sides)).sum()
    inside = shares.min(-1) > -min(slack, 1.0)
    window = np.s_[low[1] : high[1], low[0] : high[0]]
    within = np.clip(shares[inside], 0, 1)
    canvas[window][inside] = within / within.sum(1, keepdims=True) @ values
    covered[window] |= inside


def _srgb(colour: str) -> Array:
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255


def _painted(chart: Chart, figure: Figure) -> Array:
    """The colours as written on the web, 0 to 1, (SIZE, SIZE, 3)."""
    points = chart.points
    x, z = np.abs(points[..., 0]), points[..., 2]
    y = above_eyes(points, figure)
    eye = x - figure.rig["LeftEye"][0]
    colours = np.tile(_srgb(SKIN), (SIZE, SIZE, 1))

    def mix(colour: str, amount: Array) -> None:
        share = np.clip(amount, 0, 1)[..., None]
        colours[:] = colours * (1 - share) + _srgb(colour) * share

    face = step(0.02, 0.07, z)
    patches = noise(points * 45, 21) + 0.6 * noise(points * 110, 22)
    mix(BLUSH, 0.05 * patches + 0.03)
    cheek = bump(((x - 0.046) / 0.022) ** 2 + ((y + 0.038) / 0.020) ** 2)
    nose = bump((x / 0.014) ** 2 + ((y + 0.036) / 0.014) ** 2) * step(0.13, 0.15, z)
    ear = step(0.084, 0.094, x) * bump(((y + 0.02) / 0.04) ** 2)
    chin = bump((x / 0.02) ** 2 + ((y + 0.112) / 0.016) ** 2) * face
    mix(BLUSH, 0.42 * cheek * face + 0.38 * nose + 0.45 * ear + 0.18 * chin)
    socket = bump((eye / 0.023) ** 2 + ((y + 0.001) / 0.013) ** 2) * face
    under = bump(((eye + 0.004) / 0.016) ** 2 + ((y + 0.014) / 0.006) ** 2) * face
    mix(SOCKET, 0.40 * socket + 0.16 * under)
    beard = step(-0.040, -0.060, y - 0.25 * (x - 0.03).clip(0)) * step(-0.150, -0.122, y) * face
    grain = 0.5 + 0.5 * noise(points * 900, 23)
    mix(STUBBLE, beard * (0.16 + 0.16 * grain))
    mix(WATERLINE, 0.5 * chart.lids)
    crease = bump((eye / 0.019) ** 4 + ((y - 0.0088 + 6 * eye**2) / 0.0012) ** 2) * face
    mix("#7a4a3e", 0.35 * crease)
    _paint_lips(mix, chart, x, y)
    mix(HAIR, 0.92 * _brow(x, y) * face)
    line = above_hairline(points, figure)
    roots = step(-0.007, 0.008, line + 0.005 * noise(points * 160, 24)) * step(0.088, 0.078, y)
    mix(HAIR, roots * (0.55 + 0.35 * noise(points * 700, 25)))
    pores = 0.012 * noise(points * 1400, 26) + 0.012 * noise(points * 700, 27)
    return colours * (1 + pores[..., None] * chart.covered[..., None])


def _paint_lips(mix: Mix, chart: Chart, x: Array, y: Array) -> None:
    """Lips with a dark line where they meet and fine upright lines."""
    fine = 0.5 + 0.5 * noise(np.stack([x * 900, y * 120, 0 * x], axis=-1), 28)
    mix(LIPS, chart.lips * (0.62 + 0.16 * fine))
    meeting = LIPS_MEET + 3.6 * x**2
    mix(LIP_LINE, 0.45 * bump(((y - meeting) / 0.0011) ** 2) * step(0.026, 0.020, x) * chart.lips)


def _brow(x: Array, y: Array) -> Array:
    """How dense the hairs of an eyebrow are, 0 to 1."""
    (x0, y0), (x1, y1), (x2, y2) = BROW_FROM, BROW_PEAK, BROW_TO
    share = np.clip((x - x0) / (x2 - x0), -0.2, 1.2)
    middle = np.where(
        x < x1,
        y0 + (y1 - y0) * np.sin(np.clip((x - x0) / (x1 - x0), -0.3, 1) * np.pi / 2),
        y1 + (y2 - y1) * (1 - np.cos(np.clip((x - x1) / (x2 - x1), 0, 1.2) * np.pi / 2)),
    )
    half = 0.0046 - 0.0026 * np.clip(share, 0, 1) ** 1.3
    lean = np.interp(share, [0.0, 0.35, 1.0], [1.25, 0.65, -0.25])  # of the hairs, radians
    along = (x - x0) * np.cos(lean) + (y - middle) * np.sin(lean)
    beside = -(x - x0) * np.sin(lean) + (y - middle) * np.cos(lean)
    hairs = noise(np.stack([along * 220, beside * 1900, 0 * x], axis=-1), 29)
    hairs = hairs + 0.6 * noise(np.stack([along * 300, beside * 3600, 0 * x], axis=-1), 30)
    ragged = 0.0016 * hairs
    across = step(1.0, 0.35, np.abs(y - middle + ragged) / half)
    ends = step(-0.06, 0.10, share + 0.05 * hairs) * step(1.05, 0.8, share + 0.05 * hairs)
    return np.clip(across * ends * (0.78 + 0.45 * hairs), 0, 1)
