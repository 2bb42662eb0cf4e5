"""From somebody's own recordings to the bundle of a classifier that knows their gestures."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import torch

from agent_server.domain.gesture import DISCOMFORTS, HELLO, IDLE
from agent_server.errors import InvalidInput
from agent_server.inference.manifest import DataSource, MotionManifest, read_manifest
from agent_server.synthetic.corpus import subject_names
from models.data import synthetic
from models.data.labelled import GestureSet, check_repetitions
from models.data.splits import HELD_OUT, synthetic_split
from models.data.streams import idle_streams
from models.data.windows import AMBIGUOUS, JUDGED, TRAINED, Recording, WindowSet, cut, join
from models.evaluation.gesture_measures import GestureMeasures, figures_of, measure
from models.evaluation.gestures import false_reactions, labelled_windows
from models.evaluation.latency import latency_ms
from models.evaluation.readings import READINGS
from models.evaluation.rows import Bundled
from models.export.bundle import Export, write_bundle
from models.export.calibration import fit_temperature
from models.export.restore import restore_classifier
from models.export.taught_card import taught_card
from models.interformer.config import NetworkConfig, TrainConfig
from models.interformer.network import Calibrated, Classifier
from models.interformer.train import load_classifier, train, window_logits
from models.ops.session import OnnxModel
from models.training.run import Run

BUILT_IN = (*DISCOMFORTS, HELLO)
TAKES = 1_500
"""Takes of virtual people that keep the built-in gestures and the idle actions known."""
SYNTHETIC_STRIDE = 4
STRIDE = 5
IDLE_MINUTES = 10
IDLE_SEED = 902
LICENCE = "that of the recordings it was trained on"
CONFIG = TrainConfig(steps=2_500, idle=0.5, validate_every=250)
FROZEN_STEPS = 1_500
CARRIED = (*READINGS, "decisions", "idle_synthetic")
"""What the manifest holds of the figures."""


@dataclass(frozen=True, slots=True)
class People:
    """Who teaches, who chooses the checkpoint, and who tests; the last two may be one."""

    train: tuple[str, ...]
    validation: str
    test: str


@dataclass(frozen=True, slots=True)
class Lesson:
    """How to teach.

    Attributes:
        out: Folder of the bundle.
        start: Bundle of the classifier whose encoder a frozen lesson keeps.
        predictor: Bundle whose predictor completes the windows.
        encoder: ``fresh`` trains all weights anew, ``frozen`` the head alone.
        only: Leave out the built-in gestures.
        held_out: The person who tests; None takes the last by name.
        steps: Updates; None for as many as the encoder needs.
        seed: Of everything random.
        cache: Folder where generated recordings are kept.
    """

    out: Path
    start: Path
    predictor: Path
    cache: Path
    encoder: Literal["fresh", "frozen"] = "fresh"
    only: bool = False
    held_out: str | None = None
    steps: int | None = None
    seed: int = 0

    def config(self, classes: int) -> TrainConfig:
        """The training's configuration."""
        steps = self.steps or (FROZEN_STEPS if self.encoder == "frozen" else CONFIG.steps)
        return replace(
            CONFIG,
            network=NetworkConfig(classes=classes),
            steps=steps,
            validate_every=min(CONFIG.validate_every, steps),
        )

    def command(self) -> str:
        """What to type for the same again; folders are left to the reader."""
        extra = " --only" if self.only else ""
        extra += f" --held-out {self.held_out}" if self.held_out else ""
        return (
            f"agent-server gestures train DIR --out BUNDLE --encoder {self.encoder}{extra}"
            f" --seed {self.seed}"
        )


def choose_people(subjects: Sequence[str], held_out: str | None) -> People:
    """Who does what.

    Raises:
        InvalidInput: If there is one person only, or the one held out is not there.
    """
    if len(subjects) < 2:
        raise InvalidInput(
            f"the recordings show {' and '.join(subjects) or 'nobody'} only, and whether a gesture "
            "is known on somebody else could not be told: record a second person (agent-server "
            "gestures record NAME --subject OTHER)"
        )
    test = subjects[-1] if held_out is None else held_out
    if test not in subjects:
        raise InvalidInput(
            f"--held-out is {test}, the recordings show {', '.join(subjects)}: name one of them"
        )
    others = [name for name in subjects if name != test]
    if len(others) == 1:
        return People(tuple(others), test, test)
    return People(tuple(others[:-1]), others[-1], test)


def teach(taught: GestureSet, lesson: Lesson) -> MotionManifest:
    """Train on the recordings and write the bundle.

    Raises:
        InvalidInput: If the recordings do not do; the text says what to do.
    """
    people = choose_people(taught.subjects, lesson.held_out)
    check_repetitions(taught.of(*people.train), taught.gestures)
    built_in = () if lesson.only else BUILT_IN
    classes = (*built_in, *(name for name in taught.gestures if name not in built_in), IDLE)
    training = _with_synthetic(taught.of(*people.train), "train", classes, taught.gestures, lesson)
    validation = _with_synthetic(
        taught.of(people.validation), "validation", classes, taught.gestures, lesson
    )
    config = lesson.config(len(classes))
    predictor = Bundled(lesson.predictor)
    network = _started(lesson, config, classes)
    with tempfile.TemporaryDirectory() as scratch:
        run = Run(Path(scratch) / "run", config, lesson.seed, lesson.command(), resume=False)
        train(config, run, training, validation, predictor, network)
        best, info = load_classifier(run.folder), run.info
    judged = validation.take((validation.labels != AMBIGUOUS).nonzero()[:, 0])
    logits = window_logits(best, predictor, judged, config, torch.device("cpu"))
    calibrated = Calibrated(best, fit_temperature(logits, judged.labels)).eval()
    seen, _, _ = labelled_windows(cut(taught.of(people.test), 1, classes))
    windows = np.concatenate([seen, predictor.model.batched(seen)], axis=1)
    spread = np.linspace(0, len(windows) - 1, 64).astype(int)
    export = Export(
        name=lesson.out.resolve().name,
        version="1.0.0",
        task="classify",
        network=calibrated,
        windows=windows[spread],
        output_frames=0,
        labels=classes,
        info=info,
        sources=_sources(people),
        licence=LICENCE,
    )

    def results(path: Path) -> dict[str, Any]:
        model, predict = OnnxModel(path), predictor.model
        measured = measure(model.batched, predict.batched, taught.of(people.test), classes)
        figures = taught_figures(model, predict, measured)
        return {
            **{name: figures[name] for name in CARRIED},
            "latency": latency_ms(model, windows[:1]),
            "temperature": float(calibrated.temperature),
            "people": {"train": people.train, "chosen": people.validation, "test": people.test},
            "taught": taught.gestures,
            "encoder": lesson.encoder,
        }

    return write_bundle(export, lesson.out, results, taught_card)


def taught_figures(
    classify: OnnxModel, predict: OnnxModel, measured: GestureMeasures
) -> dict[str, Any]:
    """What was measured on somebody's recordings, and reactions to idle virtual people."""
    first, count, _ = HELD_OUT["test"]
    streams = idle_streams(IDLE_SEED, IDLE_MINUTES, subject_names(count, first))
    return {
        **figures_of(measured),
        "idle_synthetic": false_reactions(
            classify.batched, predict.batched, streams, measured.classes
        ),
    }


def _with_synthetic(
    own: list[Recording],
    split: Literal["train", "validation"],
    classes: tuple[str, ...],
    taught: Sequence[str],
    lesson: Lesson,
) -> WindowSet:
    """Own windows, and virtual people who make the built-in gestures or are idle."""
    made = synthetic_split(lesson.cache, split, TAKES, synthetic.Mix(without=tuple(taught)))
    kept = [
        take for take in made if all(stretch.gesture in classes for stretch in take.stretches or ())
    ]
    stride, margins = (1, TRAINED) if split == "train" else (STRIDE, JUDGED)
    return join(
        [
            cut(own, stride, classes, margins),
            cut(kept, SYNTHETIC_STRIDE * stride, classes, margins),
        ]
    )


def _started(lesson: Lesson, config: TrainConfig, classes: tuple[str, ...]) -> Classifier | None:
    """The network that a frozen lesson starts from: all but the head is kept."""
    if lesson.encoder == "fresh":
        return None
    read_manifest(lesson.start)
    known = restore_classifier(lesson.start).classifier
    torch.manual_seed(lesson.seed)
    network = Classifier(config.network)
    kept = {
        name: value for name, value in known.state_dict().items() if not name.startswith("head.")
    }
    network.load_state_dict(kept, strict=False)
    names = read_manifest(lesson.start).labels
    with torch.no_grad():
        for place, name in enumerate(classes):
            if name in names:
                network.head.weight[place] = known.head.weight[names.index(name)]
                network.head.bias[place] = known.head.bias[names.index(name)]
    for name, weight in network.named_parameters():
        weight.requires_grad = name.startswith(("hidden.", "head."))
    return network


def _sources(people: People) -> tuple[DataSource, ...]:
    named = ", ".join(people.train)
    return (
        DataSource(f"recordings of {named}", "the recordings' own", synthetic=False),
        DataSource(synthetic.SOURCE, synthetic.LICENCE, synthetic=True),
    )
