"""Configurations of the classifier."""

from dataclasses import dataclass
from typing import Literal

from agent_server.domain.gesture import GESTURES
from agent_server.domain.motion import CLASSIFIED_FRAMES
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.errors import ConfigError
from models.data.windows import Augmentation

AUGMENTATION = Augmentation(yaw=0.35, scale=0.1, noise_m=0.02, drop=0.08)


@dataclass(frozen=True, slots=True)
class NetworkConfig:
    """Shape of the network.

    Attributes:
        frames: Frames in.
        joints: Joints of the skeleton.
        classes: Probabilities out.
        patch: Frames that make one token.
        features: Features of one coordinate of one joint; a token has joints * 3 * features.
        layers: Number of encoder layers.
        heads: Heads of the temporal attention.
        dropout: Share of units left out in training.
        spatial: Attend to joints beside moments; off for an ablation.
        adjacency: A joint attends to itself and its neighbours only; off, to all joints.
    """

    frames: int = CLASSIFIED_FRAMES
    joints: int = CORE_JOINTS
    classes: int = len(GESTURES)
    patch: int = 5
    features: int = 4
    layers: int = 3
    heads: int = 4
    dropout: float = 0.1
    spatial: bool = True
    adjacency: bool = True

    def __post_init__(self) -> None:
        if self.frames % self.patch:
            raise ConfigError(
                f"frames is {self.frames}, which patch {self.patch} does not divide: "
                "choose a divisor"
            )
        if self.width % self.heads:
            raise ConfigError(
                f"a token has {self.width} features, which heads {self.heads} does not divide: "
                "choose a divisor"
            )

    @property
    def tokens(self) -> int:
        """Tokens along time."""
        return self.frames // self.patch

    @property
    def width(self) -> int:
        """Features of a token."""
        return self.joints * 3 * self.features


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How to train.

    Attributes:
        network: Shape of the network.
        futures: What completes the seen second: ``predicted`` frames, the ``true`` ones, or the
            last seen frame ``held``.
        steps: Updates.
        batch: Windows an update.
        learning_rate: Peak rate (AdamW, warm-up, then a cosine to zero).
        weight_decay: Of all weights.
        smoothing: Share of the label that is spread over all classes.
        true_future: Share of windows that end in true frames all the same, and have the label
            of all 3 s.
        last_frame: Share of the others that are completed by the last seen frame, as the server
            does when it has no predictor.
        idle: Share of idle windows in a batch, where idle is a class.
        mixup: Windows are blended with others of the batch, and their labels alike, by shares
            from Beta(mixup, mixup); 0 for none (Zhang et al., ICLR 2018).
        augmentation: How windows are varied.
        ema: Decay of the averaged weights.
        validate_every: Updates between two validations.
        synthetic_sequences: Takes of virtual people to train on.
    """

    network: NetworkConfig = NetworkConfig()
    futures: Literal["predicted", "true", "held"] = "predicted"
    steps: int = 5_000
    batch: int = 64
    learning_rate: float = 1e-3
    weight_decay: float = 0.02
    smoothing: float = 0.02
    true_future: float = 0.3
    last_frame: float = 0.1
    idle: float = 0.65
    mixup: float = 0.0
    augmentation: Augmentation = AUGMENTATION
    ema: float = 0.998
    validate_every: int = 500
    synthetic_sequences: int = 8_000

    def __post_init__(self) -> None:
        for name in ("true_future", "last_frame", "idle"):
            if not 0 <= getattr(self, name) <= 1:
                raise ConfigError(f"{name} is {getattr(self, name)}: a share lies in 0..1")

    @property
    def true_windows(self) -> int:
        """Windows of a batch that end in true frames."""
        shares = {"true": 1.0, "held": 0.0, "predicted": self.true_future}
        return round(self.batch * shares[self.futures])


CONFIGS: dict[str, TrainConfig] = {"server": TrainConfig()}
