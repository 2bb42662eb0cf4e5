"""Both codings: round trips, and errors that name the field."""

import math
import struct

import pytest

from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.convert import (
    pack_pose_stream,
    pack_skeleton,
    skeleton_from_message,
    skeleton_to_message,
    unpack_pose_stream,
)
from tests.support.bodies import frame

JSON = CODECS[m.SUBPROTOCOL_JSON]
MSGPACK = CODECS[m.SUBPROTOCOL_MSGPACK]

CLIENT = [
    m.Hello("1.0", "tester", face="none", take_over=True, topics=["decision"]),
    m.Ping(12),
    m.Pong(12, 2**53 - 1),
    m.Affect(5, -6.5, 10.0),
    m.AckMessage("s/c1", "failed", 2, "the door is stuck"),
    m.SceneEvent("window", "open"),
]
SERVER = [
    m.ErrorMessage("full", "no more", None, True),
    m.SceneState("working", {"window": "open"}),
    m.CommandMessage("s/c1", 1, "e", "greet", "hello", [m.StepMessage("wave", 1.5)], 5, 1, 2, 3),
    m.PoseMessage(1, 0, [(0.0, 1.0, 2.0, 1.0)]),
    m.ForecastMessage(3, 4, "x", [[(0.0, 0.5, 1.0)]]),
    m.StatsMessage(1, 2, 3, 4, 5, 6, 7, 8, {"gaps": 1}),
]


@pytest.mark.parametrize("codec", [JSON, MSGPACK], ids=["json", "msgpack"])
@pytest.mark.parametrize("message", CLIENT, ids=lambda message: type(message).__name__)
def test_client_messages_come_back_as_they_went(codec, message):
    assert codec.decode_client(codec.encode(message)) == message


@pytest.mark.parametrize("codec", [JSON, MSGPACK], ids=["json", "msgpack"])
@pytest.mark.parametrize("message", SERVER, ids=lambda message: type(message).__name__)
def test_server_messages_come_back_as_they_went(codec, message):
    assert codec.decode_server(codec.encode(message)) == message


def test_a_skeleton_has_the_same_bits_in_both_codings():
    sent = skeleton_to_message(frame(7, shift=(0.12345678, -0.3, 0.77777)))
    over_json = skeleton_from_message(JSON.decode_client(JSON.encode(sent)))
    over_msgpack = skeleton_from_message(MSGPACK.decode_client(MSGPACK.encode(pack_skeleton(sent))))
    assert over_json.joints.tobytes() == over_msgpack.joints.tobytes()
    assert over_json.originating_ns == over_msgpack.originating_ns == 7 * 33_333_333
    assert not over_json.joints.flags.writeable


def test_unknown_fields_are_ignored():
    assert JSON.decode_client('{"type":"ping","sent_ns":1,"colour":"red"}') == m.Ping(1)


@pytest.mark.parametrize(
    ("text", "field", "code"),
    [
        ('{"type":"affect","originating_ns":1,"valence":11,"arousal":0}', "valence", None),
        ('{"type":"affect","originating_ns":-1,"valence":1,"arousal":0}', "originating_ns", None),
        ('{"type":"affect","originating_ns":1.5,"valence":1,"arousal":0}', "originating_ns", None),
        ('{"type":"affect","originating_ns":1,"valence":1}', None, "invalid_field"),
        ('{"type":"dance"}', "type", "unknown_type"),
        ('{"type":"affect","originating_ns":1,"valence":NaN,"arousal":0}', None, "malformed"),
        ("not json", None, "malformed"),
        ("[" * 100_000, None, None),
        ('{"type":"hello","protocol":"one","client":"x"}', "protocol", None),
        ('{"type":"hello","protocol":"%s.0","client":"x"}' % ("9" * 5000), "protocol", None),
        ('{"type":"hello","protocol":"\u0661.0","client":"x"}', "protocol", None),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_field(text, field, code):
    with pytest.raises(InvalidInput) as refused:
        JSON.decode_client(text)
    if field:
        assert refused.value.field == field
    if code:
        assert refused.value.code == code


def test_the_wrong_kind_of_frame_is_refused():
    with pytest.raises(InvalidInput, match="text"):
        JSON.decode_client(b"{}")
    with pytest.raises(InvalidInput, match="binary"):
        MSGPACK.decode_client("{}")


def test_a_stretch_of_motion_is_the_same_packed_and_unpacked():
    points = [[(0.1, 1.4987, -0.03), (0.25, 0.9, 1.0)], [(0.1, 1.5, 0.0), (0.2, 0.9, -1.0)]]
    stretch = m.PoseStreamMessage("lab/c4", 5, 25.0, ["head", "neck"], points, fallback="too fast")
    assert unpack_pose_stream(pack_pose_stream(stretch)) == stretch


@pytest.mark.parametrize(("joints", "size"), [(["head", "neck"], 36), (["head"], 10), ([], 12)])
def test_a_stretch_of_motion_with_half_a_frame_is_refused(joints, size):
    stretch = m.PackedPoseStreamMessage("lab/c4", 0, 25.0, joints, bytes(size))
    with pytest.raises(InvalidInput, match=f"positions has {size} bytes") as raised:
        unpack_pose_stream(stretch)
    assert raised.value.field == "positions"


def packed(joints, name="core9"):
    return m.PackedSkeleton(1, 0, name, struct.pack(f"<{len(joints)}f", *joints))


GOOD = [0.0, 0.5, 2.0, 1.0] * 9


@pytest.mark.parametrize(
    ("message", "field", "code"),
    [
        (packed(GOOD[:-4]), "joints", "wrong_joint_count"),
        (packed([*GOOD[:4], math.nan, *GOOD[5:]]), "joints[1][0]", "not_finite"),
        (packed([*GOOD[:6], math.inf, *GOOD[7:]]), "joints[1][2]", "not_finite"),
        (packed([*GOOD[:8], 51.0, *GOOD[9:]]), "joints[2][0]", "out_of_range"),
        (packed([*GOOD[:11], 1.5, *GOOD[12:]]), "joints[2][3]", "out_of_range"),
        (packed([*GOOD[:11], -0.5, *GOOD[12:]]), "joints[2][3]", "out_of_range"),
        (packed(GOOD, "kinect_v9"), "format", "unknown_format"),
        (m.Skeleton(1, 0, "kinect_v2", [(0.0, 0.0, 0.0, 1.0)]), "joints", "wrong_joint_count"),
    ],
)
def test_a_skeleton_that_cannot_be_true_is_refused(message, field, code):
    with pytest.raises(InvalidInput) as refused:
        skeleton_from_message(message)
    assert (refused.value.field, refused.value.code) == (field, code)


def test_a_body_at_the_far_end_of_the_range_is_no_mistake():
    far = packed([0.0, 0.5, 49.0, 1.0] * 9)
    assert skeleton_from_message(far).joints[8, 2] == 49.0


def test_millimetres_may_be_larger_than_metres():
    joints = [0.0, 500.0, 2000.0, 1.0] * 32
    assert skeleton_from_message(packed(joints, "azure_kinect")).joints[0, 2] == 2000.0
