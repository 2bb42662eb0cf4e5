"""Plots as inline SVG: axes with ticks and units, lines, bars and cells. Colours are the page's."""

from collections.abc import Sequence
from html import escape

import numpy as np

WIDTH, HEIGHT = 520, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 56, 16, 14, 46


class Plot:
    """A plot with two linear axes.

    Args:
        x: Range of the x axis.
        y: Range of the y axis.
        x_title: What x is, with its unit.
        y_title: What y is, with its unit.
        alt: What the plot shows, for who cannot see it.
        percent: Whether y is a share, written in percent.
    """

    def __init__(
        self,
        x: tuple[float, float],
        y: tuple[float, float],
        x_title: str,
        y_title: str,
        alt: str,
        *,
        percent: bool = False,
    ) -> None:
        self._x, self._y = x, y
        self._alt = alt
        self._parts: list[str] = []
        bottom, middle = HEIGHT - _BOTTOM, (_TOP + HEIGHT - _BOTTOM) / 2
        for value in ticks(*y):
            at = self.at(x[0], value)[1]
            said = f"{value:.0%}" if percent else f"{value:g}"
            self._parts.append(
                f'<path class="grid" d="M{_LEFT} {at:.1f}H{WIDTH - _RIGHT}"/>'
                f'<text class="tick" x="{_LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{said}'
                "</text>"
            )
        for value in ticks(*x):
            at = self.at(value, y[0])[0]
            self._parts.append(
                f'<text class="tick" x="{at:.1f}" y="{bottom + 18}" text-anchor="middle">'
                f"{value:g}</text>"
            )
        self._parts.append(
            f'<path class="axis" d="M{_LEFT} {bottom}H{WIDTH - _RIGHT}"/>'
            f'<text class="title" x="{(WIDTH + _LEFT) / 2}" y="{HEIGHT - 6}" text-anchor="middle">'
            f"{escape(x_title)}</text>"
            f'<text class="title" transform="translate(14 {middle}) rotate(-90)" '
            f'text-anchor="middle">{escape(y_title)}</text>'
        )

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a point lies, in pixels."""
        (x0, x1), (y0, y1) = self._x, self._y
        across = (x - x0) / (x1 - x0) * (WIDTH - _LEFT - _RIGHT)
        up = (y - y0) / (y1 - y0) * (HEIGHT - _TOP - _BOTTOM)
        return _LEFT + across, HEIGHT - _BOTTOM - up

    def line(
        self,
        xs: Sequence[float],
        ys: Sequence[float],
        style: str,
        *,
        dots: Sequence[str] = (),
        name: str = "",
    ) -> None:
        """A line; ``dots`` are what each point says when pointed at, ``name`` stands at its end."""
        points = [self.at(x, y) for x, y in zip(xs, ys, strict=True)]
        if not points:
            return
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        self._parts.append(f'<path class="line {style}" d="M{path}"/>')
        for (x, y), said in zip(points, dots, strict=False):
            self._parts.append(
                f'<circle class="dot {style}" cx="{x:.1f}" cy="{y:.1f}" r="3.5">'
                f"<title>{escape(said)}</title></circle>"
            )
        if name:
            x, y = points[-1]
            self._parts.append(
                f'<text class="name {style}" x="{x - 6:.1f}" y="{y - 9:.1f}" text-anchor="end">'
                f"{escape(name)}</text>"
            )

    def bars(self, edges: Sequence[float], counts: Sequence[float], style: str) -> None:
        """Bars between neighbouring edges."""
        for left, right, count in zip(edges, edges[1:], counts, strict=False):
            if not count:
                continue
            (x0, y0), (x1, y1) = self.at(left, 0), self.at(right, count)
            self._parts.append(
                f'<rect class="bar {style}" x="{x0 + 1:.1f}" y="{y1:.1f}" '
                f'width="{max(x1 - x0 - 2, 1):.1f}" height="{y0 - y1:.1f}" rx="2">'
                f"<title>{count:g} from {left:g} to {right:g}</title></rect>"
            )

    def mark(self, x: float, y: float, said: str, *, below: bool = False) -> None:
        """A point that stands out, with a text to its right."""
        across, down = self.at(x, y)
        self._parts.append(
            f'<circle class="mark" cx="{across:.1f}" cy="{down:.1f}" r="5.5"/>'
            f'<text class="name" x="{across + 12:.1f}" y="{down + (18 if below else 4):.1f}">'
            f"{escape(said)}</text>"
        )

    def upright(self, x: float, said: str) -> None:
        """A dashed line across the plot at ``x``, with its meaning at the top."""
        across = self.at(x, 0)[0]
        self._parts.append(
            f'<path class="bound" d="M{across:.1f} {_TOP}V{HEIGHT - _BOTTOM}"/>'
            f'<text class="name" x="{across + 6:.1f}" y="{_TOP + 10}">{escape(said)}</text>'
        )

    def svg(self) -> str:
        """The plot as an element."""
        return element(WIDTH, HEIGHT, "".join(self._parts), self._alt)


def element(width: float, height: float, content: str, alt: str) -> str:
    """An SVG element that scales with the page."""
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" role="img" aria-label="{escape(alt)}">'
        f"{content}</svg>"
    )


def ticks(low: float, high: float, about: int = 5) -> list[float]:
    """Round values within a range, about so many."""
    raw = (high - low) / about
    size = 10.0 ** np.floor(np.log10(raw))
    step = next(m * size for m in (1, 2, 2.5, 5, 10) if m * size >= raw * 0.7)
    first = np.ceil(low / step - 1e-9)
    # Adding 0 makes a negative zero a plain one.
    return [round(float(n * step), 10) + 0.0 for n in np.arange(first, high / step + 1e-9)]
