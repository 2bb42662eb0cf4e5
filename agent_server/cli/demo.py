"""``agent-server demo``."""

import asyncio
import os
import socket
import sys
import webbrowser
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from agent_server import __version__, assets
from agent_server.cli.options import PortOption, run, settings_with
from agent_server.cli.story import Story
from agent_server.client.link import Options
from agent_server.client.once import Client, ConnectionFailed, join, send_paced
from agent_server.client.renderer import Renderer
from agent_server.client.timed import TimedRenderer
from agent_server.domain.inputs import SensorInput
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import RecordingError
from agent_server.protocol import messages as m
from agent_server.recording.reader import Recording, open_recording
from agent_server.service.hub import Hub
from agent_server.service.loading import load_models
from agent_server.service.seats import STAND_IN
from agent_server.transports.server import address, bind, build_hub, serving

SESSION = "demo"
CLIENT = "agent-server-demo"
FAREWELL_S = 0.5
PAUSE_NS = 3 * NS_PER_S
"""Between two rounds the person is away, long enough to count as gone."""


def demo(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="Recording to play; default: built in.")
    ] = None,
    port: PortOption = None,
    rounds: Annotated[
        int, typer.Option(min=0, help="How often to play it; 0 plays until stopped.")
    ] = 0,
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
) -> None:
    """Serve, play a recorded person in real time, and show what the agent makes of it."""
    recording = open_recording(file or assets.demo_recording())
    settings = settings_with(None, port=port)
    hub = build_hub(settings, load_models())
    main = _demo(hub, bind(settings), recording, rounds, browser=browser)
    run(main, interrupted_status=0)


async def _demo(
    hub: Hub, listener: socket.socket, recording: Recording, rounds: int, *, browser: bool
) -> None:
    console = Console(highlight=False)
    base = address(listener)
    page = f"{base}/?session={SESSION}"
    async with serving(hub, listener) as stopped:
        console.print(f"The page:  [bold]{page}[/]   (Ctrl+C ends the demo)")
        console.print(f"Playing:   {recording.metadata.description or recording.path.name}\n")
        if browser and _has_screen():
            await asyncio.to_thread(webbrowser.open, page)
        async with (
            join(base, SESSION, "monitor", hello=_hello(topics=["decision"])) as monitor,
            # Whoever brings a picture may have its place.
            Renderer(Options(base, SESSION, CLIENT), capabilities=(STAND_IN,)) as connection,
        ):
            acting = asyncio.create_task(_act(TimedRenderer(connection)))
            tasks = (
                asyncio.create_task(_listen(monitor, Story(console))),
                asyncio.create_task(_play(hub, base, recording, rounds)),
            )
            await asyncio.wait((*tasks, stopped), return_when=asyncio.FIRST_COMPLETED)
            for task in (*tasks, acting):
                task.cancel()
            results = await asyncio.gather(*tasks, return_exceptions=True)
            # A server that is being stopped sends its clients away before it says so.
            await asyncio.wait((stopped,), timeout=FAREWELL_S)
            if not stopped.done():
                _raise_first(results)


def _raise_first(results: Iterable[BaseException | None]) -> None:
    for result in results:
        if isinstance(result, Exception):
            raise result


def _hello(topics: list[m.Topic] | None = None) -> m.Hello:
    return m.Hello(m.PROTOCOL, CLIENT, __version__, topics=topics)


async def _play(hub: Hub, url: str, recording: Recording, rounds: int) -> None:
    """Play the recording again and again as one person who comes and goes."""
    inputs = [event for event in recording.events() if isinstance(event, SensorInput)]
    if not inputs:
        raise RecordingError(f"{recording.path} holds nothing that a sensor sent: play another")
    length_ns = inputs[-1].originating_ns + PAUSE_NS
    async with join(url, SESSION, "sensor", hello=_hello()) as sensor:
        room = sensor.welcome.scene.objects
        played = 0
        while rounds == 0 or played < rounds:
            shift_ns = played * length_ns
            await send_paced(
                sensor,
                (
                    replace(event, originating_ns=event.originating_ns + shift_ns)
                    for event in inputs
                ),
                1.0,
            )
            await asyncio.sleep(PAUSE_NS / NS_PER_S)
            for name, state in room.items():
                hub.sessions[SESSION].change_object(name, state)
            played += 1


async def _act(renderer: TimedRenderer) -> None:
    """Carry commands out until somebody brings a renderer of their own and takes over."""
    with suppress(ConnectionFailed):
        await renderer.run()


async def _listen(monitor: Client, story: Story) -> None:
    async for message in monitor:
        if isinstance(message, m.DecisionMessage):
            story.tell(message.decision)


def _has_screen() -> bool:
    """Whether a browser would have somewhere to show the page."""
    if sys.platform in ("win32", "darwin"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
