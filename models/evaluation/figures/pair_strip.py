"""A strip of moments of two people, seen from the side: a preview of an interaction."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from agent_server.domain.arrays import Float32
from models.data.layouts import KINECT15
from models.evaluation.figures.style import INK, QUIET, TRUTH, figure, png

MOMENTS = 6
HEIGHT = 2.4
"""Of the picture, in inches."""


def write_pair_strip(path: Path, action: Float32, reaction: Float32, title: str) -> None:
    """Write a PNG of six moments.

    Args:
        path: The file.
        action: Shape (T, 15, 3), metres, y up, in the frame of the pair.
        reaction: Shape (S, 15, 3), in the same frame; whoever ends first keeps the last pose.
        title: Above it.
    """
    made = figure(HEIGHT, arranged=False)
    canvas = made.add_axes((0, 0, 1, 1))
    canvas.set_axis_off()
    canvas.set_aspect("equal")
    everything = np.concatenate([action, reaction])[..., [0, 1]]
    low, high = everything.min(axis=(0, 1)), everything.max(axis=(0, 1))
    step = 1.15 * (high[0] - low[0])
    for column, at in enumerate(np.linspace(0, max(len(action), len(reaction)) - 1, MOMENTS)):
        for person, colour in ((action, QUIET), (reaction, TRUTH)):
            pose = person[min(round(at), len(person) - 1)]
            _draw(canvas, pose[:, [0, 1]] + [column * step, 0.0], colour)
        # The floor that the two stand on, so that nobody is taken for a neighbour's partner.
        floor = column * step + low[0], column * step + high[0]
        canvas.plot(floor, [low[1] - 0.03] * 2, color=QUIET, linewidth=0.8)
        canvas.text(floor[0], low[1] - 0.07, f"frame {round(at)}", color=INK, fontsize=7, va="top")
    canvas.set_title(title, color=INK, fontsize=9, y=0.9)
    canvas.set_xlim(low[0] - 0.1, low[0] + MOMENTS * step)
    canvas.set_ylim(low[1] - 0.25, high[1] + 0.35)
    path.write_bytes(png(made))


def _draw(canvas: Axes, pose: Float32, colour: str) -> None:
    for parent, child in KINECT15.bones:
        canvas.plot(*pose[[parent, child]].T, color=colour, linewidth=1.6)
