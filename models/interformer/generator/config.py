"""Configurations of the generator of reactions."""

from dataclasses import dataclass, replace

from agent_server.errors import ConfigError
from models.data.interactions import JOINTS


@dataclass(frozen=True, slots=True)
class NetworkConfig:
    """Shape of the network.

    Attributes:
        joints: Joints of a person.
        features: Features of one coordinate of one joint; a token has joints * 3 * features.
        layers: Encoder layers, and as many decoder layers.
        heads: Heads of the temporal attention.
        hidden: Units of the dense network of a layer.
        dropout: Share of units left out in training.
        classes: Kinds of interaction that the encoder tells apart.
        latent: Size of the noise; other noise, another reaction.
        frames: Longest segment: a longer action is reacted to piece by piece.
        spatial: Attend to joints beside moments.
        adjacency: In one person, a joint attends to itself and its neighbours only.
        distance: Joints of the two people that are near attend to each other more.
    """

    joints: int = JOINTS
    features: int = 2
    layers: int = 2
    heads: int = 3
    hidden: int = 180
    dropout: float = 0.05
    classes: int = 6
    latent: int = 4
    frames: int = 64
    spatial: bool = True
    adjacency: bool = True
    distance: bool = True

    def __post_init__(self) -> None:
        if self.width % self.heads:
            raise ConfigError(
                f"a token has {self.width} features, which heads {self.heads} does not divide: "
                "choose a divisor"
            )
        for name in ("adjacency", "distance"):
            if getattr(self, name) and not self.spatial:
                raise ConfigError(f"{name} is part of the spatial attention: set spatial, too")

    @property
    def width(self) -> int:
        """Features of a token."""
        return self.joints * 3 * self.features


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How to train.

    Attributes:
        network: Shape of the network.
        data: ``sbu`` or ``k3hi``.
        steps: Updates.
        batch: Interactions an update.
        learning_rate: Peak rate (AdamW, warm-up, then a cosine to zero).
        weight_decay: Of all weights.
        uses: Updates on a batch. In a random share of frames, all for half of the interactions,
            the decoder is given what it made in the update before instead of the true pose; in
            the first one, the pose in which the reaction begins.
        noise_m: Deviation of what a pose that is given is shifted by, metres.
        scale: Largest change of size.
        swap: Let the people change places where both do alike.
        velocity: Weight of the errors of steps.
        first: Weight of the error of the first step.
        bones: Weight of the errors of bone lengths.
        stop: Weight of the errors of the end.
        kind: Weight of the errors of the kind that the encoder takes an action for.
        divergence: Weight that holds the noise to a normal distribution.
        ema: Decay of the averaged weights.
        validate_every: Updates between two validations.
    """

    network: NetworkConfig = NetworkConfig()
    data: str = "sbu"
    steps: int = 1500
    batch: int = 16
    learning_rate: float = 2e-3
    weight_decay: float = 0.02
    uses: int = 2
    noise_m: float = 0.01
    scale: float = 0.1
    swap: bool = True
    velocity: float = 1.0
    first: float = 1.0
    bones: float = 1.0
    stop: float = 0.004
    kind: float = 0.01
    divergence: float = 0.001
    ema: float = 0.98
    validate_every: int = 100

    def __post_init__(self) -> None:
        if self.uses < 1:
            raise ConfigError(f"uses is {self.uses}: a batch is used once at least")


K3HI = NetworkConfig(classes=8)
PAPER = NetworkConfig(features=1, layers=6, heads=3, hidden=2048)
"""The published shape: tokens of 45 numbers, six layers, three heads."""

CONFIGS: dict[str, TrainConfig] = {
    "sbu": TrainConfig(),
    "k3hi": TrainConfig(network=K3HI, data="k3hi"),
    "paper": TrainConfig(network=PAPER),
    "paper_k3hi": TrainConfig(network=replace(PAPER, classes=8), data="k3hi"),
}

ABLATIONS = {
    "S1": {"spatial": False, "adjacency": False, "distance": False},
    "S2": {"spatial": True, "adjacency": False, "distance": False},
    "S3": {"spatial": True, "adjacency": True, "distance": False},
    "S4": {"spatial": True, "adjacency": True, "distance": True},
}
"""The paper's rows: a plain transformer, + spatial attention, + adjacency, + distance."""


def ablated(config: TrainConfig, row: str) -> TrainConfig:
    """A configuration with the attention of one of :data:`ABLATIONS`."""
    return replace(config, network=replace(config.network, **ABLATIONS[row]))
