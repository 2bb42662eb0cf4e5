"""Small source files, written as the data sets' own tools write them."""

import struct
import zlib
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

Mat5 = Callable[..., bytes]

_STORED = {"f8": 9, "f4": 7, "u1": 2, "i2": 3, "i4": 5}
_CLASSES = {"f8": 6, "f4": 7, "u1": 9, "i2": 10, "i4": 12}


@pytest.fixture
def mat5() -> Mat5:
    """Bytes of a MAT-file of level 5 with one variable."""
    return _mat5


def _mat5(
    name: str,
    array: NDArray[np.generic],
    *,
    order: str = "<",
    packed: bool = True,
    stored: str = "",
) -> bytes:
    def element(kind: int, content: bytes) -> bytes:
        if 0 < len(content) <= 4:
            return struct.pack(f"{order}I", len(content) << 16 | kind) + content.ljust(4, b"\0")
        return struct.pack(f"{order}2I", kind, len(content)) + content + b"\0" * (-len(content) % 8)

    kind = array.dtype.str[1:]
    numbers = array.astype(order + (stored or kind)).tobytes(order="F")
    body = (
        element(6, struct.pack(f"{order}2I", _CLASSES[kind], 0))
        + element(5, np.array(array.shape, dtype=f"{order}i4").tobytes())
        + element(1, name.encode())
        + element(_STORED[stored or kind], numbers)
    )
    variable = struct.pack(f"{order}2I", 14, len(body)) + body
    if packed:
        content = zlib.compress(variable)
        variable = struct.pack(f"{order}2I", 15, len(content)) + content
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack(f"{order}H", 0x0100)
    return header + (b"IM" if order == "<" else b"MI") + variable
