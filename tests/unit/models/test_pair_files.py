"""Files of two people's motion, opened by other readers than what wrote them."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from typer.testing import CliRunner

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput, RecordingError
from agent_server.recording.reader import open_recording
from agent_server.skeleton.formats import get_format
from agent_server.skeleton.pair import JOINT_NAMES, PARENTS
from models.__main__ import app
from models.data.bvh import read_bvh
from models.export.pair_files import PairMotion, write_pair
from models.export.pair_recording import AWAY_M
from tests.support.interactions import interaction


def motion() -> PairMotion:
    one = interaction("s01s02", "05", 12)
    return PairMotion(
        one.action, one.reaction[:9], 15.0, "shaking hands", "made_up_0", "two people of a test"
    )


def held(person: np.ndarray) -> np.ndarray:
    return person[np.minimum(np.arange(12), len(person) - 1)]


def read_glb(path: Path) -> tuple[dict, bytes]:
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    document = json.loads(data[20 : 20 + size])
    binary, tag = struct.unpack_from("<I4s", data, 20 + size)
    assert (kind, tag) == (b"JSON", b"BIN\0") and size % 4 == binary % 4 == 0
    return document, data[28 + size : 28 + size + binary]


def rows_of(document: dict, data: bytes, accessor: int) -> np.ndarray:
    entry = document["accessors"][accessor]
    view = document["bufferViews"][entry["bufferView"]]
    columns = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry["type"]]
    assert view["byteLength"] == 4 * columns * entry["count"]
    count = columns * entry["count"]
    return np.frombuffer(data, "<f4", count, view["byteOffset"]).reshape(-1, columns)


def rotated(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    axis, w = quaternion[:3], quaternion[3]
    once = np.cross(axis, vector) + w * vector
    return vector + 2 * np.cross(axis, once)


def test_a_glb_shows_every_joint_where_it_is_and_bones_that_reach(tmp_path: Path) -> None:
    some = motion()
    write_pair(some, tmp_path / "pair.glb")
    assert (tmp_path / "pair.png").read_bytes()[:4] == b"\x89PNG"
    document, data = read_glb(tmp_path / "pair.glb")
    nodes = document["nodes"]
    (animation,) = document["animations"]
    moved = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        times = rows_of(document, data, sampler["input"])[:, 0]
        target = channel["target"]
        moved[target["node"], target["path"]] = rows_of(document, data, sampler["output"])
    np.testing.assert_allclose(times, np.arange(12) / 15, atol=1e-6)
    parents = {child: at for at, node in enumerate(nodes) for child in node.get("children", [])}
    named = {node["name"]: at for at, node in enumerate(nodes)}
    assert len(named) == len(nodes) == 2 * (15 + 14)

    def place(node: int | None) -> np.ndarray:
        return 0.0 if node is None else moved[node, "translation"] + place(parents.get(node))

    for person, positions in (("first", some.action), ("second", held(some.reaction))):
        for joint, name in enumerate(JOINT_NAMES):
            found = place(named[f"{person}_{name}"])
            np.testing.assert_allclose(found, positions[:, joint], atol=1e-5)
            if PARENTS[joint] >= 0:
                parent = JOINT_NAMES[PARENTS[joint]]
                bone = named[f"{person}_{parent}_to_{name}"]
                length = moved[bone, "scale"][7, 1]
                tip = rotated(moved[bone, "rotation"][7], np.array([0.0, length, 0.0]))
                start = place(parents[bone])[7]
                np.testing.assert_allclose(start + tip, positions[7, joint], atol=1e-5)
    times_entry = document["accessors"][animation["samplers"][0]["input"]]
    assert times_entry["min"] == [0.0] and "max" in times_entry  # the format asks for them


def test_bones_that_hang_straight_down_are_turned_too(tmp_path: Path) -> None:
    some = motion()
    straight = np.array(some.action)
    straight[:, 1] = straight[:, 2] - [0, 0.5, 0]
    write_pair(
        PairMotion(straight, straight, 15.0, "x", "made_up_0", "hanging"), tmp_path / "a.glb"
    )
    _, data = read_glb(tmp_path / "a.glb")
    assert np.isfinite(np.frombuffer(data, "<f4")).all()


def test_a_recording_holds_both_bodies_and_the_label(tmp_path: Path) -> None:
    some = motion()
    out = tmp_path / "pair.mcap"
    write_pair(some, out)
    recording = open_recording(out)
    frames = [one for one in recording.events() if isinstance(one, SkeletonFrame)]
    assert len(frames) == 24 and {frame.body_id for frame in frames} == {0, 1}
    names = get_format("kinect_v1").names
    last = [frame for frame in frames if frame.body_id == 1][-1]
    assert last.originating_ns == pytest.approx(11 / 15 * 1e9, abs=1)
    elbow = last.joints[names.index("elbow_left")]
    np.testing.assert_allclose(elbow[:3], some.reaction[8, 4] + [0, 0, AWAY_M], atol=1e-4)
    assert elbow[3] == 1.0 and last.joints[names.index("hand_left"), 3] == 0.0
    (label,) = recording.labels()
    assert (label.gesture, label.subject) == ("shaking hands", "made_up_0")
    with pytest.raises(RecordingError, match="exists already"):
        write_pair(some, out)


def test_a_bvh_has_both_people_below_a_joint_that_does_not_move(tmp_path: Path) -> None:
    some = motion()
    write_pair(some, tmp_path / "pair.bvh")
    names, positions, rate = read_bvh(tmp_path / "pair.bvh")
    joints = [name for name in names if not name.endswith("_end")]
    assert len(joints) == 31 and rate == pytest.approx(15.0)
    for person, expected in (("first", some.action), ("second", held(some.reaction))):
        found = positions[:, names.index(f"{person}_left_hand")]
        np.testing.assert_allclose(found, expected[:, 5], atol=1e-5)
    assert (positions[:, names.index("pair")] == 0).all()


def test_an_array_file_keeps_both_lengths_and_others_are_refused(tmp_path: Path) -> None:
    write_pair(motion(), tmp_path / "pair.npz")
    with np.load(tmp_path / "pair.npz") as arrays:
        assert (len(arrays["action"]), len(arrays["reaction"])) == (12, 9)
    with pytest.raises(InvalidInput, match=r"ends in none of \.bvh, \.glb, \.mcap, \.npz"):
        write_pair(motion(), tmp_path / "pair.fbx")


def test_a_label_is_enough_for_the_bundle_that_comes_along(tmp_path: Path) -> None:
    def generate(*words: object) -> object:
        given = ["generate", "interaction", "--out", str(tmp_path / "two.glb"), *map(str, words)]
        return CliRunner().invoke(app, given)

    made = generate("--model", "bigraphdiff", "--label", "kicking", "--seed", 3, "--frames", 5)
    assert made.exit_code == 0, made.output
    document, data = read_glb(tmp_path / "two.glb")
    assert len(rows_of(document, data, 0)) == 5 and (tmp_path / "two.png").exists()
    with pytest.raises(InvalidInput, match="none of bigraphdiff_sbu's: walking, kicking"):
        raise generate("--model", "bigraphdiff", "--label", "dancing").exception
    with pytest.raises(InvalidInput, match="--frames 0: make 1 to 3000 frames"):
        raise generate("--model", "bigraphdiff", "--label", "kicking", "--frames", 0).exception
    alone = generate("--label", "kicking")
    assert alone.exit_code == 2 and "--data" in alone.output
