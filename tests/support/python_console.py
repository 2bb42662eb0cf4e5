"""The console renderer in Python: carries commands out by nominal times and prints JSON lines.

    python -m tests.support.python_console --url ws://HOST:PORT --session S

``direct_ns`` of a command is the time since it was decided on the clock that both processes share
where they run on one machine.
"""

import argparse
import asyncio
import json
import sys
import time

from agent_server.client import Cancelled, Options, Renderer
from agent_server.protocol import messages as m


def say(event, **more):
    """Print one line."""
    print(json.dumps({"event": event, **more}), flush=True)  # noqa: T201


class ConsoleRenderer:
    """Does nothing but wait, and says what it has done."""

    def __init__(self, renderer, scale):
        self._renderer = renderer
        self._scale = scale
        self._performing = None

    async def run(self):
        async for event in self._renderer:
            match event:
                case m.Welcome(epoch=epoch, ledger=ledger, resumed=resumed):
                    say("welcome", epoch=epoch, ledger=ledger, resumed=resumed)
                case m.CommandMessage():
                    self._cut()
                    self._arrive(event)
                    self._performing = asyncio.create_task(self._perform(event))
                case Cancelled(command, reason):
                    self._cut()
                    say("cancel", id=command.id, reason=reason)

    def _arrive(self, command):
        now_ns = time.monotonic_ns()
        clock = self._renderer.link.clock_estimate
        latency_ns = (
            None if clock.offset_ns is None else now_ns + clock.offset_ns - command.server_ns
        )
        say(
            "command",
            id=command.id,
            latency_ns=latency_ns,
            direct_ns=now_ns - command.server_ns,
            round_trip_ns=clock.round_trip_ns,
        )

    async def _perform(self, command):
        if not self._renderer.start(command.id):
            return
        for index, step in enumerate(command.steps):
            await asyncio.sleep(step.duration_s * self._scale)
            self._renderer.progress(command.id, index)
        if self._renderer.done(command.id):
            say("effect", id=command.id)

    def _cut(self):
        if self._performing is not None:
            self._performing.cancel()


async def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--url", required=True)
    parser.add_argument("--session", required=True)
    parser.add_argument("--role", default="renderer", choices=["renderer"])
    parser.add_argument("--coding", default="json", choices=["json", "msgpack"])
    parser.add_argument("--step-scale", type=float, default=1.0)
    parser.add_argument("--json", action="store_true", help="it prints nothing but JSON anyway")
    arguments = parser.parse_args()
    options = Options(
        arguments.url,
        arguments.session,
        client="python-console",
        subprotocol=f"agent-server.v1.{arguments.coding}",
    )
    async with Renderer(options) as renderer:
        running = asyncio.create_task(ConsoleRenderer(renderer, arguments.step_scale).run())
        ending = asyncio.create_task(asyncio.to_thread(sys.stdin.buffer.read))
        await asyncio.wait((running, ending), return_when=asyncio.FIRST_COMPLETED)
        if running.done():
            running.result()
        running.cancel()
    say("end")


if __name__ == "__main__":
    asyncio.run(main())
