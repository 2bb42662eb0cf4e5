"""Three-second windows over recordings, normalised, labelled and augmented."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InvalidInput
from models.data.layouts import CORE

AMBIGUOUS = -1
"""Label of a window that is left out of training and of accuracies."""
SHOWN_FRAMES = 20
"""A whole window shows a gesture that starts at least this many frames (0.8 s) before its end."""
MIRROR = list(CORE.mirror)


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a recording in which a gesture is made.

    Attributes:
        gesture: Its name.
        onset: Frame in which the movement starts.
        offset: Frame in which the body is back at rest.
    """

    gesture: str
    onset: int
    offset: int


@dataclass(frozen=True, slots=True)
class Recording:
    """One take, with what happens in it.

    Attributes:
        observed: Shape (T, 9, 3), metres: what the sensor gives, at 25 Hz.
        clean: Shape (T, 9, 3), metres: where the joints are; the same array where unknown.
        stretches: Gestures in the order of time, all else is idle; None says that nothing is
            known about gestures here, so that no window gets a label.
        subject: Who moves.
    """

    observed: NDArray[np.float32]
    clean: NDArray[np.float32]
    stretches: tuple[Stretch, ...] | None
    subject: str


@dataclass(frozen=True, slots=True)
class Margins:
    """How much of a gesture has to be seen before it counts; in between, windows are ambiguous.

    Attributes:
        started: Frames from the onset on: the hands are on their way.
        leaving: Frames before the offset: the hands are mostly back.
    """

    started: int
    leaving: int


JUDGED = Margins(started=8, leaving=10)
"""Accuracies are of windows that show a gesture for 0.32 s at least, and not its last 0.4 s."""
TRAINED = Margins(started=4, leaving=8)
"""Training begins earlier, so that the decision stage has something to go by in time."""


def window_labels(
    stretches: Sequence[Stretch] | None,
    classes: Sequence[str],
    last_seen: NDArray[np.int64],
    margins: Margins = JUDGED,
) -> NDArray[np.int64]:
    """What the seen second says: index in ``classes``, or AMBIGUOUS.

    Args:
        stretches: Gestures of the recording, or None if nothing is known.
        classes: Names of the labels.
        last_seen: Shape (N,), last seen frame of each window.
        margins: When a gesture counts. Outside onset to offset it is idle.
    """
    if stretches is None:
        return np.full(len(last_seen), AMBIGUOUS)
    labels = np.full(len(last_seen), classes.index(IDLE))
    for stretch in stretches:
        inside = (last_seen >= stretch.onset) & (last_seen < stretch.offset)
        shown = inside & (last_seen >= stretch.onset + margins.started)
        shown &= last_seen <= stretch.offset - margins.leaving
        labels[inside] = AMBIGUOUS
        labels[shown] = classes.index(stretch.gesture)
    return labels


def whole_labels(
    stretches: Sequence[Stretch] | None,
    classes: Sequence[str],
    last_seen: NDArray[np.int64],
    margins: Margins = JUDGED,
) -> NDArray[np.int64]:
    """What all 3 s say: a gesture counts too if it starts in the last 2 s but for 0.8 s."""
    if stretches is None:
        return np.full(len(last_seen), AMBIGUOUS)
    labels = np.full(len(last_seen), classes.index(IDLE))
    end = last_seen + PREDICTED_FRAMES
    for stretch in stretches:
        inside = (end >= stretch.onset) & (last_seen < stretch.offset)
        shown = inside & (end >= stretch.onset + SHOWN_FRAMES)
        shown &= last_seen <= stretch.offset - margins.leaving
        labels[inside] = AMBIGUOUS
        labels[shown] = classes.index(stretch.gesture)
    return labels


@dataclass(frozen=True, slots=True)
class WindowSet:
    """All windows of some recordings; the frames are kept once.

    Attributes:
        observed: Shape (F, 9, 3), all recordings one after the other.
        clean: Shape (F, 9, 3).
        starts: Shape (N,), first frame of each window.
        labels: Shape (N,), what the seen second says: index in ``classes`` or AMBIGUOUS.
        whole: Shape (N,), what all 3 s say.
        classes: Names of the labels.
    """

    observed: torch.Tensor
    clean: torch.Tensor
    starts: torch.Tensor
    labels: torch.Tensor
    whole: torch.Tensor
    classes: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.starts)

    def take(self, index: torch.Tensor) -> "WindowSet":
        """The windows with these indices."""
        return WindowSet(
            self.observed,
            self.clean,
            self.starts[index],
            self.labels[index],
            self.whole[index],
            self.classes,
        )

    def judged(self) -> "WindowSet":
        """Windows of which the seen second and the whole say the same."""
        clear = (self.labels != AMBIGUOUS) & (self.labels == self.whole)
        return self.take(clear.nonzero()[:, 0])

    def frames(self, index: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Observed and clean windows, both (B, 75, 9, 3), normalised alike."""
        at = self.starts[index, None] + torch.arange(CLASSIFIED_FRAMES)
        observed, clean = self.observed[at], self.clean[at]
        origin = observed[:, SEEN_FRAMES - 1, None, None, CoreJoint.NAVEL].clone()
        return observed - origin, clean - origin

    def all(self) -> torch.Tensor:
        """Every observed window, (N, 75, 9, 3), normalised."""
        return self.frames(torch.arange(len(self)))[0]


def cut(
    recordings: Iterable[Recording],
    stride: int = 1,
    classes: tuple[str, ...] = GESTURES,
    margins: Margins = JUDGED,
) -> WindowSet:
    """Every window of 75 frames that fits into a recording, ``stride`` frames apart.

    Args:
        recordings: Where from.
        stride: Frames between the starts of two windows.
        classes: Names of the labels.
        margins: When a gesture counts.

    Raises:
        InvalidInput: If no recording is long enough.
    """
    observed: list[NDArray[np.float32]] = []
    clean: list[NDArray[np.float32]] = []
    starts: list[NDArray[np.int64]] = []
    labels: list[NDArray[np.int64]] = []
    whole: list[NDArray[np.int64]] = []
    base = 0
    for recording in recordings:
        frames = len(recording.observed)
        first = np.arange(0, frames - CLASSIFIED_FRAMES + 1, stride)
        last = first + SEEN_FRAMES - 1
        starts.append(base + first)
        labels.append(window_labels(recording.stretches, classes, last, margins))
        whole.append(whole_labels(recording.stretches, classes, last, margins))
        observed.append(recording.observed)
        clean.append(recording.clean)
        base += frames
    if not any(map(len, starts)):
        raise InvalidInput(f"no recording has {CLASSIFIED_FRAMES} frames: give longer ones")
    return WindowSet(
        torch.from_numpy(np.concatenate(observed)).float(),
        torch.from_numpy(np.concatenate(clean)).float(),
        torch.from_numpy(np.concatenate(starts)),
        torch.from_numpy(np.concatenate(labels)),
        torch.from_numpy(np.concatenate(whole)),
        classes,
    )


def join(sets: Sequence[WindowSet]) -> WindowSet:
    """Several sets of the same classes as one."""
    bases = np.cumsum([0, *(len(one.observed) for one in sets)]).tolist()
    return WindowSet(
        torch.cat([one.observed for one in sets]),
        torch.cat([one.clean for one in sets]),
        torch.cat([one.starts + base for one, base in zip(sets, bases, strict=False)]),
        torch.cat([one.labels for one in sets]),
        torch.cat([one.whole for one in sets]),
        sets[0].classes,
    )


@dataclass(frozen=True, slots=True)
class Augmentation:
    """How windows are varied in training.

    Attributes:
        yaw: Largest turn about the vertical, in radians.
        scale: Largest relative change of the body's size.
        noise_m: Largest standard deviation of added sensor noise, in metres.
        drop: Chance that a joint of an arm stays where it was for part of the seen second.
    """

    yaw: float
    scale: float
    noise_m: float
    drop: float


def augment(
    observed: torch.Tensor,
    clean: torch.Tensor,
    how: Augmentation,
    generator: torch.Generator,
) -> tuple[torch.Tensor, torch.Tensor]:
    """Vary normalised windows (B, 75, 9, 3); noise and dropped joints touch only ``observed``."""
    size = len(observed)
    angle = (torch.rand(size, generator=generator) * 2 - 1) * how.yaw
    grow = 1 + (torch.rand(size, generator=generator) * 2 - 1) * how.scale
    flip = torch.where(torch.rand(size, generator=generator) < 0.5, -1.0, 1.0)
    cosine, sine, zero = torch.cos(angle), torch.sin(angle), torch.zeros(size)
    turn = torch.stack(
        [flip * cosine, zero, flip * -sine, zero, torch.ones(size), zero, sine, zero, cosine], -1
    ).reshape(size, 1, 3, 3)
    turn = turn * grow[:, None, None, None]
    mirrored = (flip < 0)[:, None, None, None]
    observed = torch.where(mirrored, observed[:, :, MIRROR], observed) @ turn
    clean = torch.where(mirrored, clean[:, :, MIRROR], clean) @ turn
    sigma = how.noise_m * torch.rand(size, generator=generator) ** 2
    noise = torch.randn(observed.shape, generator=generator) * sigma[:, None, None, None]
    observed = _hold_joints(observed + noise, how.drop, generator)
    origin = observed[:, SEEN_FRAMES - 1, None, None, CoreJoint.NAVEL].clone()
    return observed - origin, clean - origin


def _hold_joints(observed: torch.Tensor, chance: float, generator: torch.Generator) -> torch.Tensor:
    """Let elbows and wrists keep their last known position for up to half a second."""
    size, frames = observed.shape[:2]
    for joint in (
        CoreJoint.LEFT_ELBOW,
        CoreJoint.LEFT_WRIST,
        CoreJoint.RIGHT_ELBOW,
        CoreJoint.RIGHT_WRIST,
    ):
        dropped = torch.rand(size, generator=generator) < chance
        first = torch.randint(1, SEEN_FRAMES, (size,), generator=generator)
        count = torch.randint(1, SEEN_FRAMES // 2, (size,), generator=generator)
        time = torch.arange(frames)[None]
        held = dropped[:, None] & (time >= first[:, None]) & (time < (first + count)[:, None])
        source = torch.where(held, first[:, None] - 1, time)
        observed[:, :, joint] = observed[:, :, joint].gather(
            1, source[:, :, None].expand(-1, -1, 3)
        )
    return observed


HALF_QUARTER_TURN = math.pi / 4
