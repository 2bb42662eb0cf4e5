"""Figures of affect: estimates against labels, the gate, the uncertainty, the worst errors."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from agent_server.domain.affect import AFFECT_LIMIT
from agent_server.domain.arrays import Float64
from models.evaluation.affect import NAMES, Reading, affect_measures, passes
from models.evaluation.figures.style import (
    COLOURS,
    INK,
    QUIET,
    RULE,
    Plot,
    figure,
    mixed,
    plain_axes,
    png,
)

GOOD, BAD = COLOURS["server"], COLOURS["best"]
WORST = 10
_BINS = 5


def scatter_plot(reading: Reading) -> Plot:
    """Each face's estimate against its label, for both quantities."""
    estimates, labels = _found(reading)
    measures = affect_measures(estimates, labels)
    made = figure(4.9)
    rng = np.random.default_rng(0)
    for axis, axes in enumerate(made.subplots(1, 2)):
        plain_axes(axes, f"{NAMES[axis]}, as labelled", f"{NAMES[axis]}, as read")
        axes.plot((-1, 1), (-1, 1), color=RULE, linewidth=1.4)
        # Labels come in steps of a tenth: spread out, so that no dot hides another.
        x = labels[:, axis] + rng.uniform(-0.03, 0.03, len(labels))
        axes.scatter(x, estimates[:, axis], s=13, color=GOOD, alpha=0.5, linewidths=0)
        axes.set(xlim=(-1, 1), ylim=(-1, 1), aspect="equal")
        row = measures[NAMES[axis]]
        text = f"MAE {row['mae']:.3f}\nCCC {row['ccc']:.3f}"
        axes.text(0.04, 0.96, text, transform=axes.transAxes, va="top", color=INK, fontsize=10.5)
    valence, arousal = (measures[name]["mae"] for name in NAMES)
    return Plot(
        "Estimates",
        f"Valence is read to within {valence:.2f} and arousal to within {arousal:.2f} on "
        "average, on a scale from -1 to 1",
        "A dot is a face; on the line the estimate is the label. Labels are spread sideways by "
        "up to 0.03.",
        png(made),
    )


def gate_plot(reading: Reading) -> Plot:
    """The gate's two rates as its thresholds are made stricter or laxer together."""
    estimates, labels = _found(reading)
    uncomfortable, pleasant = passes(labels.round(3)), labels[:, 0].round(3) > 0
    others = ~uncomfortable & ~pleasant
    levels = np.linspace(0.02, 0.98, 97)
    opened = np.stack([(-estimates[:, 0] > t) & (np.abs(estimates[:, 1]) > t) for t in levels])
    made = figure(4.2)
    axes = made.subplots()
    plain_axes(axes, "other faces that pass, %", "uncomfortable faces that pass, %")
    for group, colour, name in (
        (pleasant, BAD, "labelled pleasant (valence over 0)"),
        (others, QUIET, "labelled neither"),
    ):
        if group.any() and uncomfortable.any():
            x, y = 100 * opened[:, group].mean(1), 100 * opened[:, uncomfortable].mean(1)
            axes.plot(x, y, color=colour, linewidth=2, label=name)
            now = passes(estimates)
            place = (100 * now[group].mean(), 100 * now[uncomfortable].mean())
            axes.plot(*place, "o", color="white", markeredgecolor=colour, markersize=9)
    axes.set(xlim=(-1, 40), ylim=(0, 102))
    axes.legend(loc="lower right", frameon=False, fontsize=10, labelcolor=INK)
    measured = affect_measures(estimates, labels)["gate"]
    return Plot(
        "Gate",
        f"{_percent(measured['uncomfortable_pass'])} of uncomfortable faces pass the gate, and "
        f"{_percent(measured['pleasant_pass'])} of pleasant ones",
        "Along a line both thresholds (minus valence and the size of arousal) go from 0.98 to "
        f"0.02. The rings are the gate as it ships: {3 / AFFECT_LIMIT:g} for both. "
        f"{measured['uncomfortable']} uncomfortable and {measured['pleasant']} pleasant faces.",
        png(made),
    )


def uncertainty_plot(reading: Reading) -> Plot:
    """Stated standard deviations against the errors that there are."""
    estimates, labels = _found(reading)
    made = figure(4.2)
    largest = 0.0
    for axis, axes in enumerate(made.subplots(1, 2)):
        plain_axes(
            axes, f"standard deviation of {NAMES[axis]}, as stated", "error, root mean square"
        )
        stated = estimates[:, 2 + axis]
        parts = np.array_split(np.argsort(stated), _BINS)
        x = [float(np.sqrt(np.mean(stated[part] ** 2))) for part in parts]
        error = estimates[:, axis] - labels[:, axis]
        y = [float(np.sqrt(np.mean(error[part] ** 2))) for part in parts]
        largest = max(largest, *x, *y) * 1.1
        axes.plot((0, 1), (0, 1), color=RULE, linewidth=1.4)
        axes.plot(x, y, "o-", color=GOOD, linewidth=2, markersize=6)
        axes.set(xlim=(0, largest), ylim=(0, largest))
    rows = affect_measures(estimates, labels)["calibration"]
    return Plot(
        "Uncertainty",
        f"{_percent(rows['valence']['within_1_sd'])} of valence errors and "
        f"{_percent(rows['arousal']['within_1_sd'])} of arousal errors are smaller than the stated "
        "standard deviation; 68 % would be just right",
        f"Faces in {_BINS} equal groups by what the model says of itself. On the line it is as "
        "good as it says; above it, worse.",
        png(made),
    )


def worst_plot(reading: Reading) -> Plot:
    """The faces that are read worst, with labels and estimates."""
    found = np.flatnonzero(reading.found)
    estimates, labels = _found(reading)
    order = np.argsort(-np.linalg.norm(estimates[:, :2] - labels, axis=1))[:WORST]
    made = figure(6.0)
    grid = made.subplots(2, WORST // 2).reshape(-1)
    for axes in grid:
        axes.set_axis_off()
    for axes, index in zip(grid, order, strict=False):
        axes.imshow(reading.faces.picture(int(found[index])))
        said = "  ".join(
            f"{name[0]} {labels[index, axis]:+.1f} → {estimates[index, axis]:+.2f}"
            for axis, name in enumerate(NAMES)
        )
        axes.set_title(said, fontsize=9, color=INK)
        _frame(axes, bool(passes(estimates[index : index + 1])[0]))
    return Plot(
        "Worst errors",
        f"The {len(order)} faces that are read worst",
        "v is valence, a is arousal: label → estimate. An orange frame passes the gate.",
        png(made),
    )


def _frame(axes: Axes, is_open: bool) -> None:
    colour = BAD if is_open else mixed(RULE, INK, 0.2)
    frame = Rectangle(
        (0, 0), 1, 1, transform=axes.transAxes, fill=False, edgecolor=colour, linewidth=2.5
    )
    axes.add_patch(frame)


def _found(reading: Reading) -> tuple[Float64, Float64]:
    labels = reading.faces.affect[reading.found].astype(np.float64)
    return reading.estimates[reading.found].astype(np.float64), labels


def _percent(share: float | None) -> str:
    return "none" if share is None else f"{100 * share:.0f} %"
