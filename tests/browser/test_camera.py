"""The page's camera in a real browser: a fake camera shows real pictures of faces."""

import asyncio

import numpy as np
import pytest

from agent_server import assets
from agent_server.client.once import send_paced
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.face.image import decode_jpeg
from agent_server.face.tracker import FaceTracker
from agent_server.inference.runtime import OnnxFaceNetwork
from agent_server.protocol import messages as m
from agent_server.recording.reader import open_recording
from agent_server.service.journal import NoJournal
from agent_server.service.loading import load_models
from tests.browser.test_page import COLD
from tests.support.browser import browsing, needs_browser, until
from tests.support.live import live
from tests.support.patience import patience
from tests.support.pictures import framed, jpeg, labelled, needs_faces, picture

pytestmark = [*needs_browser]
FAKE = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
UNCOMFORTABLE = {"valence": (-1, -0.6), "arousal": (0.5, 1)}
HAPPY = {"valence": (0.4, 1), "arousal": (0.3, 1)}


@pytest.fixture
def film(tmp_path):
    """Makes a film of one face for the fake camera, and gives its flags and its picture."""

    def make(**levels):
        file = labelled(1, **levels)[0]
        data = jpeg(framed(picture(file, 320)), 95)
        path = tmp_path / "face.mjpeg"
        path.write_bytes(data * 30)
        return (*FAKE, f"--use-file-for-fake-video-capture={path}"), decode_jpeg(data)

    return make


class Faces(NoJournal):
    """Keeps the faces that a session takes."""

    def __init__(self):
        self.taken = []

    def append_input(self, value, arrival_ns):
        del arrival_ns
        if not isinstance(value, SkeletonFrame):
            self.taken.append(value)


async def words(page):
    return await page.inner_text("#camera")


async def switched_on(page, condition):
    """Switch the camera on and wait until its state fits."""
    await until(page, lambda s: s["connection"]["phase"] == "live")
    await page.click("text=Use my camera")
    return await camera_state(page, condition)


async def camera_state(page, condition):
    """Wait until the camera's state fits."""
    async with patience():
        while not condition(  # noqa: ASYNC110 - the page announces nothing
            state := await page.evaluate("window.agentPage.camera()")
        ):
            await asyncio.sleep(0.1)
    return state


@needs_faces
async def test_the_pages_landmarks_are_the_servers(film, tmp_path):
    flags, image = film(**UNCOMFORTABLE)
    journal = Faces()
    async with (
        live(load_models(), open_journal=lambda _: journal) as server,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await switched_on(page, lambda camera: camera["hasFace"])
        state = await until(page, lambda s: s["affect"] is not None and len(journal.taken) > 3)
        assert state["affect"]["valence"] < -1
        await page.evaluate("window.agentPage.step(100, false)")
        assert "Face seen" in await words(page)
        await page.screenshot(path=tmp_path / "camera.png")
        assert page.complaints == []
        assert all(address.startswith(server.url) for address in page.requested)
        await page.click("text=Stop the camera")
        assert (await page.evaluate("window.agentPage.camera()"))["phase"] == "off"
    bundles = assets.bundles()
    tracker = FaceTracker(
        OnnxFaceNetwork(bundles / "face_detector", "detector"),
        OnnxFaceNetwork(bundles / "face_mesh", "mesh"),
    )
    for _ in range(4):
        ours = tracker.look(image).points
    theirs = journal.taken[-1]
    assert (theirs.width, theirs.height) == image.shape[1::-1]
    apart = np.linalg.norm(theirs.points[:, :2] - ours[:, :2], axis=1).mean()
    pupils = np.linalg.norm(ours[468, :2] - ours[473, :2])
    # The fake camera codes its pictures anew, with less colour.
    assert apart < 0.02 * pupils


@needs_faces
async def test_pictures_go_to_the_server_where_the_page_cannot_read_them(film):
    flags, _ = film(**HAPPY)
    async with (
        live(load_models()) as server,
        browsing(
            f"{server.url}/?session=cam&step&camera=jpeg", *flags, permissions=["camera"]
        ) as page,
    ):
        await switched_on(page, lambda camera: camera["rateHz"] > 0)
        state = await until(page, lambda s: s["affect"] is not None)
        assert state["affect"]["valence"] > 0
        assert server.hub.sessions["cam"].counters["images"] > 0
        assert "Pictures go to the server" in await words(page)


@needs_faces
async def test_a_page_that_cannot_load_the_networks_sends_pictures(film):
    flags, _ = film(**HAPPY)
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await page.context.route("**/v1/models/**", lambda route: route.abort())
        state = await switched_on(page, lambda camera: camera["rateHz"] > 0)
        assert not state["readsHere"]
        state = await until(page, lambda s: s["affect"] is not None)
        assert state["affect"]["valence"] > 0
        assert "Pictures go to the server" in await words(page)


@needs_faces
@pytest.mark.parametrize(("levels", "outcome"), [(HAPPY, "gated"), (UNCOMFORTABLE, "command")])
async def test_a_gesture_counts_only_with_the_face_to_it(film, levels, outcome):
    flags, _ = film(**levels)
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await switched_on(page, lambda camera: camera["hasFace"])
        await until(page, lambda s: s["affect"] is not None)
        frames = [e for e in open_recording(COLD).events() if isinstance(e, SkeletonFrame)]
        async with server.join("sensor", "cam") as sensor:
            sending = asyncio.create_task(send_paced(sensor, frames, 1.0))
            state = await until(
                page,
                lambda s: any(row["outcome"] == outcome for row in s["log"]),
            )
            sending.cancel()
        row = next(row for row in state["log"] if row["outcome"] == outcome)
        assert row["gesture"] == "cold"
        said = await page.inner_text("body")
        if outcome == "gated":
            assert "pleased" in said
            assert state["command"] is None
        else:
            assert "Close window" in said


async def test_a_camera_that_is_refused_is_said_in_words():
    async with (
        live(load_models()) as server,
        browsing(
            f"{server.url}/?session=cam&step",
            "--use-fake-device-for-media-stream",
            "--deny-permission-prompts",
        ) as page,
    ):
        state = await switched_on(page, lambda camera: camera["phase"] == "failed")
        assert state["fault"] == "refused"
        assert "Allow it for this page" in await words(page)


async def test_no_camera_is_said_in_words():
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", "--use-fake-ui-for-media-stream") as page,
    ):
        state = await switched_on(page, lambda camera: camera["phase"] == "failed")
        assert state["fault"] == "missing"
        assert "There is no camera" in await words(page)


async def test_a_camera_that_is_lost_is_said_in_words():
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", *FAKE, permissions=["camera"]) as page,
    ):
        await switched_on(page, lambda camera: camera["phase"] in ("loading", "running"))
        await page.evaluate(
            """() => {
                const [track] = document.querySelector("video").srcObject.getVideoTracks();
                track.dispatchEvent(new Event("ended"));
            }"""
        )
        assert (await page.evaluate("window.agentPage.camera()"))["fault"] == "lost"
        assert "The camera was lost" in await words(page)


@needs_faces
async def test_another_sensors_face_is_not_pushed_aside_unasked(film):
    flags, _ = film(**HAPPY)
    async with (
        live(load_models()) as server,
        server.join("sensor", "cam") as other,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await other.send(m.Affect(0, 1.0, 1.0))
        await switched_on(page, lambda camera: camera["link"] == "taken")
        # The page is told once, and leaves it at that.
        assert server.hub.sessions["cam"].counters["rejected_messages"] == 1
        await page.evaluate("window.agentPage.step(300, false)")
        assert "Another sensor sends" in await words(page)
        await page.click("text=Send mine instead")
        state = await until(
            page, lambda s: s["affect"] is not None and s["affect"]["valence"] > 1.5
        )
        assert state["affect"]["arousal"] > 0


@needs_faces
async def test_a_place_that_is_taken_over_is_left(film):
    flags, _ = film(**HAPPY)
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await switched_on(page, lambda camera: camera["hasFace"] and camera["rateHz"] > 0)
        hello = m.Hello(m.PROTOCOL, "tester", take_over=True)
        async with server.join("sensor", "cam", hello=hello) as other:
            await other.send(m.Affect(0, 1.0, 1.0))
            await camera_state(page, lambda camera: camera["link"] == "replaced")
            await page.evaluate("window.agentPage.step(300, false)")
            assert "Another sensor has taken over" in await words(page)
            (sensor,) = server.hub.sessions["cam"].audience.having("sensor")
            assert sensor.hello.client == "tester"


@needs_faces
async def test_a_neutral_face_is_learnt_kept_and_forgotten(film):
    flags, _ = film(**HAPPY)
    async with (
        live(load_models()) as server,
        browsing(f"{server.url}/?session=cam&step", *flags, permissions=["camera"]) as page,
    ):
        await switched_on(page, lambda camera: camera["hasFace"])
        before = (await until(page, lambda s: s["affect"] is not None))["affect"]["valence"]
        assert before > 1
        await page.evaluate("window.agentPage.step(300, false)")
        await page.click("text=My face is neutral")
        assert "Look neutral" in await words(page)
        state = await camera_state(page, lambda camera: camera["neutral"] is not None)
        assert "is known now" in await words(page)
        assert abs(state["neutral"]["valence"] - before) < 1
        # What was neutral is the middle of the plane.
        await until(page, lambda s: abs(s["affect"]["valence"]) < 1)
        await page.reload()
        await switched_on(page, lambda camera: camera["hasFace"])
        await until(page, lambda s: s["affect"] is not None and abs(s["affect"]["valence"]) < 1)
        await page.click("text=Forget it")
        await until(page, lambda s: s["affect"]["valence"] > 1)
        assert await page.evaluate("Object.keys(localStorage)") == []
