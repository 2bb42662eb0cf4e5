"""Reactions varied for their judges: what changes, and what may not."""

import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from models.data.interactions import SBU, TORSO, Pairs  # noqa: E402
from models.data.layouts import KINECT15  # noqa: E402
from models.evaluation.varied import LEAST_FRAMES, vary_bodies, vary_pace  # noqa: E402
from tests.support.interactions import interactions  # noqa: E402


def generator() -> torch.Generator:
    return torch.Generator().manual_seed(0)


def pairs() -> Pairs:
    return Pairs.of(interactions(8), SBU.labels)


def bone_lengths(motion: torch.Tensor) -> torch.Tensor:
    bones = torch.tensor(KINECT15.bones)
    return (motion[:, :, bones[:, 0]] - motion[:, :, bones[:, 1]]).norm(dim=-1)


def test_a_turn_keeps_bones_heights_and_where_the_torso_begins() -> None:
    motion = pairs().reaction
    turned = vary_bodies(motion, generator(), limbs=0.0, turn=1.0)
    assert (turned - motion).abs().max() > 0.05
    torch.testing.assert_close(bone_lengths(turned), bone_lengths(motion))
    torch.testing.assert_close(turned[..., 1], motion[..., 1])
    torch.testing.assert_close(turned[:, 0, TORSO], motion[:, 0, TORSO])


def test_other_limbs_are_as_long_in_all_frames() -> None:
    motion = pairs().reaction
    ratio = bone_lengths(vary_bodies(motion, generator(), 0.1, 0.0)) / bone_lengths(motion)
    assert (ratio - 1).abs().max() > 0.05
    torch.testing.assert_close(ratio, ratio[:, :1].expand_as(ratio))


def test_no_variation_is_none() -> None:
    some = pairs()
    torch.testing.assert_close(vary_bodies(some.reaction, generator(), 0.0, 0.0), some.reaction)
    motion, lengths = vary_pace(some.reaction, some.lengths, generator(), 0.0)
    assert torch.equal(lengths, some.lengths)
    torch.testing.assert_close(motion, some.reaction)


def test_another_pace_begins_and_ends_alike() -> None:
    some = pairs()
    motion, lengths = vary_pace(some.reaction, some.lengths, generator(), 0.4)
    assert not torch.equal(lengths, some.lengths)
    assert motion.shape == some.reaction.shape
    assert int(lengths.min()) >= LEAST_FRAMES and int(lengths.max()) <= motion.shape[1]
    torch.testing.assert_close(motion[:, 0], some.reaction[:, 0])
    for row, length in enumerate(lengths.tolist()):
        end = some.reaction[row, -1].expand_as(motion[row, length - 1 :])
        torch.testing.assert_close(motion[row, length - 1 :], end)
