"""Configurations of the predictor."""

from dataclasses import dataclass

from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.errors import ConfigError


@dataclass(frozen=True, slots=True)
class NetworkConfig:
    """Shape of the networks.

    Attributes:
        seen: Frames in.
        future: Frames out.
        joints: Joints of the skeleton.
        channels: Width of the mixer.
        blocks: Number of mixer blocks.
        coefficients: Lowest DCT coefficients of the future that the mixer gives.
        critic_channels: Width of the critic.
    """

    seen: int = SEEN_FRAMES
    future: int = PREDICTED_FRAMES
    joints: int = CORE_JOINTS
    channels: int = 128
    blocks: int = 8
    coefficients: int = 25
    critic_channels: int = 64

    def __post_init__(self) -> None:
        if not 1 <= self.coefficients <= self.future:
            raise ConfigError(
                f"coefficients is {self.coefficients}, but {self.future} future frames have only "
                f"as many: choose 1 to {self.future}"
            )


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How to train.

    The papers give adversarial, reconstruction, skeleton and bone terms the weights 1, 1, 10
    and 10 on sums over a window in their units; here the terms are means in metres, and the
    critic's weight is smaller to match.

    Attributes:
        network: Shape of the networks.
        steps: Updates of the generator.
        batch: Windows an update.
        learning_rate: Peak rate of the generator (AdamW, warm-up, then a cosine to zero).
        critic_rate: Rate of the critic (Adam).
        weight_decay: Of the generator.
        adversarial: Weight of the critic's term.
        reconstruction: Weight of the L1 distance in the tangent space, summed over the
            coordinates and averaged over the frames.
        skeleton: Weight of the Gram-matrix distance in square metres.
        bones: Weight of the bone lengths in metres.
        length: Weight of the logarithm of the curve's length; not in the paper.
        position: Weight of the joints' distance in metres; not in the paper.
        velocity: Weight of the distance of the steps in metres a frame; not in the paper.
        penalty: Weight of the gradient penalty.
        ema: Decay of the averaged weights.
        validate_every: Updates between two validations.
        synthetic_sequences: Takes of virtual people to train on.
    """

    network: NetworkConfig = NetworkConfig()
    steps: int = 4_000
    batch: int = 96
    learning_rate: float = 1e-3
    critic_rate: float = 2e-4
    weight_decay: float = 1e-4
    adversarial: float = 0.05
    reconstruction: float = 1.0
    skeleton: float = 10.0
    bones: float = 10.0
    length: float = 0.1
    position: float = 20.0
    velocity: float = 50.0
    penalty: float = 10.0
    ema: float = 0.998
    validate_every: int = 500
    synthetic_sequences: int = 2_000


CONFIGS: dict[str, TrainConfig] = {"server": TrainConfig()}
