"""The page that shows how well gestures are told apart, how early, and how honestly."""

from collections.abc import Callable, Sequence
from html import escape
from pathlib import Path

import numpy as np

from models.data.windows import Recording
from models.evaluation.calibration_curves import risk_coverage
from models.evaluation.decision_times import Answers
from models.evaluation.figures.gesture_gains import gain_plot, hands_plot
from models.evaluation.figures.gesture_thresholds import settings_plot
from models.evaluation.figures.gesture_times import live_plot, seen_plot
from models.evaluation.figures.gestures import (
    READING_COLOURS,
    confusion_plot,
    reject_plot,
    reliability_plot,
)
from models.evaluation.gesture_findings import p_text, verdict_sentences, verdict_title
from models.evaluation.gesture_measures import GestureMeasures, measure
from models.evaluation.gestures import REJECT, Classify, Predict, calibration_error
from models.evaluation.page import cell, entry, marked, plot_section, section, table, write_page
from models.evaluation.readings import HELD, PREDICTED, READINGS, TRUE

NAMES = {
    PREDICTED: "1 s seen + 2 s predicted",
    HELD: "1 s seen + last frame held",
    TRUE: "1 s seen + true 2 s",
}
NOTHING = "\u2013"

Row = dict[str, float | None]
Column = tuple[str, str, str, Callable[..., float] | None]
"""Key, heading, format and what is best."""


def write_gesture_page(
    folder: Path,
    title: str,
    classify: Classify,
    predict: Predict,
    recordings: Sequence[Recording],
    classes: tuple[str, ...],
) -> Path:
    """Measure a classifier on labelled recordings, and write what is found as a page.

    Args:
        folder: Where ``index.html`` goes; made where it is missing.
        title: What is measured on whom; names of bundles stand in backticks.
        classify: motion (B, 75, 9, 3) -> probabilities (B, C).
        predict: seen (B, 25, 9, 3) -> future (B, 50, 9, 3).
        recordings: Of people that neither has seen, with labelled gestures.
        classes: Names of the classifier's columns; ``idle`` is one of them.

    Returns:
        Path of the page.

    Raises:
        InvalidInput: If no gesture is shown, or no window can be judged.
    """
    return show_measures(folder, title, measure(classify, predict, recordings, classes))


def show_measures(folder: Path, title: str, measured: GestureMeasures) -> Path:
    """Write a page that needs nothing but itself, see ``write_gesture_page``."""
    lasting = bool(measured.seen.there.any())  # else gestures are too short for a curve of time
    body = [
        _numbers(measured),
        plot_section(confusion_plot(measured)),
        plot_section(seen_plot(measured)) if lasting else "",
        plot_section(live_plot(measured)),
        plot_section(settings_plot(measured)),
        plot_section(reliability_plot(measured)),
        plot_section(reject_plot(measured)),
        _verdict(measured),
        plot_section(gain_plot(measured)) if lasting else "",
        plot_section(hands_plot(measured)),
    ]
    return write_page(
        folder,
        title=title.replace("`", ""),
        kind="Gestures",
        heading=title,
        lead=_lead(measured),
        key="".join(f"<li>{_name(reading)}</li>" for reading in READINGS),
        body="".join(body),
    )


def _lead(measured: GestureMeasures) -> str:
    gestures = len(measured.seen.gestures)
    people = "1 person" if measured.people == 1 else f"{measured.people} people"
    return (
        f"{measured.recordings:,} recordings of {people}, {measured.minutes:.0f} minutes with "
        f"{gestures:,} gestures of {len(measured.shown)} classes: {len(measured.labels):,} "
        "windows that show one class, 0.2 s apart. 1 s is seen, and the 2 s after it are "
        "predicted, held or true; the classifier reads all 3 s, 25 frames a second."
    )


def _name(reading: str) -> str:
    return entry(escape(NAMES[reading]), READING_COLOURS[reading])


def _numbers(measured: GestureMeasures) -> str:
    accuracy = 100 * float(measured.right[PREDICTED].mean())
    return section(
        "Numbers",
        f"{accuracy:.1f} % of the windows are named right from 1 s seen and 2 s predicted",
        _readings_table(measured) + _decisions_table(measured),
        f"Bold is best in its column among what can be had live, to the precision shown; the true "
        f"2 s are there to compare with. Balanced accuracy is the mean recall of the classes. ECE "
        f"is the expected calibration error, AURC the area under risk over coverage. Accepted is "
        f"what is more than {100 * REJECT:g} % probable. Delays run from the onset of a gesture to "
        "a right decision.",
        f"<details open><summary>Each class on its own</summary>{_class_table(measured)}</details>",
    )


def _readings_table(measured: GestureMeasures) -> str:
    rows: dict[str, Row] = {}
    for reading in READINGS:
        probabilities = measured.probabilities[reading]
        kept = probabilities.max(1) > REJECT
        right = measured.right[reading]
        rows[reading] = {
            "accuracy": 100 * float(right.mean()),
            "balanced": 100
            * float(np.mean([right[measured.of(n)].mean() for n in measured.shown])),
            "ece": 100 * calibration_error(probabilities, measured.labels),
            "aurc": risk_coverage(probabilities, measured.labels).area,
            "accepted": 100 * float(kept.mean()),
            "kept": 100 * float(right[kept].mean()) if kept.any() else None,
        }
    columns: list[Column] = [
        ("accuracy", "accuracy, %", ".1f", max),
        ("balanced", "balanced accuracy, %", ".1f", max),
        ("ece", "ECE, points", ".1f", min),
        ("aurc", "AURC", ".4f", min),
        ("accepted", "accepted, %", ".1f", None),
        ("kept", "accuracy of these, %", ".1f", max),
    ]
    return _table("windows", columns, rows)


def _decisions_table(measured: GestureMeasures) -> str:
    columns: list[Column] = [
        ("right", "decided right, %", ".1f", max),
        ("wrong", "decided wrong, %", ".1f", min),
        ("missed", "missed, %", ".1f", min),
        ("p50", "median delay, s", ".2f", min),
        ("p90", "delay of 9 in 10, s", ".2f", min),
        ("false", "false in 10 idle minutes", ".1f", min),
    ]
    rows = {reading: _decided(found) for reading, found in measured.live.items()}
    return _table("live decisions", columns, rows)


def _decided(found: Answers) -> Row:
    def share(which: np.ndarray) -> float | None:
        return 100 * float(which.mean()) if len(which) else None

    return {
        "right": share(found.right),
        "wrong": share(found.wrong),
        "missed": share(found.missed),
        "p50": found.delay_s(50),
        "p90": found.delay_s(90),
        "false": found.false_per_10_minutes,
    }


def _class_table(measured: GestureMeasures) -> str:
    body = ""
    found = measured.live[PREDICTED]
    asked = np.array(found.asked)
    for name, gain in measured.gains.items():
        recalls = "".join(
            cell(reading, f"{100 * gain.accuracy[reading]:.1f}", best=False) for reading in READINGS
        )
        points = f"{gain.points:+.1f}".replace("-", "\u2212")
        own = asked == name
        decided = f"{100 * found.right[own].mean():.0f}" if own.any() else NOTHING
        delays = found.delays_s[own & found.right] if own.any() else np.array([])
        delay = f"{np.median(delays):.2f}" if len(delays) else NOTHING
        body += (
            f'<tr data-model="{escape(name)}"><th scope="row"><code>{escape(name)}</code></th>'
            + cell("windows", f"{gain.windows:,}", best=False)
            + recalls
            + cell("gain", points, best=False)
            + cell("p", p_text(gain.p_value).removeprefix("p = ").removeprefix("p "), best=False)
            + cell("decided", decided, best=False)
            + cell("delay", delay, best=False)
            + "</tr>"
        )
    headings = [
        "windows",
        "recall, 2 s predicted, %",
        "recall, frame held, %",
        "recall, true 2 s, %",
        "gain, points",
        "p of the gain",
        "decided right, %",
        "median delay, s",
    ]
    return table("class", headings, body)


def _verdict(measured: GestureMeasures) -> str:
    items = "".join(f"<li>{marked(said)}</li>" for said in verdict_sentences(measured))
    return section(
        "Does the prediction help?",
        verdict_title(measured),
        f'<ul class="said">{items}</ul>',
        "Windows of one gesture overlap, so that tests over windows are too sure of themselves; "
        "those with one window a gesture are not.",
    )


def _table(corner: str, columns: list[Column], rows: dict[str, Row]) -> str:
    """A row a reading; the best of what can be had live is bold."""
    body = ""
    for reading, row in rows.items():
        cells = ""
        for key, _, form, choose in columns:
            value = row[key]
            rivals = [other[key] for name, other in rows.items() if name != TRUE]
            shown = [float(format(rival, form)) for rival in rivals if rival is not None]
            text = NOTHING if value is None else format(value, form)
            best = choose is not None and bool(shown) and text == format(choose(shown), form)
            cells += cell(key, text, best and reading != TRUE)
        body += f'<tr data-model="{reading}"><th scope="row">{_name(reading)}</th>{cells}</tr>'
    return table(corner, [heading for _, heading, _, _ in columns], body)
