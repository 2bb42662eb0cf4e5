"""The load measurement: how it looks for the most, what it draws, and that it measures."""

import asyncio
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from agent_server.bench.load import Load, LoadResult, find_capacity, largest, measure_load
from agent_server.bench.load_plot import load_plot

SVG = "{http://www.w3.org/2000/svg}"
GOOD = LoadResult(1, Load(), 2.0, 9.0, 2.0, 9.0, 0, 150.0, 75, 3, 1.0, 0.1, 0.2)


def server_that_holds(most):
    """A measurement of a server that keeps up with so many, and who asked it what."""
    asked = []

    async def measure(sessions):
        asked.append(sessions)
        return replace(GOOD, sessions=sessions, p99_ms=9.0 if sessions <= most else 80.0)

    return measure, asked


@pytest.mark.parametrize("most", [9, 10, 25, 60, 61, 100, 149, 330])
async def test_the_most_is_found_to_the_step(most):
    measure, asked = server_that_holds(most)
    runs = await find_capacity(measure, start=25, step=10)
    assert [run.sessions for run in runs] == sorted(asked)
    assert len(set(asked)) == len(asked)
    assert most - 10 < largest(runs) <= most


@pytest.mark.parametrize(
    "change", [{"p99_ms": 51.0}, {"command_p99_ms": 51.0}, {"dropped": 1}], ids=str
)
def test_late_decisions_late_commands_and_drops_do_not_hold(change):
    assert GOOD.holds
    assert not replace(GOOD, **change).holds


def test_what_is_far_beyond_the_bound_stands_at_the_top_with_its_number():
    runs = [replace(GOOD, sessions=n, p99_ms=n * n / 8) for n in (10, 20, 80)]
    root = ElementTree.fromstring(load_plot({"uvicorn": runs}))  # noqa: S314 - our own
    line = root.find(f"{SVG}polyline")
    heights = [float(point.split(",")[1]) for point in line.get("points").split()]
    grid = [path.get("d") for path in root.iter(f"{SVG}path") if not path.get("stroke-dasharray")]
    assert heights[2] == min(float(d.split()[1].partition("H")[0]) for d in grid)
    assert heights[0] > heights[1] > heights[2] + 50
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert "800" in texts
    assert texts[0] == "Most sessions with p99 under 50 ms: uvicorn 10"


def test_the_plot_has_a_point_a_run_and_the_bound():
    runs = [replace(GOOD, sessions=n, p99_ms=n / 2, rss_mb=150 + n / 2) for n in (25, 50, 100, 150)]
    root = ElementTree.fromstring(load_plot({"uvicorn": runs, "websockets": runs[:2]}))  # noqa: S314 - our own
    lines = root.findall(f"{SVG}polyline")
    assert [len(line.get("points").split()) for line in lines] == [4, 2, 4, 2]
    dashed = [path for path in root.iter(f"{SVG}path") if path.get("stroke-dasharray")]
    assert len(dashed) == 1
    heights = [float(point.split(",")[1]) for point in lines[0].get("points").split()]
    assert heights == sorted(heights, reverse=True)
    hollow = [one for one in root.iter(f"{SVG}circle") if one.get("fill") == "#fff"]
    assert len(hollow) == 2 * sum(not run.holds for run in runs)


@pytest.mark.parametrize(
    "load", [Load("uvicorn", "json", servers=2), Load("websockets", "msgpack")], ids=str
)
async def test_real_clients_measure_a_real_server(load):
    result = await asyncio.wait_for(measure_load(2, replace(load, seconds=2.0)), 120)
    # Two sessions, five decisions a second, for two seconds; a busy machine may owe some.
    assert 5 <= result.decisions <= 24
    assert 0 < result.p50_ms <= result.p99_ms
    assert result.rss_mb > 50 * load.servers
