"""Perception: a frame that is refused changes nothing, so a recording of what was taken replays."""

from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.config import SubjectSettings, WindowSettings
from agent_server.domain.motion import Window
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.stages.perceive import Perception
from tests.support.bodies import core_joints

MS = 1_000_000
FRAMES = st.lists(
    st.tuples(
        st.integers(0, 2),  # body
        st.integers(-150, 400),  # ms since the last frame of any body
        st.sampled_from([0.0, 1.0, 1.0, 1.0]),  # confidence
    ),
    min_size=30,
    max_size=160,
)


def perception(policy):
    return Perception(WindowSettings(), SubjectSettings(policy=policy))


def stream(steps):
    stamp_ns = 0
    for body_id, step_ms, confidence in steps:
        stamp_ns = max(0, stamp_ns + step_ms * MS)
        joints = core_joints(shift=(0.3 * body_id, 0.0, 0.2 * body_id), confidence=confidence)
        yield SkeletonFrame(stamp_ns, body_id, "core9", joints)


def shape(found):
    return [
        (one.index, one.end_ns, one.positions.tobytes()) if isinstance(one, Window) else one
        for one in found
    ]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(FRAMES, st.sampled_from(["nearest", "first"]))
def test_what_was_taken_gives_the_same_again_without_what_was_refused(steps, policy):
    live, taken, found = perception(policy), [], []
    for frame in stream(steps):
        try:
            found += live.push(frame)
        except InvalidInput:
            continue
        taken.append(frame)
    again = perception(policy)
    replayed = [one for frame in taken for one in again.push(frame)]
    assert shape(replayed) == shape(found)
