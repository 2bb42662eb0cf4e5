"""Many people at once, as one process: sensors that send, renderers that obey, monitors that time.

``python -m agent_server.bench.crowd`` reads a :class:`Plan` on stdin, connects, writes a line,
waits for the time at which to begin, and writes what was measured. A sensor's frames are made
before it begins, masks included, so that the clients take little of the machine from the server.
"""

import asyncio
import bisect
import gc
import sys
import time
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import uvloop
from websockets.asyncio.client import ClientConnection, connect
from websockets.frames import Frame, Opcode
from websockets.typing import Subprotocol

from agent_server import __version__
from agent_server.client.once import socket_address
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS

WARM_UP_S = 3.0
"""What is sent before this is not measured: a window takes its first second."""
CARRY_OUT_S = 1.0
"""How long a renderer takes for a command."""


class Sent(msgspec.Struct, frozen=True, array_like=True):
    """One message of the stream that every sensor sends: capture time, kind, and its bytes."""

    stamp_ns: int
    is_body: bool
    data: bytes


class Plan(msgspec.Struct, frozen=True):
    """What a crowd is to do.

    Attributes:
        urls: Addresses of the servers; people are spread over them by their number.
        stream: File with the messages of the stream, as MessagePack.
        subprotocol: Their coding.
        people: Numbers of its people; they tell when each of them begins, and where.
        seconds: How long they send after the warm-up.
    """

    urls: list[str]
    stream: str
    subprotocol: str
    people: list[int]
    seconds: float


class Told(msgspec.Struct):
    """What a crowd has measured, in milliseconds.

    Attributes:
        decisions_ms: From sending the last frame that it needed to getting a decision.
        commands_ms: The same of commands.
        late_ms: How late the crowd sent at worst: its own fault, not the server's.
        unsent_bytes: Most that waited because the server did not read.
    """

    decisions_ms: list[float] = []
    commands_ms: list[float] = []
    late_ms: float = 0.0
    unsent_bytes: int = 0


class _Cause(msgspec.Struct):
    end_ns: int


class _Heard(msgspec.Struct):
    """What is read of a message; the rest is passed over."""

    type: str
    decision: _Cause | None = None
    originating_ns: int = 0
    id: str = ""


_Decode = Callable[[Any], _Heard]


@dataclass(slots=True)
class _Person:
    """One sensor and what is known of it; ``stamps`` and ``sent_s`` go together."""

    sensor: ClientConnection
    told: Told
    measure_from_s: float = 0.0
    stamps: list[int] = field(default_factory=list)
    sent_s: list[float] = field(default_factory=list)

    def age_ms(self, stamp_ns: int) -> float | None:
        """Time since the first frame of this stamp or later was sent; None in the warm-up."""
        index = bisect.bisect_left(self.stamps, stamp_ns)
        if index == len(self.sent_s) or self.sent_s[index] < self.measure_from_s:
            return None
        return (time.monotonic() - self.sent_s[index]) * 1000

    async def watch(self, monitor: ClientConnection, decode: _Decode) -> None:
        async for data in monitor:
            heard = decode(data)
            if heard.decision is not None and (age := self.age_ms(heard.decision.end_ns)):
                self.told.decisions_ms.append(age)

    async def obey(self, renderer: ClientConnection, decode: _Decode) -> None:
        codec = CODECS[renderer.subprotocol or m.SUBPROTOCOL_JSON]
        async with asyncio.TaskGroup() as group:
            async for data in renderer:
                heard = decode(data)
                if heard.type != "command":
                    continue
                if age := self.age_ms(heard.originating_ns):
                    self.told.commands_ms.append(age)
                await renderer.send(codec.encode(m.AckMessage(heard.id, "accepted")))
                await renderer.send(codec.encode(m.AckMessage(heard.id, "started")))
                group.create_task(self._finish(renderer, heard.id))

    async def _finish(self, renderer: ClientConnection, command: str) -> None:
        codec = CODECS[renderer.subprotocol or m.SUBPROTOCOL_JSON]
        await asyncio.sleep(CARRY_OUT_S)
        await renderer.send(codec.encode(m.AckMessage(command, "done")))


async def run_crowd(plan: Plan, stream: list[Sent]) -> Told:
    """Connect everybody, wait for the word on stdin, send, and tell what was measured."""
    opcode = Opcode.BINARY if plan.subprotocol == m.SUBPROTOCOL_MSGPACK else Opcode.TEXT
    wire = [Frame(opcode, one.data).serialize(mask=True) for one in stream]
    told = Told()
    decode: _Decode = (
        msgspec.msgpack.Decoder(_Heard).decode
        if opcode is Opcode.BINARY
        else msgspec.json.Decoder(_Heard).decode
    )
    async with AsyncExitStack() as stack, asyncio.TaskGroup() as group:
        people = []
        listening = []
        for number in plan.people:
            sockets = [
                await _join(stack, plan, number, role) for role in ("monitor", "renderer", "sensor")
            ]
            person = _Person(sockets[2], told)
            listening.append(group.create_task(person.watch(sockets[0], decode)))
            listening.append(group.create_task(person.obey(sockets[1], decode)))
            people.append(person)
        print("connected", flush=True)  # noqa: T201 - what the parent waits for
        begin_s = float(await asyncio.to_thread(sys.stdin.readline))
        gc.freeze()
        gc.disable()
        await _send(plan, people, stream, wire, begin_s)
        await asyncio.sleep(0.5)
        for task in listening:
            task.cancel()
    return told


async def _join(stack: AsyncExitStack, plan: Plan, number: int, role: m.Role) -> ClientConnection:
    url = plan.urls[number % len(plan.urls)]
    socket = await stack.enter_async_context(
        connect(
            socket_address(url, f"load-{number}", role),
            subprotocols=[Subprotocol(plan.subprotocol)],
            compression=None,
            max_size=None,
            close_timeout=1.0,
        )
    )
    hello = m.Hello(m.PROTOCOL, "bench", __version__, topics=["decision"])
    await socket.send(CODECS[plan.subprotocol].encode(hello))
    await socket.recv()
    return socket


async def _send(
    plan: Plan, people: list[_Person], stream: list[Sent], wire: list[bytes], begin_s: float
) -> None:
    """Send everybody's stream by its stamps, each begun elsewhere and not in step."""
    length_s = WARM_UP_S + plan.seconds
    spare_s = stream[-1].stamp_ns / NS_PER_S - length_s
    due: list[tuple[float, int, int]] = []
    for index, (number, person) in enumerate(zip(plan.people, people, strict=True)):
        start_s = begin_s + number * 0.618 % 1.0
        person.measure_from_s = start_s + WARM_UP_S
        from_ns = int((number * 0.382 % 1.0) * max(0.0, spare_s) * NS_PER_S)
        first = bisect.bisect_left(stream, from_ns, key=lambda one: one.stamp_ns)
        for position in range(first, len(stream)):
            offset_s = (stream[position].stamp_ns - stream[first].stamp_ns) / NS_PER_S
            if offset_s >= length_s:
                break
            due.append((start_s + offset_s, index, position))
    due.sort()
    for due_s, index, position in due:
        now_s = time.monotonic()
        if due_s > now_s:
            await asyncio.sleep(due_s - now_s)
            now_s = time.monotonic()
        person = people[index]
        late_ms = (now_s - due_s) * NS_PER_S / NS_PER_MS
        person.told.late_ms = max(person.told.late_ms, late_ms)
        if stream[position].is_body:
            person.stamps.append(stream[position].stamp_ns)
            person.sent_s.append(now_s)
        transport = person.sensor.transport
        transport.write(wire[position])
        unsent = transport.get_write_buffer_size()
        person.told.unsent_bytes = max(person.told.unsent_bytes, unsent)


def main() -> None:
    """Read a plan, carry it out, and print what was measured."""
    plan = msgspec.json.decode(sys.stdin.readline(), type=Plan)
    stream = msgspec.msgpack.decode(Path(plan.stream).read_bytes(), type=list[Sent])
    told = uvloop.run(run_crowd(plan, stream))
    print(msgspec.json.encode(told).decode())  # noqa: T201 - the answer to the parent


if __name__ == "__main__":
    main()
