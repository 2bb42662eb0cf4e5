"""The models that a server runs, shared by all its sessions."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from agent_server.domain.model import AffectModel, Classifier, FaceNetwork, Model, Predictor


@dataclass(frozen=True, slots=True)
class FaceNetworks:
    """What finds a face and its landmarks in an image."""

    detector: FaceNetwork
    mesh: FaceNetwork


@dataclass(frozen=True, slots=True)
class Models:
    """The models in use.

    Attributes:
        predictor: Continues a motion.
        classifier: Names it.
        affect: What a face is given as (``mesh``, ``points68``, ``blendshapes``) -> its model.
        face: Networks for images, or None where images are not taken.
    """

    predictor: Predictor
    classifier: Classifier
    affect: Mapping[str, AffectModel] = field(default_factory=dict)
    face: FaceNetworks | None = None

    @property
    def by_task(self) -> tuple[tuple[str, Model], ...]:
        """Every model with what it is for."""
        faces: tuple[tuple[str, Model], ...] = ()
        if self.face is not None:
            faces = (("face", self.face.detector), ("face", self.face.mesh))
        return (
            ("predict", self.predictor),
            ("classify", self.classifier),
            *(("affect", model) for model in self.affect.values()),
            *faces,
        )

    @property
    def hashes(self) -> dict[str, str]:
        """Bundle name -> first 12 hexadecimal digits of the model's hash."""
        return {model.name: model.sha256[:12] for _, model in self.by_task}
