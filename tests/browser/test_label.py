"""Labelling a recording in a real browser: by the keyboard, saved into the file, and as a table."""

import re
import shutil
from pathlib import Path

import msgspec

from agent_server.config import Settings
from agent_server.domain.label import Label
from agent_server.domain.stamp import to_ns
from agent_server.recording.label_table import read_label_table
from agent_server.recording.reader import open_recording
from tests.support.browser import browsing, needs_browser
from tests.support.live import live

pytestmark = needs_browser
STREAMS = Path(__file__).parents[2] / "recorded_streams"


def at(folder):
    settings = Settings()
    own = msgspec.structs.replace(settings.server, streams=str(folder))
    return msgspec.structs.replace(settings, server=own)


async def press(page, *keys):
    for key in keys:
        await page.keyboard.press(key)


async def said(page, words):
    beginning = re.compile("^" + re.escape(words))
    await page.locator("#said").filter(has_text=beginning).wait_for(state="attached")


async def test_a_stretch_is_marked_by_the_keyboard_and_saved_into_the_recording(tmp_path):
    path = tmp_path / "evening.mcap"
    shutil.copy(STREAMS / "cold.mcap", path)
    old = open_recording(path).labels()
    async with (
        live(settings=at(tmp_path)) as server,
        browsing(f"{server.url}/label.html?recording=evening") as page,
    ):
        await page.wait_for_selector(".label-row")
        assert await page.locator(".label-row").count() == len(old)
        first = page.locator(".label-row").nth(1)
        assert await first.inner_text() == "Cold → Close window\ns01\n4.00 \u2013 7.98 s"
        assert await page.locator("#save").is_disabled()

        await press(page, *["Shift+ArrowRight"] * 2, "i", "Shift+ArrowRight", "ArrowRight", "o")
        await press(page, "Enter")
        assert await page.evaluate("document.activeElement.id") == "gesture"
        await page.keyboard.type("Hello")
        await press(page, "Tab")
        await page.keyboard.type("Greet")
        await page.fill("#subject", "anna")
        await press(page, "Escape", "Escape")
        # One that is there already: quiet, and then one that nobody needs.
        await press(page, "Home", "ArrowDown", "Delete", "End", "ArrowUp", "Enter", "Tab")
        await page.keyboard.type("Nothing")
        await press(page, "Control+s")
        await said(page, "Saved")

        async with page.expect_download() as downloading:
            await page.click("#download")
        table = tmp_path / "labels.csv"
        await (await downloading.value).save_as(table)
        assert page.complaints == []
        assert all(address.startswith(server.url) for address in page.requested)
    new = open_recording(path).labels()
    stamp = new[0].offset_ns
    assert new[0] == Label("hello", to_ns(2), stamp, "anna", "greet", quiet=False)
    assert to_ns(3) < stamp <= to_ns(3.04)
    last = old[-1]
    unasked = Label(last.gesture, last.onset_ns, last.offset_ns, last.subject, None, quiet=False)
    assert new[1:] == (*old[1:-1], unasked)
    assert tuple(read_label_table(table)) == new
