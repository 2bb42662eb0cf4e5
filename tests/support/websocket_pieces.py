"""The bytes of a websocket connection, cut into what belongs together.

Just enough of RFC 6455 to aim at a message: heads of the upgrade, frames, masks, and the `type` of
a message in either coding. Messages are taken to be of one frame each, as all clients send them.
"""

import re
from dataclasses import dataclass
from enum import StrEnum

_JSON_TYPE = re.compile(rb'"type"\s*:\s*"(\w+)"')
_PACKED_TYPE = re.compile(rb"\xa4type[\xa1-\xbf](\w+)")
_HEAD_END = b"\r\n\r\n"
_CONTROL = {0x8: "close", 0x9: "ws_ping", 0xA: "ws_pong"}
_DATA = (0x1, 0x2)
_MASK_BYTES = 4


class Form(StrEnum):
    """What a piece is."""

    HEAD = "head"
    DATA = "data"
    CONTROL = "control"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class Piece:
    """Bytes that belong together.

    Attributes:
        raw: As they came.
        form: What they are.
        type: The message's `type`, or the name of a control frame; empty if there is none.
        code: A close frame's code, or None.
    """

    raw: bytes
    form: Form
    type: str = ""
    code: int | None = None


class Pieces:
    """Cuts one direction of a connection into pieces; all bytes come out, in order."""

    def __init__(self):
        self._rest = b""
        self._cut = self._head

    def push(self, data):
        """Take bytes and give the pieces that are whole now."""
        self._rest += data
        found = []
        while self._rest and (piece := self._cut()) is not None:
            self._rest = self._rest[len(piece.raw) :]
            found.append(piece)
        return found

    def flush(self):
        """What is left when the connection ends."""
        rest, self._rest = self._rest, b""
        return rest

    def _head(self):
        end = self._rest.find(_HEAD_END)
        if end < 0:
            return None
        raw = self._rest[: end + len(_HEAD_END)]
        first = raw.split(b"\r\n", 1)[0]
        is_upgrade = first.startswith(b"GET ") or b" 101 " in first
        self._cut = self._frame if is_upgrade else self._other
        return Piece(raw, Form.HEAD)

    def _other(self):
        return Piece(self._rest, Form.OTHER)

    def _frame(self):
        data = self._rest
        if len(data) < 2:
            return None
        opcode, is_masked, short = data[0] & 0x0F, data[1] & 0x80, data[1] & 0x7F
        extra = {126: 2, 127: 8}.get(short, 0)
        at = 2 + extra
        length = int.from_bytes(data[2:at], "big") if extra else short
        begin = at + (_MASK_BYTES if is_masked else 0)
        if len(data) < begin + length:
            return None
        raw = data[: begin + length]
        payload = raw[begin:]
        if is_masked:
            payload = _unmasked(payload, raw[at:begin])
        if opcode in _DATA:
            return Piece(raw, Form.DATA, message_type(payload))
        code = int.from_bytes(payload[:2], "big") if opcode == 0x8 and len(payload) >= 2 else None
        return Piece(raw, Form.CONTROL, _CONTROL.get(opcode, ""), code)


def message_type(payload):
    """The `type` of a message in JSON or MessagePack; empty if it has none."""
    found = _JSON_TYPE.search(payload) or _PACKED_TYPE.search(payload)
    return found[1].decode() if found else ""


def _unmasked(payload, mask):
    repeated = mask * (len(payload) // _MASK_BYTES + 1)
    size = len(payload)
    number = int.from_bytes(payload, "big") ^ int.from_bytes(repeated[:size], "big")
    return number.to_bytes(size, "big")
