"""MSRC-12 as it came: whole recordings of unseen people through the live decision stage.

A decision answers a tag of the same gesture when it comes at most 333 ms after it (the data set's
own tolerance) or at most 1 s before it; every other decision is false. Two classifiers of the
same size and budget are compared: one gets what the predictor expects after the seen second,
the other the last seen frame. Their thresholds are chosen on validation people.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from agent_server.config import DecideSettings
from agent_server.domain.arrays import Float32
from agent_server.domain.motion import FRAME_NS, SEEN_FRAMES
from models.data.msrc12 import (
    BEFORE_FRAMES,
    STREAM_CLASSES,
    Fold,
    TaggedStream,
    folds,
    read_streams,
    tagged_recordings,
)
from models.data.windows import Recording, cut
from models.evaluation.gestures import HOP_FRAMES, decisions, sliding_seen
from models.evaluation.msrc12_windows import CLASSIFIER, fold_predictors
from models.evaluation.rows import Held
from models.interformer.config import NetworkConfig, TrainConfig
from models.interformer.train import completed, load_classifier, train
from models.training.run import INFO, Run

EARLIEST_MS = -1_000
LATEST_MS = 333
FRAME_MS = FRAME_NS // 1_000_000
CONFIGS: dict[str, TrainConfig] = {
    "predicted": replace(
        CLASSIFIER,
        network=NetworkConfig(classes=len(STREAM_CLASSES)),
        steps=1_000,
        last_frame=0.0,
        idle=0.4,
    ),
}
CONFIGS["seen_only"] = replace(CONFIGS["predicted"], futures="held")
COMMAND = "python -m models evaluate gestures --benchmark msrc12-stream --data DIR"
ENTER = (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
ENTER_WINDOWS = (1, 2, 3, 4, 5)


@dataclass(frozen=True, slots=True)
class Watched:
    """A recording with what a classifier makes of it.

    Attributes:
        probabilities: Shape (N, C), a row a window.
        last: Shape (N,), last seen frame of each window.
        tags: Frame and class of each tag.
    """

    probabilities: Float32
    last: np.ndarray
    tags: tuple[tuple[int, str], ...]


@dataclass(frozen=True, slots=True)
class Tally:
    """What the decisions on some recordings come to.

    Attributes:
        tags: How many there were to find.
        false: Decisions that answer none.
        delays_ms: Decision against tag, of each tag that was found; negative is before it.
    """

    tags: int
    false: int
    delays_ms: tuple[int, ...]

    @property
    def precision(self) -> float:
        """Share of the decisions that answer a tag."""
        given = len(self.delays_ms) + self.false
        return len(self.delays_ms) / given if given else 0.0

    @property
    def recall(self) -> float:
        """Share of the tags that were found."""
        return len(self.delays_ms) / self.tags if self.tags else 0.0

    @property
    def f1(self) -> float:
        """Harmonic mean of both."""
        both = self.precision + self.recall
        return 2 * self.precision * self.recall / both if both else 0.0

    @property
    def delay_ms(self) -> float:
        """Median delay."""
        return float(np.median(self.delays_ms)) if self.delays_ms else float("nan")

    def figures(self) -> dict[str, Any]:
        """As the report gives them."""
        return {
            "precision": round(self.precision, 4),
            "recall": round(self.recall, 4),
            "f1": round(self.f1, 4),
            "delay_ms_p50": round(self.delay_ms) if self.delays_ms else None,
        }


def settings_grid() -> Iterator[DecideSettings]:
    """What may be chosen; a gesture may come again at once, as in these recordings."""
    for windows in ENTER_WINDOWS:
        for enter in ENTER:
            yield DecideSettings(
                enter=enter,
                enter_ungated=enter,
                leave=min(0.4, enter),
                enter_windows=windows,
                leave_windows=1,
                cooldown_s=0.0,
            )


def tally(watched: Sequence[Watched], settings: DecideSettings) -> Tally:
    """Decide on every recording and compare with its tags."""
    tags, false, delays = 0, 0, []
    for one in watched:
        found = decisions(one.probabilities, classes=STREAM_CLASSES, settings=settings)
        open_tags = list(one.tags)
        tags += len(open_tags)
        for window, gesture in found:
            at = int(one.last[window])
            answered = next(
                (
                    tag
                    for tag in open_tags
                    if tag[1] == gesture and EARLIEST_MS <= (at - tag[0]) * FRAME_MS <= LATEST_MS
                ),
                None,
            )
            if answered is None:
                false += 1
            else:
                open_tags.remove(answered)
                delays.append((at - answered[0]) * FRAME_MS)
    return Tally(tags, false, tuple(delays))


def msrc12_stream_report(data: Path, folder: Path, seed: int = 0) -> dict[str, Any]:
    """Train and test both rows in three rotations.

    Args:
        data: Folder that holds ``msrc12/``.
        folder: Where the runs are kept; those that are there are only measured again.
        seed: Of every training.
    """
    torch.set_num_threads(1)
    streams = read_streams(data / "msrc12")
    held: dict[str, list[Watched]] = {name: [] for name in CONFIGS}
    tested: dict[str, list[Watched]] = {name: [] for name in CONFIGS}
    for number, fold in enumerate(folds([one.subject for one in streams])):
        place = folder / f"rotation_{number}"
        expected = fold_predictors(streams, fold, place, seed)["ma_wgan"]
        for name, config in CONFIGS.items():
            predictor = expected if name == "predicted" else Held()
            network = _trained(config, streams, fold, place / f"stream_{name}", predictor, seed)
            held[name] += _watch(network, predictor, config, streams, fold.validation)
            tested[name] += _watch(network, predictor, config, streams, fold.test)
    chosen = {
        name: max(settings_grid(), key=lambda settings: tally(watched, settings).f1)
        for name, watched in held.items()
    }
    curves = {
        name: [_point(watched, settings) for settings in settings_grid()]
        for name, watched in tested.items()
    }
    return {
        "rows": {
            name: {
                **tally(watched, chosen[name]).figures(),
                "enter": chosen[name].enter,
                "enter_windows": chosen[name].enter_windows,
            }
            for name, watched in tested.items()
        },
        **_gain(curves),
        "curves": curves,
    }


def _trained(
    config: TrainConfig,
    streams: Sequence[TaggedStream],
    fold: Fold,
    place: Path,
    predictor: nn.Module,
    seed: int,
) -> nn.Module:
    if not (place / INFO).exists():
        training = cut(tagged_recordings(streams, fold.train), classes=STREAM_CLASSES)
        validation = cut(
            tagged_recordings(streams, fold.validation), HOP_FRAMES, classes=STREAM_CLASSES
        )
        train(config, Run(place, config, seed, COMMAND, False), training, validation, predictor)
    return load_classifier(place)


@torch.no_grad()
def _watch(
    network: nn.Module,
    predictor: nn.Module,
    config: TrainConfig,
    streams: Sequence[TaggedStream],
    subjects: Sequence[str],
) -> list[Watched]:
    found = []
    for recording in tagged_recordings(streams, subjects):
        if len(recording.observed) < SEEN_FRAMES:
            continue
        seen, last = sliding_seen(recording.observed)
        motion = completed(predictor, torch.from_numpy(seen), config)
        rows = torch.softmax(network(motion), -1).numpy()
        found.append(Watched(rows, last, _tags(recording)))
    return found


def _tags(recording: Recording) -> tuple[tuple[int, str], ...]:
    return tuple(
        (stretch.onset + BEFORE_FRAMES, stretch.gesture) for stretch in recording.stretches or ()
    )


def _point(watched: Sequence[Watched], settings: DecideSettings) -> dict[str, Any]:
    return {
        "enter": settings.enter,
        "enter_windows": settings.enter_windows,
        **tally(watched, settings).figures(),
    }


def _gain(curves: dict[str, list[dict[str, Any]]]) -> dict[str, Any]:
    """How much earlier the predicted row decides at the best F1 that both rows reach."""
    f1 = min(max(point["f1"] for point in curve) for curve in curves.values())
    delays = {
        name: min(point["delay_ms_p50"] for point in curve if point["f1"] >= f1)
        for name, curve in curves.items()
    }
    return {"equal_f1": f1, "gain_ms": delays["seen_only"] - delays["predicted"]}
