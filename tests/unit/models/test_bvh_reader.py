"""BVH files: the tree, the channels in any order, core joints by name, and what is refused."""

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from agent_server.errors import InvalidInput  # noqa: E402
from models.data.bvh import read_bvh  # noqa: E402
from models.data.bvh_motion import read_bvh_motion  # noqa: E402

ARM = """HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Arm
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.02
0 0 0 0 0 0 0 0 0
10 0 0 90 0 0 90 90 0
"""


@pytest.fixture
def save(tmp_path):
    def write(text):
        path = tmp_path / "Someone" / "wave.bvh"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return path

    return write


def test_positions_follow_the_hierarchy(save):
    names, positions, rate_hz = read_bvh(save(ARM))
    assert names == ("Hips", "Left Arm", "Left Arm_end")
    assert rate_hz == pytest.approx(50)
    np.testing.assert_allclose(positions[0], [[1, 2, 3], [1, 12, 3], [1, 17, 3]])
    # The root's turn about z lays the arm along -x; in its axes the end goes y -> z, and the
    # arm's own turn about z, to the left of that about x, leaves it there.
    np.testing.assert_allclose(positions[1], [[11, 2, 3], [1, 2, 3], [1, 2, 8]], atol=1e-5)


def test_the_order_of_the_channels_is_the_order_of_the_turns(save):
    text = ARM.replace("CHANNELS 3 Zrotation Xrotation", "CHANNELS 3 Xrotation Zrotation")
    _, positions, _ = read_bvh(save(text))
    # In the root's axes the end now goes y -> -x, which the turn about x leaves there.
    np.testing.assert_allclose(positions[1, 2], [1, -3, 3], atol=1e-5)


def test_position_channels_may_stand_behind_and_replace_a_joints_offset(save):
    text = ARM.replace(
        "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
        "CHANNELS 4 Zrotation Zposition Xposition Yposition",
    ).replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 2 Yposition Xrotation")
    text = text[: text.index("Frames")] + "Frames:\t1\nFrame Time:\t0.04\n90 30 10 20 7 0\n"
    _, positions, rate_hz = read_bvh(save(text))
    assert rate_hz == pytest.approx(25)
    np.testing.assert_allclose(positions[0], [[11, 22, 33], [4, 22, 33], [-1, 22, 33]], atol=1e-5)


REFUSED = {
    "no motion": (("MOTION", "NOTHING"), "has no line MOTION"),
    "no hierarchy": (("HIERARCHY", "TREE"), "line 1: expected HIERARCHY"),
    "unknown channel": (("Zposition", "Wposition"), "line 5: 'wposition' is no channel"),
    "unknown word": (("JOINT", "BONE"), "line 6: 'BONE' is none of OFFSET"),
    "no offset": (("    OFFSET 0 10 0\n", ""), "line 13: Left Arm has no OFFSET"),
    "bad offset": (("OFFSET 0 10 0", "OFFSET 0 ten 0"), "line 8: 'ten' is no finite number"),
    "open brace": (("  }\n}\nMOTION", "MOTION"), "line 13: the hierarchy ends where"),
    "second root": (("}\nMOTION", "}\nROOT B\nMOTION"), "line 16: 'ROOT' follows the end"),
    "same name": (("Left Arm", "Hips"), "line 7: a second joint is called 'Hips'"),
    "no frames": (("Frames: 2", "Frames: none"), "line 17 is 'Frames: none', expected 'Frames:'"),
    "no time": (("Frame Time: 0.02", "Frame Time: 0"), "line 18 is 'Frame Time: 0', expected"),
    "cut short": (("Frames: 2", "Frames: 3"), "line 17: Frames is 3, and 2 rows follow"),
    "short row": (("10 0 0 90 0 0", "10 0 0 90 0"), "line 20 has 8 numbers, and the joints have 9"),
    "bad value": (("10 0 0 90", "10 0 0 east"), "line 20: 'east' is no finite number"),
    "nothing moves": (("0 0 0 0 0 0 0 0 0\n10 0 0 90 0 0 90 90 0\n", ""), "MOTION has 2 lines"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_fit_is_named_with_its_line(save, case):
    (old, new), message = REFUSED[case]
    assert old in ARM
    with pytest.raises(InvalidInput, match=rf"wave\.bvh.*{message}"):
        read_bvh(save(ARM.replace(old, new, 1)))


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InvalidInput, match=r"none\.bvh cannot be read"):
        read_bvh(tmp_path / "none.bvh")


def arms(prefix=""):
    """Both arms as nested joints, in centimetres: they point to the sides."""
    text = ""
    for side, sign in (("Left", 1), ("Right", -1)):
        chain = ((f"{side}Arm", 20), (f"{side}ForeArm", 30), (f"{side}Hand", 25))
        for name, length in chain:
            text += f"JOINT {prefix}{name} {{ OFFSET {sign * length} 0 0\nCHANNELS 1 Yrotation\n"
        text += "End Site { OFFSET 0 0 0 } " + "}" * len(chain) + "\n"
    return text


def body(spine, end, prefix=""):
    """A person in centimetres: a chain of (name, length) upwards, the arms on its third joint."""
    text = f"HIERARCHY\nROOT {prefix}Hips {{ OFFSET 0 0 0\nCHANNELS 4 Xposition Yposition "
    text += "Zposition Yrotation\n"
    for place, (name, length) in enumerate(spine):
        text += f"JOINT {prefix}{name} {{ OFFSET 0 {length} 0\n"
        text += arms(prefix) if place == 2 else ""
    text += f"End Site {{ OFFSET 0 {end} 0 }} " + "}" * (len(spine) + 1)
    rows = [
        # root x y z turn, left arm, forearm, hand, right arm, forearm, hand
        *(["5 90 7 30", "0 0 0", "0 0 0"], ["5 95 9 70", "0 -90 0", "0 0 0"]),
    ]
    motion = "\n".join(" ".join(row) for row in rows)
    return f"{text}\nMOTION\nFrames: 2\nFrame Time: 0.08\n{motion}\n"


CMU_SPINE = (("Spine", 14), ("Spine0", 0), ("Spine1", 14), ("Neck1", 11), ("Head", 11))
MIXAMO_SPINE = (
    *(("Spine", 10), ("Spine1", 12), ("Spine2", 13)),
    *(("Neck", 15), ("Head", 10), ("HeadTop_End", 20)),
)
FILES = {
    "CMU": (body(CMU_SPINE, 12), {"navel": 0.14, "shoulder": 0.28, "neck": 0.39, "head": 0.62}),
    "Mixamo": (
        body(MIXAMO_SPINE, 0, "mixamorig:"),
        {"navel": 0.22, "shoulder": 0.35, "neck": 0.50, "head": 0.70},
    ),
}


@pytest.mark.parametrize("kind", FILES)
def test_core_joints_are_found_by_name_and_face_the_sensor(save, kind):
    text, heights = FILES[kind]
    motion = read_bvh_motion(save(text), scale=0.01)
    assert (motion.subject, motion.label, motion.source) == ("Someone", "wave", "bvh")
    assert motion.positions.shape == (3, 9, 3)  # 0, 40 and 80 ms of frames 80 ms apart
    first = motion.positions[0]
    for joint in (CoreJoint.NAVEL, CoreJoint.NECK, CoreJoint.HEAD):
        height = heights[joint.name.lower()]
        np.testing.assert_allclose(first[joint], [0, height, 2.5], atol=1e-6)
    side = heights["shoulder"]
    np.testing.assert_allclose(first[CoreJoint.RIGHT_WRIST], [0.75, side, 2.5], atol=1e-6)
    np.testing.assert_allclose(first[CoreJoint.LEFT_SHOULDER], [-0.2, side, 2.5], atol=1e-6)
    # The left forearm, along x, turns about y until it points forwards: at the sensor.
    np.testing.assert_allclose(
        motion.positions[2, CoreJoint.LEFT_WRIST], [-0.5, side, 2.25], atol=1e-5
    )
    half_way = (first + motion.positions[2]) / 2
    np.testing.assert_allclose(motion.positions[1], half_way, atol=1e-6)


def test_other_names_can_be_given(save):
    text = FILES["CMU"][0].replace("Neck1", "Nacken")
    with pytest.raises(InvalidInput, match=r"lacks Neck1 of CMU; HeadTop_End, Neck of Mixamo"):
        read_bvh_motion(save(text), scale=0.01)
    sides = {"LEFT": "Left", "RIGHT": "Right"}
    parts = {"SHOULDER": "Arm", "ELBOW": "ForeArm", "WRIST": "Hand"}
    names = {
        CoreJoint[f"{side}_{part}"]: (sides[side] + parts[part],)
        for side in sides
        for part in parts
    }
    names |= {CoreJoint.HEAD: ("Head", "Head_end"), CoreJoint.NAVEL: ("Spine",)}
    with pytest.raises(InvalidInput, match="nothing for NECK"):
        read_bvh_motion(save(text), scale=0.01, names=names)
    motion = read_bvh_motion(save(text), scale=0.01, names={**names, CoreJoint.NECK: ("Nacken",)})
    assert motion.positions[0, CoreJoint.HEAD, 1] == pytest.approx(0.56)


def test_a_wrong_unit_and_other_axes_are_named(save):
    text = FILES["CMU"][0]
    with pytest.raises(InvalidInput, match="with scale 1 the navel is 25 m from the neck"):
        read_bvh_motion(save(text), scale=1.0)
    swapped = text.replace("Left", "?").replace("Right", "Left").replace("?", "Right")
    with pytest.raises(InvalidInput, match="y up and z forwards"):
        read_bvh_motion(save(swapped), scale=0.01)
