"""How figures look: one colour a model, quiet axes, names at the ends of lines."""

import io
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from scipy.optimize import isotonic_regression

INK = "#1b1f24"
QUIET = "#68707a"
RULE = "#e4e7eb"
TRUTH = "#1b1f24"
COLOURS = {
    "zero_velocity": "#8b929b",
    "one_fc": "#e08e00",
    "simlpe": "#0072b2",
    "paper": "#b8629a",
    "best": "#d1490c",
    "server": "#00876a",
}
"""Told apart by colour-blind readers too (after Okabe and Ito), each plain on white."""
SPARE = ("#3f9fdc", "#7a3e9d", "#7c6a00", "#882255")
WIDTH = 10.4
DPI = 180


@dataclass(frozen=True, slots=True)
class Plot:
    """A figure and what it shows.

    Attributes:
        kind: What sort of figure it is.
        title: The finding, from the numbers; names of models and actions stand in backticks.
        note: How to read it.
        png: The picture.
    """

    kind: str
    title: str
    note: str
    png: bytes


def colours(models: list[str]) -> dict[str, str]:
    """A colour for each model; a model of the product always has the same one."""
    others = [name for name in models if name not in COLOURS]
    spare = {name: SPARE[at % len(SPARE)] for at, name in enumerate(others)}
    return {name: COLOURS.get(name) or spare[name] for name in models}


def mixed(colour: str, other: str, share: float) -> tuple[float, float, float]:
    """A colour with a share of another one in it."""
    red, green, blue = (1 - share) * np.array(to_rgb(colour)) + share * np.array(to_rgb(other))
    return float(red), float(green), float(blue)


def duration(ms: float) -> str:
    """``80 ms``, ``1 s``, ``1.5 s``."""
    return f"{ms / 1000:g} s" if abs(ms) >= 1000 else f"{ms:g} ms"


def text_colour(colour: str) -> tuple[float, float, float]:
    """A line's colour, dark enough to be read as text on white."""
    return mixed(colour, INK, 0.25)


def figure(height: float, *, arranged: bool = True) -> Figure:
    """An empty figure of the page's width, height in inches; no global state is touched.

    Args:
        height: In inches.
        arranged: Whether axes make room for their labels; else the caller places them.
    """
    layout = ConstrainedLayoutEngine() if arranged else None
    made = Figure(figsize=(WIDTH, height), dpi=DPI, facecolor="white", layout=layout)
    FigureCanvasAgg(made)
    return made


def plain_axes(axes: Axes, x: str, y: str) -> None:
    """Two quiet spines, a light grid across, labels with units."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(RULE)
    axes.tick_params(colors=QUIET, labelsize=9.5, length=0, pad=6)
    axes.grid(axis="y", color=RULE, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.set_xlabel(x, color=QUIET, fontsize=10, labelpad=8)
    axes.set_ylabel(y, color=QUIET, fontsize=10, labelpad=8)


def name_ends(axes: Axes, x: float, ends: list[tuple[str, float, str]]) -> None:
    """Write names beside the ends of lines, pushed apart where lines end close together.

    Args:
        axes: With their final limits in y.
        x: Where the lines end.
        ends: Name, y of the end and colour of each line.
    """
    low, high = axes.get_ylim()
    gap = 0.062 * (high - low)
    ordered = sorted(ends, key=lambda end: end[1])
    wanted = np.array([y for _, y, _ in ordered])
    # The nearest places (least squares) that are in order and at least a gap apart.
    slots = np.arange(len(wanted)) * gap
    placed = np.maximum(isotonic_regression(wanted - slots).x, low) + slots
    for (name, _, colour), y in zip(ordered, placed, strict=True):
        axes.annotate(
            name,
            (x, y),
            xytext=(9, 0),
            textcoords="offset points",
            va="center",
            color=text_colour(colour),
            fontsize=10,
            fontweight="bold",
            annotation_clip=False,
        )


def png(made: Figure) -> bytes:
    """The picture of a figure."""
    buffer = io.BytesIO()
    made.savefig(buffer, format="png")
    return buffer.getvalue()
