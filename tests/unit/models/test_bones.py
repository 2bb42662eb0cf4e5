"""Bones that keep their length."""

import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.skeleton import CORE_BONES, CORE_JOINTS, CoreJoint  # noqa: E402
from models.ops.bones import with_lengths  # noqa: E402
from models.ops.losses import bone_lengths  # noqa: E402


def random_poses(*shape: int) -> torch.Tensor:
    return torch.randn(*shape, CORE_JOINTS, 3, generator=torch.Generator().manual_seed(0))


def test_bones_get_their_length_and_keep_their_direction_and_root() -> None:
    poses = random_poses(2, 7)
    wanted = torch.linspace(0.1, 0.4, 2 * len(CORE_BONES)).view(2, 1, -1)
    fixed = with_lengths(poses, wanted, CORE_BONES)
    torch.testing.assert_close(bone_lengths(fixed, CORE_BONES), wanted.expand(2, 7, -1))
    torch.testing.assert_close(fixed[..., CoreJoint.NAVEL, :], poses[..., CoreJoint.NAVEL, :])
    for parent, child in CORE_BONES:
        lines = [motion[..., child, :] - motion[..., parent, :] for motion in (poses, fixed)]
        alike = torch.nn.functional.cosine_similarity(*lines, dim=-1)
        torch.testing.assert_close(alike, torch.ones(2, 7))


def test_poses_whose_bones_are_right_stay_as_they_are() -> None:
    poses = random_poses(3)
    same = with_lengths(poses, bone_lengths(poses, CORE_BONES), CORE_BONES)
    torch.testing.assert_close(same, poses)


def test_a_bone_of_no_length_stays_finite_and_so_does_its_gradient() -> None:
    poses = torch.zeros(CORE_JOINTS, 3, requires_grad=True)
    with_lengths(poses, torch.ones(len(CORE_BONES)), CORE_BONES).sum().backward()
    assert torch.isfinite(poses.grad).all()
