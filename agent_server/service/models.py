"""The models that a server runs, shared by all its sessions."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from agent_server.domain.model import (
    AffectModel,
    Classifier,
    FaceNetwork,
    Model,
    Predictor,
    Reactor,
    Sampler,
)


@dataclass(frozen=True, slots=True)
class FaceNetworks:
    """What finds a face and its landmarks in an image."""

    detector: FaceNetwork
    mesh: FaceNetwork


@dataclass(frozen=True, slots=True)
class Drawing:
    """How several futures are drawn.

    Attributes:
        sampler: Draws them.
        count: Futures of a window, the forecast among them: 2 or more.
        least_quality: Drawn futures that are less probably real are left out.
    """

    sampler: Sampler
    count: int
    least_quality: float


@dataclass(frozen=True, slots=True)
class Models:
    """The models in use.

    Attributes:
        predictor: Continues a motion.
        classifier: Names it.
        affect: What a face is given as (``mesh``, ``points68``, ``blendshapes``) -> its model.
        face: Networks for images, or None where images are not taken.
        drawing: How futures are drawn beside the forecast, or None where it is alone.
        reactor: Makes reactions for rules that ask for it, or None.
    """

    predictor: Predictor
    classifier: Classifier
    affect: Mapping[str, AffectModel] = field(default_factory=dict)
    face: FaceNetworks | None = None
    drawing: Drawing | None = None
    reactor: Reactor | None = None

    @property
    def by_task(self) -> tuple[tuple[str, Model], ...]:
        """Every model with what it is for."""
        faces: tuple[tuple[str, Model], ...] = ()
        if self.face is not None:
            faces = (("face", self.face.detector), ("face", self.face.mesh))
        drawing: tuple[tuple[str, Model], ...] = ()
        if self.drawing is not None:
            drawing = (("futures", self.drawing.sampler),)
        reactor: tuple[tuple[str, Model], ...] = ()
        if self.reactor is not None:
            reactor = (("react", self.reactor),)
        return (
            ("predict", self.predictor),
            *drawing,
            ("classify", self.classifier),
            *(("affect", model) for model in self.affect.values()),
            *faces,
            *reactor,
        )

    @property
    def hashes(self) -> dict[str, str]:
        """Bundle name -> first 12 hexadecimal digits of the model's hash."""
        return {model.name: model.sha256[:12] for _, model in self.by_task}
