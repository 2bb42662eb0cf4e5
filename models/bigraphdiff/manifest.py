"""The manifest of a generator of interactions."""

from typing import Literal

from agent_server.inference.manifest import Manifest, SkeletonName, Training

NORMALISER_FILE = "normaliser.npz"
"""``mean`` and ``deviation`` of joints as the denoiser sees them, each (2, 15, 3), metres."""


class InteractionManifest(Manifest, frozen=True):
    """What ``manifest.json`` holds; ``normaliser.npz`` is a file beside ``model.onnx``.

    Attributes:
        task: ``interact`` (a label -> the motion of two people).
        skeleton: Joints of both people.
        rate_hz: Frames a second.
        frames: Longest piece.
        steps: Steps of the diffusion.
        drawn_steps: How many of them a draw takes.
        labels: What the people can do.
        lengths: For each label how many frames nine of ten training interactions have at least,
            and at most.
        training: How it was made.
    """

    task: Literal["interact"]
    skeleton: SkeletonName
    rate_hz: int
    frames: int
    steps: int
    drawn_steps: int
    labels: list[str]
    lengths: dict[str, tuple[int, int]]
    training: Training
