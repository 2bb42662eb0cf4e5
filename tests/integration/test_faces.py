"""Faces over real websockets, with the models that ship: every way in which one can be sent."""

import asyncio
from contextlib import asynccontextmanager
from pathlib import Path

import msgspec
import numpy as np
import pytest

from agent_server.clock import SystemClock
from agent_server.config import FaceSettings, GateSettings, Settings
from agent_server.domain.affect import AffectSample
from agent_server.domain.face import FaceBlendshapes
from agent_server.protocol import messages as m
from agent_server.protocol.inputs import input_to_message
from agent_server.recording.reader import open_recording
from agent_server.service.loading import load_models
from agent_server.service.recorder import recorder
from agent_server.synthetic.face import SyntheticFace
from tests.support.live import live, next_of
from tests.support.patience import until
from tests.support.pictures import framed, jpeg, labelled, needs_faces, picture

S = 1_000_000_000
STEP = S // 10
CODINGS = [m.SUBPROTOCOL_JSON, m.SUBPROTOCOL_MSGPACK]


@pytest.fixture(scope="module")
def models():
    return load_models()


@asynccontextmanager
async def session(models, subprotocol=m.SUBPROTOCOL_JSON, settings=None, hello=None, journal=None):
    """A server with a sensor and a monitor."""
    async with (
        live(models, settings, journal) as server,
        server.join("monitor") as monitor,
        server.join("sensor", subprotocol=subprotocol, hello=hello) as sensor,
    ):
        yield server, sensor, monitor


def faces(kind, valence, arousal, count=12, start=0):
    person = SyntheticFace(np.random.default_rng(3))
    stamps = range(start, start + count * STEP, STEP)
    return [person.show(AffectSample(at, valence, arousal), kind) for at in stamps]


async def last_affect(sensor, monitor, values):
    """What the server reads off the last of some faces."""
    for value in values:
        await sensor.send(input_to_message(value))
    stamp = values[-1].originating_ns
    while (state := await next_of(monitor, m.AffectTelemetry)).originating_ns < stamp:
        pass
    return state


@pytest.mark.parametrize("subprotocol", CODINGS)
@pytest.mark.parametrize(
    ("kind", "source"),
    [
        ("mesh478", "mesh"),
        ("mesh468", "mesh"),
        ("dlib68", "points68"),
        ("blendshapes", "blendshapes"),
    ],
)
async def test_affect_is_read_off_any_kind_of_face(models, subprotocol, kind, source):
    async with session(models, subprotocol) as (_, sensor, monitor):
        state = await last_affect(sensor, monitor, faces(kind, -6, 5))
        assert state.source == source
        assert state.valence < -3
        assert abs(state.arousal) > 3
        assert 0 < state.valence_sd < 5
        # The mean of a second lags by half of it.
        assert 400 <= state.delay_ms <= 600
        later = faces(kind, 5, 4.5, start=2 * S)
        state = await last_affect(sensor, monitor, later)
        assert state.valence > 0


@needs_faces
@pytest.mark.parametrize("subprotocol", CODINGS)
async def test_a_face_is_found_in_pictures(models, subprotocol):
    (file,) = labelled(1, valence=(-1, -0.6), arousal=(0.6, 1))
    data = jpeg(framed(picture(file, 300)))
    async with session(models, subprotocol) as (server, sensor, monitor):
        for index in range(4):
            await sensor.send(m.Image(index * STEP, data))
            state = await next_of(monitor, m.AffectTelemetry)
            assert (state.originating_ns, state.source) == (index * STEP, "mesh")
        assert state.valence < -3
        counters = server.hub.sessions["s"].counters
        assert (counters["images"], counters["faces"]) == (4, 4)


async def test_a_picture_without_a_face_is_counted_and_says_nothing(models):
    async with session(models) as (server, sensor, monitor):
        await sensor.send(m.Image(0, jpeg(np.full((240, 320, 3), 120, np.uint8))))
        counters = server.hub.sessions["s"].counters
        await until(lambda: counters["images_without_face"])
        # The session goes on.
        state = await last_affect(sensor, monitor, faces("mesh478", 5, 4, start=S))
        assert state.valence > 0


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"no picture at all", "bad_image"),
        (b"\xff\xd8\xff\xe0\x00\x10 cut off", "bad_image"),
        (jpeg(np.zeros((900, 1400, 3), np.uint8), 10), "image_too_large"),
        (jpeg(np.zeros((16, 16, 3), np.uint8)), "image_too_small"),
    ],
)
async def test_a_picture_that_cannot_be_used_is_answered(models, data, code):
    async with session(models) as (_, sensor, monitor):
        await sensor.send(m.Image(0, data))
        error = await next_of(sensor, m.ErrorMessage)
        assert (error.code, error.field, error.fatal) == (code, "jpeg", False)
        state = await last_affect(sensor, monitor, faces("dlib68", 5, 4, start=S))
        assert state.source == "points68"


async def test_a_picture_over_the_limit_is_refused_and_points_are_too(models):
    settings = Settings()
    limit = settings.server.max_image_bytes
    async with session(models) as (_, sensor, _):
        await sensor.send(m.Image(0, bytes(limit)))
        error = await next_of(sensor, m.ErrorMessage)
        assert (error.code, str(limit) in error.message) == ("too_large", True)


async def test_a_neutral_face_becomes_the_zero_and_can_be_given_again(models):
    async with session(models) as (_, sensor, monitor):
        await sensor.send(m.Calibrate(0, seconds=1.0))
        state = await last_affect(sensor, monitor, faces("mesh478", -3, 1.5, 14))
        done = await next_of(sensor, m.CalibrationState)
        assert done.is_done
        assert done.faces >= 9
        # The next second is read against it.
        state = await last_affect(sensor, monitor, faces("mesh478", -3, 1.5, 14, 2 * S))
        assert abs(state.valence) < 1.2
        assert abs(state.arousal) < 1.2
    async with session(models) as (_, sensor, monitor):
        await sensor.send(m.Calibrate(0, valence=done.valence, arousal=done.arousal))
        assert (await next_of(monitor, m.CalibrationState)).is_done
        again = await last_affect(sensor, monitor, faces("mesh478", -3, 1.5, 14, 2 * S))
        assert again.valence == pytest.approx(state.valence, abs=0.5)


async def test_a_gaze_on_the_agent_opens_the_gate_of_a_headset(models):
    hello = m.Hello(m.PROTOCOL, "headset", face="gaze")
    settings = Settings(gate=GateSettings(mode="required"))
    async with session(models, settings=settings, hello=hello) as (server, sensor, _):
        core = server.hub.sessions["s"]._core
        for at in range(0, S, STEP):
            await sensor.send(m.Gaze(at, (0.0, 0.2, 2.0), (0.0, -0.1, -1.0)))
        await until(lambda: server.hub.sessions["s"].counters["gazes"] == 10)
        verdict = core._gate.verdict(9 * STEP)
        assert (verdict.mode, verdict.is_open) == ("gaze", True)
        await sensor.send(m.Gaze(S, (0.0, 0.2, 2.0), (1.0, 0.0, -1.0)))
        await until(lambda: server.hub.sessions["s"].counters["gazes"] == 11)
        assert not core._gate.verdict(S).is_open


@pytest.mark.parametrize("with_images", [False, True])
async def test_pictures_are_recorded_only_when_asked_for(models, tmp_path, with_images):
    settings = Settings(face=FaceSettings(record_images=with_images))

    def journal(name):
        return recorder(tmp_path, name, models, SystemClock(), settings, b"")

    data = jpeg(np.full((240, 320, 3), 120, np.uint8))
    async with session(models, settings=settings, journal=journal) as (server, sensor, monitor):
        await sensor.send(m.Image(0, data))
        counters = server.hub.sessions["s"].counters
        await until(lambda: counters["images_without_face"])
        await last_affect(sensor, monitor, faces("blendshapes", 5, 4, start=S))
    (path,) = tmp_path.glob("*.mcap")
    recording = open_recording(path)
    assert recording.summary.topics.get("/image", 0) == with_images
    (shapes, *_) = [e for e in recording.events() if isinstance(e, FaceBlendshapes)]
    assert np.allclose(shapes.values, faces("blendshapes", 5, 4, start=S)[0].values, atol=1e-4)


async def test_a_face_that_comes_late_is_used_and_monitors_are_warned(models):
    cold = msgspec.structs.replace(Settings(), gate=GateSettings(pair_tolerance_ms=100))
    path = Path(__file__).parents[2] / "recorded_streams" / "cold.mcap"
    async with session(models, settings=cold) as (_, sensor, monitor):
        held = []
        for event in open_recording(path).events():
            if event.originating_ns > 4 * S:
                break
            message = input_to_message(event)
            if isinstance(message, m.FacePoints):
                held.append(message)
                # Two of three faces are left out.
                if len(held) % 6:
                    continue
            await sensor.send(message)
            await asyncio.sleep(0)
        warning = await next_of(monitor, m.ErrorMessage)
        assert warning.code == "face_skew"
        assert "ms" in warning.message
