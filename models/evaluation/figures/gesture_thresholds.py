"""What other thresholds of the decision stage would give."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes

from models.evaluation.decision_times import ENTER, ENTER_WINDOWS, Answers, Setting
from models.evaluation.figures.gestures import BAD
from models.evaluation.figures.style import (
    INK,
    Plot,
    figure,
    mixed,
    plain_axes,
    png,
    text_colour,
)
from models.evaluation.gesture_measures import GestureMeasures
from models.evaluation.gestures import DECIDE
from models.evaluation.readings import PREDICTED


def settings_plot(measured: GestureMeasures) -> Plot:
    """What other thresholds of the decision stage would give: right, early or quiet."""
    mine = measured.live[PREDICTED]
    others = [other for other in measured.others if other.answers.delay_s(50) is not None]
    idle = mine.false_per_10_minutes is not None
    made = figure(4.6)
    panels = list(made.subplots(1, 2 if idle else 1, squeeze=False)[0])
    plain_axes(panels[0], "median time to a right decision, s", "gestures decided right, %")
    _trade(panels[0], others, mine, lambda found: 100 * float(found.right.mean()))
    if idle:
        plain_axes(
            panels[1], "median time to a right decision, s", "false reactions in 10 idle minutes"
        )
        _trade(panels[1], others, mine, lambda found: found.false_per_10_minutes or 0.0)
        panels[1].set_ylim(0)
    panels[-1].legend(
        title="windows in a row",
        loc="upper right",
        fontsize=9,
        title_fontsize=9,
        framealpha=0.9,
        edgecolor="none",
        labelcolor=INK,
    )
    return Plot(
        "Thresholds",
        _settings_finding(measured, others),
        f"Each line asks for so many windows in a row, each dot on it for another probability: "
        f"{', '.join(f'{100 * enter:g}' for enter in ENTER)} %, from left to right. The ring is "
        f"what ships: {100 * DECIDE.enter:g} % in {DECIDE.enter_windows} windows.",
        png(made),
    )


def _trade(
    axes: Axes, others: list[Setting], mine: Answers, value: Callable[[Answers], float]
) -> None:
    for at, windows in enumerate(ENTER_WINDOWS):
        line = [one for one in others if one.settings.enter_windows == windows]
        x = [one.answers.delay_s(50) or np.nan for one in line]
        axes.plot(
            x,
            [value(one.answers) for one in line],
            marker="o",
            markersize=5,
            linewidth=1.7,
            color=mixed("#0b3d66", "#9fd0f5", 1 - at / 3),
            markeredgecolor="white",
            label=str(windows),
        )
    median = mine.delay_s(50)
    if median is not None:
        axes.plot(
            [median],
            [value(mine)],
            "o",
            markersize=13,
            markerfacecolor="none",
            markeredgewidth=2.2,
            markeredgecolor=text_colour(BAD),
            zorder=4,
        )
        axes.annotate(
            "ships",
            (median, value(mine)),
            xytext=(10, 9),
            textcoords="offset points",
            ha="left",
            color=text_colour(BAD),
            fontsize=10,
            fontweight="bold",
        )


def _settings_finding(measured: GestureMeasures, others: list[Setting]) -> str:
    mine = measured.live[PREDICTED]
    median = mine.delay_s(50)
    if median is None:
        return "No gesture is decided right with the thresholds that ship"
    better = [
        other
        for other in others
        if other.answers.right.mean() >= mine.right.mean()
        and (other.answers.false_per_10_minutes or 0) <= (mine.false_per_10_minutes or 0)
        and (other.answers.delay_s(50) or np.inf) < median - 1e-9
    ]
    if not better:
        return (
            "No other threshold tried is earlier than the one that ships without being less often "
            "right or more often false"
        )
    best = min(better, key=lambda other: other.answers.delay_s(50) or np.inf)
    saved = median - (best.answers.delay_s(50) or 0)
    return (
        f"Asking for {100 * best.settings.enter:g} % in {best.settings.enter_windows} windows "
        f"would be {1000 * saved:.0f} ms earlier, no less often right and no more often false"
    )
