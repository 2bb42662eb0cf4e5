"""Time from the server's decision to a client's callback, on this machine's loopback.

    python -m tests.bench.command_latency --language python --count 500 --json

``latency_ms`` is what a client finds out by itself: its own clock, mapped by pings onto the
server's; ``offset_bound_ms``, half a round trip, is how far off that can be. Where a client and the
server share a clock, ``direct_ms`` is the same without an estimate, ``offset_error_ms`` how far the
two are apart, and ``read_ms`` the time until this program has read the line that the callback
printed: more than the callback took, by a pipe.

``bare_ms`` is the machine's floor: a websocket message between two programs that do nothing else,
or to the same page, taken right after, while the same person goes on and the server works.
``added_ms`` is how much later than that a command comes.
"""

import argparse
import asyncio
import json
import sys
import tempfile
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np

from tests.bench import bare_websocket
from tests.support.console_clients import LANGUAGES, Missing, console
from tests.support.observers import Presence, act, watch
from tests.support.server_process import server_process

BROWSER = "browser"
SESSION = "latency"
HASTE = 2.0
STEP_SCALE = 0.001
WARM_UP_S = 4.0
"""By then eight pongs have come, and the estimate of the clock has settled."""
COMMANDS_A_SECOND = 2
"""At the very least."""
TELEMETRY_S = 0.5
"""A monitor may hear of a command after the renderer."""

_RENDERER = """
async ([server, session, scale]) => {
  const { RendererClient, browserHost } = await import("/client.js");
  window.arrivals = [];
  const carryOut = (command, index) => {
    const step = command.steps[index];
    if (step === undefined) return client.done(command.id);
    setTimeout(() => carryOut(command, index + 1), step.duration_s * 1000 * scale);
  };
  const client = new RendererClient(
    { server, session, client: { name: "bench", version: "", token: null } },
    browserHost,
    {
      onCommand(command) {
        const { serverNs, roundTripNs } = client;
        const latency = serverNs === null ? null : serverNs - command.server_ns;
        window.arrivals.push({ latency_ns: latency, round_trip_ns: roundTripNs });
        if (client.start(command.id)) carryOut(command, 0);
      },
      onCancel() {},
      onWelcome: () => { window.isWelcome = true; },
    },
  );
  client.open();
}
"""


async def arrivals_of_console(language, port, count, may_act, decided_ns):
    """Commands as a console client says that they came."""
    address = f"ws://127.0.0.1:{port}"
    async with console(language, address, SESSION, step_scale=STEP_SCALE) as client:
        await client.until("welcome", 30)
        await asyncio.sleep(WARM_UP_S)
        may_act.set()
        async with asyncio.timeout(count / COMMANDS_A_SECOND):
            while len(lines := [line for line in client.lines if line.event == "command"]) < count:
                client.heard.clear()
                await client.heard.wait()
        await asyncio.sleep(TELEMETRY_S)
        return [
            {**line.said, "read_ns": line.at_ns - decided_ns[line.said["id"]]}
            for line in lines[:count]
        ]


async def arrivals_in_browser(port, count, may_act):
    """Commands as a page in a real browser has them, and bare messages there."""
    from tests.support.browser import browsing  # noqa: PLC0415 - it needs a browser

    async with browsing(f"http://127.0.0.1:{port}/healthz") as page:
        await page.evaluate(_RENDERER, [f"ws://127.0.0.1:{port}", SESSION, STEP_SCALE])
        await page.wait_for_function("window.isWelcome")
        await asyncio.sleep(WARM_UP_S)
        may_act.set()
        async with asyncio.timeout(count / COMMANDS_A_SECOND):
            await page.wait_for_function(f"window.arrivals.length >= {count}", timeout=0)
        found = (await page.evaluate("window.arrivals"))[:count]
        return found, await bare_websocket.latencies_in_page_ms(page, count)


@asynccontextmanager
async def gestures(server, may_act, decided_ns):
    """A person whose gestures become commands from ``may_act`` on; a monitor notes when."""

    def note(message):
        if message["type"] == "command":
            decided_ns[message["id"]] = message["server_ns"]

    async with asyncio.TaskGroup() as group:
        monitor = Presence()
        tasks = [
            group.create_task(watch(server.port, SESSION, note, monitor)),
            group.create_task(act(server.port, SESSION, may_act, asyncio.Event(), HASTE)),
        ]
        await monitor.joined.wait()
        yield
        for task in tasks:
            task.cancel()


async def measure(language, count):
    """Figures of one client."""
    may_act, decided_ns = asyncio.Event(), {}
    with tempfile.TemporaryDirectory(prefix="latency") as folder:
        async with server_process(Path(folder)) as server:
            await server.start()
            async with gestures(server, may_act, decided_ns):
                if language == BROWSER:
                    found, bare = await arrivals_in_browser(server.port, count, may_act)
                else:
                    found = await arrivals_of_console(
                        language, server.port, count, may_act, decided_ns
                    )
                    bare = await bare_websocket.latencies_ms(count)
    latency, round_trip = _column(found, "latency_ns"), _column(found, "round_trip_ns")
    figures = {
        "client": language,
        "commands": len(found),
        "latency_ms": _percentiles(latency),
        "round_trip_ms": _percentiles(round_trip),
        "offset_bound_ms": round(float(np.median(round_trip)) / 2, 3),
        "bare_ms": _percentiles(bare),
    }
    if "direct_ns" in found[0]:
        direct = _column(found, "direct_ns")
        figures["direct_ms"] = _percentiles(direct)
        figures["offset_error_ms"] = _percentiles(np.abs(latency - direct))
        figures["read_ms"] = _percentiles(_column(found, "read_ns"))
    shown, bare_ms = figures.get("direct_ms", figures["latency_ms"]), figures["bare_ms"]
    figures["added_ms"] = {name: round(value - bare_ms[name], 3) for name, value in shown.items()}
    return figures


def _column(found, name):
    """A figure of every command, in milliseconds."""
    return np.array([one[name] for one in found], dtype=float) / 1e6


def _percentiles(values):
    return {f"p{p}": round(float(np.percentile(values, p)), 3) for p in (50, 95, 99)}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--language", choices=[*LANGUAGES, BROWSER], required=True)
    parser.add_argument("--count", type=int, default=500, help="commands")
    parser.add_argument("--json", action="store_true", help="on one line")
    arguments = parser.parse_args()
    try:
        figures = asyncio.run(measure(arguments.language, arguments.count))
    except Missing as error:
        sys.exit(str(error))
    print(json.dumps(figures, indent=None if arguments.json else 2))  # noqa: T201


if __name__ == "__main__":
    main()
