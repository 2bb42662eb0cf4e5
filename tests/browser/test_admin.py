"""The operators' page in a real browser."""

from tests.integration.test_sight import UNGATED, perform
from tests.support.browser import browsing, needs_browser
from tests.support.live import live

pytestmark = needs_browser


async def test_the_page_lists_sessions_with_what_is_amiss_first():
    async with (
        live(settings=UNGATED) as server,
        server.join("monitor", "front-desk"),
        server.join("renderer", "ann"),
    ):
        await perform(server, "ann")
        async with server.join("sensor", "lab"), browsing(f"{server.url}/admin") as page:
            rows = page.locator("#sessions tr")
            # The page's policy forbids a condition in words to be asked a second time.
            await rows.nth(2).wait_for()
            names = await rows.locator(".name").all_text_contents()
            assert names == ["lab", "ann", "front-desk"]
            assert "has not sent a frame yet" in await rows.nth(0).inner_text()
            ann = await rows.nth(1).inner_text()
            assert "loud: " in ann
            assert await rows.nth(1).locator("svg path").get_attribute("d")
            assert await page.locator("#state").inner_text() == "ready"
            assert not page.complaints
            elsewhere = [url for url in page.requested if not url.startswith(server.url)]
            assert [url for url in elsewhere if not url.startswith("data:")] == []
