"""Figures of several futures: losses, quality, features, and what they are worth."""

from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from models.evaluation.figures.style import (
    COLOURS,
    INK,
    QUIET,
    RULE,
    Plot,
    figure,
    plain_axes,
    png,
)

WITH, WITHOUT = COLOURS["server"], COLOURS["best"]
BINS = 20


def losses_plot(rows: dict[str, Any]) -> Plot:
    """Diversity and the jump at the seam, with and without the loss that is for them."""
    made = figure(4.2)
    left, right = made.subplots(1, 2)
    base = rows["all"]
    sets = list(base)
    plain_axes(left, "held-out windows", "two futures apart, mm")
    plain_axes(right, "held-out windows", "first step less the last seen one, mm")
    for axes, key, other in (
        (left, "apart_mm", "without diversity"),
        (right, "seam_mm", "without consistency"),
    ):
        places = np.arange(len(sets))
        for shift, name, colour in ((-0.2, "all", WITH), (0.2, other, WITHOUT)):
            values = [rows[name][one][key] for one in sets]
            label = f"{'all losses' if name == 'all' else name}"
            bars = axes.bar(places + shift, values, 0.36, color=colour, label=label)
            axes.bar_label(bars, fmt="%.1f", color=INK, fontsize=9.5, padding=2)
        if key == "seam_mm":
            for place, one in zip(places, sets, strict=True):
                truth = base[one]["true_seam_mm"]
                axes.plot((place - 0.4, place + 0.4), (truth, truth), color=INK, linewidth=1.4)
        axes.set_xticks(places, sets)
        axes.margins(y=0.22)
        axes.legend(frameon=False, fontsize=9.5, labelcolor=INK, loc="upper left")
    apart = [rows[name]["synthetic"]["apart_mm"] for name in ("all", "without diversity")]
    seam = [rows[name]["synthetic"]["seam_mm"] for name in ("all", "without consistency")]
    return Plot(
        "Losses",
        f"Futures lie {apart[0]:.0f} mm apart with the diversity loss and {apart[1]:.0f} mm "
        f"without; the seam is off by {seam[0]:.1f} mm with the consistency loss and "
        f"{seam[1]:.1f} mm without",
        "The same short training of each; virtual people in the title. A line is the truth's.",
        png(made),
    )


def quality_plot(real: Float32, generated: Float32) -> Plot:
    """How probably real the quality network holds real and generated futures."""
    made = figure(3.8)
    axes = made.subplots()
    plain_axes(axes, "quality: how probably the motion is real", "share of the futures, %")
    edges = np.linspace(0, 1, BINS + 1)
    for values, colour, name in ((real, INK, "real"), (generated, WITHOUT, "generated")):
        share = 100 * np.histogram(values, edges)[0] / values.size
        axes.stairs(share, edges, color=colour, linewidth=2, label=name)
    axes.axvline(0.5, color=QUIET, linewidth=0.9, linestyle=(0, (2, 3)))
    axes.set(xlim=(0, 1), ylim=(0, None))
    axes.legend(frameon=False, fontsize=10, labelcolor=INK, loc="upper center")
    return Plot(
        "Quality",
        f"{100 * (real > 0.5).mean():.0f} % of real futures and "
        f"{100 * (generated > 0.5).mean():.0f} % of generated ones are judged real",
        "Held-out windows. The dotted line is where futures are kept or left out.",
        png(made),
    )


def features_plot(shares: dict[str, Any]) -> Plot:
    """Accuracy over epochs from both starts, for each share of the labels."""
    made = figure(4.0)
    for axes, (share, row) in zip(
        made.subplots(1, len(shares), sharey=True), shares.items(), strict=True
    ):
        plain_axes(axes, f"epochs, {100 * float(share):g} % of the labels", "accuracy, %")
        for name, colour in (("random", WITHOUT), ("discriminator", WITH)):
            curve = 100 * np.array(row["accuracy"][name])
            axes.plot(np.arange(1, len(curve) + 1), curve, color=colour, linewidth=2, label=name)
        axes.axhline(100 * row["goal"], color=RULE, linewidth=1.4)
        axes.set(xlim=(1, len(curve)), ylim=(0, 100))
        axes.legend(frameon=False, fontsize=9.5, labelcolor=INK, loc="lower right")
    said = "; ".join(
        f"{100 * float(share):g} %: {row['epochs_to_same']['discriminator'] or 'never'} against "
        f"{row['epochs_to_same']['random']}"
        for share, row in shares.items()
    )
    return Plot(
        "Features",
        f"Epochs to the best accuracy of a random start, from the discriminator and from random "
        f"weights, by share of the labels: {said}",
        "MSRC-12's twelve gestures, unseen people, mean of two seeds. The line is the best that "
        "the random start reaches.",
        png(made),
    )


def counts_plot(named: dict[str, Any], title: str) -> Plot:
    """Accuracy and calibration error for each way of naming a window."""
    made = figure(4.0)
    rows = named["rows"]
    names = list(rows)
    for axes, key, label in zip(
        made.subplots(1, 2),
        ("accuracy", "ece"),
        ("accuracy, %", "calibration error, %"),
        strict=True,
    ):
        plain_axes(axes, label, "")
        axes.grid(visible=False)
        values = [100 * rows[name][key] for name in names]
        colours = [
            INK if name == "forecast" else WITHOUT if "alone" in name else WITH for name in names
        ]
        bars = axes.barh(np.arange(len(names)), values, color=colours)
        axes.bar_label(bars, fmt="%.1f", color=INK, fontsize=9.5, padding=3)
        axes.set_yticks(np.arange(len(names)), [name.replace("_", " ") for name in names])
        axes.invert_yaxis()
        axes.margins(x=0.15)
    forecast, ten = rows["forecast"], rows["10_futures"]
    return Plot(
        "Several futures",
        f"{title}: {100 * ten['accuracy']:.1f} % right with ten futures, "
        f"{100 * forecast['accuracy']:.1f} % with the forecast alone; calibration error "
        f"{100 * ten['ece']:.1f} and {100 * forecast['ece']:.1f} %",
        f"{named['windows']:,} windows. Futures: the forecast and drawn ones that are judged real; "
        "drawn alone: without the forecast, whatever their quality.",
        png(made),
    )
