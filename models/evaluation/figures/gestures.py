"""Which gestures are taken for which, and whether probabilities mean what they say."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import FancyBboxPatch
from matplotlib.ticker import NullLocator, StrMethodFormatter
from matplotlib.typing import ColorType

from models.evaluation.calibration_curves import BINS, Reliability, reliability, risk_coverage
from models.evaluation.figures.style import (
    COLOURS,
    INK,
    QUIET,
    TRUTH,
    Plot,
    figure,
    mixed,
    name_ends,
    plain_axes,
    png,
    text_colour,
)
from models.evaluation.gesture_measures import GestureMeasures
from models.evaluation.gestures import REJECT, calibration_error, rejecting
from models.evaluation.readings import HELD, PREDICTED, READINGS, TRUE

GOOD = COLOURS["server"]
BAD = COLOURS["best"]
READING_COLOURS = {PREDICTED: GOOD, HELD: COLOURS["zero_velocity"], TRUE: TRUTH}
SHORT = {PREDICTED: "2 s predicted", HELD: "last frame held", TRUE: "true 2 s"}
"""What completes the second that was seen."""
LINES = {PREDICTED: "-", HELD: "-", TRUE: (0, (1, 1.6))}
HIGHEST = 98.0
"""The axis of accuracies starts here at the latest, in percent."""
WELL = 0.9
"""A class of which at least this share is named right is named well."""


def percent(share: float) -> str:
    """``7 %``, or ``99.6 %`` where whole numbers would say all or nothing."""
    whole = f"{100 * share:.0f}"
    return f"{100 * share:.1f} %" if whole in {"0", "100"} and 0 < share < 1 else f"{whole} %"


def confusion_plot(measured: GestureMeasures) -> Plot:
    """Share and count of the windows of each class that are named as each other one."""
    names = measured.classes
    counts = np.zeros((len(names), len(names)), int)
    guess = measured.probabilities[PREDICTED].argmax(1)
    np.add.at(counts, (measured.labels, guess), 1)
    rows = [at for at in range(len(names)) if counts[at].any()]
    shares = counts[rows] / counts[rows].sum(axis=1, keepdims=True)

    made = figure(1.2 + 0.62 * len(rows))
    axes = made.add_subplot()
    good = LinearSegmentedColormap.from_list("good", ["white", GOOD])
    bad = LinearSegmentedColormap.from_list("bad", ["white", BAD])
    small = len(names) > 8
    for place, row in enumerate(rows):
        for column in range(len(names)):
            share, count = float(shares[place, column]), int(counts[row, column])
            # A tenth of a class that goes astray must be plain to see.
            shade = good(0.85 * share) if row == column else bad(min(1.0, 0.05 + 2.4 * share))
            axes.add_patch(_tile(column, place, shade if count else "#f7f8f9"))
            if count:
                dark = share > 0.6 if row == column else share > 0.3
                ink = "white" if dark else INK
                axes.text(
                    column,
                    place - 0.13,
                    percent(share),
                    color=ink,
                    fontsize=8 if small else 10,
                    fontweight="bold",
                    ha="center",
                    va="center",
                )
                axes.text(
                    column,
                    place + 0.22,
                    f"{count:,}",
                    color=ink,
                    alpha=0.8,
                    fontsize=6.5 if small else 8,
                    ha="center",
                    va="center",
                )
    axes.set_xlim(-0.5, len(names) - 0.5)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.spines[:].set_visible(False)
    axes.tick_params(colors=INK, labelsize=8.5 if small else 10.5, length=0, pad=6)
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.set_xticks(range(len(names)), names)
    if small:
        axes.tick_params(axis="x", labelrotation=35)
        for label in axes.get_xticklabels():
            label.set(ha="left", rotation_mode="anchor")
    axes.set_yticks(range(len(rows)), [names[row] for row in rows])
    axes.set_xlabel("named as, share and number of windows", color=QUIET, fontsize=10, labelpad=10)
    axes.set_ylabel("what is shown", color=QUIET, fontsize=10, labelpad=10)
    return Plot(
        "Confusion",
        _confusion_finding(names, rows, shares),
        "Rows are what people do, columns what the most probable class says: the share of the "
        "row, and below it the windows. Each window is 1 s that was seen with "
        "2 s that the predictor expects. Off the diagonal, colour grows faster than on it.",
        png(made),
    )


def _tile(column: int, row: int, colour: ColorType) -> FancyBboxPatch:
    return FancyBboxPatch(
        (column - 0.46, row - 0.45),
        0.92,
        0.9,
        boxstyle="round,pad=0,rounding_size=0.06",
        facecolor=colour,
        edgecolor="none",
    )


def _confusion_finding(names: tuple[str, ...], rows: list[int], shares: np.ndarray) -> str:
    own = np.array([shares[place, row] for place, row in enumerate(rows)])
    well = f"{int((own >= WELL).sum())} of {len(rows)} classes are named right in at least 9 of 10"
    others = shares.copy()
    others[np.arange(len(rows)), rows] = 0
    place, column = np.unravel_index(others.argmax(), others.shape)
    if not others.any():
        return "Nothing is taken for anything else"
    return (
        f"{well} windows; `{names[rows[place]]}` is most often taken for another, for "
        f"`{names[column]}` in {percent(float(others[place, column]))}"
    )


def reliability_plot(measured: GestureMeasures) -> Plot:
    """Accuracy at each confidence, beside how many windows have it."""
    rows = measured.probabilities[PREDICTED]
    found = reliability(rows, measured.labels)
    error = calibration_error(rows, measured.labels)
    made = figure(4.6)
    left, right = made.subplots(1, 2, width_ratios=(1, 1.15))
    _diagram(left, found)
    _counts(right, found)
    over = found.over
    manner = f"{100 * abs(over):.1f} points too {'boastful' if over > 0 else 'modest'}"
    if abs(over) < 0.0005:
        manner = "neither boastful nor modest"
    return Plot(
        "Reliability",
        f"Probabilities are {100 * error:.1f} points off on average (ECE), and on the whole "
        f"{manner}",
        f"Windows in {BINS} bins by the probability of their most probable class. On the line, "
        "what is called 80 % probable is right 8 times of 10; under it the classifier boasts. "
        "Bars span from the line to what was found. The expected calibration error (ECE) is "
        "their mean length, weighted by the number of windows on the right.",
        png(made),
    )


def _diagram(axes: Axes, found: Reliability) -> None:
    plain_axes(axes, "probability of the most probable class, %", "of these named right, %")
    axes.plot([0, 100], [0, 100], color=QUIET, linewidth=1, linestyle=(0, (2, 3)))
    filled = found.counts > 0
    x, y = 100 * found.confidence[filled], 100 * found.accuracy[filled]
    for at, (sure, true) in enumerate(zip(x, y, strict=True)):
        axes.plot(
            [sure, sure],
            [sure, true],
            color=BAD if true < sure else GOOD,
            alpha=0.35,
            linewidth=6,
            solid_capstyle="butt",
            zorder=2 + 0.001 * at,
        )
    axes.plot(
        x,
        y,
        color=GOOD,
        linewidth=1.6,
        marker="o",
        markersize=6.5,
        markeredgecolor="white",
        zorder=3,
    )
    low = 10 * np.floor(min(x.min(), y.min(), 90) / 10)
    axes.set_xlim(low, 101)
    axes.set_ylim(low, 101)
    axes.annotate(
        "as it should be",
        (low + 0.5 * (100 - low), low + 0.5 * (100 - low)),
        xytext=(8, -12),
        textcoords="offset points",
        color=QUIET,
        fontsize=9,
    )


def _counts(axes: Axes, found: Reliability) -> None:
    plain_axes(axes, "probability of the most probable class, %", "windows, log scale")
    edges = 100 * np.arange(BINS) / BINS
    bars = axes.bar(
        edges,
        found.counts,
        width=100 / BINS * 0.86,
        align="edge",
        color=mixed(GOOD, "#ffffff", 0.45),
    )
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_ylim(0.8, 3 * found.counts.max())
    axes.set_xlim(edges[np.flatnonzero(found.counts)[0]] - 2, 101)
    for bar, count in zip(bars, found.counts, strict=True):
        if count:
            axes.annotate(
                f"{count:,}",
                (bar.get_x() + bar.get_width() / 2, count),
                xytext=(0, 4),
                textcoords="offset points",
                ha="center",
                color=QUIET,
                fontsize=8,
            )


def reject_plot(measured: GestureMeasures) -> Plot:
    """Accuracy of what is accepted, over how much is accepted."""
    made = figure(4.3)
    axes = made.add_subplot()
    plain_axes(
        axes, "share of the windows accepted, the surest first, %", "of these named right, %"
    )
    ends = []
    lowest = HIGHEST
    areas = {}
    for reading in reversed(READINGS):
        curve = risk_coverage(measured.probabilities[reading], measured.labels)
        areas[reading] = curve.area
        colour = READING_COLOURS[reading]
        right = 100 * (1 - curve.risk)
        shown = curve.coverage >= 0.02
        axes.plot(
            100 * curve.coverage[shown],
            right[shown],
            color=colour,
            linestyle=LINES[reading],
            linewidth=2.6 if reading == PREDICTED else 1.7,
        )
        ends.append((f"{SHORT[reading]} {right[-1]:.1f} %", float(right[-1]), colour))
        lowest = min(lowest, float(right[shown].min()))
    kept = rejecting(measured.probabilities[PREDICTED], measured.labels)
    x, y = 100 * kept["accepted"], 100 * kept["accuracy"]
    axes.plot(
        [x],
        [y],
        "o",
        markersize=10,
        markerfacecolor="white",
        markeredgewidth=2.4,
        markeredgecolor=text_colour(GOOD),
        zorder=4,
    )
    axes.set_xlim(0, 100)
    axes.set_ylim(lowest - 0.12 * (100 - lowest), 100 + 0.04 * (100 - lowest))
    axes.annotate(
        f"reject below {100 * REJECT:g} %:\n{x:.1f} % accepted, {y:.1f} % right",
        (x, y),
        xytext=(-62, -46),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=10,
        color=text_colour(GOOD),
        fontweight="bold",
        arrowprops={"arrowstyle": "-", "color": QUIET, "linewidth": 0.8, "shrinkB": 7},
    )
    name_ends(axes, 100, ends)
    all_right = 100 * float(measured.right[PREDICTED].mean())
    return Plot(
        "Reject option",
        _reject_finding(100 - x, all_right, y),
        f"Windows are accepted from the surest down. One whose best class is not more "
        f"probable than {100 * REJECT:g} % counts as idle (ring). The area under the share of "
        "mistakes over this axis (AURC, smaller is better) is "
        + ", ".join(f"{areas[reading]:.4f} with the {SHORT[reading]}" for reading in READINGS)
        + ".",
        png(made),
    )


def _reject_finding(rejected: float, before: float, after: float) -> str:
    if rejected < 0.05:
        return "The reject option rejects next to nothing"
    manner = "lifts" if after > before else "lowers"
    return (
        f"Rejecting {rejected:.1f} % of the windows {manner} accuracy on the rest from "
        f"{before:.1f} to {after:.1f} %"
    )
