"""Configurations of siMLPe."""

from dataclasses import dataclass, replace

from agent_server.errors import ConfigError


@dataclass(frozen=True, slots=True)
class NetworkConfig:
    """Shape of the network.

    Attributes:
        seen: Frames in.
        step: Frames out of one pass; further ones come from feeding them back.
        future: Frames that are asked for.
        coordinates: Numbers a pose.
        blocks: Number of blocks.
    """

    seen: int = 50
    step: int = 10
    future: int = 25
    coordinates: int = 66
    blocks: int = 48

    def __post_init__(self) -> None:
        if not 1 <= self.step <= self.seen:
            raise ConfigError(
                f"step is {self.step}, but a pass over {self.seen} frames gives as many at most: "
                f"choose 1 to {self.seen}"
            )


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How to train.

    Attributes:
        network: Shape of the network.
        data: ``h36m``, ``cmu`` or ``server``: which set, and with it which joints.
        steps: Updates.
        batch: Windows an update.
        learning_rate: The highest rate.
        last_rate: Rate after the drop; without one the rate follows a cosine to zero.
        drop_at: Update at which the rate drops to ``last_rate``.
        weight_decay: As the L2 term of Adam with a drop, decoupled without.
        clip: Largest norm of the gradient; the published recipe has none.
        ema: Decay of the averaged weights, 0 for none.
        half: Multiply in bfloat16, which is exact enough and twice as fast on recent CPUs.
        validate_every: Updates between two validations.
        synthetic_sequences: Takes of virtual people to train on.
    """

    network: NetworkConfig = NetworkConfig()
    data: str = "h36m"
    steps: int = 35_000
    batch: int = 256
    learning_rate: float = 3e-4
    last_rate: float = 1e-5
    drop_at: int | None = 30_000
    weight_decay: float = 1e-4
    clip: float = float("inf")
    ema: float = 0.0
    half: bool = False
    validate_every: int = 1_000
    synthetic_sequences: int = 2_000


CPU = TrainConfig(
    steps=10_000,
    learning_rate=1.5e-3,
    drop_at=None,
    clip=5.0,
    ema=0.998,
    half=True,
    validate_every=500,
)

CONFIGS: dict[str, TrainConfig] = {
    "published": TrainConfig(),
    "cpu": CPU,
    "cmu": replace(CPU, network=NetworkConfig(coordinates=75), data="cmu", steps=3_000),
    "server": replace(
        CPU,
        network=NetworkConfig(seen=25, step=25, future=50, coordinates=27),
        data="server",
        steps=6_000,
    ),
}
