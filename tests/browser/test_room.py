"""The agent's room in a real browser: recorded people, a made-up one, and things done by hand."""

import asyncio
import itertools
import time
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path

import httpx

from agent_server.client import Options, Renderer
from agent_server.client.once import send_paced
from agent_server.protocol import messages as m
from agent_server.recording.reader import open_recording
from agent_server.service.loading import load_models
from tests.support.browser import browsing, needs_browser, until
from tests.support.live import live
from tests.support.patience import patience

pytestmark = needs_browser
STREAMS = Path(__file__).parents[2] / "recorded_streams"
LEAD_NS = 3_000_000_000
"""A recorded person is sent from this long before the gesture on."""
STEP_MS = 50
LONGEST_STEP_MS = 200
PATIENT_TRIES = 3
ACTIVITIES = {"command", "nothing_to_do", "gated", "busy"}


@asynccontextmanager
async def room(**options):
    """A server, and a page on it whose agent acts."""
    async with (
        live(load_models(), **options) as server,
        browsing(f"{server.url}/?session=s&step") as page,
    ):
        yield server, page, await enter(page)


async def enter(page):
    """Wait until the agent is there and acts."""
    return await until(page, lambda state: state["room"]["part"] == "acting")


@asynccontextmanager
async def playing(server, gesture, stream=None):
    """Send a recorded person meanwhile, who soon makes a gesture."""
    async with server.join("sensor") as sensor:
        recording = open_recording(STREAMS / f"{stream or gesture}.mcap")
        onset_ns = next(one.onset_ns for one in recording.labels() if one.gesture == gesture)
        begin_ns = max(0, onset_ns - LEAD_NS)
        events = (event for event in recording.events() if event.originating_ns >= begin_ns)
        sending = asyncio.create_task(send_paced(sensor, events, 1.0))
        try:
            yield sending
        finally:
            if sending.done():
                sending.result()
            sending.cancel()


async def watch(page, is_over, *, moves=True):
    """Let the agent move until ``is_over`` of its state; gives the states on the way."""
    states, before_s = [], time.monotonic()
    async with patience():
        while not states or not is_over(states[-1]):
            # A slow machine must not make a slow agent, which the server would give up.
            now_s = time.monotonic()
            step_ms = min(max(STEP_MS, 1000 * (now_s - before_s)), LONGEST_STEP_MS)
            before_s = now_s
            if moves:
                await page.evaluate(f"window.agentPage.step({step_ms}, false)")
            states.append(await page.evaluate("window.agentPage.state()"))
            await asyncio.sleep(0.02)
    return states


def hasty(rule):
    """Whatever somebody asks for ends what is being done about the window."""
    return replace(rule, preempts=frozenset({"close_window"}))


def patient(rule):
    """Commands stay worth starting for as long as a slow machine needs to load a page."""
    return replace(rule, reaction=replace(rule.reaction, ttl_ms=60_000))


def is_at_a_command(state):
    """The return to work, when somebody has left, is none."""
    return state["room"]["playing"] is not None and state["mode"] == "reacting"


def is_settled(state):
    return state["room"]["playing"] is None and state["mode"] != "reacting"


def outcomes(state, gesture):
    """What became of a gesture, the latest first; moments of doubt and repetition left out."""
    rows = [row["outcome"] for row in state["log"] if row["gesture"] == gesture]
    return [outcome for outcome in rows if outcome in ACTIVITIES]


@asynccontextmanager
async def asking(server, page, gesture):
    """A recorded person makes a gesture, which is answered by a command, and stays meanwhile.

    A slow machine leaves windows out, and may miss the gesture that way: it is made again then.
    """
    for _ in range(PATIENT_TRIES):
        async with playing(server, gesture) as sending:
            seen = await watch(page, lambda state: is_at_a_command(state) or sending.done())
            if is_at_a_command(seen[-1]):
                yield
                return
    raise AssertionError(f"{gesture} was made {PATIENT_TRIES} times without a command")


async def assert_all_done(session, page):
    """Each command ends as done; the page's word of the last one may still be on its way.

    The agent may be sent back to work meanwhile, so it goes on moving.
    """
    counters = session.counters
    await watch(page, lambda _: counters["commands_done"] == counters["commands"])


async def react(server, page, gesture):
    """Let a recorded person make a gesture; gives the states of the reaction that follows."""
    async with asking(server, page, gesture):
        return await watch(page, is_settled)


def changes(values):
    """The values without repetitions."""
    return [value for value, _ in itertools.groupby(values)]


async def assert_reaction(server, page, gesture, thing, before, after, *, rises):
    """A gesture leads to a deed once, and to nothing where there is nothing to do."""
    state = await page.evaluate("window.agentPage.state()")
    assert state["objects"][thing] == before
    states = await react(server, page, gesture)
    agents = [state["room"]["agent"] for state in states]
    (deed,) = {one["doing"] for one in agents if one["doing"].endswith(f" {thing}")} - {
        f"walk_to {thing}"
    }
    assert ("standing" in {one["stance"] for one in agents}) == rises
    held = [
        (state, hand["error_m"])
        for state in states
        for hand in state["room"]["agent"]["hands"].values()
        if hand["holds"] == thing
    ]
    assert held
    assert max(error for _, error in held) < 0.02
    # The server holds the old state for true until the agent is done.
    assert {state["objects"][thing] for state, _ in held} == {before}
    assert states[-1]["objects"][thing] == after
    assert changes(state["objects"][thing] for state in states) == [before, after]
    assert states[-1]["mode"] == "attention"
    assert agents[-1]["stance"] == "seated"
    doings = changes(one["doing"] for one in agents)
    if rises:
        assert doings.index("stand_up") < doings.index(deed) < doings.index("sit_down")
    issued = server.hub.sessions["s"].counters["commands"]
    async with playing(server, gesture) as sending:
        seen = await watch(
            page, lambda state: outcomes(state, gesture)[:1] == ["nothing_to_do"] or sending.done()
        )
    assert outcomes(seen[-1], gesture)[0] == "nothing_to_do"
    assert not any(is_at_a_command(state) for state in seen)
    assert server.hub.sessions["s"].counters["commands"] == issued


async def test_each_gesture_has_its_reaction_and_only_where_there_is_something_to_do():
    async with room() as (server, page, state):
        assert state["room"]["agent"]["stance"] == "seated"
        counts = state["room"]["counts"]
        assert 40_000 < counts["triangles"] <= 60_000
        for gesture, thing, before, after, rises in (
            ("cold", "window", "open", "closed", True),
            ("hot", "window", "closed", "open", True),
            ("loud", "hifi", "high", "low", True),
            ("smell", "cigarette", "lit", "out", False),
            ("bright", "curtain", "open", "closed", True),
        ):
            await assert_reaction(server, page, gesture, thing, before, after, rises=rises)
        states = await react(server, page, "hello")
        assert {state["room"]["agent"]["stance"] for state in states} == {"seated"}
        assert states[-1]["mode"] == "attention"
        objects = states[-1]["objects"]
        async with playing(server, "cold", "pleasant_face") as sending:
            seen = await watch(page, lambda state: outcomes(state, "cold")[:1] == ["gated"])
            sending.cancel()
        assert not any(is_at_a_command(state) for state in seen)
        # Whoever does nothing is left in peace, and after a while the agent works again.
        async with playing(server, "idle", "idle_12_minutes"):
            seen = await watch(page, lambda state: state["mode"] == "working")
        assert seen[-1]["objects"] == objects
        session = server.hub.sessions["s"]
        assert session.counters["commands_done"] >= 6
        assert session.counters["commands_failed"] == session.counters["commands_timed_out"] == 0
        assert page.complaints == []


async def test_a_reaction_is_cut_short_and_taken_back_gracefully():
    async with room(alter_rule=hasty) as (server, page, _):
        async with asking(server, page, "cold"):
            await watch(page, lambda state: state["room"]["agent"]["stance"] == "walking")
        async with playing(server, "loud"):
            # The agent would be at the window by the time that somebody has become loud: it waits.
            await watch(page, lambda state: outcomes(state, "loud"), moves=False)
            seen = await watch(page, is_settled)
        assert seen[-1]["objects"]["window"] == "open"
        assert seen[-1]["objects"]["hifi"] == "low"
        assert seen[-1]["room"]["agent"]["stance"] == "seated"
        doings = changes(state["room"]["agent"]["doing"] for state in seen)
        assert "close window" not in doings
        assert "turn_down hifi" in doings
        # Nobody jumps: between two states the agent walks no further than one can.
        places = [state["room"]["agent"]["position"] for state in seen]
        steps = [
            ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a, b in itertools.pairwise(places)
        ]
        assert max(steps) < 2.0 * LONGEST_STEP_MS / 1000
        counters = server.hub.sessions["s"].counters
        assert counters["commands_preempted"] == 1
        assert page.complaints == []


async def test_a_reaction_goes_on_over_a_lost_connection_and_starts_again_on_a_new_page():
    async with room(alter_rule=patient) as (server, page, _):
        async with asking(server, page, "cold"):
            await watch(page, lambda state: state["room"]["agent"]["stance"] == "walking")
        session = server.hub.sessions["s"]
        for client in list(session.audience.clients):
            client.outbox.close(1011, "something broke")
        states = await watch(
            page, lambda state: is_settled(state) and state["objects"]["window"] == "closed"
        )
        # It was resumed, not begun again.
        assert "stand_up" not in [state["room"]["agent"]["doing"] for state in states]
        assert session.counters["resent_commands"] == 1
        await assert_all_done(session, page)
        async with asking(server, page, "loud"):
            pass
        await watch(page, lambda state: state["room"]["agent"]["stance"] == "walking")
        await page.reload()
        await enter(page)
        states = await watch(
            page, lambda state: is_settled(state) and state["objects"]["hifi"] == "low"
        )
        assert "stand_up" in [state["room"]["agent"]["doing"] for state in states]
        await assert_all_done(session, page)
        assert page.complaints == []


async def test_objects_change_by_hand_and_a_content_face_is_left_in_peace():
    async with room() as (_, page, _):
        await page.click("#room >> text=Window")
        seen = await watch(page, lambda state: state["objects"].get("window") == "closed")
        assert seen[-1]["mode"] == "working"
        await page.click("#play >> text=Content")
        await page.click("#play >> text=Loud")
        seen = await watch(page, lambda state: outcomes(state, "loud"))
        assert outcomes(seen[-1], "loud")[0] == "gated"
        assert not is_at_a_command(seen[-1])


async def test_a_renderer_of_ones_own_takes_over_and_the_page_follows_it():
    async with room() as (server, page, _):
        async with Renderer(Options(server.url, "s")) as mine, httpx.AsyncClient() as http:
            await watch(page, lambda state: state["room"]["part"] == "watching")
            await page.click("#play >> text=Loud")
            async with patience():
                async for event in mine:
                    if isinstance(event, m.CommandMessage):
                        break
            assert mine.start(event.id)
            seen = await watch(page, lambda state: state["room"]["playing"] == event.id)
            assert seen[-1]["command"]["id"] == event.id
            assert mine.done(event.id)
            await watch(page, lambda state: state["objects"]["hifi"] == "low")
            put = await http.put(f"{server.url}/v1/sessions/s/objects/hifi?state=high")
            assert put.status_code == 200
            await watch(page, lambda state: state["objects"]["hifi"] == "high")
        assert page.complaints == []
