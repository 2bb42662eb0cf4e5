"""What an avatar program receives, over a real socket and read by python-osc."""

import logging
import socket

import numpy as np
import pytest
from pythonosc.osc_bundle import OscBundle

from agent_server.config import VmcSettings
from agent_server.domain.face import ARKIT_BLENDSHAPES, FaceBlendshapes, FaceLandmarks, FaceLayout
from agent_server.domain.motion import FRAME_NS, Forecast
from agent_server.domain.skeleton import CoreFrame, CoreJoint
from agent_server.errors import ConfigError
from agent_server.service.avatar import NoAvatar
from agent_server.service.vmc import MAX_DATAGRAM_BYTES, Performer, VmcSender, open_avatar
from tests.support.bodies import core_joints

S = 1_000_000_000
R = np.sqrt(0.5)
STILL = core_joints()[:, :3]


def right_hand_up():
    """Both arms straight, the left one out, the right one up; facing the sensor."""
    pose = STILL.copy()
    for joint, position in {
        CoreJoint.LEFT_ELBOW: (-0.48, 0.3, 2.0),
        CoreJoint.LEFT_WRIST: (-0.73, 0.3, 2.0),
        CoreJoint.RIGHT_ELBOW: (0.18, 0.6, 2.0),
        CoreJoint.RIGHT_WRIST: (0.18, 0.85, 2.0),
    }.items():
        pose[joint] = position
    return pose


def frame(stamp_ns=0, positions=STILL):
    return CoreFrame(stamp_ns, 1, positions, np.ones(9, np.float32))


def read(datagrams):
    """Messages of some datagrams as (address, arguments)."""
    return [
        (message.address, message.params)
        for datagram in datagrams
        for message in OscBundle(datagram)
    ]


def bones(datagrams):
    """Rotation of each bone by its name."""
    return {
        arguments[0]: arguments[4:]
        for address, arguments in read(datagrams)
        if address == "/VMC/Ext/Bone/Pos"
    }


def blend(**values):
    """A face that shows nothing but what is named."""
    return FaceBlendshapes(0, np.float32([values.get(name, 0.0) for name in ARKIT_BLENDSHAPES]))


@pytest.fixture
def program():
    """The socket of an avatar program."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(5)
        yield receiver


@pytest.fixture
def avatar(program):
    sender = open_avatar(VmcSettings(enabled=True, port=program.getsockname()[1]))
    yield sender
    sender.close()


def test_a_body_with_the_right_hand_up_arrives(program, avatar):
    avatar.show_body("a", frame(7 * S))
    program.recv(65536)
    avatar.show_body("a", frame(9 * S + S // 2, right_hand_up()))
    datagram = program.recv(65536)
    messages = read([datagram])
    assert messages[:3] == [
        ("/VMC/Ext/OK", [1]),
        ("/VMC/Ext/T", [2.5]),
        ("/VMC/Ext/Root/Pos", ["root", 0, 0, 0, 0, 0, 0, 1]),
    ]
    assert [arguments[0] for _, arguments in messages[3:]] == [
        *("Hips", "Spine", "Chest", "Neck", "Head"),
        *("LeftShoulder", "LeftUpperArm", "LeftLowerArm"),
        *("RightShoulder", "RightUpperArm", "RightLowerArm"),
    ]
    found = bones([datagram])
    # Unity: from +x, its right, to +y is a quarter turn about z.
    assert found.pop("RightUpperArm") == pytest.approx((0, 0, R, R), abs=1e-6)
    for name, rotation in found.items():
        assert rotation == pytest.approx((0, 0, 0, 1), abs=1e-6), name


def test_positions_are_those_of_the_resting_skeleton():
    before, after = (
        [arguments[:4] for address, arguments in read(sent) if address == "/VMC/Ext/Bone/Pos"]
        for performer in [Performer(VmcSettings())]
        for sent in (performer.body("a", frame()), performer.body("a", frame(1, right_hand_up())))
    )
    assert before == after
    assert ["RightLowerArm", pytest.approx(0.316), 0, 0] in after


def test_a_face_arrives_in_datagrams_that_are_not_cut_up(program, avatar):
    avatar.show_body("a", frame())
    program.recv(65536)
    avatar.show_face("a", blend(jawOpen=0.75, browDownLeft=0.25))
    datagrams = [program.recv(65536), program.recv(65536)]
    assert max(map(len, datagrams)) <= MAX_DATAGRAM_BYTES
    *values, last = read(datagrams)
    assert last == ("/VMC/Ext/Blend/Apply", [])
    assert {address for address, _ in values} == {"/VMC/Ext/Blend/Val"}
    shown = dict(arguments for _, arguments in values)
    assert tuple(shown) == ARKIT_BLENDSHAPES
    assert {name: value for name, value in shown.items() if value} == {
        "jawOpen": 0.75,
        "browDownLeft": 0.25,
    }


def test_landmarks_and_a_face_without_a_body_are_not_shown():
    performer = Performer(VmcSettings())
    assert performer.face("a", blend(jawOpen=1.0)) == []
    performer.body("a", frame())
    points = np.zeros((68, 2), np.float32)
    assert performer.face("a", FaceLandmarks(0, FaceLayout.DLIB68, points, 640, 480)) == []
    assert performer.face("b", blend(jawOpen=1.0)) == []


def test_the_first_session_with_a_body_is_shown_until_it_is_forgotten():
    performer = Performer(VmcSettings())
    assert performer.body("a", frame())
    assert performer.body("b", frame()) == []
    assert performer.forget("b") == []
    assert performer.body("a", frame(S))
    assert read(performer.forget("a")) == [("/VMC/Ext/OK", [0])]
    assert ("/VMC/Ext/T", [0]) in read(performer.body("b", frame(5 * S)))
    assert performer.body("a", frame(2 * S)) == []


def test_a_session_that_is_named_is_shown_alone():
    performer = Performer(VmcSettings(session="b"))
    assert performer.body("a", frame()) == []
    assert performer.body("b", frame())


def rising():
    """Two seconds in which the right arm rises by itself: pose i has it i degrees up."""
    poses = np.repeat(right_hand_up()[None], 50, axis=0)
    angle = np.radians(np.arange(50))[:, None]
    along = np.concatenate([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    shoulder = poses[:, CoreJoint.RIGHT_SHOULDER]
    poses[:, CoreJoint.RIGHT_ELBOW] = shoulder + 0.3 * along
    poses[:, CoreJoint.RIGHT_WRIST] = shoulder + 0.55 * along
    return Forecast(poses, "test")


def degrees_up(datagrams):
    x, y, z, w = bones(datagrams)["RightUpperArm"]
    assert (x, y) == pytest.approx((0, 0), abs=1e-6)
    return np.degrees(2 * np.arctan2(z, w))


def test_a_forecast_is_played_in_time():
    performer = Performer(VmcSettings(show="predicted", lead_ms=400))
    assert performer.body("a", frame(S)) == [], "nothing is predicted yet"
    performer.forecast("a", rising(), end_ns=S)
    # Ten frames lead; pose 0 is one frame after the end of the window.
    for index in range(41):
        shown = performer.body("a", frame(S + index * FRAME_NS))
        assert degrees_up(shown) == pytest.approx(9 + index, abs=1e-3)
    assert performer.body("a", frame(S + 41 * FRAME_NS)) == [], "the forecast is over"
    performer.forecast("a", rising(), end_ns=S + 40 * FRAME_NS)
    assert degrees_up(performer.body("a", frame(S + 42 * FRAME_NS))) == pytest.approx(11, abs=1e-3)


def test_a_forecast_is_forgotten_with_its_session_and_does_not_reach_another():
    performer = Performer(VmcSettings(show="predicted"))
    performer.body("a", frame())
    performer.forecast("b", rising(), end_ns=0)
    assert performer.body("a", frame(FRAME_NS)) == []
    performer.forecast("a", rising(), end_ns=0)
    assert performer.body("a", frame(2 * FRAME_NS))
    performer.forget("a")
    assert performer.body("a", frame(3 * FRAME_NS)) == []


def test_what_is_observed_is_shown_whatever_is_predicted():
    performer = Performer(VmcSettings())
    performer.body("a", frame())
    performer.forecast("a", rising(), end_ns=0)
    assert degrees_up(performer.body("a", frame(1, right_hand_up()))) == pytest.approx(90, abs=1e-3)


def test_a_joint_that_coincides_keeps_the_rotation_that_was_shown_before():
    performer = Performer(VmcSettings())
    performer.body("a", frame(0, right_hand_up()))
    lost = right_hand_up()
    lost[CoreJoint.RIGHT_ELBOW] = lost[CoreJoint.RIGHT_SHOULDER]
    assert degrees_up(performer.body("a", frame(1, lost))) == pytest.approx(90, abs=1e-3)


class Closed:
    """A socket on which nothing can be sent."""

    def __init__(self, error):
        self.error = error

    def send(self, datagram):
        raise self.error


@pytest.mark.parametrize("error", [BlockingIOError(), ConnectionRefusedError(), OSError("gone")])
def test_what_cannot_be_sent_is_counted_and_said_once(caplog, error):
    sender = VmcSender(Performer(VmcSettings()), Closed(error))
    with caplog.at_level(logging.WARNING):
        for index in range(3):
            sender.show_body("a", frame(index))
    assert sender.failures == 3
    assert [record.levelname for record in caplog.records] == ["WARNING"]


def test_a_send_buffer_that_is_full_does_not_hold_up_the_server(avatar):
    assert not avatar._socket.getblocking()


def test_it_goes_on_when_the_program_is_closed_and_after_the_socket_is(program, avatar):
    program.close()
    for index in range(4):
        avatar.show_body("a", frame(index))
    avatar.close()
    failures = avatar.failures
    avatar.show_body("a", frame(5))
    assert avatar.failures == failures + 1


def test_nothing_is_opened_unless_it_is_asked_for():
    assert isinstance(open_avatar(VmcSettings(host="nowhere.invalid")), NoAvatar)


@pytest.mark.parametrize("host", ["256.0.0.1", "a" * 64 + ".invalid"])
def test_a_host_that_cannot_be_used_is_refused_by_name(host):
    with pytest.raises(ConfigError, match="host"):
        open_avatar(VmcSettings(enabled=True, host=host))
