"""The plots of a report, each under the finding that it shows."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import NDArray

from agent_server.qa import measures
from agent_server.qa.report.svg import Plot, element
from agent_server.qa.result import CaseResult, Run
from agent_server.qa.totals import right_delays

_CELL, _ROW_NAME = 46, 74
_BINS = 24


@dataclass(frozen=True, slots=True)
class Figure:
    """A plot.

    Attributes:
        kind: What sort of plot it is.
        finding: What it shows, in a sentence.
        svg: The plot.
        note: How to read it.
    """

    kind: str
    finding: str
    svg: str
    note: str


def figures(run: Run, baseline: Run | None) -> list[Figure]:
    """All plots that the run has values for; where there is a baseline, its lines are dashed."""
    cases = run.cases
    before = [] if baseline is None else baseline.cases
    made = (
        _confusion(cases),
        _accuracy(cases, before),
        _delays(cases),
        _latencies(cases),
        _gate(run, baseline),
        _forecast(cases),
    )
    return [figure for figure in made if figure is not None]


def _confusion(cases: Sequence[CaseResult]) -> Figure | None:
    table = measures.confusion(cases)
    shown = [i for i, row in enumerate(table.counts) if sum(row)]
    if not shown:
        return None
    right = sum(table.counts[i][i] for i in shown)
    of = sum(map(sum, table.counts))
    parts = []
    for column, name in enumerate(table.labels):
        x = _ROW_NAME + column * _CELL + _CELL / 2
        parts.append(
            f'<text class="tick" x="{x}" y="30" text-anchor="middle">{escape(name)}</text>'
        )
    for line, row in enumerate(shown):
        y = 40 + line * _CELL
        asked = sum(table.counts[row])
        parts.append(
            f'<text class="tick" x="{_ROW_NAME - 10}" y="{y + _CELL / 2 + 4}" text-anchor="end">'
            f"{escape(table.labels[row])}</text>"
        )
        for column, count in enumerate(table.counts[row]):
            share = count / asked
            style = "hit" if row == column else "miss"
            strength = 0.12 + 0.88 * share if count else 0
            ink = " on" if strength > 0.6 else ""
            x = _ROW_NAME + column * _CELL
            parts.append(
                f'<rect class="cell" x="{x + 1}" y="{y + 1}" width="{_CELL - 2}" '
                f'height="{_CELL - 2}" rx="4"/>'
                f'<rect class="{style}" style="opacity:{strength:.2f}" x="{x + 1}" y="{y + 1}" '
                f'width="{_CELL - 2}" height="{_CELL - 2}" rx="4"/>'
            )
            if count:
                parts.append(
                    f'<text class="count{ink}" x="{x + _CELL / 2}" y="{y + _CELL / 2 + 5}" '
                    f'text-anchor="middle">{count}</text>'
                )
    width = _ROW_NAME + len(table.labels) * _CELL + 8
    middle = _ROW_NAME + len(table.labels) * _CELL / 2
    parts.append(
        f'<text class="title" x="{middle}" y="12" text-anchor="middle">held for (stretches)</text>'
        f'<text class="title" transform="translate(12 {40 + len(shown) * _CELL / 2}) rotate(-90)" '
        'text-anchor="middle">labelled</text>'
    )
    return Figure(
        "Confusions",
        f"{right} of {of} labelled stretches were held for what they are",
        element(max(width, 460), 48 + len(shown) * _CELL, "".join(parts), "confusion matrix"),
        "A gesture counts as what the agent held it for longest, up to 1 s after its end; an idle "
        "stretch as the gesture that it reacted to in it, if any.",
    )


def _accuracy(cases: Sequence[CaseResult], before: Sequence[CaseResult]) -> Figure | None:
    curve = measures.accuracy_over_time(cases)
    if not curve.x:
        return None
    reached = next((x for x, y in zip(curve.x, curve.y, strict=True) if y >= 0.9), None)
    finding = (
        f"The best guess is right nine times in ten once {reached:.1f} s of a gesture were seen"
        if reached is not None
        else f"The best guess is right at most {max(curve.y):.0%} of the time"
    )
    plot = Plot(
        (0, measures.SEEN_MS / 1000), (0, 1), "time seen of the gesture (s)",
        "windows guessed right", finding, percent=True,
    )  # fmt: skip
    old = measures.accuracy_over_time(before)
    plot.line(old.x, old.y, "old", name="baseline" if old.x else "")
    said = [f"{y:.0%} of {n} windows" for y, n in zip(curve.y, curve.n, strict=True)]
    plot.line(curve.x, curve.y, "one", dots=said)
    return Figure(
        "Accuracy against time seen",
        finding,
        plot.svg(),
        "Windows that end within a labelled gesture, in steps of 0.2 s. A window looks back 1 s, "
        "so an early one shows mostly what went before.",
    )


def _delays(cases: Sequence[CaseResult]) -> Figure | None:
    delays = np.array(right_delays(cases)) / 1000
    if not len(delays):
        return None
    return _histogram(
        "Time to react",
        f"Half of the right reactions come within {np.median(delays):.1f} s of the onset",
        delays,
        "from onset to reaction (s)",
        "reactions",
        "Only reactions that came as expected. A reaction counts from the end of its window.",
    )


def _latencies(cases: Sequence[CaseResult]) -> Figure | None:
    values = np.array([value for case in cases for value in case.recorded_latency_ms])
    if not len(values):
        return None
    p99 = np.percentile(values, 99)
    return _histogram(
        "Latency when it was recorded",
        f"99 of 100 live decisions came within {p99:.1f} ms of their last frame",
        values[values <= np.percentile(values, 99.5)],
        "from the last frame's arrival to the decision (ms)",
        "decisions",
        "As the server noted it while it recorded; the slowest one in 200 is left out.",
    )


def _histogram(
    kind: str, finding: str, values: NDArray[np.float64], x_title: str, y_title: str, note: str
) -> Figure:
    high = float(values.max()) * 1.05 or 1.0
    counts, edges = np.histogram(values, bins=_BINS, range=(0, high))
    plot = Plot((0, high), (0, float(counts.max()) * 1.15), x_title, y_title, finding)
    plot.bars(edges.round(3).tolist(), counts.tolist(), "one")
    plot.upright(float(np.median(values)), "median")
    return Figure(kind, finding, plot.svg(), note)


def _gate(run: Run, baseline: Run | None) -> Figure | None:
    curve = measures.gate_curve(run.cases, run.gate)
    if curve is None:
        return None
    finding = (
        f"The gate lets {curve.at[1]:.0%} of the uncomfortable faces pass, and "
        f"{curve.at[0]:.1%} of the others"
    )
    plot = Plot(
        (0, 1), (0, 1), "other faces that pass (share)", "uncomfortable faces that pass", finding,
        percent=True,
    )  # fmt: skip
    plot.line([0, 1], [0, 1], "chance")
    old = None if baseline is None else measures.gate_curve(baseline.cases, baseline.gate)
    if old is not None:
        plot.line(old.false_pass, old.true_pass, "old")
    plot.line(curve.false_pass, curve.true_pass, "one")
    plot.mark(*curve.at, f"valence < {run.gate.valence:g}, as set", below=True)
    return Figure(
        "Gate",
        finding,
        plot.svg(),
        f"ROC over all bounds on valence, with |arousal| > {run.gate.arousal:g}; area "
        f"{curve.area:.3f}. {curve.positives} windows in gestures that ask for a reaction against "
        f"{curve.negatives} where the agent must stay quiet. Hysteresis is left out.",
    )


def _forecast(cases: Sequence[CaseResult]) -> Figure | None:
    pair = measures.forecast_curves(cases, "gesture") or measures.forecast_curves(cases, "idle")
    if pair is None:
        return None
    live, held = pair
    gain = 1 - live.y[-1] / held.y[-1] if held.y[-1] else 0.0
    word = "less" if gain >= 0 else "more"
    finding = (
        f"{live.x[-1]:g} s ahead the forecast is off by {live.y[-1]:.0f} mm, {abs(gain):.0%} "
        f"{word} than holding the last pose"
    )
    high = max(*live.y, *held.y) * 1.18
    plot = Plot((0, live.x[-1]), (0, high), "ahead (s)", "mean joint error (mm)", finding)
    for curve, style, name in ((held, "chance", "last pose held"), (live, "one", "forecast")):
        said = [f"{x:g} s: {y:.1f} mm, {n} windows"
                for x, y, n in zip(curve.x, curve.y, curve.n, strict=True)]  # fmt: skip
        plot.line(curve.x, curve.y, style, dots=said, name=name)
    idle = measures.forecast_curves(cases, "idle")
    beside = (
        f" In idle motion, {idle[0].x[-1]:g} s ahead: {idle[0].y[-1]:.0f} mm against "
        f"{idle[1].y[-1]:.0f} mm held."
        if idle is not None and idle[0] is not live
        else ""
    )
    return Figure(
        "Forecast against what came",
        finding,
        plot.svg(),
        "Windows that end within a labelled gesture and whose future was seen; joints that were "
        f"not measured do not count.{beside}",
    )
