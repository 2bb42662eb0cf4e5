"""Motion as points on spheres, and as tangent vectors at their mean.

After Chopin et al., "Human Motion Prediction Using Manifold-Aware Wasserstein GAN" (FG 2021): the
square-root velocity function (SRVF) of a motion is a point on the unit sphere, and networks work
in the tangent space at the Karcher mean of the training motions. The paper takes the whole body as
one curve. Here every joint may also be a curve of its own, so that a motion is a point on a
product of spheres: a joint that rests then no longer takes its share of another's sphere. The
lengths, which the spheres forget, are kept beside them.
"""

from typing import Literal, NamedTuple

import torch
from torch import nn

from models.ops import sphere, srvf

MOVING_M = 0.02
"""Length of a curve, a joint of the body, at which its direction counts half: the direction of a
curve that hardly moves is noise."""


class Point(NamedTuple):
    """A motion on S spheres.

    Attributes:
        tangent: Shape (B, S, D), at the reference point.
        log_length: Shape (B, S).
        moving: Shape (B, S), in [0, 1]: how much the tangent vector means.
    """

    tangent: torch.Tensor
    log_length: torch.Tensor
    moving: torch.Tensor


class Forecast(NamedTuple):
    """What a generator expects.

    Attributes:
        point: The future on the spheres.
        poses: Shape (B, future, C), metres.
    """

    point: Point
    poses: torch.Tensor


class Target(NamedTuple):
    """What the generator sees and ought to give; everything faces the front if it should.

    Attributes:
        seen: Shape (B, seen, C), metres, as the sensor saw it.
        future: Shape (B, future, C), metres, without sensor noise.
    """

    seen: torch.Tensor
    future: torch.Tensor

    @property
    def start(self) -> torch.Tensor:
        """The last seen pose, (B, 1, C)."""
        return self.seen[:, -1:]

    def curve(self) -> torch.Tensor:
        """The future and the pose that it starts from, (B, future + 1, C)."""
        return torch.cat([self.start, self.future], dim=1)


def curves(poses: torch.Tensor, spheres: Literal["body", "joints"]) -> torch.Tensor:
    """Poses (B, T, C) as one curve for the body, (B, 1, T, C), or a joint each, (B, J, T, 3)."""
    if spheres == "body":
        return poses.unsqueeze(1)
    lines: torch.Tensor = poses.unflatten(2, (-1, 3)).transpose(1, 2)
    return lines


class Spheres(nn.Module):
    """The map between curves and tangent vectors.

    Args:
        reference: Karcher mean, shape (S, D): S unit vectors of ``frames`` steps each.
        frames: Steps of a curve.
        spheres: ``body`` or ``joints``.
        log_clip: The authors' clipping of the cosine in the log map.
    """

    reference: torch.Tensor

    def __init__(
        self,
        reference: torch.Tensor,
        frames: int,
        spheres: Literal["body", "joints"],
        log_clip: float | None = None,
    ) -> None:
        super().__init__()
        self.frames, self.spheres, self.log_clip = frames, spheres, log_clip
        self.register_buffer("reference", reference)

    def encode(self, poses: torch.Tensor, floor: float = srvf.TINY) -> Point:
        """A motion of T + 1 poses (B, T + 1, C), the first of which is where it starts.

        Args:
            poses: Positions in metres.
            floor: Lowest speed in metres a frame, for gradients that stay bounded.
        """
        lines = curves(poses, self.spheres)
        point, length = srvf.steps_to_sphere(lines.diff(dim=2), floor)
        tangent = sphere.log(point.flatten(2), self.reference, self.log_clip)
        joints = lines.shape[-1] // 3
        return Point(tangent, torch.log(length + 1e-3), length / (length + MOVING_M * joints))

    def decode(
        self, tangent: torch.Tensor, log_length: torch.Tensor, start: torch.Tensor
    ) -> torch.Tensor:
        """Tangent (B, S, D), log-length (B, S), first pose (B, C) -> later poses (B, T, C)."""
        point = sphere.exp(tangent, self.reference).unflatten(2, (self.frames, -1))
        first = curves(start.unsqueeze(1), self.spheres)[:, :, 0]
        lines = srvf.from_sphere(point, torch.exp(log_length), first)  # (B, S, T, C / S)
        return lines.transpose(1, 2).flatten(2)

    def project(self, poses: torch.Tensor) -> torch.Tensor:
        """The tangent part of vectors laid out like poses, (B, T, C) -> (B, S, D)."""
        return sphere.project(curves(poses, self.spheres).flatten(2), self.reference)


def karcher_means(poses: torch.Tensor, spheres: Literal["body", "joints"]) -> torch.Tensor:
    """Reference point of motions (N, T + 1, C): the mean of those that move, shape (S, D).

    A joint that never moves gets a steady walk along the diagonal: any point would do.
    """
    point, length = srvf.to_sphere(curves(poses.double(), spheres))
    enough = 10 * MOVING_M * point.shape[-1] / 3
    means = []
    for one, long in zip(point.flatten(2).unbind(1), length.unbind(1), strict=True):
        moving = one[(long >= min(enough, float(long.median()))) & (long > MOVING_M)]
        steady = torch.full_like(one[0], one.shape[1] ** -0.5)
        means.append(sphere.karcher_mean(moving) if len(moving) else steady)
    return torch.stack(means).float()
