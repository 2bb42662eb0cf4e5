"""Configurations of HP-GAN."""

from dataclasses import dataclass, replace

from agent_server.domain.gesture import GESTURES
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
        noise: Numbers of ``z``.
        patch: Frames that a recurrent layer takes, or the decoder gives, in one step.
        width: Units of each recurrent layer of the generator.
        layers: Recurrent layers of encoder and decoder.
        critic_width: Units of each layer of the discriminator.
        critic_layers: Its layers before the two heads.
        judge_width: Units of the quality network.
        classes: Classes that the discriminator's second head tells apart.
    """

    seen: int = SEEN_FRAMES
    future: int = PREDICTED_FRAMES
    joints: int = CORE_JOINTS
    noise: int = 128
    patch: int = 5
    width: int = 128
    layers: int = 2
    critic_width: int = 384
    critic_layers: int = 3
    judge_width: int = 64
    classes: int = len(GESTURES)

    def __post_init__(self) -> None:
        for name in ("noise", "layers", "critic_layers"):
            if getattr(self, name) < 1:
                raise ConfigError(f"{name} is {getattr(self, name)}: choose 1 or more")
        for name in ("seen", "future"):
            if self.patch < 1 or getattr(self, name) % self.patch:
                raise ConfigError(
                    f"patch is {self.patch}, which does not divide {name} = {getattr(self, name)}: "
                    "choose a divisor of both, for example 5"
                )


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How to train.

    Attributes:
        network: Shape of the networks.
        steps: Updates of the generator.
        batch: Windows an update; each gets two futures.
        learning_rate: Peak rate of the generator (Adam, warm-up, then a cosine to zero).
        critic_rate: Rate of the discriminator (Adam).
        critic_steps: Updates of the discriminator for one of the generator.
        judge_rate: Rate of the quality network (Adam).
        adversarial: Weight of the discriminator's score.
        nearest: Weight of how far the nearer of two futures is from the truth, in metres.
        consistency: Weight of the jump at the seam, in metres a frame.
        diversity: Weight of the term that wants two futures of one past apart.
        energy: Weight of the centre of mass's speed and acceleration, in metres a frame.
        bones: Weight of the bone lengths in metres.
        classes: Weight of the class that the discriminator's second head finds.
        penalty: Weight of the gradient penalty.
        ema: Decay of the averaged weights.
        validate_every: Updates between two validations.
        judged_from: Updates before the quality network is trusted to choose a checkpoint.
        synthetic_sequences: Takes of virtual people to train on.
    """

    network: NetworkConfig = NetworkConfig()
    steps: int = 2_000
    batch: int = 32
    learning_rate: float = 6e-4
    critic_rate: float = 1e-3
    critic_steps: int = 5
    judge_rate: float = 5e-4
    adversarial: float = 1.0
    nearest: float = 20.0
    consistency: float = 50.0
    diversity: float = 1.0
    energy: float = 50.0
    bones: float = 100.0
    classes: float = 0.1
    penalty: float = 10.0
    ema: float = 0.998
    validate_every: int = 250
    judged_from: int = 500
    synthetic_sequences: int = 2_000

    def __post_init__(self) -> None:
        if not self.judged_from <= self.steps:
            raise ConfigError(
                f"judged_from is {self.judged_from}, but training ends after {self.steps} updates: "
                "choose fewer, or no checkpoint is ever chosen by the quality network"
            )


SERVER = TrainConfig()
SHORT = replace(SERVER, steps=250, validate_every=125, judged_from=250)

CONFIGS: dict[str, TrainConfig] = {
    "server": SERVER,
    "short": SHORT,
    "short_without_diversity": replace(SHORT, diversity=0.0),
    "short_without_consistency": replace(SHORT, consistency=0.0),
}
