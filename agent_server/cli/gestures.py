"""``agent-server gestures``: teach the agent gestures of one's own."""

import asyncio
import json
import socket
import subprocess
import sys
from contextlib import closing
from importlib.util import find_spec
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.markup import escape

from agent_server.cli.options import HostOption, JsonOption, PortOption, run, settings_with
from agent_server.cli.prompts import Prompter
from agent_server.cli.status import INTERRUPTED
from agent_server.clock import SystemClock
from agent_server.config import Settings
from agent_server.domain.stamp import to_ns
from agent_server.errors import AgentServerError, ConfigError
from agent_server.recording.takes import TakePlan
from agent_server.service.hub import Hub
from agent_server.service.loading import load_models, load_room
from agent_server.service.take_recorder import TakeRecorder
from agent_server.transports.server import address, bind, serving
from agent_server.transports.websocket import SESSION_ID, SESSION_ID_RULE

LINGER_S = 24 * 3600.0
"""A sensor that comes back finds its session, and with it the time line of the recording."""
NEEDS_TRAINING = ("models", "torch")

gestures = typer.Typer(
    name="gestures",
    help="Teach the agent gestures of your own.",
    no_args_is_help=True,
    add_completion=False,
)


class NobodyThere(AgentServerError):
    """Nobody was seen for too long; the text says what the sensor did instead."""


@gestures.command()
def record(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME", help="What the gesture is called; idle for everything that is none."
        ),
    ],
    subject: Annotated[
        str,
        typer.Option(metavar="NAME", help="Who moves: another name for each person."),
    ] = "p01",
    repetitions: Annotated[int, typer.Option(min=1, help="How often to show it.")] = 10,
    seconds: Annotated[
        float, typer.Option(min=1.0, max=20.0, help="For one repetition, back to rest included.")
    ] = 3.0,
    rest: Annotated[
        float, typer.Option(min=0.0, max=60.0, help="Seconds of rest after a repetition.")
    ] = 2.0,
    session: Annotated[str, typer.Option(metavar="NAME", help="The sensor's session.")] = "lab",
    wait: Annotated[
        float, typer.Option(min=1.0, help="Give up when nobody is seen for so many seconds.")
    ] = 120.0,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder of the recordings.")] = Path(
        "gestures"
    ),
    host: HostOption = None,
    port: PortOption = None,
    as_json: JsonOption = False,
) -> None:
    """Record repetitions of a gesture from a sensor, each with a label, into an MCAP file."""
    if not SESSION_ID.fullmatch(session):
        raise ConfigError(f"--session is {session!r}: {SESSION_ID_RULE}")
    plan = TakePlan(name, subject, repetitions, to_ns(seconds), to_ns(rest))
    settings = _patient(settings_with(None, host=host, port=port))
    models = load_models(settings)
    rules = load_room(settings, models)
    console = Console(stderr=as_json, highlight=False)
    prompter = Prompter(console, plan, session)
    with closing(bind(settings)) as listener:
        takes = TakeRecorder(out, plan, session, SystemClock(), prompter.tell)
        hub = Hub(settings, rules, models, SystemClock(), takes.open)
        try:
            run(_record(hub, listener, takes, session, wait, console))
        finally:
            takes.close()
            _report(takes, console, as_json=as_json)


def _patient(settings: Settings) -> Settings:
    server = msgspec.structs.replace(settings.server, session_linger_s=LINGER_S)
    return msgspec.structs.replace(settings, server=server)


async def _record(
    hub: Hub,
    listener: socket.socket,
    takes: TakeRecorder,
    session: str,
    wait_s: float,
    console: Console,
) -> None:
    base = address(listener)
    async with serving(hub, listener) as stopped:
        where = base.replace("http", "ws", 1) + f"/v1/sessions/{session}/sensor"
        console.print(f"Connect a sensor to  [bold]{where}[/]   (docs/protocol.md)", soft_wrap=True)
        if ip_address(listener.getsockname()[0]).is_loopback:
            console.print("It runs on this machine; for another one's add --host 0.0.0.0.")
        console.print(f"What it sees:        {base}/?session={session}   (Ctrl+C ends early)\n")
        ended = asyncio.create_task(takes.ended.wait())
        try:
            while not (ended.done() or stopped.done()):
                seen = takes.director.followed
                await asyncio.wait(
                    (ended, stopped), timeout=wait_s, return_when=asyncio.FIRST_COMPLETED
                )
                if not ended.done() and not stopped.done() and takes.director.followed == seen:
                    raise NobodyThere(_absence(hub, session, wait_s, where))
        finally:
            ended.cancel()
    if takes.failure is not None:
        raise takes.failure
    if not takes.is_complete:
        # A background job of a shell ignores SIGINT after the server has obeyed it.
        raise typer.Exit(INTERRUPTED)


def _absence(hub: Hub, session: str, wait_s: float, where: str) -> str:
    """What a sensor did while nobody was seen, and what to do about it."""
    there = hub.sessions.get(session)
    counters = {} if there is None else there.counters
    frames, refused = counters.get("frames", 0), counters.get("rejected_messages", 0)
    if frames:
        what = f"{frames} frames came, now none shows head, trunk and arms: step into the picture"
    elif refused:
        what = f"{refused} of its messages were refused, which the sensor was told: mend them"
    elif there is not None and any(there.audience.having("sensor")):
        what = "a sensor is connected, but sends no body: step into the picture"
    else:
        what = f"no sensor came: connect one to {where}, or wait longer with --wait"
    return f"nobody was seen for {wait_s:g} s; {what}"


def _report(takes: TakeRecorder, console: Console, *, as_json: bool) -> None:
    """Say what is kept, however it ended."""
    labels, is_kept = takes.labels, bool(takes.labels)
    if as_json:
        report = {
            "file": str(takes.path) if is_kept else None,
            "repetitions": len(labels),
            "frames": takes.frames,
            "repeated": takes.director.repeated,
            "labels": [msgspec.to_builtins(label) for label in labels],
        }
        print(json.dumps(report))
    elif is_kept:
        console.print(
            f"\n[bold]{escape(str(takes.path))}[/]: {len(labels)} labels in {takes.frames} frames, "
            f"{takes.director.repeated} repeated",
            soft_wrap=True,
        )
    else:
        console.print("\nNo repetition was finished, so there is no file.")


_PASSED_ON = {"allow_extra_args": True, "ignore_unknown_options": True}


@gestures.command(context_settings=_PASSED_ON)
def train(
    arguments: Annotated[
        list[str],
        typer.Argument(metavar="DIR --out BUNDLE [...]", help="As for models gestures train."),
    ],
) -> None:
    """Train a classifier on the recordings of a folder, with one person held out.

    The bundle then goes to serve --classifier. All options: python -m models gestures train --help
    """
    _run_models("train", arguments)


@gestures.command(context_settings=_PASSED_ON)
def check(
    arguments: Annotated[
        list[str],
        typer.Argument(metavar="BUNDLE DIR [...]", help="As for models gestures check."),
    ],
) -> None:
    """Measure a bundle on recordings: confusions, accuracy against time seen, calibration.

    All options: python -m models gestures check --help
    """
    _run_models("check", arguments)


def _run_models(command: str, arguments: list[str]) -> None:
    """Let ``models`` do it in a process of its own: the server imports nothing of training."""
    missing = [name for name in NEEDS_TRAINING if find_spec(name) is None]
    if missing:
        raise ConfigError(
            f"gestures {command} needs {' and '.join(missing)}, which the server is installed "
            "without: take a checkout of the project and run pip install -e '.[train]' in it"
        )
    line = [sys.executable, "-m", "models", "gestures", command, *arguments]
    # The arguments are the user's own, and no shell sees them.
    raise typer.Exit(subprocess.run(line, check=False).returncode)  # noqa: S603
