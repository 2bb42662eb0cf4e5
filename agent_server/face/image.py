"""Images of a camera: from JPEG to pixels."""

import cv2
import numpy as np
from numpy.typing import NDArray

from agent_server.errors import InvalidInput

Pixels = NDArray[np.uint8]
"""Shape (height, width, 3), RGB."""

MAX_WIDTH, MAX_HEIGHT = 1280, 720
MIN_SIDE = 32
_START = b"\xff\xd8"
# Markers of a frame header: SOF0 to SOF15 without DHT, JPG and DAC.
_FRAME_HEADERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_WITHOUT_LENGTH = frozenset({0x01, *range(0xD0, 0xD9)})


def use_one_thread() -> None:
    """Keep OpenCV to the thread that calls it, in the whole process.

    Crops are small: other threads would only take the cores that the models need. Whoever owns
    the thread that looks at images calls this once.
    """
    cv2.setNumThreads(1)


def decode_jpeg(data: bytes) -> Pixels:
    """Decode a JPEG of at most 1280 x 720, in either orientation.

    Raises:
        InvalidInput: If it is no JPEG, is damaged, or has another size; a large one is refused
            before it is decoded.
    """
    width, height = jpeg_size(data)
    longer, shorter = max(width, height), min(width, height)
    if longer > MAX_WIDTH or shorter > MAX_HEIGHT:
        raise InvalidInput(
            f"the image has {width} x {height} pixels, at most {MAX_WIDTH} x {MAX_HEIGHT} are "
            "taken: send a smaller one, 640 x 480 is plenty",
            field="jpeg",
            code="image_too_large",
        )
    if shorter < MIN_SIDE:
        raise InvalidInput(
            f"the image has {width} x {height} pixels: no face can be seen in it",
            field="jpeg",
            code="image_too_small",
        )
    # What a camera sends is upright, so a note on its orientation is not followed.
    flags = cv2.IMREAD_COLOR_RGB | cv2.IMREAD_IGNORE_ORIENTATION
    image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    if image is None or image.shape != (height, width, 3):
        raise _bad("it is damaged")
    return image.astype(np.uint8, copy=False)


def jpeg_size(data: bytes) -> tuple[int, int]:
    """Width and height of a JPEG, from its header alone.

    Raises:
        InvalidInput: If there is no such header.
    """
    if not data.startswith(_START):
        raise _bad("it does not begin as a JPEG does")
    at = len(_START)
    while at + 9 <= len(data):
        marker = data[at + 1]
        # Behind such bytes a decoder searches on, and might find another size than is seen here.
        if data[at] != 0xFF or marker == 0x00:
            break
        if marker == 0xFF:
            at += 1
        elif marker in _WITHOUT_LENGTH:
            at += 2
        elif marker in _FRAME_HEADERS:
            height = int.from_bytes(data[at + 5 : at + 7], "big")
            width = int.from_bytes(data[at + 7 : at + 9], "big")
            return width, height
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    raise _bad("its header is damaged")


def _bad(why: str) -> InvalidInput:
    return InvalidInput(
        f"the image cannot be read: {why}; send a whole JPEG", field="jpeg", code="bad_image"
    )
