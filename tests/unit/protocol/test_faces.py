"""Faces on the wire: what is taken, what is refused, and why."""

import msgspec
import numpy as np
import pytest

from agent_server.domain.affect import Calibration
from agent_server.domain.face import ARKIT_BLENDSHAPES, FaceBlendshapes, FaceLandmarks, FaceLayout
from agent_server.errors import InvalidInput
from agent_server.protocol import faces
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS, IMAGE_HEADER
from agent_server.protocol.inputs import packed

JSON, MSGPACK = CODECS[m.SUBPROTOCOL_JSON], CODECS[m.SUBPROTOCOL_MSGPACK]


def points(layout="mesh478", seed=1):
    layout = FaceLayout(layout)
    rng = np.random.default_rng(seed)
    values = rng.uniform(100, 300, (layout.points, layout.axes))
    if layout.axes == 3:
        values[:, 2] -= 200
    return m.FacePoints(5, layout.value, 640, 480, values.tolist())


def shapes(**changes):
    values = dict.fromkeys(ARKIT_BLENDSHAPES, 0.25)
    return m.Blendshapes(7, {**values, **changes})


def refusal(take, message):
    with pytest.raises(InvalidInput) as caught:
        take(message)
    return caught.value


@pytest.mark.parametrize("layout", ["mesh478", "mesh468", "dlib68"])
@pytest.mark.parametrize("codec", [JSON, MSGPACK])
def test_points_are_the_same_by_both_codings_and_back(layout, codec):
    message = points(layout)
    sent = codec.encode(packed(message) if codec is MSGPACK else message)
    face = faces.landmarks_from_message(codec.decode_client(sent))
    assert face.points.shape == (FaceLayout(layout).points, FaceLayout(layout).axes)
    assert not face.points.flags.writeable
    # A sixteenth of a pixel, exactly.
    assert np.array_equal(face.points * 16, np.round(face.points * 16))
    assert np.abs(face.points - np.array(message.points)).max() <= 1 / 32 + 1e-4
    again = faces.landmarks_from_message(faces.face_to_message(face))
    assert np.array_equal(again.points, face.points)
    assert (again.width, again.height, again.layout) == (640, 480, layout)


def changed(message, index, point):
    rows = [list(row) for row in message.points]
    rows[index] = point
    return msgspec.structs.replace(message, points=rows)


@pytest.mark.parametrize(
    ("message", "field", "code"),
    [
        (msgspec.structs.replace(points(), format="mesh468"), "points", "wrong_point_count"),
        (changed(points(), 3, [1.0, 2.0]), "points[3]", "wrong_point_size"),
        (changed(points(), 3, [1.0, float("nan"), 2.0]), "points[3][1]", "not_finite"),
        (changed(points(), 4, [float("inf"), 1.0, 2.0]), "points[4][0]", "not_finite"),
        (changed(points(), 9, [1.0, 2000.0, 2.0]), "points[9][1]", "out_of_range"),
        (changed(points("dlib68"), 67, [-700.0, 2.0]), "points[67][0]", "out_of_range"),
        (
            msgspec.structs.replace(
                points("dlib68"), points=(np.random.default_rng(0).random((68, 2))).tolist()
            ),
            "points",
            "face_too_small",
        ),
    ],
)
def test_bad_points_are_refused_by_name(message, field, code):
    error = refusal(faces.landmarks_from_message, message)
    assert (error.field, error.code) == (field, code)


def test_packed_points_of_the_wrong_length_are_refused():
    message = packed(points())
    error = refusal(
        faces.landmarks_from_message, msgspec.structs.replace(message, points=message.points[:-4])
    )
    assert error.code == "wrong_point_count"


def test_blendshapes_keep_arkits_order_whatever_the_order_and_case_of_names():
    values = {name: index / 100 for index, name in enumerate(ARKIT_BLENDSHAPES)}
    capital = {name[0].upper() + name[1:]: value for name, value in reversed(values.items())}
    # Live Link Face adds the rotations of head and eyes.
    capital |= {"HeadYaw": -0.4, "LeftEyePitch": 1.7}
    face = faces.blendshapes_from_message(m.Blendshapes(3, capital))
    assert np.allclose(face.values, list(values.values()), atol=1e-6)
    assert faces.face_to_message(face).values == pytest.approx(values, abs=1e-6)


def test_the_tongue_may_be_left_out_and_nothing_else():
    values = dict(shapes().values)
    del values["tongueOut"]
    assert faces.blendshapes_from_message(m.Blendshapes(0, values)).values[-1] == 0
    del values["jawOpen"]
    error = refusal(faces.blendshapes_from_message, m.Blendshapes(0, values))
    assert error.code == "missing_blendshape"
    assert "jawOpen" in str(error)


@pytest.mark.parametrize(
    ("message", "field", "code"),
    [
        (shapes(jawOpened=0.1), "values.jawOpened", "unknown_blendshape"),
        (shapes(jawOpen=1.01), "values.jawOpen", "out_of_range"),
        (shapes(jawOpen=float("nan")), "values.jawOpen", "out_of_range"),
    ],
)
def test_bad_blendshapes_are_refused_by_name(message, field, code):
    error = refusal(faces.blendshapes_from_message, message)
    assert (error.field, error.code) == (field, code)


def test_a_gaze_is_given_unit_length():
    gaze = faces.gaze_from_message(m.Gaze(2, (0.0, 1.0, 2.0), (0.0, 0.0, -4.0)))
    assert gaze.direction == (0.0, 0.0, -1.0)
    error = refusal(faces.gaze_from_message, m.Gaze(2, (0.0, 1.0, 2.0), (0.0, 0.0, 0.0)))
    assert (error.field, error.code) == ("direction", "out_of_range")
    error = refusal(faces.gaze_from_message, m.Gaze(2, (0.0, float("inf"), 2.0), (0.0, 0.0, 1.0)))
    assert (error.field, error.code) == ("origin", "not_finite")


def test_a_calibration_has_a_time_or_a_result_and_not_both():
    assert faces.calibration_from_message(m.Calibrate(1, 3.0)) == Calibration(1, 3.0, None)
    known = m.Calibrate(1, None, -1.0, 0.5)
    assert faces.calibration_from_message(known) == Calibration(1, None, (-1.0, 0.5))
    assert faces.calibration_to_message(Calibration(1, None, (-1.0, 0.5))) == known
    for wrong in (m.Calibrate(1), m.Calibrate(1, 3.0, 1.0, 1.0), m.Calibrate(1, None, 1.0)):
        assert refusal(faces.calibration_from_message, wrong).field == "seconds"


@pytest.mark.parametrize("codec", [JSON, MSGPACK])
def test_an_image_goes_through_both_codings(codec):
    image = m.Image(2**52 + 1, b"\xff\xd8 not much of a JPEG")
    sent = codec.encode(image)
    assert isinstance(sent, bytes)
    assert codec.decode_client(sent) == image


def test_the_layout_of_an_image_frame_is_what_the_protocol_says():
    sent = JSON.encode(m.Image(0x0102030405, b"jpeg"))
    assert sent == b"AFJ1" + bytes(4) + bytes([5, 4, 3, 2, 1, 0, 0, 0]) + b"jpeg"


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"\x00\x01", "wrong_coding"),
        (b"AFJ1", "malformed"),
        (IMAGE_HEADER.pack(b"AFJ1", 0, 5), "malformed"),
        (IMAGE_HEADER.pack(b"AFJ1", 2, 5) + b"x", "invalid_field"),
        (IMAGE_HEADER.pack(b"AFJ1", 0, -5) + b"x", "out_of_range"),
    ],
)
def test_a_binary_frame_that_is_no_image_is_refused(data, code):
    assert refusal(JSON.decode_client, data).code == code


def test_a_face_is_a_frozen_value():
    face = faces.face_from_message(shapes())
    assert isinstance(face, FaceBlendshapes)
    assert not face.values.flags.writeable
    assert isinstance(faces.face_from_message(points()), FaceLandmarks)
