"""Configurations of the predictor."""

from dataclasses import dataclass, replace
from typing import Literal

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
        family: ``mixer``, or the ``convolutions`` of the paper.
        spheres: One SRVF for the whole ``body``, as in the paper, or one for each of the
            ``joints``: a product of spheres.
        output: What the mixer gives: a ``tangent`` vector, or the ``curve`` itself, so that the
            sphere is where the losses and the critic look at it.
        length: Predict the curves' lengths, which the sphere forgets. Off, the future is as
            long as the past was in the same time.
        front: Turn the body to the front inside the network.
        flip: Once trained, average each future with that of the mirrored body.
        noise: Size of the noise that several futures are drawn with, 0 for none.
        channels: Width of the mixer, or of the first convolution.
        blocks: Number of mixer blocks.
        coefficients: Lowest DCT coefficients of the future that the mixer gives.
        dropout: Share of the mixer's hidden channels that training leaves out.
        critic_channels: Width of the critic.
        critic_poses: Show the critic the poses beside the tangent vectors.
        log_clip: The authors' clipping of the cosine in the log map at 0.98; None for none.
    """

    seen: int = SEEN_FRAMES
    future: int = PREDICTED_FRAMES
    joints: int = CORE_JOINTS
    family: Literal["mixer", "convolutions"] = "mixer"
    spheres: Literal["body", "joints"] = "joints"
    output: Literal["tangent", "curve"] = "tangent"
    length: bool = True
    front: bool = True
    flip: bool = False
    noise: int = 0
    channels: int = 128
    blocks: int = 8
    coefficients: int = 25
    dropout: float = 0.0
    critic_channels: int = 64
    critic_poses: bool = True
    log_clip: float | None = None

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
        data: ``server`` (synthetic people and CMU, nine joints), ``h36m`` or ``cmu``.
        steps: Updates of the generator.
        batch: Windows an update.
        learning_rate: Peak rate of the generator (AdamW, warm-up, then a cosine to zero).
        critic_rate: Rate of the critic (Adam).
        weight_decay: Of the generator.
        adversarial: Weight of the critic's term; 0 leaves the critic out.
        reconstruction: Weight of the L1 distance in the tangent space, averaged over spheres
            and frames.
        skeleton: Weight of the Gram-matrix distance in square metres.
        bones: Weight of the bone lengths in metres.
        length: Weight of the logarithm of the curves' lengths; not in the paper.
        position: Weight of the joints' distance in metres; not in the paper.
        velocity: Weight of the distance of the steps in metres a frame; not in the paper.
        spread: Weight of the distance between drawn futures, where there is noise; not in the
            paper.
        near: Position and velocity of the t-th future frame weigh t to the power of minus this,
            so that the small errors of the first frames count beside the large ones of the last.
        penalty: Weight of the gradient penalty.
        ema: Decay of the averaged weights.
        half: Multiply in bfloat16 while training.
        validate_every: Updates between two validations.
        synthetic_sequences: Takes of virtual people to train on.
    """

    network: NetworkConfig = NetworkConfig()
    data: Literal["server", "h36m", "cmu"] = "server"
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
    spread: float = 10.0
    near: float = 0.0
    penalty: float = 10.0
    ema: float = 0.998
    half: bool = True
    validate_every: int = 500
    synthetic_sequences: int = 2_000


SERVER = TrainConfig(
    network=NetworkConfig(output="curve"),
    steps=10_000,
    batch=128,
    learning_rate=2.5e-3,
    adversarial=0.01,
    reconstruction=0.05,
    skeleton=1.0,
    bones=1.0,
    length=0.01,
    velocity=20.0,
    near=0.5,
    ema=0.999,
)

BEST = replace(
    SERVER,
    network=NetworkConfig(
        seen=50,
        future=25,
        joints=22,
        output="curve",
        front=False,
        flip=True,
        blocks=12,
        dropout=0.1,
    ),
    data="h36m",
    steps=9_000,
    weight_decay=0.05,
)

PAPER = TrainConfig(
    network=NetworkConfig(
        seen=50,
        future=25,
        joints=22,
        family="convolutions",
        spheres="body",
        length=False,
        front=False,
        channels=512,
        log_clip=0.98,
    ),
    data="h36m",
    steps=30_000,
    batch=64,
    learning_rate=1e-4,
    critic_rate=1e-4,
    weight_decay=0.0,
    adversarial=1.0,
    reconstruction=1.0,
    skeleton=10.0,
    bones=10.0,
    length=0.0,
    position=0.0,
    velocity=0.0,
    ema=0.999,
    half=False,
)

CONFIGS: dict[str, TrainConfig] = {
    "server": SERVER,
    "server_noise": replace(
        SERVER, network=replace(SERVER.network, noise=16), steps=2_000, batch=64, validate_every=100
    ),
    "best": BEST,
    "best_plain": replace(
        BEST,
        network=replace(BEST.network, dropout=0.0),
        steps=15_000,
        weight_decay=1e-4,
    ),
    "best_near": replace(BEST, network=replace(BEST.network, dropout=0.0), steps=4_500, near=1.0),
    "best_nearer": replace(BEST, network=replace(BEST.network, dropout=0.0), steps=3_000, near=1.5),
    "best_cmu": replace(BEST, network=replace(BEST.network, joints=25), data="cmu"),
    "paper": PAPER,
    "paper_quarter": replace(
        PAPER, network=replace(PAPER.network, channels=128, critic_channels=16), steps=6_000
    ),
}
