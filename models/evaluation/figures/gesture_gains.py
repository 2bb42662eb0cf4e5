"""Where a predicted future helps the classifier, and how near it comes to the truth."""

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.ticker import MaxNLocator

from agent_server.domain.arrays import Float64
from models.evaluation.figures.gesture_times import AFTER_ONSET, FEWEST
from models.evaluation.figures.gestures import BAD, GOOD, READING_COLOURS
from models.evaluation.figures.style import (
    INK,
    QUIET,
    RULE,
    Plot,
    duration,
    figure,
    plain_axes,
    png,
)
from models.evaluation.gesture_measures import GestureMeasures
from models.evaluation.prediction_gain import HORIZONS_MS, LEVEL, p_over_time
from models.evaluation.readings import HELD, PREDICTED
from models.evaluation.time_seen import SECONDS, TimeSeen

NONE = "#b9bfc7"
"""Ink of a gain of nothing."""
FULL = 20
"""Points of a hundred at which a colour of the map is full, at least."""


def gain_plot(measured: GestureMeasures) -> Plot:
    """Points that the prediction adds to a held frame, by gesture and time seen."""
    seen = measured.seen
    names = [name for name in measured.classes if (seen.gestures == name).any()]
    rows = [_points(seen, None), *(_points(seen, name) for name in names)]
    values = np.array(rows)
    made = figure(1.35 + 0.46 * len(rows))
    axes = made.add_subplot()
    top = max(FULL, float(np.nanmax(np.abs(values), initial=0)))
    colours = LinearSegmentedColormap.from_list("gain", [BAD, "#ffffff", GOOD], bad="#f3f4f6")
    axes.pcolormesh(values, cmap=colours, vmin=-top, vmax=top, edgecolors="white", linewidth=1.2)
    for row, column in np.ndindex(values.shape):
        value = float(values[row, column])
        if not np.isnan(value):
            ink = "white" if abs(value) > 0.7 * top else INK if round(value) else NONE
            axes.text(
                column + 0.5,
                row + 0.5,
                f"{value:+.0f}".replace("-", "\u2212") if round(value) else "0",
                color=ink,
                ha="center",
                va="center",
                fontsize=7.5,
                fontweight="bold" if row == 0 else "normal",
            )
    axes.axhline(1, color="white", linewidth=6)
    axes.set_ylim(len(rows), 0)
    axes.set_yticks(np.arange(len(rows)) + 0.5, ["all", *names])
    ticks = [step for step in range(len(SECONDS)) if round(10 * SECONDS[step]) % 5 == 0]
    axes.set_xticks([step + 0.5 for step in ticks], [f"{SECONDS[step]:g}" for step in ticks])
    axes.spines[:].set_visible(False)
    axes.tick_params(colors=INK, labelsize=10, length=0, pad=6)
    axes.set_xlabel(AFTER_ONSET, color=QUIET, fontsize=10, labelpad=8)
    return Plot(
        "Gain over time seen",
        _gain_finding(measured, names, values),
        "Points of a hundred by which 2 s predicted name more gestures right than the last frame "
        "held: green where the prediction helps, orange where it hurts. "
        f"Grey: fewer than {FEWEST} gestures are still going on.",
        png(made),
    )


def _points(seen: TimeSeen, gesture: str | None) -> Float64:
    """Gain at each time seen (S,); NaN where too few gestures are going on."""
    counted = seen.there if gesture is None else seen.there & (seen.gestures == gesture)[:, None]
    gain = 100 * (seen.share(PREDICTED, gesture) - seen.share(HELD, gesture))
    return np.where(counted.sum(axis=0) >= FEWEST, gain, np.nan)


def _gain_finding(measured: GestureMeasures, names: list[str], values: Float64) -> str:
    if np.isnan(values[0]).all():
        return "Too few gestures are going on at any time to say where the prediction helps"
    best = int(np.nanargmax(values[0]))
    beyond = p_over_time(measured.seen) < LEVEL
    if values[0, best] <= 0:
        return "At no time seen does the prediction name more gestures right than a held frame"
    said = (
        f"The prediction adds most at {SECONDS[best]:g} s seen, {values[0, best]:.0f} points"
        f"{'' if beyond[best] else ', which may be chance'}"
    )
    each = values[1:, best]
    if np.isnan(each).all():
        return said
    return f"{said}, and there most for `{names[int(np.nanargmax(each))]}`"


def hands_plot(measured: GestureMeasures) -> Plot:
    """Distance of predicted and of held hands from the true ones, by class."""
    names = measured.shown
    predicted, held = (
        np.array([measured.hands_mm[reading][measured.of(name)].mean(axis=0) for name in names])
        for reading in (PREDICTED, HELD)
    )
    made = figure(1.3 + 0.4 * len(names))
    panels = list(made.subplots(1, len(HORIZONS_MS), sharex=True, sharey=True, squeeze=False)[0])
    for at, (axes, ms) in enumerate(zip(panels, HORIZONS_MS, strict=True)):
        plain_axes(axes, "distance from the true hands, mm", "")
        axes.grid(axis="y", visible=False)
        axes.grid(axis="x", color=RULE, linewidth=0.8)
        rows = np.arange(len(names))
        nearer = predicted[:, at] < held[:, at]
        axes.hlines(
            rows,
            predicted[:, at],
            held[:, at],
            linewidth=3,
            alpha=0.35,
            colors=[GOOD if near else BAD for near in nearer],
        )
        axes.plot(
            held[:, at],
            rows,
            "o",
            markersize=8,
            color=READING_COLOURS[HELD],
            markeredgecolor="white",
            label="last frame held",
        )
        axes.plot(
            predicted[:, at],
            rows,
            "o",
            markersize=9,
            color=GOOD,
            markeredgecolor="white",
            label="predicted",
        )
        axes.set_ylim(len(names) - 0.4, -0.6)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.set_title(
            f"{duration(ms)} ahead", loc="left", fontsize=10.5, fontweight="bold", color=INK, pad=10
        )
    panels[0].set_xlim(0, 1.06 * max(predicted.max(), held.max()))
    panels[0].set_yticks(range(len(names)), names)
    panels[0].tick_params(axis="y", colors=INK, labelsize=10.5)
    legend = panels[0].legend(
        loc="upper right", fontsize=8.5, framealpha=0.9, edgecolor="none", handletextpad=0.2
    )
    for text in legend.get_texts():
        text.set_color(INK)
    return Plot(
        "How near the predicted hands come",
        _hands_finding(names, predicted[:, -2], held[:, -2]),
        "Mean distance of both wrists from where they truly are, over the windows of each class, "
        "for the prediction and for hands that stay where they were last seen (zero velocity). "
        "Green bars are what the prediction gains, orange ones what it loses.",
        png(made),
    )


def _hands_finding(names: list[str], predicted: Float64, held: Float64) -> str:
    # Hands that never move are held without an error: no prediction comes nearer.
    ratio = np.divide(predicted, held, out=np.ones_like(predicted), where=held > 0)
    best, worst = int(ratio.argmin()), int(ratio.argmax())
    nearer = int((ratio < 1).sum())
    said = f"{duration(HORIZONS_MS[-2])} ahead, predicted hands are nearer the truth than held ones"
    if not nearer:
        return said.replace("are nearer", "are never nearer") + " for any class"
    count = f"all {len(names)}" if nearer == len(names) else f"{nearer} of {len(names)}"
    return (
        f"{said} for {count} classes: the error is {_change(ratio[best])} for `{names[best]}`, "
        f"{_change(ratio[worst])} for `{names[worst]}`"
    )


def _change(ratio: float) -> str:
    return f"{100 * abs(1 - ratio):.0f} % {'smaller' if ratio < 1 else 'larger'}"
