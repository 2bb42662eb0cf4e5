"""What the numbers say about the prediction, in sentences."""

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.gesture import IDLE
from models.evaluation.gesture_measures import GestureMeasures
from models.evaluation.prediction_gain import HORIZONS_MS, LEVEL, Gain, Verdict, p_over_time
from models.evaluation.readings import HELD, PREDICTED, TRUE
from models.evaluation.time_seen import SECONDS

LITTLE = 1.0
"""Points of a hundred that are as good as nothing."""
JUDGED_AT = 1
"""Which horizon speaks for how near the hands come."""


def verdict_title(measured: GestureMeasures) -> str:
    """Whether the prediction helps to name gestures, and what it does to idle motion."""
    parts = {"gestures": measured.gesture_gain, f"`{IDLE}`": measured.gains.get(IDLE)}
    said = [
        f"{gain.verdict.value} {name} ({100 * gain.accuracy[HELD]:.1f} to "
        f"{100 * gain.accuracy[PREDICTED]:.1f} % right)"
        for name, gain in parts.items()
        if gain is not None
    ]
    return f"The prediction {' and '.join(said)}"


def verdict_sentences(measured: GestureMeasures) -> list[str]:
    """Where the prediction helps, where not, and why not; names stand in backticks."""
    gain = measured.gain
    said = [
        f"Over all {gain.windows:,} windows, 2 s predicted in place of the last frame held change "
        f"accuracy by {signed(gain.points)} ({p_text(gain.p_value)}, McNemar's exact test on the "
        f"same windows). The true 2 s would change it by {signed(gain.room)}"
        + (
            f", so the prediction brings {100 * gain.points / gain.room:.0f} % of what "
            "there is to gain."
            if gain.verdict is Verdict.HELPS and gain.room > LITTLE
            else "."
        ),
        _over_time(measured),
    ]
    helped = [name for name, each in measured.gains.items() if each.verdict is Verdict.HELPS]
    if helped:
        listed = sorted(helped, key=lambda name: -measured.gains[name].points)
        said.append(f"By class it surely (p < {LEVEL:g}) helps {_listed(measured, listed)}.")
    return said + [
        f"{_not_helped(name, each)} {_why(measured, name, each)}"
        for name, each in measured.gains.items()
        if each.verdict is not Verdict.HELPS
    ]


def _listed(measured: GestureMeasures, names: list[str]) -> str:
    parts = [f"`{name}` ({signed(measured.gains[name].points)})" for name in names]
    return f"{', '.join(parts[:-1])} and {parts[-1]}" if parts[1:] else parts[0]


def _over_time(measured: GestureMeasures) -> str:
    seen = measured.seen
    if not seen.there.any():
        return "The gestures are too short to compare one window of each at times after the onset."
    gain = 100 * (seen.share(PREDICTED) - seen.share(HELD))
    sure = p_over_time(seen) < LEVEL
    ahead = [f"{at:g}" for at in SECONDS[sure & (gain > 0)]]
    behind = [f"{at:g}" for at in SECONDS[sure & (gain < 0)]]
    if not ahead and not behind:
        return (
            "With one window a gesture, so that none overlap, the two differ beyond chance at no "
            "time after the onset."
        )
    said = "With one window a gesture, so that none overlap, "
    if ahead:
        most = int(np.nanargmax(np.where(sure, gain, np.nan)))
        said += (
            f"the prediction is ahead beyond chance at {_times(ahead)} after the onset, most at "
            f"{SECONDS[most]:g} s ({signed(float(gain[most]))})"
        )
    if behind:
        said += f"{', and ' if ahead else 'the prediction is '}behind at {_times(behind)}"
    return said + "."


def _times(times: list[str]) -> str:
    return (
        f"{len(times)} times between {times[0]} and {times[-1]} s" if times[1:] else f"{times[0]} s"
    )


def _not_helped(name: str, gain: Gain) -> str:
    if gain.verdict is Verdict.HURTS:
        return f"It hurts `{name}` ({signed(gain.points)}, {p_text(gain.p_value)}):"
    return (
        f"It makes no sure difference to `{name}` ({signed(gain.points)}, {p_text(gain.p_value)}):"
    )


def _why(measured: GestureMeasures, name: str, gain: Gain) -> str:
    which = measured.of(name)
    if gain.verdict is Verdict.HURTS:
        return _taken_for(measured, which)
    predicted, held = (
        float(measured.hands_mm[reading][which, JUDGED_AT].mean()) for reading in (PREDICTED, HELD)
    )
    after = f"{HORIZONS_MS[JUDGED_AT] / 1000:g} s"
    if gain.room <= LITTLE:
        return (
            f"even the true 2 s change little ({signed(gain.room)}); the second that is seen names "
            f"{100 * gain.accuracy[HELD]:.1f} % right already."
            if gain.accuracy[HELD] >= gain.accuracy[TRUE] - LITTLE / 100
            else f"even the true 2 s change little ({signed(gain.room)})."
        )
    if predicted >= held:
        return (
            f"the predicted hands come no nearer to the truth than held ones, {predicted:.0f} mm "
            f"against {held:.0f} mm after {after}."
        )
    return (
        f"the predicted hands are nearer to the truth, {predicted:.0f} mm against {held:.0f} mm "
        f"after {after}, but not by enough for a sure gain; the true 2 s would give "
        f"{signed(gain.room)}."
    )


def _taken_for(measured: GestureMeasures, which: NDArray[np.bool_]) -> str:
    """The class that a prediction most adds to what windows of another are taken for."""
    sizes = {
        reading: np.bincount(
            measured.probabilities[reading][which].argmax(1), minlength=len(measured.classes)
        )
        for reading in (PREDICTED, HELD)
    }
    more = sizes[PREDICTED] - sizes[HELD]
    most = int(more.argmax())
    return f"{more[most]:,} more of its windows are taken for `{measured.classes[most]}`."


def signed(points: float) -> str:
    """``+3.1 points``, with a minus sign where it is one."""
    return f"{points:+.1f}".replace("-", "\u2212") + " points"


def p_text(value: float) -> str:
    """``p < 0.001`` or ``p = 0.024``."""
    return "p < 0.001" if value < 0.001 else f"p = {value:.3f}"
