"""A real browser on a page of the server."""

import asyncio
import shutil
from contextlib import asynccontextmanager

import pytest

from agent_server import assets
from tests.support.patience import PATIENCE_S, patience

playwright = pytest.importorskip("playwright.async_api", reason="playwright is not installed")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
needs_browser = [
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium on this machine"),
    pytest.mark.skipif(
        not (assets.page() / "index.html").exists(), reason="the page is not built: make page"
    ),
]
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]


def origin_of(address):
    """An address as it counts for who is asked: what a page made itself is of its own origin."""
    return address.removeprefix("blob:")


@asynccontextmanager
async def browsing(url, *flags, permissions=()):
    """A page on ``url``, and everything that it asked for and complained about."""
    async with playwright.async_playwright() as tool:
        browser = await tool.chromium.launch(executable_path=CHROMIUM, args=[*FLAGS, *flags])
        context = await browser.new_context(
            viewport={"width": 1280, "height": 720}, permissions=list(permissions)
        )
        context.set_default_timeout(1000 * PATIENCE_S)
        page = await context.new_page()
        page.requested, page.complaints = [], []
        page.on("request", lambda request: page.requested.append(origin_of(request.url)))
        page.on("pageerror", lambda error: page.complaints.append(str(error)))
        await page.goto(url)
        try:
            yield page
        finally:
            await browser.close()


async def until(page, condition):
    """Step the page, without drawing, until its state fits ``condition``; gives that state."""
    async with patience():
        while True:
            await page.evaluate("window.agentPage.step(100, false)")
            state = await page.evaluate("window.agentPage.state()")
            if condition(state):
                # The state may be newer than what the panels say.
                await page.evaluate("window.agentPage.step(0, false)")
                return state
            await asyncio.sleep(0.05)


async def picture(page):
    """Draw, and take a picture; software may take a minute for the first one."""
    await page.evaluate("window.agentPage.step(0)")
    return await page.screenshot(timeout=180_000)
