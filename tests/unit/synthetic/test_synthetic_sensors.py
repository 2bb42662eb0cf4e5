from dataclasses import replace

import numpy as np
import pytest

from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InvalidInput
from agent_server.skeleton.formats import get_format
from agent_server.skeleton.retarget import retarget
from agent_server.synthetic.clips import Clip, sample_clip
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.sensors import (
    KINECT_V1,
    KINECT_V2,
    MOCAP,
    SENSORS,
    WEBCAM,
    Sensor,
    observe_core,
    observe_frames,
)
from agent_server.synthetic.tables import place_core


def clip(gesture: str = "loud", seed: int = 0, distance_m: float = 2.0) -> Clip:
    rng = np.random.default_rng(seed)
    place = replace(Placement.sample(rng, seated=False), distance_m=distance_m, heading_rad=0.0)
    return sample_clip(rng, gesture, Person.sample(rng, subject="x"), placement=place)


def errors(sensor: Sensor, seed: int, **where: float) -> np.ndarray:
    """Errors that change over time, shape (T, 9, 3): without the constant part."""
    motion = clip("idle", seed, **where)
    seen = observe_core(motion, sensor, np.random.default_rng(seed))
    difference = seen.positions - place_core(motion.at(seen.stamps_s), sensor.places)
    return difference - np.median(difference, axis=0)


@pytest.mark.parametrize("sensor", SENSORS, ids=lambda sensor: sensor.name)
def test_an_observation_is_well_formed(sensor: Sensor) -> None:
    motion = clip()
    seen = observe_core(motion, sensor, np.random.default_rng(1))
    assert (np.diff(seen.stamps_s) > 0).all()
    assert seen.stamps_s[0] >= 0 and seen.stamps_s[-1] <= motion.duration_s + 0.02
    assert len(seen.stamps_s) > 0.9 * motion.duration_s * sensor.rate_hz
    assert np.isfinite(seen.positions).all()
    assert set(np.unique(seen.confidence)) <= {0.0, 0.5, 1.0}
    assert not seen.positions.flags.writeable


@pytest.mark.parametrize("sensor", [KINECT_V1, KINECT_V2], ids=lambda sensor: sensor.name)
def test_native_frames_hold_the_core_observation(sensor: Sensor) -> None:
    motion = clip(seed=3)
    seen = observe_core(motion, sensor, np.random.default_rng(8))
    frames = observe_frames(motion, sensor, np.random.default_rng(8), 7, 5_000_000_000)
    assert len(frames) == len(seen.stamps_s)
    stamps = np.array([frame.originating_ns for frame in frames])
    np.testing.assert_allclose((stamps - 5_000_000_000) / 1e9, seen.stamps_s, atol=1e-8)
    core = np.stack([retarget(frame) for frame in frames])
    np.testing.assert_array_equal(core[..., 3], seen.confidence)
    tracked = seen.confidence > 0
    np.testing.assert_allclose(core[..., :3][tracked], seen.positions[tracked], atol=0.0005 + 1e-6)
    assert {frame.body_id for frame in frames} == {7}
    joints = np.stack([frame.joints for frame in frames])
    assert joints.shape[1] == len(get_format(frames[0].format).names)
    np.testing.assert_allclose(joints[..., :3], np.round(joints[..., :3], 3), atol=1e-6)


def test_a_joint_that_is_given_up_is_zero_in_frames_and_stays_put_in_the_core() -> None:
    assert KINECT_V2.weakness is not None
    blind = replace(KINECT_V2, weakness=replace(KINECT_V2.weakness, untracked_hz=3.0))
    motion = clip(seed=4)
    seen = observe_core(motion, blind, np.random.default_rng(2))
    frames = observe_frames(motion, blind, np.random.default_rng(2), 1, 0)
    lost = seen.confidence[1:] == 0
    assert lost[:, [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]].any()
    moved = np.abs(np.diff(seen.positions, axis=0)).max(axis=2)
    assert moved[lost].max() == 0.0
    joints = np.stack([frame.joints for frame in frames])
    assert not joints[joints[..., 3] == 0].any()


def test_a_skeleton_stands_upright_in_its_native_table() -> None:
    frames = observe_frames(clip("idle"), KINECT_V2, np.random.default_rng(0), 1, 0)
    names = get_format("kinect_v2").names
    middle = np.median([frame.joints for frame in frames], axis=0)
    height = {name: middle[index, 1] for index, name in enumerate(names)}
    order = ["foot_left", "knee_left", "spine_base", "spine_mid", "spine_shoulder", "neck", "head"]
    assert [height[name] for name in order] == sorted(height[name] for name in order)
    assert middle[names.index("hip_right"), 0] > middle[names.index("hip_left"), 0]


def test_sensors_rank_as_their_makers_say() -> None:
    size = {
        sensor.name: np.mean(
            [errors(replace(sensor, weakness=None), seed).std() for seed in range(6)]
        )
        for sensor in SENSORS
    }
    assert size["mocap"] < 0.002
    assert size["mocap"] < size["kinect_v2"] < size["kinect_v1"] < 0.05
    webcam = np.concatenate([errors(WEBCAM, seed).std(axis=0) for seed in range(6)])
    assert webcam[:, 2].mean() > 2.0 * webcam[:, :2].mean()


def test_errors_of_a_depth_camera_grow_with_the_distance() -> None:
    calm = replace(KINECT_V1, weakness=None, lag_s=0.0)
    near, far = (
        np.mean([errors(calm, seed, distance_m=distance).std() for seed in range(6)])
        for distance in (1.4, 2.8)
    )
    assert 2.0 < far / near < 6.0


def test_wrists_fail_at_the_head_and_not_at_the_side() -> None:
    quiet = loud = 0.0
    for seed in range(12):
        motion = clip("loud", seed)
        seen = observe_core(motion, KINECT_V1, np.random.default_rng(seed))
        clean = place_core(motion.at(seen.stamps_s), "kinect_v1")
        off = np.linalg.norm(seen.positions - clean, axis=2)[:, [5, 8]] > 0.08
        held = (seen.stamps_s > motion.onset_s + 0.6) & (seen.stamps_s < motion.offset_s - 0.6)
        loud += off[held].mean()
        quiet += off[seen.stamps_s < motion.onset_s].mean()
    assert loud > 0.4  # of 12
    assert quiet < 0.5 * loud


def test_a_marker_system_has_no_frames_of_its_own() -> None:
    with pytest.raises(InvalidInput, match="sensor is 'mocap'"):
        observe_frames(clip(), MOCAP, np.random.default_rng(0), 1, 0)
