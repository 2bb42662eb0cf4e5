"""Several futures in a live session: told to monitors, in the decision, and again in a replay."""

import asyncio
from functools import partial

import msgspec
import numpy as np

from agent_server.client.once import send_paced
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, Settings
from agent_server.protocol import messages as m
from agent_server.recording.reader import open_recording
from agent_server.scene.rules import default_rules
from agent_server.service.core import Core
from agent_server.service.models import Drawing, Models
from agent_server.service.recorder import recorder
from agent_server.service.replay import log_line, replay
from tests.support.bodies import stream
from tests.support.live import live
from tests.support.models import RisingSampler, fake_models

SETTINGS = Settings(gate=GateSettings(mode="off"))


def several():
    """A forecast and three draws, of which one is not good enough."""
    plain = fake_models()
    drawing = Drawing(RisingSampler(0.9, 0.3, 0.6), 4, 0.5)
    return Models(plain.predictor, plain.classifier, plain.affect, drawing=drawing)


async def watched(models, open_journal=None):
    """The forecasts and the decisions of two seconds."""
    hello = m.Hello("1.0", "t", topics=["decision", "forecast"])
    told = []

    async def listen(monitor):
        async for message in monitor:
            told.append(message)  # noqa: PERF401 - what came before the end is wanted

    async with (
        live(models, SETTINGS, open_journal) as server,
        server.join("monitor", hello=hello) as monitor,
        server.join("sensor") as sensor,
    ):
        listening = asyncio.create_task(listen(monitor))
        await send_paced(sensor, stream(2), 4.0)
        await asyncio.sleep(0.3)
        listening.cancel()
    kinds = m.ForecastMessage, m.DecisionMessage
    return [[message for message in told if isinstance(message, kind)] for kind in kinds]


async def test_monitors_get_the_good_futures_and_how_far_they_disagree(tmp_path):
    models = several()
    open_journal = partial(
        recorder, tmp_path, models=models, clock=SystemClock(), settings=SETTINGS, rules=b""
    )
    forecasts, decisions = await watched(models, open_journal)
    assert [future.quality for future in forecasts[0].futures] == [0.9, 0.6]
    expected = np.array(forecasts[0].positions)
    for future, rise in zip(forecasts[0].futures, (0.1, 0.3), strict=True):
        positions = np.array(future.positions)
        assert positions.shape == (10, 9, 3)
        np.testing.assert_allclose(positions[..., 1] - expected[4::5, :, 1], rise, atol=2e-3)
    body = decisions[0].decision
    assert (body.futures.classified, body.futures.left_out) == (3, 1)
    assert set(body.futures.spread) == set(body.probabilities)
    assert body.models["rising_sampler"] == "4" * 12
    (path,) = tmp_path.glob("s-*.mcap")
    again = several()
    core = Core("s", SETTINGS, default_rules(again.classifier.labels), again)
    replayed = [log_line(decision) for decision in replay(open_recording(path), core, again)]
    assert replayed == [msgspec.json.encode(message.decision) for message in decisions]


async def test_one_future_is_told_as_ever():
    forecasts, decisions = await watched(fake_models())
    assert forecasts
    assert all(not message.futures for message in forecasts)
    assert all(b'"futures"' not in msgspec.json.encode(message) for message in decisions)
