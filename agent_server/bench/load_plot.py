"""A picture of how latency and memory grow with the sessions, as SVG."""

from collections.abc import Callable, Mapping, Sequence

from agent_server.bench.load import BOUND_MS, LoadResult

WIDTH, HEIGHT = 720, 596
LEFT, RIGHT, TOP, GAP, BOTTOM = 64, 24, 70, 66, 64
MOST_OF_BOUND = 3
"""A panel with a bound ends at this many times of it; what lies beyond stands at its top edge."""
COLOURS = {"uvicorn": "#2563eb", "websockets": "#d97706"}


def load_plot(runs: Mapping[str, Sequence[LoadResult]]) -> str:
    """Two panels, p99 and memory over sessions, with a line a stack.

    Args:
        runs: What carried the websockets -> its runs, by their sessions.
    """
    most = max(run.sessions for some in runs.values() for run in some)
    height = (HEIGHT - TOP - GAP - BOTTOM) / 2
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="system-ui, sans-serif" font-size="13" fill="#334155">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
        f'<text x="{LEFT}" y="26" font-size="15" font-weight="600">{_finding(runs)}</text>',
        *_panel(runs, most, TOP, height, "p99 of decisions, ms", lambda run: run.p99_ms, BOUND_MS),
        *_panel(runs, most, TOP + height + GAP, height, "memory, MB", lambda run: run.rss_mb, None),
    ]
    for index, name in enumerate(runs):
        y = TOP - 12
        x = WIDTH - RIGHT - 110 * (len(runs) - index)
        parts.append(f'<circle cx="{x}" cy="{y - 4}" r="4" fill="{COLOURS[name]}"/>')
        parts.append(f'<text x="{x + 10}" y="{y}">{name}</text>')
    return "\n".join([*parts, "</svg>", ""])


def _finding(runs: Mapping[str, Sequence[LoadResult]]) -> str:
    """What the picture shows, in a line."""
    largest = {
        name: max((run.sessions for run in some if run.holds), default=0)
        for name, some in runs.items()
    }
    carried = ", ".join(f"{name} {sessions}" for name, sessions in largest.items())
    return f"Most sessions with p99 under {BOUND_MS:g} ms: {carried}"


def _panel(
    runs: Mapping[str, Sequence[LoadResult]],
    most: int,
    top: float,
    height: float,
    title: str,
    of: Callable[[LoadResult], float],
    bound: float | None,
) -> list[str]:
    values = [of(run) for some in runs.values() for run in some]
    # Far beyond the bound it matters no more by how much.
    highest = max(values) if bound is None else min(max(values), MOST_OF_BOUND * bound)
    step = _step(highest)
    ceiling = step * (int(highest / step) + 1)
    width = WIDTH - LEFT - RIGHT

    def x(sessions: float) -> float:
        return round(LEFT + width * sessions / most, 1)

    def y(value: float) -> float:
        return round(top + height * (1 - min(1.0, value / ceiling)), 1)

    parts = [f'<text x="{LEFT}" y="{top - 12}" font-weight="600">{title}</text>']
    for index in range(int(ceiling / step) + 1):
        line = y(index * step)
        parts.append(
            f'<path d="M{LEFT} {line}H{WIDTH - RIGHT}" stroke="#e2e8f0"/>'
            f'<text x="{LEFT - 8}" y="{line + 4}" text-anchor="end">{index * step:g}</text>'
        )
    along = _step(most)
    parts += [
        f'<text x="{x(index * along)}" y="{top + height + 20}" text-anchor="middle">'
        f"{index * along:g}</text>"
        for index in range(int(most / along) + 1)
    ]
    parts.append(
        f'<text x="{WIDTH - RIGHT}" y="{top + height + 36}" text-anchor="end">sessions</text>'
    )
    if bound is not None and bound <= ceiling:
        parts.append(
            f'<path d="M{LEFT} {y(bound)}H{WIDTH - RIGHT}" stroke="#dc2626" '
            'stroke-dasharray="6 4"/>'
        )
    for name, some in runs.items():
        points = " ".join(f"{x(run.sessions)},{y(of(run))}" for run in some)
        colour = COLOURS[name]
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
        )
        parts += [
            f'<circle cx="{x(run.sessions)}" cy="{y(of(run))}" r="4" stroke="{colour}" '
            f'stroke-width="2" fill="{colour if run.holds else "#fff"}"/>'
            for run in some
        ]
        parts += [
            f'<text x="{x(run.sessions)}" y="{y(of(run)) + 20}" '
            f'text-anchor="{"end" if run.sessions == most else "middle"}">{of(run):.0f}</text>'
            for run in some
            if of(run) > ceiling
        ]
    return parts


def _step(most: float) -> float:
    """A round distance that divides an axis into two to five."""
    step = 1.0
    while most / step > 5:
        step *= 2.5 if str(step)[0] == "2" else 2
    return step
