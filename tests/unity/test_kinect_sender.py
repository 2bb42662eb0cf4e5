"""The Kinect sender, with stubs for the SDKs, against a server that looks at each number."""

import asyncio
import struct
from contextlib import asynccontextmanager
from itertools import pairwise

import pytest
from websockets.asyncio.server import serve

from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from tests.fixtures.protocol.make import welcome
from tests.support.live import live
from tests.support.patience import PATIENCE_S, patience
from tests.unity.build import BRIDGE, compiled, core, needs_mono, sources

pytestmark = needs_mono

SENDER = BRIDGE / "Tools~" / "KinectSender"
CODEC = CODECS[m.SUBPROTOCOL_MSGPACK]
FRAMES = 5


def with_stubs():
    files = sources(SENDER)
    return compiled("KinectSender.exe", files, (core(),), "-d:KINECT_V2;AZURE_KINECT")


def without_devices():
    files = tuple(path for path in sources(SENDER) if path.parent.name != "Stubs")
    return compiled("SyntheticSender.exe", files, (core(),))


@pytest.fixture(autouse=True, scope="module")
def _built():
    """Compile before a server runs: it would stand still meanwhile."""
    with_stubs()
    without_devices()


@asynccontextmanager
async def started(program, url, *arguments):
    process = await asyncio.create_subprocess_exec(
        *("mono", str(program), "--url", url, "--session", "s", *arguments),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
    )
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
            await process.communicate()


async def ended(process):
    """End its input; its status and what it printed."""
    printed, _ = await asyncio.wait_for(process.communicate(b""), PATIENCE_S)
    return process.returncode, printed.decode()


async def frames_of(source):
    """Hello and the first skeletons of a source."""
    heard = asyncio.Queue()

    async def handle(socket):
        await heard.put(CODEC.decode_client(await socket.recv()))
        await socket.send(CODEC.encode(welcome(session="s", role="sensor")))
        async for data in socket:
            await heard.put(CODEC.decode_client(data))

    async with serve(handle, "127.0.0.1", 0, subprotocols=[CODEC.subprotocol]) as server:
        port = server.sockets[0].getsockname()[1]
        url = f"ws://127.0.0.1:{port}"
        hello, skeletons = None, []
        async with started(with_stubs(), url, "--source", source) as process:
            async with patience():
                while len(skeletons) < FRAMES:
                    match await heard.get():
                        case m.Hello() as hello:
                            pass
                        case m.PackedSkeleton() as skeleton:
                            skeletons.append(skeleton)
            status, printed = await ended(process)
    assert status == 0
    assert "dropped" in printed
    return hello, skeletons


def joints(skeleton):
    return list(struct.iter_unpack("<4f", skeleton.joints))


async def test_a_kinect_v2_is_sent_as_its_sdk_sees_it():
    hello, skeletons = await frames_of("kinect-v2")
    assert (hello.client, hello.role, hello.face) == ("kinect-sender", "sensor", "none")
    assert {skeleton.format for skeleton in skeletons} == {"kinect_v2"}
    assert {skeleton.body_id for skeleton in skeletons} == {0}
    expected = [(i, i + 0.25, 2.0, 0.5 if i % 3 == 0 else 1.0) for i in range(25)]
    assert joints(skeletons[0]) == expected


async def test_an_azure_kinect_is_sent_as_its_sdk_sees_it():
    _, skeletons = await frames_of("azure-kinect")
    assert {skeleton.format for skeleton in skeletons} == {"azure_kinect"}
    expected = [(i, -i, 2000.0, (0.0, 0.5, 1.0, 1.0)[i % 4]) for i in range(32)]
    assert joints(skeletons[0]) == expected


@pytest.mark.parametrize("source", ["kinect-v2", "azure-kinect"])
async def test_stamps_are_the_device_clock_from_the_start_of_the_sender(source):
    _, skeletons = await frames_of(source)
    stamps = [skeleton.originating_ns for skeleton in skeletons]
    assert 0 <= stamps[0] < PATIENCE_S * 1e9
    steps = [late - early for early, late in pairwise(stamps)]
    assert all(step % 33_000_000 == 0 and step > 0 for step in steps)


@pytest.mark.parametrize("coding", ["json", "msgpack"])
async def test_the_synthetic_person_is_taken_by_the_server(coding):
    async with (
        live() as server,
        server.join("monitor") as monitor,
        started(without_devices(), server.url, "--coding", coding) as process,
    ):
        async with patience():
            async for message in monitor:
                if isinstance(message, m.PoseMessage):
                    head = message.joints[0]
                    break
        assert head[1] == pytest.approx(0.42, abs=0.01)
        assert head[2] == pytest.approx(1.98, abs=0.01)
        status, printed = await ended(process)
    assert status == 0
    assert "refused" not in printed


async def test_a_source_that_was_not_compiled_is_refused():
    url = "ws://127.0.0.1:9"
    async with started(without_devices(), url, "--source", "kinect-v2") as process:
        _, errors = await asyncio.wait_for(process.communicate(b""), PATIENCE_S)
    assert process.returncode == 2
    assert b"--source is 'kinect-v2': give one of synthetic" in errors
