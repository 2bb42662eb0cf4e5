"""What the stages need of a model. The real ones run on onnxruntime; tests bring small fakes."""

from collections.abc import Iterator
from typing import Protocol

from agent_server.domain.arrays import Float32
from agent_server.domain.reaction import TrainingRange


class Model(Protocol):
    """A model with a name and the hash of its weights."""

    @property
    def name(self) -> str:
        """Name of the bundle."""
        ...

    @property
    def sha256(self) -> str:
        """SHA-256 of the model file in hexadecimal."""
        ...


class Predictor(Model, Protocol):
    """Continues a motion."""

    def predict(self, seen: Float32) -> Float32:
        """Predict two seconds.

        Args:
            seen: Shape (B, 25, 9, 3), normalised.

        Returns:
            Shape (B, 50, 9, 3), in the same frame.

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...


class Sampler(Model, Protocol):
    """Draws several futures of a motion, always the same ones for the same motion."""

    def draw(self, seen: Float32, count: int) -> tuple[Float32, Float32]:
        """Draw futures of one window.

        Args:
            seen: Shape (25, 9, 3), normalised.
            count: How many, K.

        Returns:
            Futures, shape (K, 50, 9, 3), in the same frame, and how probably each is a real
            motion, shape (K,), in [0, 1].

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...


class Reactor(Model, Protocol):
    """Makes one person's reaction to what another one does, pose by pose."""

    @property
    def range(self) -> TrainingRange:
        """What it was trained on."""
        ...

    @property
    def rate_hz(self) -> int:
        """Frames a second."""
        ...

    @property
    def frames(self) -> int:
        """Longest action that it reads."""
        ...

    @property
    def latent(self) -> int:
        """How many numbers of noise it takes."""
        ...

    def react(
        self, action: Float32, first: Float32, noise: Float32
    ) -> Iterator[tuple[Float32, float]]:
        """Make a reaction until the action or the reaction is over.

        Args:
            action: Shape (S, 15, 3), metres, in the frame of the pair.
            first: Shape (15, 3), likewise: how the reaction begins, the first pose given.
            noise: Shape (latent,).

        Yields:
            Poses of shape (15, 3), in the same frame; with each, what the quality network holds
            of the reaction up to it, in [0, 1]: above 0.5 it is rather a recorded one to such an
            action than none.

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...


class Classifier(Model, Protocol):
    """Names a motion."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Class names in output order; ``idle`` is one of them."""
        ...

    def classify(self, motion: Float32) -> Float32:
        """Give class probabilities.

        Args:
            motion: Shape (B, 75, 9, 3), normalised.

        Returns:
            Shape (B, C), rows that sum to 1.

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...


class AffectModel(Model, Protocol):
    """Estimates valence and arousal from one kind of face features."""

    def estimate(self, features: Float32) -> Float32:
        """Estimate affect with its uncertainty.

        Args:
            features: Shape (B, D), as :mod:`agent_server.face.features` makes them.

        Returns:
            Shape (B, 4): valence, arousal and their standard deviations, on [-1, 1].

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...


class FaceNetwork(Model, Protocol):
    """One network of the face pipeline: named arrays out for one array in."""

    @property
    def input_shape(self) -> tuple[int, ...]:
        """Shape of its input: images (1, height, width, 3), or points (1, N, 2)."""
        ...

    def run(self, given: Float32) -> dict[str, Float32]:
        """Run the network.

        Args:
            given: An image of RGB pixels in the network's range, or points.

        Returns:
            Output name -> array.

        Raises:
            InferenceError: If the model fails or gives something that is not finite.
        """
        ...
