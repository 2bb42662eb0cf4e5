"""Configurations of the affect models."""

from dataclasses import dataclass
from typing import Literal, get_args

from agent_server.errors import ConfigError

Source = Literal["mesh", "points68", "blendshapes"]
SOURCES: tuple[Source, ...] = get_args(Source)


@dataclass(frozen=True, slots=True)
class AffectConfig:
    """Shape and training of a model.

    Attributes:
        source: What a face is given as.
        hidden: Units of each hidden layer.
        dropout: Share of units left out in training.
        members: Networks whose estimates are averaged; their spread is part of the uncertainty.
        linear: Share that a linear model (ridge regression) has in the estimate.
        symmetric: Average the estimates of a face and of its mirror image.
        varied: Train on all views of a picture, not only on the picture as it is.
        epochs: Passes through the views.
        batch: Faces an update.
        rate: Highest learning rate, of a cycle up and down.
        weight_decay: Of AdamW.
        noise: Standard deviation of what is added to the standardised features.
        mixup: Parameter of the Beta distribution by which two faces are mixed; 0 mixes none.
    """

    source: Source
    hidden: tuple[int, ...] = (256, 128)
    dropout: float = 0.3
    members: int = 4
    linear: float = 0.3
    symmetric: bool = True
    varied: bool = True
    epochs: int = 12
    batch: int = 128
    rate: float = 3e-3
    weight_decay: float = 1e-2
    noise: float = 0.02
    mixup: float = 0.4

    def __post_init__(self) -> None:
        if self.members < 1:
            raise ConfigError(f"members is {self.members}: at least one network is needed")
        if not 0 <= self.dropout < 1:
            raise ConfigError(f"dropout is {self.dropout}: it lies in 0..1")


def named(name: str, source: Source) -> AffectConfig:
    """The configuration ``name`` for a source.

    ``paper`` is the thesis's network: four dense layers with dropout between them, on landmarks
    as they are seen. It gives no sizes; these are ours.

    Raises:
        ConfigError: If there is none of that name.
    """
    match name:
        case "default":
            return _DEFAULTS[source]
        case "paper":
            return AffectConfig(
                source,
                hidden=(256, 128, 64),
                dropout=0.5,
                members=1,
                linear=0.0,
                symmetric=False,
                varied=False,
                epochs=120,
                rate=1e-3,
                weight_decay=0.0,
                noise=0.0,
                mixup=0.0,
            )
    raise ConfigError(f"there is no configuration {name!r}: choose default or paper")


_DEFAULTS = {
    "mesh": AffectConfig("mesh", epochs=24),
    "points68": AffectConfig("points68", hidden=(384, 192), epochs=14, noise=0.05),
    "blendshapes": AffectConfig("blendshapes", epochs=24, noise=0.05),
}
