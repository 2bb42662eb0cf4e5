"""Stick figures at growing horizons, a row for the truth and each model."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from agent_server.domain.arrays import Float32
from models.data.layouts import Layout
from models.evaluation.figures.anatomy import (
    head_joints,
    loose_ends,
    oblique_axes,
    side_joints,
)
from models.evaluation.figures.comparison import Comparison, typical
from models.evaluation.figures.style import (
    INK,
    QUIET,
    RULE,
    TRUTH,
    WIDTH,
    Plot,
    duration,
    figure,
    mixed,
    png,
    text_colour,
)

NAMES = 1.25
"""Width of the names of the rows, in inches."""
HEADINGS = 0.45
"""Height of the times above the columns, in inches."""
ROW = 2.15
"""Height of a row at most, in inches."""
GAP = 0.1
"""Between neighbours, as a share of the largest figure."""
HEAD_MM = 85
"""Radius of a head."""
PALE = 0.84
"""Share of white in the truth behind a prediction."""


def strip_plots(comparison: Comparison) -> list[Plot]:
    """A typical window of the easiest action and one of the hardest, as the subject finds them."""
    errors = {action: comparison.window_errors(action) for action in comparison.actions}
    ordered = sorted(errors, key=lambda action: float(errors[action].mean()))
    chosen = {ordered[0]: "the easiest action, "}
    chosen[ordered[-1]] = "the hardest action, " if len(ordered) > 1 else ""
    return [
        _strip(comparison, action, typical(errors[action]), kind) for action, kind in chosen.items()
    ]


def _strip(comparison: Comparison, action: str, window: int, kind: str) -> Plot:
    protocol = comparison.protocol
    outcome = comparison.results[comparison.subject][action]
    last = outcome.seen[window, -1]
    view = oblique_axes(last, protocol.layout).T
    middle = last.mean(axis=0) * [1, 0, 1]
    rows = {"truth": np.concatenate([last[None], outcome.true[window, protocol.frames]])}
    for model in comparison.models:
        rows[model] = comparison.results[model][action].predicted[window, protocol.frames]
    drawn = {name: (poses - middle) @ view for name, poses in rows.items()}
    pelvis = -middle @ view

    spread = np.concatenate([poses.reshape(-1, 2) for poses in drawn.values()])
    low, high = spread.min(axis=0) - HEAD_MM, spread.max(axis=0) + HEAD_MM
    columns = 1 + len(protocol.frames)
    step = (1 + GAP) * (high - low)  # a cell, in mm of the drawing
    scale = min((WIDTH - NAMES) / (columns * step[0]), ROW / step[1])  # inches a mm
    step[0] = (WIDTH - NAMES) / (columns * scale)
    made = figure(len(rows) * step[1] * scale + HEADINGS, arranged=False)
    canvas = made.add_axes((0, 0, 1, 1))
    canvas.set_axis_off()
    canvas.set_xlim(-NAMES / scale, columns * step[0])
    canvas.set_ylim(-len(rows) * step[1], HEADINGS / scale)

    _headings(canvas, protocol.horizons_ms, step, len(rows))
    for row, (name, poses) in enumerate(drawn.items()):
        colour = TRUTH if name == "truth" else comparison.colours[name]
        first = columns - len(poses)
        for at, pose in enumerate(poses):
            cell = np.array([(first + at + 0.5) * step[0], -(row + 0.5) * step[1]])
            shift = cell - (low + high) / 2
            if name != "truth":
                true = drawn["truth"][first + at]
                _body(canvas, true + shift, protocol.layout, pelvis + shift, None)
            _body(canvas, pose + shift, protocol.layout, pelvis + shift, colour)
        canvas.text(
            -NAMES / scale,
            -(row + 0.5) * step[1],
            name,
            color=INK if name == "truth" else text_colour(colour),
            fontsize=10.5,
            fontweight="bold",
            va="center",
        )
    return _titled(comparison, action, window, kind, png(made))


def _titled(comparison: Comparison, action: str, window: int, kind: str, picture: bytes) -> Plot:
    outcome = comparison.results[comparison.subject][action]
    off = np.linalg.norm(outcome.predicted[window] - outcome.true[window], axis=-1).mean(axis=1)
    frames, horizons = comparison.protocol.frames, comparison.protocol.horizons_ms
    note = (
        f"Window {window + 1} of {len(outcome.true)}, the one whose error is the median; the "
        "numbers are its mean joint distance at these times. All figures have one scale and one "
        "view, from the front at an angle. The pale figure behind a prediction is the truth; the "
        "right side is dark, the left side light."
    )
    if loose_ends(comparison.protocol.layout):
        note += " Thin lines join the parts at the pelvis, which the data hold still."
    return Plot(
        "Skeletons over time",
        f"In {kind}`{action}`, `{comparison.subject}` is typically {off[frames[0]]:.0f} mm off at "
        f"{duration(horizons[0])} and {off[frames[-1]]:.0f} mm at {duration(horizons[-1])}",
        note,
        picture,
    )


def _headings(canvas: Axes, horizons_ms: tuple[int, ...], step: Float32, rows: int) -> None:
    """Time above each column, a line where prediction starts and hairlines between rows."""
    for column, text in enumerate(["last seen", *map(duration, horizons_ms)]):
        canvas.annotate(
            text,
            ((column + 0.5) * step[0], 0),
            xytext=(0, 9),
            textcoords="offset points",
            ha="center",
            color=INK if column else QUIET,
            fontsize=9.5,
        )
    for row in range(1, rows):
        canvas.axhline(-row * step[1], color=RULE, linewidth=0.8)
    canvas.plot(
        [step[0], step[0]],
        [-rows * step[1], 0],
        color=QUIET,
        linewidth=0.9,
        linestyle=(0, (2, 3)),
    )


def _body(canvas: Axes, pose: Float32, layout: Layout, pelvis: Float32, colour: str | None) -> None:
    """A stick figure from positions (J, 2); None draws the pale truth behind a prediction."""
    right, left = (set(side_joints(layout, side)) for side in ("right", "left"))
    layer = 1 if colour is None else 3

    def tone(joint: int) -> tuple[float, float, float]:
        if colour is None:
            return mixed(TRUTH, "#ffffff", PALE)
        return mixed(colour, "#ffffff", 0.5 if joint in left else 0.0 if joint in right else 0.22)

    def line(start: Float32, joint: int, width: float) -> None:
        canvas.plot(
            *zip(start, pose[joint], strict=True),
            color=tone(joint),
            linewidth=width,
            solid_capstyle="round",
            zorder=layer,
        )

    for joint in loose_ends(layout):
        line(pelvis, joint, 1.3)
    # The dark side is drawn over the light one.
    for parent, child in sorted(layout.bones, key=lambda bone: bone[1] in right):
        line(pose[parent], child, 3.6 if colour is None else 2.6)
    head = head_joints(layout)
    centre = pose[head].mean(axis=0)
    canvas.add_patch(Circle(centre, HEAD_MM, color=tone(head[0]), linewidth=0, zorder=layer))
