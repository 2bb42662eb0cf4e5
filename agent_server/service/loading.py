"""Models and room of a server, as its settings name them."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Literal

from agent_server import assets
from agent_server.config import Settings
from agent_server.errors import BundleError, RuleError
from agent_server.inference.reactor import OnnxReactor
from agent_server.inference.runtime import (
    OnnxAffect,
    OnnxClassifier,
    OnnxFaceNetwork,
    OnnxPredictor,
    OnnxSampler,
)
from agent_server.scene.rulebook import Rules
from agent_server.scene.rules import default_rules, load_rules
from agent_server.service.models import Drawing, FaceNetworks, Models

PREDICTOR = "ma_wgan_server"
CLASSIFIER = "interformer_server"
SAMPLER = "sampler_server"
DETECTOR = "face_detector"
MESHES = {"full": "face_mesh", "fast": "face_mesh_fast"}
AFFECT_SOURCES = ("mesh", "points68", "blendshapes")

Swappable = Literal["predictor", "classifier", "sampler", "reactions"]
"""A model that the settings may name, and that may be changed while the server runs."""


def bundle_folders(settings: Settings) -> dict[Swappable, Path]:
    """Where each model in use is read from, of those that the settings may name."""
    chosen, shipped = settings.models, assets.bundles()
    folders: dict[Swappable, Path] = {
        "predictor": Path(chosen.predictor or shipped / PREDICTOR),
        "classifier": Path(chosen.classifier or shipped / CLASSIFIER),
    }
    if chosen.futures > 1:
        folders["sampler"] = Path(chosen.sampler or shipped / SAMPLER)
    if chosen.reactions is not None:
        folders["reactions"] = Path(chosen.reactions)
    return folders


def load_models(settings: Settings | None = None) -> Models:
    """Load and check the bundles that the server uses.

    Args:
        settings: They may name other bundles than those that ship.

    Raises:
        BundleError: If a bundle is missing, altered or wrong.
    """
    shipped = assets.bundles()
    settings = settings or Settings()
    mesh = MESHES[settings.face.mesh]
    chosen, folders = settings.models, bundle_folders(settings)
    drawing = None
    if "sampler" in folders:
        sampler = OnnxSampler(folders["sampler"], chosen.futures - 1)
        drawing = Drawing(sampler, chosen.futures, chosen.futures_quality)
    return Models(
        OnnxPredictor(folders["predictor"]),
        OnnxClassifier(folders["classifier"]),
        {source: OnnxAffect(shipped / f"affect_{source}", source) for source in AFFECT_SOURCES},
        FaceNetworks(
            OnnxFaceNetwork(shipped / DETECTOR, "detector"), OnnxFaceNetwork(shipped / mesh, "mesh")
        ),
        drawing,
        OnnxReactor(folders["reactions"]) if "reactions" in folders else None,
    )


def exchanged(models: Models, folders: Mapping[Swappable, Path]) -> Models:
    """Models of which some are read anew from the folders given.

    Raises:
        BundleError: If a bundle is not good, or of a model that is not in use.
    """
    try:
        for which, folder in folders.items():
            models = _EXCHANGES[which](models, folder)
    except OSError as error:
        raise BundleError(f"a bundle cannot be read: {error}") from error
    return models


def _sampler_exchanged(models: Models, folder: Path) -> Models:
    drawing = models.drawing
    if drawing is None:
        raise BundleError(
            "this server draws no futures: set futures in [models] and start the server anew"
        )
    return replace(models, drawing=replace(drawing, sampler=OnnxSampler(folder, drawing.count - 1)))


def _reactor_exchanged(models: Models, folder: Path) -> Models:
    if models.reactor is None:
        raise BundleError(
            "this server makes no reactions: name a bundle, reactions in [models], and start the "
            "server anew"
        )
    return replace(models, reactor=OnnxReactor(folder))


_EXCHANGES: dict[Swappable, Callable[[Models, Path], Models]] = {
    "predictor": lambda models, folder: replace(models, predictor=OnnxPredictor(folder)),
    "classifier": lambda models, folder: replace(models, classifier=OnnxClassifier(folder)),
    "sampler": _sampler_exchanged,
    "reactions": _reactor_exchanged,
}


def rule_file(settings: Settings) -> Traversable:
    """The room's rules as a file."""
    if settings.rules is not None:
        return Path(settings.rules)
    return resources.files("agent_server.scene") / "room.toml"


def load_room(settings: Settings, models: Models) -> Rules:
    """Read the room's rules for the gestures that the classifier knows.

    Raises:
        RuleError: If the rule file is wrong, a rule asks for a generated motion and no model
            makes one, or there is no file and the room that ships reacts to gestures that the
            classifier does not know.
    """
    known = models.classifier.labels
    if settings.rules is not None:
        generates = models.reactor is not None
        return load_rules(Path(settings.rules), known, generates=generates)
    try:
        return default_rules(known)
    except RuleError as error:
        raise RuleError(
            f"the room that ships does not go with the classifier {models.classifier.name} "
            f"({error}): copy {rule_file(settings)}, leave rules for the known gestures alone in "
            "it, add some for the new ones, and name the copy with --rules FILE, or with "
            "rules = 'FILE' in the settings"
        ) from error
