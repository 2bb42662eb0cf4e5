"""A websocket client that sends what no library would."""

import asyncio
import base64
import os
import struct


class RawSocket:
    """One connection; frames go out as they are told, and what comes is read and sorted roughly."""

    def __init__(self, reader, writer):
        self._reader = reader
        self.writer = writer
        self.close_code = None

    @classmethod
    async def open(cls, port, path, subprotocol):
        reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=2**22)
        key = base64.b64encode(os.urandom(16)).decode()
        writer.write(
            (
                f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {subprotocol}\r\n\r\n"
            ).encode()
        )
        head = await reader.readuntil(b"\r\n\r\n")
        assert b" 101 " in head, head
        return cls(reader, writer)

    def send(self, payload, *, is_text):
        self.writer.write(frame(payload, 1 if is_text else 2))

    async def receive(self):
        """Opcode and payload of the next frame; None at the end."""
        try:
            first, short = await self._reader.readexactly(2)
            size = short & 0x7F
            if size == 126:
                (size,) = struct.unpack("!H", await self._reader.readexactly(2))
            elif size == 127:
                (size,) = struct.unpack("!Q", await self._reader.readexactly(8))
            payload = await self._reader.readexactly(size)
        except (asyncio.IncompleteReadError, ConnectionError):
            return None
        if first & 0x0F == 8:
            self.close_code = int.from_bytes(payload[:2], "big")
        return first & 0x0F, payload

    def abort(self):
        self.writer.transport.abort()


def frame(payload, opcode):
    """A frame whose mask is zero, so that the payload goes out as it is."""
    size = len(payload)
    if size < 126:
        head = bytes((0x80 | opcode, 0x80 | size))
    elif size < 2**16:
        head = bytes((0x80 | opcode, 0x80 | 126)) + size.to_bytes(2, "big")
    else:
        head = bytes((0x80 | opcode, 0x80 | 127)) + size.to_bytes(8, "big")
    return head + bytes(4) + payload
