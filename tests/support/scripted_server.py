"""A real server in a process of its own that finds gestures by script, to be killed and started.

    python -m tests.support.scripted_server --port N --state DIR --json

With ``--respawn`` each line on stdin starts it anew, in a fresh process that has loaded its code
already; the end of stdin ends it. Every start prints ``{"event": "serving", "pid": ...}``.
"""

import argparse
import asyncio
import json
import os
import resource
import signal
import sys
from contextlib import suppress
from pathlib import Path

import uvloop

from agent_server.config import (
    DecideSettings,
    GateSettings,
    ServerSettings,
    Settings,
    WindowSettings,
)
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.service.models import Models
from agent_server.transports.server import address, bind, build_hub, serving
from tests.support.gesture_script import named

ROOM = Path(__file__).with_name("scripted_room.toml")
HEARTBEAT_S = 0.4
"""Short, so that a hole is found within a second."""


def settings(port, state):
    """Every window may start a gesture, and no face has to confirm it."""
    return Settings(
        window=WindowSettings(hop_frames=1),
        gate=GateSettings(mode="off"),
        decide=DecideSettings(enter_windows=1, leave_windows=1, cooldown_s=0.0),
        server=ServerSettings(port=port, state=state, heartbeat_s=HEARTBEAT_S),
        rules=str(ROOM),
    )


async def serve(port, state, *, as_json, record=None):
    """Serve until stopped by a signal."""
    chosen = settings(port, state)
    models = Models(LastFramePredictor(), RuleClassifier(named))
    hub = build_hub(chosen, models, None if record is None else Path(record))
    listener = bind(chosen)
    async with serving(hub, listener) as stopped:
        line = {"event": "serving", "pid": os.getpid(), "address": address(listener)}
        print(json.dumps(line) if as_json else line["address"], flush=True)  # noqa: T201
        await stopped


def run(arguments):
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        runner.run(
            serve(
                arguments.port,
                arguments.state,
                as_json=arguments.json,
                record=arguments.record,
            )
        )


def respawn(arguments):
    """Start a server a line; a process that was killed is gone, and nothing of it is kept."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    pid = None
    for _ in sys.stdin:
        pid = os.fork()
        if pid == 0:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            sys.stdin.close()
            run(arguments)
            os._exit(0)
    if pid is not None:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--state", help="folder in which sessions are remembered")
    parser.add_argument("--record", help="folder in which sessions are recorded")
    parser.add_argument("--largest-file", type=int, help="bytes beyond which no file can grow")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--respawn", action="store_true", help="start anew with each line on stdin")
    arguments = parser.parse_args()
    if arguments.largest_file is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (arguments.largest_file,) * 2)
    (respawn if arguments.respawn else run)(arguments)


if __name__ == "__main__":
    main()
