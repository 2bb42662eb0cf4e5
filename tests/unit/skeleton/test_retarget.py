import math

import numpy as np
import pytest

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.skeleton.formats import FORMATS
from agent_server.skeleton.retarget import Retargeter, navel_distance, retarget

MS = 1_000_000


def body(
    stamp_ns: int,
    missing: dict[int, object] | None = None,
    *,
    body_id: int = 1,
    name: str = "core9",
    at: float = 0.0,
) -> SkeletonFrame:
    """A frame whose joint j lies at (at, j, 2); ``missing`` overrides rows."""
    joints = np.ones((len(FORMATS[name].names), 4), np.float32)
    joints[:, 0], joints[:, 1], joints[:, 2] = at, np.arange(len(joints)), 2.0
    for joint, row in (missing or {}).items():
        joints[joint] = row
    return SkeletonFrame(stamp_ns, body_id, name, joints)


@pytest.mark.parametrize(
    "row",
    [
        (9.0, 9.0, 9.0, 0.0),
        (math.nan, 0.0, 2.0, 1.0),
        (0.0, math.inf, 2.0, 1.0),
        (0.0, 0.0, -math.inf, 1.0),
        (0.0, 0.0, 2.0, math.nan),
    ],
)
def test_missing_joint_keeps_its_last_known_position(row: tuple[float, ...]) -> None:
    retargeter = Retargeter()
    retargeter.push(body(0, at=1.0))
    first = retargeter.push(body(33 * MS, {4: row}, at=2.0))
    second = retargeter.push(body(66 * MS, {4: row}, at=3.0))
    back = retargeter.push(body(99 * MS, at=4.0))
    assert first is not None
    assert second is not None
    assert back is not None
    for frame, moved_to in ((first, 2.0), (second, 3.0)):
        assert frame.positions[4].tolist() == [1.0, 4.0, 2.0]
        assert frame.positions[3].tolist() == [moved_to, 3.0, 2.0]
        assert frame.confidence.tolist() == [1, 1, 1, 1, 0, 1, 1, 1, 1]
    assert back.positions[4].tolist() == [4.0, 4.0, 2.0]
    assert back.confidence.tolist() == [1] * 9


def test_nothing_is_given_until_every_joint_has_been_seen() -> None:
    retargeter = Retargeter()
    hidden = (0.0, 0.0, 0.0, 0.0)
    assert retargeter.push(body(0, {5: hidden, 8: hidden}, at=1.0)) is None
    assert retargeter.push(body(40 * MS, {8: hidden}, at=2.0)) is None
    # The last unseen joint comes while another one, seen before, is away.
    core = retargeter.push(body(80 * MS, {5: hidden}, at=3.0))
    assert core is not None
    assert core.positions[5].tolist() == [2.0, 5.0, 2.0]
    assert core.positions[8].tolist() == [3.0, 8.0, 2.0]
    assert core.confidence[[5, 8]].tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    "change",
    [{"body_id": 2}, {"name": "kinect_v2"}, {"stamp_ns": 1_033 * MS + 1}],
    ids=["body", "format", "away for more than a second"],
)
def test_another_source_starts_from_nothing(change: dict[str, object]) -> None:
    retargeter = Retargeter()
    assert retargeter.push(body(33 * MS)) is not None
    hidden = {6: (0.0, 0.0, 0.0, 0.0)}
    settings: dict[str, object] = {"stamp_ns": 66 * MS, **change}
    assert retargeter.push(body(missing=hidden, **settings)) is None  # type: ignore[arg-type]


def test_a_pause_of_a_second_does_not_forget() -> None:
    retargeter = Retargeter()
    retargeter.push(body(0, at=1.0))
    core = retargeter.push(body(1_000 * MS, {6: (0.0, 0.0, 0.0, 0.0)}))
    assert core is not None
    assert core.positions[6].tolist() == [1.0, 6.0, 2.0]


def test_result_is_read_only_and_the_input_untouched() -> None:
    frame = body(0, name="azure_kinect")
    before = frame.joints.copy()
    core = Retargeter().push(frame)
    assert core is not None
    np.testing.assert_array_equal(frame.joints, before)
    with pytest.raises(ValueError, match="read-only"):
        core.positions[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        core.confidence[0] = 1.0


def test_a_mean_of_an_untracked_joint_is_untracked() -> None:
    ears = [FORMATS["blazepose"].names.index(f"{side}_ear") for side in ("left", "right")]
    retargeter = Retargeter()
    seen = retargeter.push(body(0, name="blazepose"))
    lost = retargeter.push(
        body(1, {ears[0]: (math.inf, 0.0, 0.0, 1.0), ears[1]: (1, 1, 1, 1)}, name="blazepose")
    )
    assert seen is not None
    assert lost is not None
    assert lost.confidence.tolist() == [0, 0, 1, 1, 1, 1, 1, 1, 1]
    np.testing.assert_array_equal(lost.positions[:2], seen.positions[:2])


def test_retarget_fills_nothing_in() -> None:
    core = retarget(body(0, {4: (math.nan, 1.0, 2.0, 0.0)}))
    np.testing.assert_array_equal(core[4], [math.nan, 1.0, 2.0, 0.0])


def test_distance_of_a_hidden_navel_is_unknown() -> None:
    assert navel_distance(body(0)) == 2.0
    assert navel_distance(body(0, {2: (0.0, 0.0, 2.0, 0.0)})) == math.inf
    assert navel_distance(body(0, {2: (0.0, 0.0, math.nan, 1.0)})) == math.inf


def test_unknown_format_is_refused() -> None:
    frame = SkeletonFrame(0, 1, "stick_man", np.zeros((3, 4), np.float32))
    with pytest.raises(InvalidInput, match="stick_man"):
        Retargeter().push(frame)
    with pytest.raises(InvalidInput, match="stick_man"):
        navel_distance(frame)
