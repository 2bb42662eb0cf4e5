"""The proxy that breaks connections: what passes, what does not, and where the break is."""

import asyncio
import json
import socket
import struct
import time
from collections import Counter
from contextlib import asynccontextmanager
from dataclasses import replace
from itertools import islice
from random import Random

import msgspec
import pytest

from tests.support.fault_proxy import FaultProxy
from tests.support.faults import UP, Delay, Fault, How, Where, faults
from tests.support.patience import until
from tests.support.websocket_pieces import Form, Pieces

REQUEST = b"GET /v1/sessions/s/renderer HTTP/1.1\r\nUpgrade: websocket\r\n\r\n"
RESPONSE = b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n\r\n"
WELCOME = {"type": "welcome", "scene": {"type": "scene", "mode": "working"}}
COMMAND = {"type": "command", "id": "s/c1", "steps": [{"action": "wave"}]}
ACK = {"command_id": "s/c1", "type": "ack", "status": "done"}


def frame(payload, opcode=1, mask=None):
    size = len(payload)
    flag = 0x80 if mask else 0
    if size < 126:
        head = bytes([0x80 | opcode, flag | size])
    elif size < 65536:
        head = bytes([0x80 | opcode, flag | 126]) + struct.pack(">H", size)
    else:
        head = bytes([0x80 | opcode, flag | 127]) + struct.pack(">Q", size)
    if mask is None:
        return head + payload
    masked = bytes(byte ^ mask[index % 4] for index, byte in enumerate(payload))
    return head + mask + masked


def text(message, mask=None):
    return frame(json.dumps(message).encode(), 1, mask)


def packed(message, mask=None):
    return frame(msgspec.msgpack.encode(message), 2, mask)


MASK = b"\x01\x80\x7f\xfe"
UPWARDS = [REQUEST, text({"type": "hello"}, MASK), text(ACK, MASK), packed(ACK, MASK)]
DOWNWARDS = [RESPONSE, text(WELCOME), text({"type": "ping"}), text(COMMAND), packed(COMMAND)]
ALL_UP, ALL_DOWN = b"".join(UPWARDS), b"".join(DOWNWARDS)
TYPES_UP = ["", "hello", "ack", "ack"]
TYPES_DOWN = ["", "welcome", "ping", "command", "command"]


@pytest.mark.parametrize("step", [1, 2, 7, 10_000])
@pytest.mark.parametrize(("pieces", "types"), [(UPWARDS, TYPES_UP), (DOWNWARDS, TYPES_DOWN)])
def test_pieces_are_cut_at_their_borders_however_the_bytes_come(pieces, types, step):
    data = b"".join(pieces)
    cutter = Pieces()
    found = [
        piece for at in range(0, len(data), step) for piece in cutter.push(data[at : at + step])
    ]
    assert [piece.raw for piece in found] == pieces
    assert [piece.type for piece in found] == types
    assert [piece.form for piece in found] == [Form.HEAD] + [Form.DATA] * (len(pieces) - 1)
    assert cutter.flush() == b""


@pytest.mark.parametrize("size", [0, 125, 126, 65535, 65536])
def test_frames_of_every_length_are_whole(size):
    cutter = Pieces()
    cutter.push(REQUEST)
    raw = frame(bytes(size), 2, MASK)
    assert cutter.push(raw[:-1]) == []
    (piece,) = cutter.push(raw[-1:] + b"rest")
    assert piece.raw == raw
    assert cutter.flush() == b"rest"


def test_a_close_frame_tells_its_code():
    cutter = Pieces()
    (_, piece) = cutter.push(RESPONSE + frame(struct.pack(">H", 4410) + b"silent", 8))
    assert (piece.form, piece.type, piece.code) == (Form.CONTROL, "close", 4410)


def test_an_answer_that_is_no_upgrade_passes_as_it_is():
    cutter = Pieces()
    (head, body) = cutter.push(b"HTTP/1.1 403 Forbidden\r\n\r\n\x81\x05no")
    assert (head.form, body.form, body.raw) == (Form.HEAD, Form.OTHER, b"\x81\x05no")


class Upstream:
    """Answers each connection with given bytes, and keeps what it gets and how that ended."""

    def __init__(self, answer):
        self._answer = answer
        self.got = []
        self.ends = []

    async def serve(self, reader, writer):
        self.got.append(b"")
        at = len(self.got) - 1
        writer.write(self._answer)
        try:
            while data := await reader.read(1000):
                self.got[at] += data
            self.ends.append("fin")
        except ConnectionResetError:
            self.ends.append("reset")
        writer.close()


@asynccontextmanager
async def proxied(fault=None, answer=ALL_DOWN, **options):
    """A connection through the proxy: its ends, the upstream and the proxy."""
    upstream = Upstream(answer)
    server = await asyncio.start_server(upstream.serve, "127.0.0.1", 0)
    plans = iter([fault])
    async with server:
        port = server.sockets[0].getsockname()[1]
        proxy = FaultProxy(port, lambda: next(plans, None), **options)
        async with proxy.serving() as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            yield reader, writer, upstream, proxy
            writer.close()


async def read_on(reader):
    """What still comes, and how it ends."""
    got = b""
    try:
        while data := await reader.read(1000):
            got += data
    except ConnectionResetError:
        return got, "reset"
    return got, "fin"


async def test_without_a_fault_bytes_pass_unchanged():
    random = Random(5)
    upwards = REQUEST + b"".join(
        frame(random.randbytes(random.choice((3, 200, 70_000))), 2, random.randbytes(4))
        for _ in range(30)
    )
    downwards = RESPONSE + b"".join(
        frame(random.randbytes(random.randrange(999))) for _ in range(30)
    )
    async with proxied(answer=downwards) as (reader, writer, upstream, proxy):
        at = 0
        while at < len(upwards):
            size = random.randrange(1, 20_000)
            writer.write(upwards[at : at + size])
            await writer.drain()
            at += size
        assert await reader.readexactly(len(downwards)) == downwards
        writer.write_eof()
        assert await read_on(reader) == (b"", "fin")
        await until(lambda: upstream.ends)
        assert upstream.got == [upwards]
        assert proxy.cuts == []
        await until(lambda: proxy.connections[0].ended_by)
        assert proxy.connections[0].ended_by == "client"


@pytest.mark.parametrize("how", list(How))
@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
@pytest.mark.parametrize(
    ("where", "nth", "index"),
    [
        (Where.REQUEST, 3, 0),
        (Where.RESPONSE, 3, 0),
        (Where.ACK, 1, 2),
        (Where.ACK, 2, 3),
        (Where.COMMAND, 1, 3),
        (Where.COMMAND, 2, 4),
        (Where.FRAME_UP, 1, 1),
        (Where.FRAME_DOWN, 2, 2),
    ],
)
async def test_a_cut_is_where_it_was_planned(where, nth, index, share, how):
    fault = Fault(where, how, nth, share, hold_s=0.05)
    pieces = UPWARDS if where in UP else DOWNWARDS
    size = len(pieces[index])
    is_part = where not in (Where.COMMAND, Where.ACK)
    passed = min(max(round(share * size), 1), size - 1) if is_part else round(share * size)
    expected = b"".join(pieces[:index]) + pieces[index][:passed]
    async with proxied(fault) as (reader, writer, upstream, proxy):
        writer.write(ALL_UP)
        got, end = await read_on(reader)
        assert end == ("fin" if how is How.FIN else "reset")
        writer.close()
        await until(lambda: upstream.ends)
        assert upstream.ends == [end]
        assert (upstream.got[0] if where in UP else got) == expected
        (cut,) = proxy.cuts
        assert (cut.where, cut.how, cut.passed, cut.size) == (where, how, passed, size)
        assert proxy.connections[0].ended_by == "cut"


async def test_between_frames_all_of_a_frame_has_passed():
    async with proxied(Fault(Where.BETWEEN, How.RESET, after_s=0.05)) as (
        reader,
        writer,
        up,
        proxy,
    ):
        writer.write(ALL_UP + UPWARDS[1][:3])
        assert await read_on(reader) == (ALL_DOWN, "reset")
        await until(lambda: up.ends)
        assert up.got == [ALL_UP]
        assert [cut.where for cut in proxy.cuts] == [Where.BETWEEN]


async def test_what_never_comes_is_replaced_by_a_cut_between_frames():
    fault = Fault(Where.COMMAND, How.FIN, nth=9, after_s=0.05)
    async with proxied(fault) as (reader, writer, _, proxy):
        writer.write(REQUEST)
        assert await read_on(reader) == (ALL_DOWN, "fin")
        assert [cut.where for cut in proxy.cuts] == [Where.BETWEEN]


async def test_a_hole_swallows_in_silence_and_then_resets():
    fault = Fault(Where.BETWEEN, How.HOLE, after_s=0.05, hold_s=0.3)
    async with proxied(fault) as (reader, writer, upstream, proxy):
        writer.write(REQUEST)
        await reader.readexactly(len(ALL_DOWN))
        await until(lambda: upstream.got == [REQUEST])
        await asyncio.sleep(0.15)
        start = time.monotonic()
        writer.write(UPWARDS[1])
        assert await read_on(reader) == (b"", "reset")
        assert time.monotonic() - start > 0.1
        await until(lambda: upstream.ends)
        assert upstream.got == [REQUEST]
        assert len(proxy.cuts) == 1


async def test_a_connection_that_ends_by_itself_is_not_cut():
    async with proxied(Fault(Where.BETWEEN, How.RESET, after_s=0.1)) as (reader, writer, up, proxy):
        writer.write(REQUEST)
        await reader.readexactly(len(RESPONSE))
        writer.close()
        await until(lambda: up.ends)
        await asyncio.sleep(0.15)
        assert proxy.cuts == []
        assert proxy.connections[0].ended_by == "client"


async def test_a_reset_passes_as_a_reset():
    async with proxied() as (reader, writer, upstream, proxy):
        writer.write(REQUEST)
        await reader.readexactly(len(RESPONSE))
        side = writer.get_extra_info("socket")
        side.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        writer.transport.abort()
        await until(lambda: upstream.ends)
        assert upstream.ends == ["reset"]
        assert proxy.connections[0].ended_by == "client"


async def test_without_a_server_connections_are_reset_and_take_no_fault():
    taken = []
    with socket.socket() as idle:
        idle.bind(("127.0.0.1", 0))
        proxy = FaultProxy(idle.getsockname()[1], lambda: taken.append(1))
        async with proxy.serving() as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            assert (await read_on(reader))[1] == "reset"
            writer.close()
    assert taken == []
    assert proxy.connections[0].ended_by == "refused"


async def test_bytes_come_late_and_in_order():
    async with proxied(delay=Delay(0.1, 0.05), seed=3) as (reader, writer, upstream, _):
        start = time.monotonic()
        for piece in UPWARDS:
            writer.write(piece)
            await asyncio.sleep(0.01)
        await until(lambda: upstream.got and len(upstream.got[0]) == len(ALL_UP))
        assert 0.1 < time.monotonic() - start < 1.0
        assert upstream.got[0] == ALL_UP
        assert await reader.readexactly(10) == RESPONSE[:10]


async def test_the_welcome_and_the_close_code_are_noted():
    answer = RESPONSE + text(WELCOME) + frame(struct.pack(">H", 1001), 8)
    async with proxied(answer=answer) as (reader, writer, _, proxy):
        writer.write(REQUEST)
        await reader.readexactly(len(answer))
        (connection,) = proxy.connections
        assert connection.welcomed_ns > connection.opened_ns
        assert connection.close_code == 1001


def test_faults_are_of_all_kinds_and_the_same_for_a_seed():
    first = list(islice(faults(Random(7)), 1000))
    assert first == list(islice(faults(Random(7)), 1000))
    assert first != list(islice(faults(Random(8)), 1000))
    count = Counter((fault.where, fault.how) for fault in first)
    assert set(count) == {(where, how) for where in Where for how in How}
    assert {replace(fault, share=0.0).passing(100) for fault in first} == {0, 1}
