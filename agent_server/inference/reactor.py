"""The bundle of a generator of reactions: encoder, cached step, and who judges what they make."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.reaction import TrainingRange
from agent_server.errors import BundleError, InferenceError
from agent_server.inference.manifest import ReactionManifest
from agent_server.inference.runtime import GOLDEN_TOLERANCE, OnnxModel, Session
from agent_server.skeleton.pair import JOINT_NAMES

ENCODER_FILE = "encoder.onnx"
QUALITY_FILE = "quality.onnx"


class OnnxReactor(OnnxModel[ReactionManifest]):
    """A bundle that makes one person's reaction to what another one does.

    Args:
        folder: The bundle.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "react", ReactionManifest)

    @property
    def range(self) -> TrainingRange:
        """What it was trained on."""
        return self.manifest.range

    @property
    def rate_hz(self) -> int:
        """Frames a second."""
        return self.manifest.rate_hz

    @property
    def frames(self) -> int:
        """Longest action that it reads."""
        return self.manifest.frames

    @property
    def latent(self) -> int:
        """How many numbers of noise it takes."""
        return self.manifest.latent

    def react(
        self, action: Float32, first: Float32, noise: Float32
    ) -> Iterator[tuple[Float32, float]]:
        """Make a reaction pose by pose, until the action or the reaction is over.

        Args:
            action: Shape (S, 15, 3), metres, in the frame of the pair.
            first: Shape (15, 3), likewise: how the reaction begins, the first pose given.
            noise: Shape (latent,).

        Yields:
            Poses of shape (15, 3), in the same frame; with each, what the quality network holds
            of the reaction up to it, in [0, 1].

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        pose, quality = first, _Quality(self._quality)
        steps = self._steps(action, first, noise, len(action))
        for acting, (following, stop) in zip(action, steps, strict=True):
            yield pose, quality.push(acting, pose)
            if stop > 0:
                return
            pose = following

    def _steps(
        self, action: Float32, first: Float32, noise: Float32, count: int
    ) -> Iterator[tuple[Float32, float]]:
        """The pose after each one, and the logit that there is none."""
        tokens, bias, seen, kind = self._encoder.run(
            action[None], np.array([len(action)], np.int64)
        )
        past, pose, before = seen[..., :0, :], first, first
        for at in range(count):
            beside = min(at, len(action) - 1)
            following, stop, past = self._session.run(
                *(first[None], pose[None], before[None], np.array([at], np.int64)),
                *(noise[None], kind, past),
                *(action[None, beside], tokens[:, beside], bias, seen),
            )
            before, pose = pose, following[0]
            yield pose, float(stop[0])

    def _check(self, folder: Path) -> None:
        reads = (self.manifest.skeleton, len(self.manifest.range.reaction))
        if reads != ("kinect15", len(JOINT_NAMES)):
            raise BundleError(
                f"{folder} reacts with {reads[1]} joints of {reads[0]}, the server needs "
                f"{len(JOINT_NAMES)} of kinect15: name another bundle"
            )
        self._encoder = Session(folder / ENCODER_FILE, self.name)
        self._quality = Session(folder / QUALITY_FILE, self.name)

    def _replay_golden(self, path: Path) -> None:
        try:
            with np.load(path, allow_pickle=False) as golden:
                names = ("action", "lengths", "given", "noise", "reaction", "quality")
                action, lengths, given, noise, expected, qualities = (
                    golden[name] for name in names
                )
        except (OSError, KeyError, ValueError) as error:
            raise BundleError(f"{path} cannot be read: {error}") from error
        worst = 0.0
        try:
            for row, length in enumerate(lengths.tolist()):
                steps = self._steps(
                    action[row, :length], given[row, 0], noise[row], expected.shape[1] - 1
                )
                made = np.stack([given[row, 0], *(pose for pose, _ in steps)])
                worst = max(worst, float(np.abs(made - expected[row]).max()))
                quality = _Quality(self._quality)
                held = [quality.push(*poses) for poses in zip(action[row], made, strict=True)]
                worst = max(worst, float(np.abs(held - qualities[row]).max()))
        except InferenceError as error:
            raise BundleError(
                f"{path}: the model does not run on its golden input: {error}"
            ) from error
        if not worst <= GOLDEN_TOLERANCE:
            raise BundleError(
                f"{path}: the model does not give its golden output: "
                "export it again, or use the onnxruntime it was made with"
            )


class _Quality:
    """What the quality network holds of one reaction: a mean over the frames so far.

    Args:
        network: It.
    """

    def __init__(self, network: Session) -> None:
        self._network = network
        self._first: Float32 | None = None
        self._sum, self._frames = 0.0, 0

    def push(self, acting: Float32, reacting: Float32) -> float:
        """Look at the next pose (15, 3) of both; gives the quality so far, in [0, 1]."""
        pair = np.concatenate([acting, reacting])[None]
        if self._first is None:
            self._first = self._before = pair
            self._hidden = np.zeros(self._network.shapes[-1], np.float32)
        logit, self._hidden = self._network.run(self._first, self._before, pair, self._hidden)
        self._before = pair
        self._sum += float(logit[0])
        self._frames += 1
        return 1 / (1 + math.exp(-self._sum / self._frames))
