"""Mutated messages on all roles in both codings, over real sockets, at a real server.

Beside them a witness: a session of its own, whose sensor, renderer and monitor must not notice.
"""

import asyncio
import json
import os
import random
import re
import sys
import tempfile
import time
from collections import Counter
from contextlib import asynccontextmanager
from pathlib import Path

from agent_server.client.once import ConnectionFailed, join
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.convert import skeleton_to_message
from agent_server.protocol.roles import CLIENT_SENDS
from tests.support.bodies import stream
from tests.support.mutations import Mutator, good
from tests.support.raw_socket import RawSocket, frame

ROOT = Path(__file__).parents[2]
FIXTURES = json.loads((ROOT / "tests/fixtures/protocol/messages.json").read_text())
SUBPROTOCOLS = {"json": m.SUBPROTOCOL_JSON, "msgpack": m.SUBPROTOCOL_MSGPACK}
BURST = 200
PING, PONG = 9, 10
RUDE_SHARE = 0.002
"""Of bursts that end in a frame that is no websocket's, after which a connection is opened anew."""
RUDE = (
    frame(b"\xff\xfe", 1),  # text that is not UTF-8
    b"\x01\x80\0\0\0\0\x81\x80\0\0\0\0",  # a message within a message
    b"\xf3\x80\0\0\0\0",  # reserved bits and an opcode that is none
    b"\x82\x05hello",  # not masked
    b"\x82\xff" + (2**62).to_bytes(8, "big") + bytes(4),  # too long to be true
    b"\x88\x81\0\0\0\0\x03",  # a close frame with half a code
    b"\x89\xfe\x01\x00" + bytes(4),  # a ping that is too long
)
SETTINGS = """
[server]
max_errors = 1000000000
max_messages_per_s = 1000000000
command_queue = 100000
handshake_timeout_s = 60
[gate]
mode = "off"
"""
"""Nobody is cut for errors or made to wait, so that every message is looked at."""


class Fuzzer:
    """One role in one coding."""

    def __init__(self, port, role, coding, seed):
        self._port, self.role, self.coding = port, role, coding
        self._random = random.Random(f"{seed} {role} {coding}")
        sends = {kind.__struct_config__.tag for kind in CLIENT_SENDS[role]} | {"hello", "ping"}
        self._mutations = iter(
            Mutator(f"{seed} {role} {coding} m", coding, good(FIXTURES, coding, sends))
        )
        self._codec = CODECS[SUBPROTOCOLS[coding]]
        self.sent = 0
        self.answers = Counter()
        self.connections = 0
        self.closes = Counter()

    async def run(self, count, until_s):
        """Send so many, or as many as there is time for."""

        def is_over():
            return self.sent >= count or time.monotonic() >= until_s

        while not is_over():
            socket = await self._open()
            while not is_over() and await self._burst(socket):
                pass
            socket.abort()

    async def _open(self):
        path = f"/v1/sessions/fuzz-{self.coding}/{self.role}"
        socket = await RawSocket.open(self._port, path, self._codec.subprotocol)
        self.connections += 1
        # The place of a connection that has just been aborted is still taken.
        hello = m.Hello(m.PROTOCOL, "fuzzer", take_over=True, topics=["error"])
        await self._exchange(socket, hello)
        return socket

    async def _burst(self, socket):
        """Send some, and wait until all were looked at; tells whether the connection holds."""
        for _ in range(BURST):
            is_text, payload = next(self._mutations)
            socket.send(payload, is_text=is_text)
        self.sent += BURST
        if self._random.random() < RUDE_SHARE * (BURST / 100):
            socket.writer.write(self._random.choice(RUDE))
            self.sent += 1
        return await self._exchange(socket, m.Ping(2**50 + self.sent))

    async def _exchange(self, socket, message):
        """Send a good message and read up to its answer, or to the end of the connection."""
        data = self._codec.encode(message)
        is_text = isinstance(data, str)
        try:
            socket.send(data.encode() if is_text else data, is_text=is_text)
            await socket.writer.drain()
        except ConnectionError:
            return False
        async with asyncio.timeout(60):
            while (received := await socket.receive()) is not None:
                opcode, payload = received
                if opcode == 8:
                    self.closes[socket.close_code] += 1
                    return False
                if opcode == PING:
                    socket.writer.write(frame(payload, PONG))
                if opcode not in (1, 2):
                    continue
                answer = self._codec.decode_server(payload.decode() if opcode == 1 else payload)
                match answer:
                    case m.Welcome():
                        return True
                    case m.Pong(sent_ns=sent_ns) if sent_ns == getattr(message, "sent_ns", None):
                        return True
                    case m.ErrorMessage(code=code):
                        self.answers[code] += 1
        return False


class Witness:
    """A session that has nothing to do with all this."""

    def __init__(self, url):
        self._url = url
        self.sent = 0
        self.errors = []
        self.decisions = 0
        self.total_ms = []
        self.stats = None

    async def run(self, is_over):
        hello = m.Hello(m.PROTOCOL, "witness", face="none")
        url = self._url
        try:
            async with (
                join(url, "witness", "monitor", hello=hello) as monitor,
                join(url, "witness", "renderer", hello=hello) as renderer,
                join(url, "witness", "sensor", hello=hello) as sensor,
                asyncio.TaskGroup() as group,
            ):
                tasks = [group.create_task(self._watch(one)) for one in (monitor, renderer)]
                await self._stand(sensor, is_over)
                await asyncio.sleep(1.0)
                for task in tasks:
                    task.cancel()
        except (ConnectionFailed, ExceptionGroup) as error:
            self.errors.append(f"the connection ended: {error!r}")

    async def _stand(self, sensor, is_over):
        for one in _endless():
            if is_over.is_set():
                return
            await sensor.send(skeleton_to_message(one))
            self.sent += 1
            await asyncio.sleep(1 / 30)

    async def _watch(self, client):
        async for message in client:
            match message:
                case m.ErrorMessage():
                    self.errors.append(f"{message.code}: {message.message}")
                case m.DecisionMessage(timing=timing):
                    self.decisions += 1
                    self.total_ms.append(timing.total_ms)
                case m.StatsMessage():
                    self.stats = message


def _endless():
    index = 0
    while True:
        (one,) = stream(1 / 30, hands_up=lambda t: t % 8 < 2, start=index)
        yield one
        index += 1


@asynccontextmanager
async def served(settings=SETTINGS):
    """``agent-server serve`` in a process of its own; gives process, port, and its log so far."""
    with tempfile.TemporaryDirectory(prefix="bad_input") as folder:
        config, log = Path(folder) / "settings.toml", Path(folder) / "log"
        config.write_text(settings)
        with log.open("wb") as stderr:
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "agent_server", "serve", "--config", str(config)),
                *("--port", "0", "--json"),
                stdout=asyncio.subprocess.PIPE,
                stderr=stderr,
                cwd=ROOT,
            )
        try:
            url = json.loads(await process.stdout.readline())["address"]
            yield process, url, log.read_text
        finally:
            if process.returncode is None:
                process.terminate()
                await process.wait()


def rss_mib(pid):
    status = Path(f"/proc/{pid}/status").read_text()
    return round(int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024, 1)


def cpu_seconds(pid):
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def run_trial(count, seed=0, within_s=24 * 3600):
    """Send so many mutated messages, or as many as there is time for; gives the figures."""
    async with served() as (process, url, log):
        port = int(url.rpartition(":")[2])
        witness, is_over = Witness(url), asyncio.Event()
        fuzzers = [
            Fuzzer(port, role, coding, seed)
            for role in ("sensor", "renderer", "monitor")
            for coding in SUBPROTOCOLS
        ]
        start_s = time.monotonic()
        rss = []
        async with asyncio.TaskGroup() as group:
            watching = group.create_task(witness.run(is_over))
            tasks = [
                group.create_task(one.run(count // len(fuzzers), start_s + within_s))
                for one in fuzzers
            ]
            while not all(task.done() for task in tasks):
                rss.append((sum(one.sent for one in fuzzers), rss_mib(process.pid)))
                await asyncio.sleep(0.5)
            is_over.set()
            await watching
        cpu_s = cpu_seconds(process.pid)
        seconds = time.monotonic() - start_s
        process.terminate()
        status = await process.wait()
        return {
            **_figures(fuzzers, witness, rss, seconds, status, log()),
            "server_cpu_s": cpu_s,
        }


_STALL = re.compile(r" ERROR agent_server\.service\.watchdog: .*")
"""The watchdog's word that loop or models were held up, which a busy machine does too."""


def _tracebacks(log):
    return re.findall(r"Traceback \(most recent call last\)(?:\n[ \t].*)*\n.*", log)


def _errors(log):
    return [line for line in re.findall(r".* ERROR .*", log) if not _STALL.search(line)]


def _figures(fuzzers, witness, rss, seconds, status, log):
    sent = sum(one.sent for one in fuzzers)
    warm = [mib for at, mib in rss if at >= sent / 5] or [rss[-1][1]]
    answers = sum((one.answers for one in fuzzers), Counter())
    stats = witness.stats
    lates = sorted(witness.total_ms)
    return {
        "messages": sent,
        "refused": answers.total(),
        "seconds": round(seconds, 1),
        "connections": sum(one.connections for one in fuzzers),
        "closes": dict(sum((one.closes for one in fuzzers), Counter())),
        "answers": dict(answers.most_common()),
        "unhandled": len(_tracebacks(log)) + len(_errors(log)),
        "unhandled_lines": (_errors(log) + _tracebacks(log))[:10],
        "stalls": len(_STALL.findall(log)),
        "exit_status": status,
        "witness": {
            "frames_sent": witness.sent,
            "frames_taken": None if stats is None else stats.frames,
            "windows": None if stats is None else stats.windows,
            "decisions": witness.decisions,
            "errors": witness.errors[:10],
            "decision_ms_p50": lates[len(lates) // 2] if lates else None,
            "decision_ms_p99": lates[int(len(lates) * 0.99)] if lates else None,
        },
        "rss_mib": {"after_a_fifth": warm[0], "end": rss[-1][1], "most": max(warm)},
    }
