"""People that the page can put before the agent where there is no sensor: made up, or recorded."""

import asyncio
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from fastapi import APIRouter
from fastapi.responses import JSONResponse, Response, StreamingResponse

from agent_server.domain.inputs import SensorInput
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import AgentServerError, InvalidInput
from agent_server.protocol.convert import skeleton_to_message
from agent_server.protocol.inputs import input_to_message
from agent_server.recording.reader import Recording, open_recording

if TYPE_CHECKING:
    from agent_server.synthetic.stand_in import Clip

SUFFIX = ".mcap"
LONGEST_S = 120.0
"""Of a longer recording the page gets the beginning."""
LINES_AT_ONCE = 20


def people_router(streams: Path) -> APIRouter:
    """Routes ``/v1/stand-in`` and ``/v1/streams``.

    Args:
        streams: Folder of the recordings that may be played.
    """
    router = APIRouter(prefix="/v1")

    @router.get("/stand-in")
    async def stand_in_clip(gesture: str, seed: int = 0, take: int = 0) -> Response:
        """What a made-up person does, for a page that plays without a sensor."""
        try:
            clip = await asyncio.to_thread(_stand_in, gesture, abs(seed), abs(take))
        except InvalidInput as error:
            return JSONResponse({"detail": str(error)}, 422)
        return _json(
            {
                "gesture": clip.gesture,
                "variant": clip.variant,
                "onset_ns": clip.onset_ns,
                "offset_ns": clip.offset_ns,
                "frames": [skeleton_to_message(frame) for frame in clip.frames],
            }
        )

    @router.get("/streams")
    async def names() -> dict[str, list[str]]:
        """The recordings that may be played."""
        return {"streams": sorted(recordings_in(streams))}

    @router.get("/streams/{name}")
    async def stream(name: str) -> Response:
        """What the sensors of a recording sent, in order, one message a line."""
        file = recordings_in(streams).get(name)
        if file is None:
            return JSONResponse({"detail": f"there is no recording {name!r}"}, 404)
        try:
            recording = await asyncio.to_thread(open_recording, file)
        except AgentServerError as error:
            return JSONResponse({"detail": str(error)}, 422)
        return StreamingResponse(_lines(recording), media_type="application/x-ndjson")

    return router


def _stand_in(gesture: str, seed: int, take: int) -> "Clip":
    """Make the clip, off the event loop."""
    # A server starts sooner without the generator, which few of them need.
    from agent_server.synthetic.stand_in import stand_in  # noqa: PLC0415

    return stand_in(gesture, seed, take)


def recordings_in(folder: Path) -> Mapping[str, Path]:
    """Recordings of a folder by their name, which is that of the file without its ending."""
    return {path.stem: path for path in folder.glob(f"*{SUFFIX}")}


def _lines(recording: Recording) -> Iterator[bytes]:
    """A line for each message: when it was captured, counted from the first, and what it says."""
    first_ns: int | None = None
    lines: list[bytes] = []
    for event in recording.events():
        if not isinstance(event, SensorInput):
            continue
        first_ns = event.originating_ns if first_ns is None else first_ns
        after_ms = (event.originating_ns - first_ns) / NS_PER_MS
        if after_ms > 1000 * LONGEST_S:
            break
        line = {"at_ms": after_ms, "message": input_to_message(event)}
        lines.append(msgspec.json.encode(line) + b"\n")
        if len(lines) == LINES_AT_ONCE:
            # Between pieces the server does other things.
            yield b"".join(lines)
            lines.clear()
    yield b"".join(lines)


def _json(body: object) -> Response:
    return Response(msgspec.json.encode(body), media_type="application/json")
