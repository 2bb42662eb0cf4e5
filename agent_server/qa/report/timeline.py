"""One recording on a line: what was labelled, what the agent saw in it, and what it did."""

from collections import defaultdict
from collections.abc import Callable
from html import escape

from agent_server.domain.gesture import IDLE
from agent_server.qa.report.svg import element, ticks
from agent_server.qa.result import CaseResult, Step

_WIDTH, _LEFT, _RIGHT = 1060, 92, 12
_LABELS, _GUESS, _FACE, _DONE, _END = 8, 40, 92, 138, 176
_GUESS_HEIGHT, _FACE_HEIGHT = 40, 34
_WINDOW_MS = 200
_TEXT_PX = 6.5
_At = Callable[[float], float]
"""Milliseconds to pixels."""


def timeline(case: CaseResult, valence_bound: float) -> str:
    """The recording as SVG: labels, best guesses, valence, and reactions over seconds."""
    scale = (_WIDTH - _LEFT - _RIGHT) / max(case.duration_ms, 1)

    def at(ms: float) -> float:
        return _LEFT + ms * scale

    parts = [
        _row_name("labelled", _LABELS + 16),
        _row_name("best guess", _GUESS + 26),
        _row_name("valence", _FACE + 22),
        _row_name("reactions", _DONE + 18),
    ]
    for label in case.labels:
        x, width = at(label.onset_ms), max((label.offset_ms - label.onset_ms) * scale, 1)
        is_idle = label.gesture == IDLE
        style = "quiet" if is_idle else f"g-{slug(label.gesture)}"
        said = f"{label.gesture}, {label.onset_ms / 1000:.1f} to {label.offset_ms / 1000:.1f} s: "
        said += label.expected or ("stay quiet" if label.quiet else "as it likes")
        parts.append(
            f'<rect class="{style}" x="{x:.1f}" y="{_LABELS}" width="{width:.1f}" height="24" '
            f'rx="4"><title>{escape(said)}</title></rect>'
        )
        if not is_idle and width > len(label.gesture) * _TEXT_PX:
            parts.append(
                f'<text class="on-bar" x="{x + width / 2:.1f}" y="{_LABELS + 16}" '
                f'text-anchor="middle">{escape(label.gesture)}</text>'
            )
    parts.append(_guesses(case.steps, at, scale))
    parts.append(_valence(case.steps, at, valence_bound))
    parts.append(_reactions(case, at))
    parts.append(f'<path class="axis" d="M{_LEFT} {_END - 16}H{_WIDTH - _RIGHT}"/>')
    parts.extend(
        f'<text class="tick" x="{at(second * 1000):.1f}" y="{_END}" text-anchor="middle">'
        f"{second:g} s</text>"
        for second in ticks(0, case.duration_ms / 1000, 12)
    )
    return element(_WIDTH, _END + 6, "".join(parts), f"{case.name} over time")


def _row_name(name: str, y: float) -> str:
    return f'<text class="tick" x="{_LEFT - 12}" y="{y}" text-anchor="end">{name}</text>'


def _guesses(steps: list[Step], at: _At, scale: float) -> str:
    """A bar a window, as high as its best guess is probable; idle is left out."""
    base = _GUESS + _GUESS_HEIGHT
    width = max(_WINDOW_MS * scale - 0.4, 0.3)
    paths: dict[str, list[str]] = defaultdict(list)
    for step in steps:
        if step.best == IDLE:
            continue
        high = step.probability * _GUESS_HEIGHT
        left = at(step.at_ms - _WINDOW_MS)
        paths[step.best].append(f"M{left:.1f} {base}v{-high:.1f}h{width:.1f}v{high:.1f}z")
    drawn = "".join(
        f'<path class="g-{slug(name)}" d="{"".join(parts)}"><title>{escape(name)}</title></path>'
        for name, parts in paths.items()
    )
    return f'<path class="grid" d="M{_LEFT} {base}H{_WIDTH - _RIGHT}"/>{drawn}'


def _valence(steps: list[Step], at: _At, bound: float) -> str:
    """Valence from -10 to 10, with the bound under which the gate opens."""
    points = [(at(step.at_ms), step.valence) for step in steps if step.valence is not None]
    if not points:
        return (
            f'<text class="tick" x="{_LEFT}" y="{_FACE + 22}">no face was seen, or none is needed'
            "</text>"
        )

    def down(valence: float) -> float:
        return _FACE + (10 - valence) / 20 * _FACE_HEIGHT

    path = "L".join(f"{x:.1f} {down(valence):.1f}" for x, valence in points)
    return (
        f'<path class="bound" d="M{_LEFT} {down(bound):.1f}H{_WIDTH - _RIGHT}"/>'
        f'<path class="line two" d="M{path}"/>'
    )


def _reactions(case: CaseResult, at: _At) -> str:
    good = {
        check.at_ms + check.delay_ms
        for check in case.checks
        if check.passed and check.at_ms is not None and check.delay_ms is not None
    }
    parts = []
    for step in case.steps:
        if step.reaction is None:
            continue
        x = at(step.at_ms)
        style = "good" if step.at_ms in good else "bad"
        end = "end" if x > _WIDTH - 140 else "start"
        shift = -9 if end == "end" else 9
        parts.append(
            f'<path class="{style}" d="M{x:.1f} {_DONE}l6 18h-12z"><title>'
            f"{escape(step.reaction)} at {step.at_ms / 1000:.2f} s</title></path>"
            f'<text class="tick" x="{x + shift:.1f}" y="{_DONE + 15}" text-anchor="{end}">'
            f"{escape(step.reaction.replace('_', ' '))}</text>"
        )
    return "".join(parts)


def slug(gesture: str) -> str:
    """A gesture's name as part of the name of a style."""
    return "".join(c if c.isalnum() else "-" for c in gesture)
