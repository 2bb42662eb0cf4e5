"""Bodies before and after a decision: what was seen, what was predicted, and what came."""

from collections.abc import Iterable
from html import escape

from agent_server.domain.skeleton import CORE_BONES
from agent_server.qa.report.svg import element
from agent_server.qa.result import Moment

_CELL, _HEIGHT, _FOOT = 104, 128, 22
_SCALE = 0.082
"""Pixels a millimetre."""
_NAVEL_Y = 84
_SEEN_S = (-0.96, -0.72, -0.48, -0.24, 0.0)
_AHEAD_S = (0.4, 0.8, 1.2, 1.6, 2.0)


def strip(moment: Moment) -> str:
    """Ten bodies side by side, from the front; the forecast lies over what came."""
    parts = []
    middle = len(_SEEN_S) * _CELL
    parts.append(f'<path class="bound" d="M{middle} 6V{_HEIGHT - 4}"/>')
    for index, (pose, second) in enumerate(zip(moment.seen, _SEEN_S, strict=True)):
        parts.append(_body(index, pose, "seen"))
        parts.append(_time(index, second))
    futures = zip(moment.predicted, moment.truth, _AHEAD_S, strict=True)
    for index, (pose, truth, second) in enumerate(futures, len(_SEEN_S)):
        if truth:
            parts.append(_body(index, truth, "truth"))
        parts.append(_body(index, pose, "predicted"))
        parts.append(_time(index, second))
    width = (len(_SEEN_S) + len(_AHEAD_S)) * _CELL
    return element(width, _HEIGHT + _FOOT, "".join(parts), f"bodies: {moment.title}")


def _body(index: int, pose: list[list[int]], style: str) -> str:
    # Seen from the sensor x points to the left, as nobody draws it.
    points = [((index + 0.5) * _CELL - x * _SCALE, _NAVEL_Y - y * _SCALE) for x, y, _ in pose]
    bones = "".join(f"M{_at(points[parent])}L{_at(points[child])}" for parent, child in CORE_BONES)
    head = points[0]
    return (
        f'<path class="bone {style}" d="{bones}"/>'
        f'<circle class="head {style}" cx="{head[0]:.1f}" cy="{head[1]:.1f}" r="7"/>'
    )


def _at(point: tuple[float, float]) -> str:
    return f"{point[0]:.1f} {point[1]:.1f}"


def _time(index: int, second: float) -> str:
    said = "now" if second == 0 else f"{second:+.2g} s".replace("-", "\u2212")
    return (
        f'<text class="tick" x="{(index + 0.5) * _CELL:.0f}" y="{_HEIGHT + 14}" '
        f'text-anchor="middle">{said}</text>'
    )


def strips(moments: Iterable[Moment]) -> str:
    """All moments of a recording, each under its title."""
    return "".join(
        f"<h4>{moment.at_ms / 1000:.1f} s: {escape(moment.title)}</h4>{strip(moment)}"
        for moment in moments
    )
