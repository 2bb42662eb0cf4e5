"""JPEG from anywhere: decoded as it was, or refused in words before it costs anything."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.errors import InvalidInput
from agent_server.face.image import decode_jpeg, jpeg_size, use_one_thread

law = settings(derandomize=True, deadline=None, max_examples=200)


def ramp(width, height):
    """Red grows to the right, green downwards; blue is constant."""
    red = np.broadcast_to(np.linspace(0, 255, width), (height, width))
    green = np.broadcast_to(np.linspace(0, 255, height)[:, None], (height, width))
    return np.stack((red, green, np.full_like(red, 60)), axis=2).astype(np.uint8)


def encoded(image, *options):
    """As JPEG; a grey image stays grey."""
    bgr = image if image.ndim == 2 else np.ascontiguousarray(image[..., ::-1])
    return cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, 95, *options])[1].tobytes()


def segments(data):
    """Offset of the first frame header of a JPEG, and the header."""
    at = data.index(b"\xff\xc0")
    return at, data[at : at + 2 + int.from_bytes(data[at + 2 : at + 4], "big")]


@pytest.mark.parametrize("progressive", [0, 1])
@pytest.mark.parametrize(("width", "height"), [(640, 480), (1280, 720), (720, 1280), (33, 47)])
def test_colours_and_places_survive(width, height, progressive):
    image = ramp(width, height)
    data = encoded(image, cv2.IMWRITE_JPEG_PROGRESSIVE, progressive)
    assert jpeg_size(data) == (width, height)
    decoded = decode_jpeg(data)
    assert decoded.dtype == np.uint8
    assert decoded.shape == (height, width, 3)
    assert np.abs(decoded.astype(int) - image).mean() < 4


def test_a_grey_image_has_three_equal_channels():
    decoded = decode_jpeg(encoded(ramp(64, 48)[..., 0]))
    assert decoded.shape == (48, 64, 3)
    assert (decoded == decoded[..., :1]).all()


def test_tables_may_stand_before_the_size():
    plain = encoded(ramp(64, 48))
    at, header = segments(plain)
    after = plain[at + len(header) :]
    assert after[:2] == b"\xff\xc4", "the tables of Huffman codes"
    end = after.index(b"\xff\xda")
    moved = plain[:at] + after[:end] + header + after[end:]
    assert jpeg_size(moved) == (64, 48)
    assert np.array_equal(decode_jpeg(moved), decode_jpeg(plain))


def test_a_note_on_orientation_is_not_followed():
    plain = encoded(ramp(64, 48))
    # Exif of one entry: orientation 6, a quarter turn.
    entry = b"\x12\x01\x03\x00\x01\x00\x00\x00\x06\x00\x00\x00"
    tiff = b"II*\x00\x08\x00\x00\x00\x01\x00" + entry + b"\x00\x00\x00\x00"
    body = b"Exif\x00\x00" + tiff
    turned = plain[:2] + b"\xff\xe1" + (len(body) + 2).to_bytes(2, "big") + body + plain[2:]
    followed = cv2.imdecode(np.frombuffer(turned, np.uint8), cv2.IMREAD_COLOR)
    assert followed is not None
    assert followed.shape == (64, 48, 3), "the note is one that OpenCV understands"
    assert np.array_equal(decode_jpeg(turned), decode_jpeg(plain))


@pytest.mark.parametrize(("width", "height"), [(1281, 720), (1280, 721), (721, 1280), (4000, 3000)])
def test_a_large_image_is_refused_by_its_size(width, height):
    with pytest.raises(InvalidInput, match=f"{width} x {height}.*640 x 480") as caught:
        decode_jpeg(encoded(np.zeros((height, width, 3), np.uint8)))
    assert caught.value.code == "image_too_large"
    assert caught.value.field == "jpeg"


def test_a_large_image_is_refused_before_it_is_decoded():
    data = encoded(ramp(64, 48))
    at, header = segments(data)
    claims = header[:5] + (60_000).to_bytes(2, "big") * 2 + header[9:]
    with pytest.raises(InvalidInput) as caught:
        decode_jpeg(data[:at] + claims)  # nothing follows that could be decoded
    assert caught.value.code == "image_too_large"


def test_a_size_cannot_be_hidden_behind_bytes_that_a_decoder_skips():
    large, small = encoded(np.zeros((800, 1400, 3), np.uint8)), encoded(ramp(64, 48))
    at, _ = segments(large)
    _, other = segments(small)
    rest = large[at:]
    length = (2 + len(rest)).to_bytes(2, "big")
    hidden = large[:at] + b"\xff\x00" + length + rest + other
    found = cv2.imdecode(np.frombuffer(hidden, np.uint8), cv2.IMREAD_COLOR)
    assert found is not None
    assert found.shape == (800, 1400, 3), "OpenCV takes the large one"
    with pytest.raises(InvalidInput) as caught:
        jpeg_size(hidden)
    assert caught.value.code == "bad_image"


def test_a_tiny_image_is_refused():
    with pytest.raises(InvalidInput, match="31 x 200") as caught:
        decode_jpeg(encoded(ramp(31, 200)))
    assert caught.value.code == "image_too_small"


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xd8",
        b"\xff\xd8\xff",
        b"no picture at all",
        b"\x89PNG\r\n\x1a\n" + bytes(64),
        b"\xff\xd8" + b"\xff" * 64,
        b"\xff\xd8\xff\xe0\x00\x00" + bytes(64),
        encoded(ramp(64, 48))[:200],
        encoded(ramp(64, 48))[:-200],
    ],
)
def test_what_is_no_whole_jpeg_is_refused(data):
    with pytest.raises(InvalidInput, match="send a whole JPEG") as caught:
        decode_jpeg(data)
    assert caught.value.code == "bad_image"


@law
@given(st.binary(max_size=400))
def test_bytes_are_an_image_or_refused(data):
    for head in (b"", b"\xff\xd8"):
        with pytest.raises(InvalidInput):
            decode_jpeg(head + data)


@law
@given(st.integers(0, 2**32 - 1))
def test_a_damaged_image_has_its_size_or_is_refused(seed):
    rng = np.random.default_rng(seed)
    data = bytearray(encoded(ramp(64, 48)))
    for at in rng.integers(2, len(data), rng.integers(1, 8)):
        data[at] = rng.integers(256)
    try:
        size = jpeg_size(bytes(data))
        decoded = decode_jpeg(bytes(data))
    except InvalidInput as error:
        assert error.code in {"bad_image", "image_too_large", "image_too_small"}
    else:
        assert decoded.shape == (size[1], size[0], 3)


def test_opencv_keeps_to_one_thread():
    before = cv2.getNumThreads()
    try:
        use_one_thread()
        assert cv2.getNumThreads() == 1
    finally:
        cv2.setNumThreads(before)
