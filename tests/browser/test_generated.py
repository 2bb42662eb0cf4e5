"""The page's agent answers a recorded wave with a motion that a model makes while it plays.

The person is synthetic (recorded_streams/hello.mcap), the server and the models are real; the
generator of reactions is the research bundle.
"""

from dataclasses import replace
from pathlib import Path

from agent_server.domain.command import Motion
from agent_server.inference.reactor import OnnxReactor
from agent_server.service.loading import load_models
from tests.browser.test_room import asking, enter, is_settled, patient, watch
from tests.support.browser import browsing, needs_browser
from tests.support.live import live

pytestmark = needs_browser
BUNDLE = Path(__file__).parents[2] / "models" / "benchmarks" / "interformer_sbu"


def generated(rule):
    return replace(patient(rule), motion=Motion.GENERATED)


def led(state):
    return any(hand["led"] for hand in state["room"]["agent"]["hands"].values())


async def test_a_wave_is_answered_with_a_hand_that_a_model_leads():
    models = replace(load_models(), reactor=OnnxReactor(BUNDLE))
    async with (
        live(models, alter_rule=generated) as server,
        browsing(f"{server.url}/?session=s&step") as page,
    ):
        await enter(page)
        async with asking(server, page, "hello"):
            (*_, reached) = await watch(page, lambda state: led(state) or is_settled(state))
            assert led(reached)
            assert reached["room"]["playing"] is not None
            states = await watch(page, lambda state: is_settled(state) and not led(state))
        counters = server.hub.sessions["s"].counters
        assert counters["reactions_generated"] == 1
        assert counters["reactions_refused"] == 0
        assert counters["commands_done"] >= 1
        assert sum(map(led, states)) > 3
        assert page.complaints == []
