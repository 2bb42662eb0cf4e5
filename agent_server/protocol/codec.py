"""The two codings of a message: JSON text and MessagePack bytes.

An image is the one message that is binary in the JSON coding: a short header and the JPEG.
"""

import struct
from typing import Any, Protocol

import msgspec

from agent_server.domain.stamp import MAX_STAMP_NS
from agent_server.errors import InvalidInput
from agent_server.protocol.convert import pack_pose_stream
from agent_server.protocol.messages import (
    SUBPROTOCOL_JSON,
    SUBPROTOCOL_MSGPACK,
    ClientMessage,
    Image,
    Message,
    PackedClientMessage,
    PackedServerMessage,
    PoseStreamMessage,
    ServerMessage,
)

Wire = str | bytes

IMAGE_MAGIC = b"AFJ1"
IMAGE_HEADER = struct.Struct("<4sIq")
"""Magic, flags (none is defined: 0), originating_ns; little-endian. The JPEG follows."""


class Codec(Protocol):
    """Turns messages into what a websocket carries, and back."""

    @property
    def subprotocol(self) -> str:
        """Name of the websocket subprotocol."""
        ...

    def encode(self, message: Message) -> Wire:
        """Encode one message."""
        ...

    def decode_client(self, data: Wire) -> Message:
        """Decode what a client sent.

        Raises:
            InvalidInput: With the field and what was expected.
        """
        ...

    def decode_server(self, data: Wire) -> Message:
        """Decode what a server sent.

        Raises:
            InvalidInput: With the field and what was expected.
        """
        ...


class JsonCodec:
    """Text messages, and images as binary ones."""

    subprotocol = SUBPROTOCOL_JSON

    def __init__(self) -> None:
        self._encoder = msgspec.json.Encoder()
        self._client = msgspec.json.Decoder(ClientMessage)
        self._server = msgspec.json.Decoder(ServerMessage)

    def encode(self, message: Message) -> Wire:
        """One message as JSON text, an image as bytes."""
        if isinstance(message, Image):
            return IMAGE_HEADER.pack(IMAGE_MAGIC, 0, message.originating_ns) + message.jpeg
        return self._encoder.encode(message).decode()

    def decode_client(self, data: Wire) -> Message:
        """Decode what a client sent."""
        return _image(data) if isinstance(data, bytes) else _decoded(self._client, data)

    def decode_server(self, data: Wire) -> Message:
        """Decode what a server sent."""
        return _decoded(self._server, data)


class MsgpackCodec:
    """Binary messages, with joints as packed float32."""

    subprotocol = SUBPROTOCOL_MSGPACK

    def __init__(self) -> None:
        self._encoder = msgspec.msgpack.Encoder()
        self._client = msgspec.msgpack.Decoder(PackedClientMessage)
        self._server = msgspec.msgpack.Decoder(PackedServerMessage)

    def encode(self, message: Message) -> bytes:
        """One message as MessagePack, the positions of a motion packed."""
        if isinstance(message, PoseStreamMessage):
            message = pack_pose_stream(message)
        return self._encoder.encode(message)

    def decode_client(self, data: Wire) -> Message:
        """Decode what a client sent."""
        if isinstance(data, str):
            raise InvalidInput(
                f"this connection speaks {SUBPROTOCOL_MSGPACK}, whose messages are binary; got "
                f"{len(data)} characters of text",
                code="wrong_coding",
            )
        return _decoded(self._client, data)

    def decode_server(self, data: Wire) -> Message:
        """Decode what a server sent."""
        return _decoded(self._server, data)


def _image(data: bytes) -> Image:
    if not data.startswith(IMAGE_MAGIC):
        raise InvalidInput(
            f"this connection speaks {SUBPROTOCOL_JSON}, whose messages are text; got "
            f"{len(data)} bytes of binary without the {IMAGE_MAGIC.decode()} of an image",
            code="wrong_coding",
        )
    if len(data) <= IMAGE_HEADER.size:
        raise InvalidInput(
            f"the image has {len(data)} bytes: send {IMAGE_HEADER.size} of header and the JPEG",
            code="malformed",
        )
    _, flags, originating_ns = IMAGE_HEADER.unpack_from(data)
    if flags != 0:
        raise InvalidInput(
            f"flags is {flags}, and none is defined: send 0", field="flags", code="invalid_field"
        )
    if not 0 <= originating_ns <= MAX_STAMP_NS:
        raise InvalidInput(
            f"originating_ns is {originating_ns}: send nanoseconds in 0..{MAX_STAMP_NS}",
            field="originating_ns",
            code="out_of_range",
        )
    return Image(originating_ns, data[IMAGE_HEADER.size :])


CODECS: dict[str, Codec] = {codec.subprotocol: codec for codec in (JsonCodec(), MsgpackCodec())}
"""Every coding, by the name of its websocket subprotocol."""


class _Decoder(Protocol):
    def decode(self, data: Any, /) -> Any: ...


def _decoded(decoder: _Decoder, data: Wire) -> Message:
    try:
        message: Message = decoder.decode(data)
    except msgspec.ValidationError as error:
        sentence, _, path = str(error).partition(" - at `")
        field = path.rstrip("`").removeprefix("$").removeprefix(".") or None
        code = "unknown_type" if field == "type" else "invalid_field"
        raise InvalidInput(sentence, field=field, code=code) from None
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InvalidInput(f"the message cannot be read: {error}", code="malformed") from None
    return message
