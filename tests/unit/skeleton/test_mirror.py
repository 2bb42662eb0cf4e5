"""The mirror detector on poses, and on real recordings beside their mirror images."""

import gzip
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.skeleton.mirror import MirrorDetector
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter

HOP = 5
MIRROR = np.float32([-1, 1, 1])
TURN_ROUND = np.float32([-1, 1, -1])
SWAP_SIDES = [0, 1, 2, 6, 7, 8, 3, 4, 5]

# Faces the sensor, the forearms 10 cm before the elbows.
POSE = np.array(
    [
        *((0.0, 0.60, 2.0), (0.0, 0.40, 2.0), (0.0, 0.0, 2.0)),
        *((-0.18, 0.35, 2.0), (-0.25, 0.10, 2.02), (-0.24, -0.10, 1.92)),
        *((0.18, 0.35, 2.0), (0.25, 0.10, 2.02), (0.24, -0.10, 1.92)),
    ],
    np.float32,
)


def verdicts(
    motion: Float32, confidence: Float32 | None = None, detector: MirrorDetector | None = None
) -> list[bool]:
    """What a detector says after each hop."""
    detector = detector or MirrorDetector()
    if confidence is None:
        confidence = np.ones(motion.shape[:2], np.float32)
    return [
        detector.update(motion[at : at + HOP], confidence[at : at + HOP])
        for at in range(0, len(motion) - HOP + 1, HOP)
    ]


def still(pose: Float32, seconds: float) -> Float32:
    return np.repeat(pose[None], round(25 * seconds), axis=0)


@pytest.mark.parametrize(
    ("wrong", "pose"),
    [
        (False, POSE),
        (False, POSE * TURN_ROUND),
        (True, POSE * MIRROR),
        (True, POSE[SWAP_SIDES]),
        # Seems to face the sensor, forearms behind: a sensor that takes all to face it.
        (False, POSE * MIRROR * TURN_ROUND),
        # No width and no height give no direction.
        (False, POSE * np.float32([0, 1, 1])),
        (False, POSE * np.float32([1, 0, 1])),
    ],
    ids=["as is", "turned", "mirrored", "sides swapped", "turned Kinect", "no width", "no height"],
)
def test_verdict_on_a_pose(wrong: bool, pose: Float32) -> None:
    said = verdicts(still(pose, 4))
    assert said[-1] == wrong
    assert not any(said[: round(1.5 * 25 / HOP)]), "two seconds of evidence come first"


def test_sideways_says_nothing() -> None:
    quarter = POSE[:, [2, 1, 0]] * np.float32([1, 1, -1])
    detector = MirrorDetector()
    assert verdicts(still(POSE * MIRROR, 4), detector=detector)[-1]
    assert all(verdicts(still(quarter, 20), detector=detector))


def test_hidden_joints_say_nothing() -> None:
    motion = still(POSE * MIRROR, 10)
    confidence = np.ones(motion.shape[:2], np.float32)
    confidence[:, [5, 8]] = 0.0
    assert not any(verdicts(motion, confidence))


def test_a_mended_stream_is_believed_again_within_seconds() -> None:
    detector = MirrorDetector()
    assert verdicts(still(POSE * MIRROR, 60), detector=detector)[-1]
    said = verdicts(still(POSE, 10), detector=detector)
    assert said[0]
    assert not said[-1]


def test_weak_evidence_keeps_the_verdict_as_it_is() -> None:
    weak = POSE * MIRROR
    weak[[4, 5, 7, 8], 2] = 2.0, 1.99, 2.0, 1.99
    assert not any(verdicts(still(weak, 30)))
    detector = MirrorDetector()
    assert verdicts(still(POSE * MIRROR, 4), detector=detector)[-1]
    assert all(verdicts(still(weak, 30), detector=detector))


def test_a_longer_hop_comes_to_the_same() -> None:
    detector = MirrorDetector()
    ones = np.ones((25, 9), np.float32)
    said = [detector.update(still(POSE * MIRROR, 1), ones) for _ in range(4)]
    assert said == [False, True, True, True]


def recordings(folder: Path) -> Iterator[tuple[Float32, Float32]]:
    """Positions and confidence at 25 Hz of every eighth MSRC-12 recording."""
    for path in sorted(folder.glob("*.csv.gz"))[::8]:
        with gzip.open(path) as file:
            table = np.loadtxt(file)
        joints = table[:, 1:].reshape(-1, 20, 4).astype(np.float32)
        retargeter, resampler, frames = Retargeter(), Resampler(), []
        for microseconds, row in zip(table[:, 0] - table[0, 0], joints, strict=True):
            frame = SkeletonFrame(round(microseconds * 1000), 1, "kinect_v1", row)
            core = retargeter.push(frame)
            if core is not None:
                frames += resampler.push(core)
        if len(frames) > 250:
            yield (
                np.stack([frame.positions for frame in frames]),
                np.stack([frame.confidence for frame in frames]),
            )


def test_real_recordings_and_their_mirror_images() -> None:
    root = os.environ.get("AGENT_SERVER_DATA")
    if not root or not (Path(root) / "msrc12").is_dir():
        pytest.skip("MSRC-12 is absent: set AGENT_SERVER_DATA to the folder that holds msrc12/")
    three, five, false_alarms, turned, streams = [], [], 0, [], 0
    for positions, confidence in recordings(Path(root) / "msrc12"):
        streams += 1
        false_alarms += any(verdicts(positions, confidence))
        turned.append(np.mean(verdicts(positions * TURN_ROUND, confidence)))
        for start in range(0, len(positions) - 125, 125):
            stretch = slice(start, start + 125)
            if np.count_nonzero(confidence[stretch]) < 0.9 * confidence[stretch].size:
                continue  # nobody is tracked
            said = verdicts(positions[stretch] * MIRROR, confidence[stretch])
            three.append(any(said[:15]))
            five.append(any(said))
    assert streams > 40
    assert false_alarms == 0
    assert np.mean(three) > 0.96
    assert np.mean(five) > 0.97
    assert np.mean(turned) < 0.01
