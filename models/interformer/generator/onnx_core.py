"""An exported generator, run the way a real-time program would: one thread."""

from pathlib import Path

import torch

from agent_server.inference.manifest import MODEL_FILE, ReactionManifest, read_manifest
from models.interformer.generator.generate import Read, Told
from models.ops.session import open_session

ENCODER_FILE = "encoder.onnx"
ENCODE_INPUTS = ("action", "lengths")
STEP_INPUTS = (
    *("first", "pose", "before", "at", "noise", "kind", "past"),
    *("action_pose", "action_token", "action_bias", "action_seen"),
)


class OnnxCore:
    """The two files of a bundle as a core.

    Args:
        encoder: File of the encoder.
        step: File of one step of the decoder.
    """

    def __init__(self, encoder: Path, step: Path) -> None:
        self._encoder, self._step = open_session(encoder), open_session(step)

    @classmethod
    def of(cls, bundle: Path) -> tuple["OnnxCore", ReactionManifest]:
        """A bundle that is whole, and its manifest.

        Raises:
            BundleError: If it is not whole, or no generator of reactions.
        """
        manifest = read_manifest(bundle, ReactionManifest)
        return cls(bundle / ENCODER_FILE, bundle / MODEL_FILE), manifest

    def encode(self, action: torch.Tensor, lengths: torch.Tensor) -> Read:
        """Read actions (B, S, J, 3) of ``lengths`` (B,) frames."""
        values = zip(ENCODE_INPUTS, (action, lengths), strict=True)
        outputs = self._encoder.run(None, {name: value.numpy() for name, value in values})
        return Read(*map(torch.from_numpy, outputs))

    def step(
        self,
        first: torch.Tensor,
        pose: torch.Tensor,
        before: torch.Tensor,
        at: torch.Tensor,
        noise: torch.Tensor,
        kind: torch.Tensor,
        past: torch.Tensor,
        action_pose: torch.Tensor,
        action_token: torch.Tensor,
        action_bias: torch.Tensor,
        action_seen: torch.Tensor,
    ) -> Told:
        """Give the next pose; see :class:`models.interformer.generator.generate.Step`."""
        given = (
            *(first, pose, before, at, noise, kind, past),
            *(action_pose, action_token, action_bias, action_seen),
        )
        values = zip(STEP_INPUTS, given, strict=True)
        outputs = self._step.run(None, {name: value.numpy() for name, value in values})
        return Told(*map(torch.from_numpy, outputs))
