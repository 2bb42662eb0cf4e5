"""The checked-in human is what the page counts on: bones, morphs, bounds and a light file."""

import json
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

WEB = Path(__file__).parents[3] / "agent_server" / "web"
GLB = WEB / "public" / "human.glb"
VALIDATOR = WEB / "node_modules" / "gltf-validator"
TYPES = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
SIDES = ("Left", "Right")
PARENTS = {
    "Spine": "Hips",
    "Spine1": "Spine",
    "Spine2": "Spine1",
    "Neck": "Spine2",
    "Head": "Neck",
    **{f"{side}Eye": "Head" for side in SIDES},
    **{f"{side}Shoulder": "Spine2" for side in SIDES},
    **{f"{side}Arm": f"{side}Shoulder" for side in SIDES},
    **{f"{side}ForeArm": f"{side}Arm" for side in SIDES},
    **{f"{side}Hand": f"{side}ForeArm" for side in SIDES},
    **{f"{side}UpLeg": "Hips" for side in SIDES},
    **{f"{side}Leg": f"{side}UpLeg" for side in SIDES},
    **{f"{side}Foot": f"{side}Leg" for side in SIDES},
    **{f"{side}ToeBase": f"{side}Foot" for side in SIDES},
    **{
        f"{side}Hand{finger}{k}": f"{side}Hand{finger}{k - 1}" if k > 1 else f"{side}Hand"
        for side in SIDES
        for finger in ("Thumb", "Index", "Middle", "Ring", "Pinky")
        for k in (1, 2, 3)
    },
}


class Glb:
    """A small reader for files without extensions and interleaving."""

    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json = json.loads(data[20 : 20 + size])
        rest, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0"
        self.binary = data[28 + size : 28 + size + rest]

    def values(self, index):
        """What an accessor holds as stored, (count, width)."""
        accessor = self.json["accessors"][index]
        width = WIDTHS[accessor["type"]]
        shape = (accessor["count"], width)
        if "bufferView" in accessor:
            return self._read(accessor["bufferView"], accessor["componentType"], shape)
        values = np.zeros(shape, TYPES[accessor["componentType"]])
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            at, what = sparse["indices"], sparse["values"]
            rows = self._read(at["bufferView"], at["componentType"], (sparse["count"], 1))
            values[rows[:, 0]] = self._read(
                what["bufferView"], accessor["componentType"], (sparse["count"], width)
            )
        return values

    def _read(self, view, component, shape):
        view = self.json["bufferViews"][view]
        kind = np.dtype(TYPES[component]).newbyteorder("<")
        start = view.get("byteOffset", 0)
        count = shape[0] * shape[1]
        assert count * kind.itemsize == view["byteLength"]
        return np.frombuffer(self.binary, kind, count, start).reshape(shape)

    def primitives(self):
        return [p for mesh in self.json["meshes"] for p in mesh["primitives"]]

    def attribute(self, primitive, name):
        return self.values(primitive["attributes"][name])

    def mesh(self, name):
        return next(mesh for mesh in self.json["meshes"] if mesh["name"] == name)


@pytest.fixture(scope="module")
def human():
    return Glb(GLB.read_bytes())


@pytest.fixture(scope="module")
def bones(human):
    """Name -> place at rest, metres."""
    nodes = human.json["nodes"]
    places = {}

    def walk(index, origin):
        node = nodes[index]
        places[node["name"]] = origin + node.get("translation", [0, 0, 0])
        for child in node.get("children", []):
            walk(child, places[node["name"]])

    walk(human.json["skins"][0]["skeleton"], np.zeros(3))
    return {name.removeprefix("mixamorig"): place for name, place in places.items()}


def test_is_light(human):
    triangles = sum(len(human.values(p["indices"])) // 3 for p in human.primitives())
    assert 15_000 < triangles <= 25_000
    assert GLB.stat().st_size <= 1_500_000


def test_loads_without_extensions(human):
    assert "extensionsUsed" not in human.json
    assert "extensionsRequired" not in human.json


def test_says_whose_work_it_is(human):
    assert "MakeHuman" in human.json["asset"]["copyright"]
    assert "CC0" in human.json["asset"]["copyright"]


def test_bones_have_the_names_and_parents_of_mixamo(human):
    nodes = human.json["nodes"]
    joints = human.json["skins"][0]["joints"]
    names = {nodes[k]["name"] for k in joints}
    assert names == {f"mixamorig{name}" for name in ("Hips", *PARENTS)}
    found = {
        nodes[child]["name"].removeprefix("mixamorig"): node["name"].removeprefix("mixamorig")
        for node in nodes
        for child in node.get("children", [])
    }
    assert found == PARENTS


def test_no_bone_is_turned_or_scaled_at_rest(human):
    for joint in human.json["skins"][0]["joints"]:
        assert set(human.json["nodes"][joint]) <= {"name", "translation", "children"}


def test_the_bind_pose_is_the_rest_pose(human, bones):
    skin = human.json["skins"][0]
    inverse = human.values(skin["inverseBindMatrices"]).reshape(-1, 4, 4)
    assert len(inverse) == len(skin["joints"])
    for joint, matrix in zip(skin["joints"], inverse, strict=True):
        name = human.json["nodes"][joint]["name"].removeprefix("mixamorig")
        np.testing.assert_allclose(matrix[:3, :3], np.eye(3), atol=1e-6)
        np.testing.assert_allclose(matrix[3, :3], -bones[name], atol=1e-4)


def test_every_mesh_follows_the_bones(human):
    nodes = [node for node in human.json["nodes"] if "mesh" in node]
    assert {node["name"] for node in nodes} == {"Head", "Eyes", "Hair", "Arms", "Clothes"}
    assert all(node["skin"] == 0 for node in nodes)


def test_stands_on_the_floor_facing_front(human, bones):
    points = np.concatenate([human.attribute(p, "POSITION") for p in human.primitives()])
    low, high = points.min(0), points.max(0)
    assert low[1] == pytest.approx(0, abs=0.001)
    assert 1.75 < high[1] < 1.85
    assert low[0] == pytest.approx(-high[0], abs=0.01)
    assert bones["LeftEye"][0] == pytest.approx(-bones["RightEye"][0], abs=1e-5)
    assert bones["LeftEye"][0] > 0.02
    assert bones["LeftEye"][2] > bones["Head"][2] + 0.05
    assert bones["LeftToeBase"][2] > bones["LeftFoot"][2] + 0.05


def test_bones_lie_inside_the_body(human, bones):
    points = np.concatenate([human.attribute(p, "POSITION") for p in human.primitives()])
    for name, place in bones.items():
        near = points[np.linalg.norm(points - place, axis=1) < 0.2]
        assert (near.min(0) < place).all(), name
        assert (near.max(0) > place).all(), name


def test_numbers_are_sound(human):
    for primitive in human.primitives():
        points = human.attribute(primitive, "POSITION")
        assert np.isfinite(points).all()
        indices = human.values(primitive["indices"])[:, 0]
        assert indices.max() < len(points)
        assert set(indices.tolist()) == set(range(len(points)))
        lengths = np.linalg.norm(human.attribute(primitive, "NORMAL"), axis=1)
        np.testing.assert_allclose(lengths, 1, atol=1e-4)


def test_weights_sum_to_one(human):
    count = len(human.json["skins"][0]["joints"])
    for primitive in human.primitives():
        weights = human.attribute(primitive, "WEIGHTS_0").astype(int)
        assert (weights.sum(1) == 255).all()
        joints = human.attribute(primitive, "JOINTS_0")
        assert joints.max() < count
        assert (joints[weights == 0] == 0).all()


def test_each_eyeball_follows_its_own_bone(human):
    (eyes,) = human.mesh("Eyes")["primitives"]
    names = [human.json["nodes"][k]["name"] for k in human.json["skins"][0]["joints"]]
    left = human.attribute(eyes, "POSITION")[:, 0] > 0
    followed = human.attribute(eyes, "JOINTS_0")[:, 0]
    assert (human.attribute(eyes, "WEIGHTS_0")[:, 0] == 255).all()
    assert set(followed[left].tolist()) == {names.index("mixamorigLeftEye")}
    assert set(followed[~left].tolist()) == {names.index("mixamorigRightEye")}


def test_surfaces_face_outwards(human):
    for primitive in human.primitives():
        points = human.attribute(primitive, "POSITION").astype(float)
        corners = points[human.values(primitive["indices"])[:, 0].reshape(-1, 3)]
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = human.attribute(primitive, "NORMAL")
        mean = normals[human.values(primitive["indices"])[:, 0].reshape(-1, 3)].mean(1)
        agrees = (faces * mean).sum(1) > 0
        areas = np.linalg.norm(faces, axis=1)
        assert areas[agrees].sum() > 0.9 * areas.sum()


def moves(human, name):
    """What a morph does to the skin of the head: its points, and their moves in metres."""
    mesh = human.mesh("Head")
    number = mesh["extras"]["targetNames"].index(name)
    skin = mesh["primitives"][0]
    return human.attribute(skin, "POSITION"), human.values(skin["targets"][number]["POSITION"])


def test_the_face_has_its_morphs(human):
    mesh = human.mesh("Head")
    names = ["blinkLeft", "blinkRight", "attention", "discomfort", "mouthOpen"]
    assert mesh["extras"]["targetNames"] == names
    assert mesh["weights"] == [0] * len(names)
    for primitive in mesh["primitives"]:
        assert len(primitive["targets"]) == len(names)
    for name in names:
        _, moved = moves(human, name)
        assert np.isfinite(moved).all()
        assert 0.003 < np.linalg.norm(moved, axis=1).max() < 0.05


def test_a_blink_lowers_one_upper_lid(human):
    for name, side in (("blinkLeft", 1), ("blinkRight", -1)):
        points, moved = moves(human, name)
        touched = np.linalg.norm(moved, axis=1) > 1e-4
        assert (side * points[touched, 0] > 0).all()
        assert moved[:, 1].min() < -0.006


def test_attention_raises_the_brows_and_mouth_corners(human, bones):
    points, moved = moves(human, "attention")
    height = points[:, 1] - bones["LeftEye"][1]
    brows = (height > 0.012) & (height < 0.03) & (points[:, 2] > 0.1)
    corners = (height < -0.06) & (height > -0.085) & (np.abs(points[:, 0]) > 0.015)
    assert moved[brows, 1].max() > 0.002
    assert moved[corners, 1].max() > 0.0015


def test_discomfort_lowers_the_brows_and_mouth_corners(human, bones):
    points, moved = moves(human, "discomfort")
    height = points[:, 1] - bones["LeftEye"][1]
    brows = (height > 0.012) & (height < 0.03) & (points[:, 2] > 0.1)
    corners = (height < -0.06) & (height > -0.085) & (np.abs(points[:, 0]) > 0.015)
    assert moved[brows, 1].min() < -0.002
    assert moved[corners, 1].min() < -0.0015


@pytest.mark.skipif(
    shutil.which("node") is None or not VALIDATOR.exists(),
    reason="the npm package gltf-validator is not installed",
)
def test_passes_the_validator():
    script = (
        "const fs = require('fs');"
        f"require({json.dumps(str(VALIDATOR))})"
        f".validateBytes(new Uint8Array(fs.readFileSync({json.dumps(str(GLB))})))"
        ".then((report) => console.log(JSON.stringify(report.issues)));"
    )
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, check=True)
    issues = json.loads(done.stdout)
    assert issues["numErrors"] == 0, issues["messages"]
    assert issues["numWarnings"] == 0, issues["messages"]
