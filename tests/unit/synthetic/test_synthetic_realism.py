"""The generator against real people: MSRC-12's goggles and had-enough recordings (Kinect v1)."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from agent_server.domain.arrays import Float64
from agent_server.skeleton.readers.msrc12 import read_msrc12
from agent_server.skeleton.retarget import retarget
from agent_server.synthetic.clips import sample_clip
from agent_server.synthetic.corpus import people, subject_names
from agent_server.synthetic.person import Placement
from agent_server.synthetic.sensors import KINECT_V1, observe_core

FILES = 6


def relative_wrists(core: Float64) -> Float64:
    """Wrists from the head of people who face the sensor: outwards, up, back; shape (2 T, 3)."""
    wrists = core[:, [5, 8], :3] - core[:, :1, :3]
    wrists[:, 0, 0] *= -1
    return wrists.reshape(-1, 3)


def real_holds(tag: str) -> Float64:
    data = os.environ.get("AGENT_SERVER_DATA")
    folder = Path(data or "", "msrc12")
    if data is None or not folder.is_dir():
        pytest.skip("AGENT_SERVER_DATA has no msrc12")
    holds = []
    for path in sorted(folder.glob(f"P?_?_{tag[1:]}_p*.csv.gz"))[:FILES]:
        recording = read_msrc12(path)
        stamps = np.array([frame.originating_ns for frame in recording.frames])
        for mark in recording.marks:
            assert mark.tag == tag
            first = int(np.searchsorted(stamps, mark.stamp_ns))
            core = np.stack([retarget(frame) for frame in recording.frames[first : first + 8]])
            holds.append(relative_wrists(core))
    return np.concatenate(holds)


def made_holds(gesture: str, variant: str | None) -> Float64:
    group = list(people(0, subject_names(20)).values())
    holds = []
    for index in range(80):
        rng = np.random.default_rng(index)
        place = replace(Placement.sample(rng, seated=False), heading_rad=0.0, distance_m=2.7)
        clip = sample_clip(rng, gesture, group[index % 20], variant, placement=place)
        seen = observe_core(clip, KINECT_V1, rng)
        middle = int(np.searchsorted(seen.stamps_s, 0.5 * (clip.onset_s + clip.offset_s)))
        holds.append(relative_wrists(seen.positions[middle : middle + 8].astype(float)))
    return np.concatenate(holds)


@pytest.mark.parametrize(
    ("tag", "gesture", "variant"),
    [("G4", "bright", "eyes_both"), ("G9", "loud", None)],
)
def test_hands_are_held_where_real_people_hold_them(
    tag: str, gesture: str, variant: str | None
) -> None:
    real, made = real_holds(tag), made_holds(gesture, variant)
    np.testing.assert_allclose(np.median(made, axis=0), np.median(real, axis=0), atol=0.035)
    # No narrower than people are, or a model would know the generator and not the gesture.
    spread = np.percentile(made, 90, axis=0) - np.percentile(made, 10, axis=0)
    people_spread = np.percentile(real, 90, axis=0) - np.percentile(real, 10, axis=0)
    assert (spread > 0.6 * people_spread).all()
    assert (spread < 3.0 * people_spread).all()
