"""The page in a real browser, on a real server, with the shipped models and a recorded stream."""

import asyncio
import gzip
from pathlib import Path

from agent_server import assets
from agent_server.client.once import send_paced
from agent_server.recording.reader import open_recording
from agent_server.service.loading import load_models
from tests.support.browser import browsing, needs_browser, picture, until
from tests.support.live import live

pytestmark = needs_browser
COLD = Path(__file__).parents[2] / "recorded_streams" / "cold.mcap"
SPEED = 2.0


async def test_the_page_shows_what_the_agent_makes_of_a_person():
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cold&step") as page,
    ):
        state = await until(page, lambda s: s["problem"] == "no_sensor")
        assert state["connection"]["phase"] == "live"
        assert state["objects"]["window"] == "open"
        async with server.join("sensor", "cold") as sensor:
            events = open_recording(COLD).events()
            sending = asyncio.create_task(send_paced(sensor, events, SPEED))
            # Room and decision come in messages of their own, in any order.
            state = await until(page, lambda s: s["mode"] == "reacting" and s["gesture"] == "cold")
            assert state["command"]
            assert state["gateOpen"]
            assert state["affect"]["valence"] < -3
            assert state["forecastFrames"] == 50
            assert state["poseNs"] > 4e9
            assert state["lastDecision"]["id"].startswith("cold/")
            # A mark a gesture, none for idle; hello, which no face confirms, has the highest.
            marks = await page.locator(".tick").evaluate_all(
                "ticks => ticks.map(t => t.style.left)"
            )
            assert marks == ["65%"] * 5 + ["69%"]
            state = await until(page, lambda s: s["objects"]["window"] == "closed")
            sending.cancel()
        assert len(await picture(page)) > 20_000
        rows = [(row["outcome"], row["gesture"]) for row in state["log"]]
        assert ("command", "cold") in rows
        assert state["errors"] == []
        assert page.complaints == []
        assert all(address.startswith(server.url) for address in page.requested)
        assert "Close window" in await page.inner_text("body")


async def test_a_pleased_face_is_explained_on_the_page():
    pleasant = COLD.with_name("pleasant_face.mcap")
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=p&step") as page,
        server.join("sensor", "p") as sensor,
    ):
        await until(page, lambda s: s["connection"]["phase"] == "live")
        sending = asyncio.create_task(send_paced(sensor, open_recording(pleasant).events(), SPEED))
        state = await until(page, lambda s: s["log"] and s["log"][0]["outcome"] == "gated")
        assert state["command"] is None
        assert not state["gateOpen"]
        assert "pleased" in await page.inner_text("body")
        await until(page, lambda s: s["gesture"])
        await page.get_by_role("button", name="Enlarge").click()
        gesture = await page.locator("#spoken").bounding_box()
        sound = await page.get_by_role("button", name="Sound").bounding_box()
        assert gesture["width"] > 20
        assert gesture["x"] + gesture["width"] < sound["x"], "one hides the other"
        sending.cancel()


async def test_a_connection_that_is_lost_comes_back_by_itself():
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=lost&step") as page,
    ):
        await until(page, lambda s: s["connection"]["phase"] == "live")
        # The room of the page may have joined already, as a renderer.
        (monitor,) = server.hub.sessions["lost"].audience.having("monitor")
        assert monitor.hello.client == "agent-server-page"
        monitor.outbox.close(1001, "the server is stopping")
        await until(page, lambda s: s["connection"]["phase"] != "live")
        state = await until(page, lambda s: s["connection"]["phase"] == "live")
        assert state["connection"]["fault"] is None


def test_the_page_is_light_until_the_camera_is_switched_on():
    page = assets.page()
    scripts = [path for path in page.glob("assets/*") if path.suffix in (".js", ".css")]
    first = [page / "index.html", page / "human.glb", *scripts]
    assert len(first) > 5
    assert sum(len(gzip.compress(path.read_bytes())) for path in first) < 3_000_000
