"""Labelling a recording over HTTP: what it shows, and its labels as a table."""

import asyncio
import hashlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from pathlib import Path

import msgspec
from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import Response, StreamingResponse

from agent_server.config import Settings
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import AgentServerError, InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.convert import pose_message
from agent_server.recording.inputs import from_record
from agent_server.recording.label_table import format_label_table, parse_label_table
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.relabel import save_labels
from agent_server.recording.topics import DECISION, SKELETON
from agent_server.scene.rulebook import RESUME_WORK
from agent_server.service.auth import NotAdmitted
from agent_server.service.hub import Hub
from agent_server.stages.perceive import Perception
from agent_server.transports.guard import require
from agent_server.transports.people import recordings_in

LONGEST_NS = to_ns(3600)
"""Of a longer recording the page sees the beginning."""
LINES_AT_ONCE = 50
MAX_TABLE_BYTES = 1024 * 1024
_SHIPPED = (
    "recordings that ship stay as they are; download the labels, or name a folder of your own as "
    "streams in [server]"
)


def labelling_router(hub: Hub, streams: Path, *, is_own: bool) -> APIRouter:
    """Routes ``/v1/streams/NAME/about``, ``/motion`` and ``/labels``.

    Args:
        hub: Its models and rules name the gestures and the reactions.
        streams: Folder of the recordings.
        is_own: Whether the folder is the operator's, and not that of what ships.
    """
    router = APIRouter(prefix="/v1/streams/{name}")
    saving = asyncio.Lock()

    def opened(name: str) -> Recording:
        file = recordings_in(streams).get(name)
        if file is None:
            raise HTTPException(HTTPStatus.NOT_FOUND, f"there is no recording {name!r}")
        with _told():
            return open_recording(file)

    @router.get("/about")
    def about(request: Request, name: str) -> dict[str, object]:
        """How long it is, what may be written in a label, and why it could not be saved."""
        summary = opened(name).summary
        return {
            "start_s": summary.start_ns / NS_PER_S,
            "end_s": summary.end_ns / NS_PER_S,
            "gestures": hub.models.classifier.labels,
            "reactions": [one for one in hub.rules.reactions if one != RESUME_WORK],
            "refusal": _refusal(request) or (None if is_own else _SHIPPED),
        }

    @router.get("/motion")
    def motion(name: str) -> Response:
        """The followed body at 25 Hz and recorded decisions, as a monitor gets them, one a line."""
        lines = _lines(opened(name), hub.settings)
        return StreamingResponse(lines, media_type="application/x-ndjson")

    @router.get("/labels")
    def labels(name: str) -> Response:
        """The labels, as the table that ``agent-server annotate`` reads."""
        with _told():
            return _answer(_table(opened(name)))

    def replaced(name: str, body: bytes, expected: str | None) -> str:
        """The table as it stands after the labels of another one were saved."""
        recording = opened(name)
        with _told():
            if expected not in (None, _tag(_table(recording))):
                said = "somebody else has saved other labels meanwhile: load them and save again"
                raise HTTPException(HTTPStatus.PRECONDITION_FAILED, said)
            try:
                text = body.decode("utf-8-sig")
            except UnicodeDecodeError as error:
                raise InvalidInput(f"the table of labels is not UTF-8: {error}") from error
            save_labels(recording.path, parse_label_table(text, "labels"))
            return _table(opened(name))

    @router.put("/labels")
    async def save(request: Request, name: str) -> Response:
        """Put the labels of a table in the place of those in the recording.

        With ``If-Match`` only where they still are what the tag stands for.
        """
        require(request.scope, None, "operator")
        if not is_own:
            raise HTTPException(HTTPStatus.CONFLICT, _SHIPPED)
        body = await _body(request)
        async with saving:
            expected = request.headers.get("if-match")
            return _answer(await asyncio.to_thread(replaced, name, body, expected))

    return router


def _refusal(request: Request) -> str | None:
    """Why the bearer may not save, or None."""
    try:
        require(request.scope, None, "operator")
    except NotAdmitted as error:
        return str(error)
    return None


async def _body(request: Request) -> bytes:
    body = b""
    async for piece in request.stream():
        body += piece
        if len(body) > MAX_TABLE_BYTES:
            said = f"a table of labels may have {MAX_TABLE_BYTES} bytes: label a shorter part"
            raise HTTPException(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, said)
    return body


@contextmanager
def _told() -> Iterator[None]:
    """What is wrong with a recording or a table is the answer."""
    try:
        yield
    except AgentServerError as error:
        raise HTTPException(HTTPStatus.UNPROCESSABLE_ENTITY, str(error)) from error


def _table(recording: Recording) -> str:
    return format_label_table(recording.labels())


def _tag(table: str) -> str:
    return f'"{hashlib.sha256(table.encode()).hexdigest()[:32]}"'


def _answer(table: str) -> Response:
    return Response(table, media_type="text/csv", headers={"ETag": _tag(table)})


def _lines(recording: Recording, settings: Settings) -> Iterator[bytes]:
    until_ns = recording.summary.start_ns + LONGEST_NS
    lines: list[bytes] = []
    for message in _seen(recording, Perception(settings.window, settings.subject), until_ns):
        lines.append(msgspec.json.encode(message) + b"\n")
        if len(lines) == LINES_AT_ONCE:
            # Between pieces the server does other things.
            yield b"".join(lines)
            lines.clear()
    yield b"".join(lines)


def _seen(
    recording: Recording, perception: Perception, until_ns: int
) -> Iterator[m.PoseMessage | m.DecisionMessage]:
    """Poses and decisions up to a time, in the order of the file."""
    for record in recording.records((SKELETON.name, DECISION.name), end_ns=until_ns):
        if isinstance(record.message, m.DecisionMessage):
            yield record.message
            continue
        frame = from_record(record.message, record.stamp_ns)
        if not isinstance(frame, SkeletonFrame):
            continue
        before = perception.latest
        with suppress(InvalidInput):  # out of order: a live session passes over it too
            perception.push(frame)
        if perception.latest is not None and perception.latest is not before:
            yield pose_message(perception.latest)
