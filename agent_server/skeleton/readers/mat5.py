"""Numeric arrays of MATLAB level 5 MAT-files.

The format is MathWorks' "MAT-File Format", level 5: a 128-byte header, then elements of a
type, a length and data padded to 8 bytes; each variable is one element, mostly compressed.
Text, cells, structs, objects, sparse and complex arrays are left out.
"""

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import read_bytes

_HEADER_BYTES = 128
_MATRIX = 14
_COMPRESSED = 15
_COMPLEX_FLAG = 0x08

_STORED = {
    1: "i1",
    2: "u1",
    3: "i2",
    4: "u2",
    5: "i4",
    6: "u4",
    7: "f4",
    9: "f8",
    12: "i8",
    13: "u8",
}
"""Type of an element -> how its numbers are stored. A writer stores integers as small as fits."""

_CLASSES = {
    6: "f8",
    7: "f4",
    8: "i1",
    9: "u1",
    10: "i2",
    11: "u2",
    12: "i4",
    13: "u4",
    14: "i8",
    15: "u8",
}
"""Class of a matrix -> what its numbers are."""


def read_mat5(path: Path) -> dict[str, NDArray[np.generic]]:
    """All real numeric arrays of a MAT-file.

    Returns:
        Name of a variable -> array of the shape and number type that it has in MATLAB.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If it is no level 5 MAT-file or is damaged.
    """
    data = read_bytes(path)
    order = {b"IM": "<", b"MI": ">"}.get(data[126:_HEADER_BYTES])
    if order is None:
        raise InvalidInput(
            f"{path} is no MAT-file of level 5 (saved with -v6 or -v7): save it again with -v7",
            code="not_mat5",
        )
    try:
        return dict(_variables(data[_HEADER_BYTES:], order))
    except (struct.error, zlib.error, ValueError, KeyError, IndexError) as error:
        raise InvalidInput(f"{path} is damaged: {error!r}", code="damaged") from error


def _variables(data: bytes, order: str) -> Iterator[tuple[str, NDArray[np.generic]]]:
    for kind, content in _elements(data, order):
        if kind == _COMPRESSED:
            yield from _variables(zlib.decompress(content), order)
        elif kind == _MATRIX:
            variable = _matrix(content, order)
            if variable is not None:
                yield variable


def _elements(data: bytes, order: str) -> Iterator[tuple[int, bytes]]:
    """(type, content) of every element in ``data``."""
    at = 0
    while at < len(data):
        kind, size = struct.unpack_from(f"{order}2I", data, at)
        start = at + 8
        if kind >> 16:  # an element of up to 4 bytes shares its 8 bytes with its tag
            kind, size, start = kind & 0xFFFF, kind >> 16, at + 4
            at += 8
        else:
            at = start + size + (0 if kind == _COMPRESSED else -size % 8)
        if start + size > len(data):
            raise ValueError(f"an element of {size} bytes ends after its container")
        yield kind, data[start : start + size]


def _matrix(content: bytes, order: str) -> tuple[str, NDArray[np.generic]] | None:
    elements = _elements(content, order)
    flags = struct.unpack_from(f"{order}I", next(elements)[1])[0]
    if flags & 0xFF not in _CLASSES or (flags >> 8) & _COMPLEX_FLAG:
        return None
    shape = np.frombuffer(next(elements)[1], f"{order}i4")
    name = next(elements)[1].decode("ascii")
    kind, numbers = next(elements)
    stored = np.frombuffer(numbers, order + _STORED[kind])
    array = stored.astype(_CLASSES[flags & 0xFF])
    return name, array.reshape(tuple(int(n) for n in shape), order="F")
