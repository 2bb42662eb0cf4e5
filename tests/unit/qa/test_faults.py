"""Faults: each does what its name says, and the same twice."""

from itertools import pairwise

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.domain.skeleton import CoreJoint, SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.qa.faults.base import Arrival
from agent_server.qa.faults.clocks import ClockDrift, ClockJump
from agent_server.qa.faults.sensors import FaceLoss, FrameRate, Noise, Occlusion, SecondBody
from agent_server.qa.faults.standard import FAULTS
from agent_server.qa.faults.transport import Delay, Drop, Duplicate, Jitter, Reorder
from agent_server.skeleton.formats import get_format
from tests.support.bodies import stream

SECONDS = 20


def arrivals():
    body = stream(SECONDS)
    face = [AffectSample(i * 100 * NS_PER_MS, -5.0, 5.0) for i in range(SECONDS * 10)]
    events = sorted([*body, *face], key=lambda event: event.originating_ns)
    return [Arrival(event.originating_ns, event) for event in events]


def apply(fault, seed=1):
    return fault.apply(arrivals(), np.random.default_rng(seed))


def bodies(found):
    return [a for a in found if a.is_body]


def faces(found):
    return [a for a in found if a.is_face]


def same(one, other):
    """Whether two inputs are equal, arrays too."""
    if not isinstance(one, SkeletonFrame):
        return one == other
    return one.originating_ns == other.originating_ns and np.array_equal(one.joints, other.joints)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_seed_gives_the_same_fault_and_leaves_the_recording_alone(fault):
    given = arrivals()
    before = [(a.at_ns, a.value.originating_ns) for a in given]
    first, second = (fault.apply(given, np.random.default_rng(3)) for _ in range(2))
    assert [a.at_ns for a in first] == [a.at_ns for a in second]
    assert all(same(a.value, b.value) for a, b in zip(first, second, strict=True))
    assert [(a.at_ns, a.value.originating_ns) for a in given] == before


def test_names_are_unique():
    assert len({fault.name for fault in FAULTS}) == len(FAULTS)


def test_drop_loses_its_share_of_skeletons_and_no_face():
    found = apply(Drop(0.3))
    assert 0.6 < len(bodies(found)) / len(bodies(arrivals())) < 0.8
    assert len(faces(found)) == len(faces(arrivals()))


def test_delay_moves_the_arrival_of_skeletons_and_no_stamp():
    for was, now in zip(arrivals(), apply(Delay(200)), strict=True):
        assert now.at_ns - was.at_ns == (200 * NS_PER_MS if was.is_body else 0)
        assert now.value.originating_ns == was.value.originating_ns


def test_jitter_keeps_the_order_and_delays_by_its_mean_or_more():
    found = apply(Jitter(50))
    times = [a.at_ns for a in found]
    assert times == sorted(times)
    late = [now.at_ns - was.at_ns for was, now in zip(arrivals(), found, strict=True)]
    assert min(late) >= 0
    assert np.mean(late) > 50 * NS_PER_MS


def test_reorder_puts_some_behind_their_successors():
    found = sorted(apply(Reorder(0.1, ms=60)), key=lambda a: a.at_ns)
    stamps = [a.value.originating_ns for a in bodies(found)]
    swapped = sum(a > b for a, b in pairwise(stamps))
    assert 0.05 < swapped / len(stamps) < 0.15


def test_duplicate_sends_the_same_again():
    found = apply(Duplicate(0.2))
    assert 0.15 < len(found) / len(arrivals()) - 1 < 0.25


def test_drift_grows_with_time_and_only_on_the_body():
    last = bodies(apply(ClockDrift(1000)))[-1]
    assert last.value.originating_ns - last.at_ns == pytest.approx(last.at_ns / 1000, abs=1)
    assert all(a.value.originating_ns == a.at_ns for a in faces(apply(ClockDrift(1000))))


@pytest.mark.parametrize("ms", [2000, -500])
def test_a_clock_jumps_once_and_stays(ms):
    for arrival in bodies(apply(ClockJump(ms, at_s=3.0))):
        off = 0 if arrival.at_ns < 3 * NS_PER_S else ms * NS_PER_MS
        assert arrival.value.originating_ns == arrival.at_ns + off


def test_noise_has_its_size_in_millimetres():
    moved = [
        now.value.joints[:, :3] - was.value.joints[:, :3]
        for was, now in zip(bodies(arrivals()), bodies(apply(Noise(10))), strict=True)
    ]
    unit_mm = get_format(bodies(arrivals())[0].value.format).unit_m * 1000
    assert np.std(moved) * unit_mm == pytest.approx(10, rel=0.05)


def test_occlusion_hides_one_joint_for_its_share_of_time():
    found = bodies(apply(Occlusion(CoreJoint.LEFT_WRIST, hidden_s=1.0, every_s=4.0)))
    table = get_format(found[0].value.format)
    index = table.names.index(table.core[CoreJoint.LEFT_WRIST][0][0])
    hidden = np.array([a.value.joints[:, 3] == 0 for a in found])
    assert hidden[:, index].mean() == pytest.approx(0.25, abs=0.06)
    assert not np.delete(hidden, index, axis=1).any()


def test_a_lower_rate_thins_the_frames_evenly():
    found = bodies(apply(FrameRate(10)))
    assert len(found) == pytest.approx(SECONDS * 10, abs=2)
    assert np.diff([a.at_ns for a in found]).max() < 0.15 * NS_PER_S


def test_the_face_is_lost_for_its_share_of_time():
    found = apply(FaceLoss(lost_s=2.0, every_s=4.0))
    assert len(faces(found)) / len(faces(arrivals())) == pytest.approx(0.5, abs=0.1)
    assert len(bodies(found)) == len(bodies(arrivals()))


def test_a_second_body_has_its_own_number_and_stands_farther_away():
    found = bodies(apply(SecondBody(lag_ms=1000, behind_m=0.6)))
    ids = {a.value.body_id for a in found}
    assert len(ids) == 2
    first = [a for a in found if a.value.body_id == min(ids)]
    other = [a for a in found if a.value.body_id == max(ids)]
    unit_m = get_format(first[0].value.format).unit_m
    depth = other[0].value.joints[:, 2] - first[0].value.joints[:, 2]
    assert depth * unit_m == pytest.approx(np.full(len(depth), 0.6), abs=1e-4)
    assert other[0].at_ns - first[0].at_ns == NS_PER_S
