"""Take the pictures of docs/: the page, and a sheet with the key moment of each reaction.

    python -m tests.browser.pictures --out docs

People come from the recorded streams (synthetic), the server and the models are real.
"""

import argparse
import asyncio
from pathlib import Path

import cv2
import numpy as np

from agent_server.service.loading import load_models
from tests.browser.test_room import enter, is_at_a_command, is_settled, playing, watch
from tests.support.browser import browsing
from tests.support.live import live

WIDTH, HEIGHT = 640, 360
COLUMNS = 2
QUALITY = 82
SHOT_MS = 300_000
"""Software may take minutes for the first picture."""
CAPTION_PX = 30
SETTLE_MS = 400
"""How long the hand has been on something when the picture is taken."""


def holds(thing):
    return lambda state: any(
        hand["holds"] == thing for hand in state["room"]["agent"]["hands"].values()
    )


def looks_round(state):
    return is_at_a_command(state) and "look" in state["room"]["agent"]["doing"]


MOMENTS = (
    ("cold", "It is cold: the window is closed", holds("window")),
    ("hot", "It is hot: the window is opened", holds("window")),
    ("loud", "It is loud: the hi-fi is turned down", holds("hifi")),
    ("smell", "It smells: the cigarette is put out", holds("cigarette")),
    ("hello", "Hello: the agent looks up", looks_round),
    ("bright", "It is bright: the curtain is closed", holds("curtain")),
)
_BARE = """
for (const id of ["body-view", "act", "camera"]) {
  document.getElementById(id).style.display = "none";
}
"""


async def room_picture(page):
    """The room alone, as an image."""
    await page.evaluate("window.agentPage.step(16)")
    data = await page.locator("#theatre").screenshot(timeout=SHOT_MS)
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    height, width = image.shape[:2]
    tall = round(width * HEIGHT / WIDTH)
    top = max(0, (height - tall) // 2)
    cut = image[top : top + min(tall, height)]
    return cv2.resize(cut, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)


def captioned(image, caption):
    bar = np.full((CAPTION_PX, WIDTH, 3), 24, np.uint8)
    place = (10, CAPTION_PX - 10)
    cv2.putText(bar, caption, place, cv2.FONT_HERSHEY_DUPLEX, 0.5, (235, 235, 235), 1, cv2.LINE_AA)
    return np.vstack([image, bar])


def sheet(pictures):
    rows = [pictures[i : i + COLUMNS] for i in range(0, len(pictures), COLUMNS)]
    return np.vstack([np.hstack(row) for row in rows])


async def take(out):
    """Take all pictures."""
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=s&step") as page,
    ):
        await enter(page)
        await page.evaluate("window.agentPage.step(16)")
        await page.screenshot(timeout=SHOT_MS)
        await watch(page, lambda state: state["connection"]["phase"] == "live")
        pictures = []
        for gesture, caption, is_moment in MOMENTS:
            async with playing(server, gesture):
                await watch(page, is_moment)
                await page.evaluate(f"window.agentPage.step({SETTLE_MS}, false)")
                await page.evaluate("window.agentPage.step(16)")
                if not pictures:
                    await page.screenshot(path=out / "page.png", timeout=SHOT_MS)
                    await page.evaluate(_BARE)
                pictures.append(captioned(await room_picture(page), caption))
                await watch(page, is_settled)
    quality = [cv2.IMWRITE_JPEG_QUALITY, QUALITY]
    cv2.imwrite(str(out / "room.jpg"), sheet(pictures), quality)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the pictures")
    asyncio.run(take(parser.parse_args().out))


if __name__ == "__main__":
    main()
