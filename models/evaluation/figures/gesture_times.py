"""Accuracy against time: what is seen, what is decided, and what other thresholds give."""

import numpy as np
from matplotlib.axes import Axes

from agent_server.domain.arrays import Float64
from models.evaluation.decision_times import Answers
from models.evaluation.figures.gestures import (
    BAD,
    GOOD,
    LINES,
    READING_COLOURS,
    SHORT,
    percent,
)
from models.evaluation.figures.style import (
    QUIET,
    Plot,
    figure,
    mixed,
    name_ends,
    plain_axes,
    png,
    text_colour,
)
from models.evaluation.gesture_measures import GestureMeasures
from models.evaluation.gestures import DECIDE
from models.evaluation.readings import HELD, PREDICTED, READINGS
from models.evaluation.time_seen import SECONDS, TimeSeen

ENOUGH = (0.9, 0.8, 0.7, 0.6, 0.5)
"""Shares of the gestures that may be named right for a time to be enough, best first."""
FEWEST = 5
"""Shares of fewer gestures than this are not drawn."""
LIVE: Float64 = np.round(np.arange(0, 3.52, 0.04), 2)
AFTER_ONSET = "time after the onset of the gesture, s"


def seen_plot(measured: GestureMeasures) -> Plot:
    """Share of gestures that one window names right, by how long they have been seen."""
    seen = measured.seen
    made = figure(4.8)
    axes = made.add_subplot()
    plain_axes(axes, AFTER_ONSET, "gestures named right, %")
    drawn = seen.remaining >= min(FEWEST, seen.remaining.max())
    most = int(np.flatnonzero(drawn)[-1]) + 1
    sure = 2 * seen.remaining[:most] >= len(seen.gestures)
    half = int(sure.sum())
    axes.set_xlim(SECONDS[0], SECONDS[most - 1])
    axes.set_ylim(0, 104)
    axes.set_yticks(range(0, 101, 20))
    ends = []
    for reading in reversed(READINGS):
        share = 100 * seen.share(reading)[:most]
        colour, width = READING_COLOURS[reading], 2.6 if reading == PREDICTED else 1.7
        axes.plot(
            SECONDS[:most],
            share,
            color=mixed(colour, "#ffffff", 0.62),
            linewidth=width,
            linestyle=LINES[reading],
        )
        axes.plot(
            SECONDS[:half], share[:half], color=colour, linewidth=width, linestyle=LINES[reading]
        )
        if not np.isnan(share).all():
            ends.append((SHORT[reading], float(share[~np.isnan(share)][-1]), colour))
    enough = _enough(seen)
    if enough is not None:
        axes.axhline(100 * enough, color=QUIET, linewidth=0.9, linestyle=(0, (2, 3)))
        for reading, offset in ((PREDICTED, 13), (HELD, -15)):
            _mark(axes, seen, reading, enough, offset)
    name_ends(axes, SECONDS[most - 1], ends)
    _remaining(axes, seen, most)
    return Plot(
        "Accuracy against time seen",
        _seen_finding(seen),
        f"One window a gesture, whose last seen frame lies so long after the onset; right is when "
        "the most probable class is the gesture. Only gestures that are still going on count: "
        f"above the lines stands how many of the {len(seen.gestures):,} do, and lines are pale "
        "where they are fewer than half. The same classifier reads all three; the true 2 s are the "
        "most that any prediction could give.",
        png(made),
    )


def _mark(axes: Axes, seen: TimeSeen, reading: str, enough: float, offset: int) -> None:
    at = seen.first_at(reading, enough)
    if at is None:
        return
    share = 100 * seen.share(reading)[int(np.argmin(np.abs(SECONDS - at)))]
    colour = READING_COLOURS[reading]
    axes.plot([at], [share], "o", markersize=8, color=colour, markeredgecolor="white", zorder=4)
    axes.annotate(
        f"{at:g} s",
        (at, share),
        xytext=(0, offset),
        textcoords="offset points",
        ha="center",
        va="center",
        color=text_colour(colour),
        fontsize=10,
        fontweight="bold",
    )


def _remaining(axes: Axes, seen: TimeSeen, most: int) -> None:
    for step in range(most):
        if step % 3 == 0:
            axes.annotate(
                f"{seen.remaining[step]:,}" if step else f"n = {seen.remaining[step]:,}",
                (SECONDS[step], 1),
                xycoords=("data", "axes fraction"),
                xytext=(0, 4),
                textcoords="offset points",
                ha="center",
                va="bottom",
                color=QUIET,
                fontsize=8.5,
            )


def _enough(seen: TimeSeen) -> float | None:
    """The largest share of the gestures that the prediction ever names right."""
    return next((share for share in ENOUGH if seen.first_at(PREDICTED, share) is not None), None)


def _seen_finding(seen: TimeSeen) -> str:
    enough = _enough(seen)
    if enough is None:
        return "At no time are half of the gestures named right"
    at, held = seen.first_at(PREDICTED, enough), seen.first_at(HELD, enough)
    said = f"{at:g} s seen are enough to name {10 * enough:g} of 10 gestures"
    if held is None:
        return f"{said} with 2 s predicted; with the last frame held no time is"
    if held == at:
        return f"{said}, with 2 s predicted as with the last frame held"
    return f"{said} with 2 s predicted, {held:g} s with the last frame held"


def live_plot(measured: GestureMeasures) -> Plot:
    """Share of gestures that the live stage has decided on, right and wrong, by time."""
    found, held = measured.live[PREDICTED], measured.live[HELD]
    made = figure(4.6)
    axes = made.add_subplot()
    plain_axes(axes, AFTER_ONSET, "gestures decided, %")
    axes.set_xlim(0, LIVE[-1])
    axes.set_ylim(0, 104)
    axes.set_yticks(range(0, 101, 20))
    lines = (
        ("right, last frame held", held, held.right, READING_COLOURS[HELD], 1.7),
        ("wrong", found, found.wrong, BAD, 2.2),
        ("right", found, found.right, GOOD, 2.6),
    )
    ends = []
    for name, stream, which, colour, width in lines:
        share = 100 * stream.by(LIVE, which)
        axes.step(LIVE, share, where="post", color=colour, linewidth=width)
        ends.append((f"{name} {share[-1]:.0f} %", float(share[-1]), colour))
    name_ends(axes, LIVE[-1], ends)
    _mark_median(axes, found)
    return Plot(
        "Decisions in time",
        _live_finding(found, held),
        f"The live decision stage over all windows of each recording, one every 0.2 s: a gesture "
        f"is decided once its class has been at least {100 * DECIDE.enter:g} % probable in "
        f"{DECIDE.enter_windows} windows in a row. The first decision between onset and 0.4 s "
        "after the end is the answer. The dotted line is the median time to a right decision.",
        png(made),
    )


def _mark_median(axes: Axes, found: Answers) -> None:
    median = found.delay_s(50)
    if median is None or median > LIVE[-1]:
        return
    axes.axvline(median, color=text_colour(GOOD), linewidth=1, linestyle=(0, (2, 3)))
    axes.annotate(
        f"median {median:.2f} s",
        (median, 1),
        xycoords=("data", "axes fraction"),
        xytext=(0, 3),
        textcoords="offset points",
        ha="center",
        va="bottom",
        color=text_colour(GOOD),
        fontsize=10,
        fontweight="bold",
    )


def _live_finding(found: Answers, held: Answers) -> str:
    median, other = found.delay_s(50), held.delay_s(50)
    if median is None:
        return "No gesture is decided right"
    said = (
        f"{percent(float(found.right.mean()))} of the gestures are decided right, half of these "
        f"within {median:.2f} s, and {percent(float(found.wrong.mean()))} wrong"
    )
    if other is None:
        return said
    gain = 1000 * (other - median)
    if abs(gain) < 1:
        return f"{said}; with the last frame held the median is the same"
    manner = "earlier" if gain > 0 else "later"
    return f"{said}; the prediction makes the median {abs(gain):.0f} ms {manner}"
