"""Which people and which files train, validate and test."""

from pathlib import Path
from typing import Literal

from agent_server.synthetic.corpus import subject_names
from models.data.cmu import IDLE_ACTIONS, held_out, read_cmu
from models.data.synthetic import SERVER_MIX, Mix, cached_recordings
from models.data.windows import Recording

Split = Literal["train", "validation", "test"]

SYNTHETIC_SEED = 20
TRAIN_PEOPLE = 60
HELD_OUT: dict[str, tuple[int, int, int]] = {
    "validation": (100, 12, 400),
    "test": (300, 12, 700),
}
"""Number of the first person, how many people, and how many takes; people of no other split."""


def cmu_split(data: Path, split: Split) -> list[Recording]:
    """CMU recordings of a split; those that may hold gestures carry no label.

    Args:
        data: Folder that holds ``cmu_mocap/``.
        split: ``validation`` is every seventh of the published training files.
    """
    recordings = [
        Recording(
            observed=motion.positions,
            clean=motion.positions,
            stretches=() if motion.label in IDLE_ACTIONS else None,
            subject=motion.subject,
        )
        for motion in read_cmu(data, "test" if split == "test" else "train")
    ]
    if split == "test":
        return recordings
    held = split == "validation"
    return [r for i, r in enumerate(recordings) if held_out(i) == held]


def synthetic_split(
    cache: Path, split: Split, sequences: int = 0, mix: Mix = SERVER_MIX
) -> list[Recording]:
    """Synthetic recordings of a split.

    Args:
        cache: Folder where generated recordings are kept.
        split: Which people.
        sequences: How many to train on; the other splits have a fixed number.
        mix: What the takes are a mix of.
    """
    if split == "train":
        people = subject_names(TRAIN_PEOPLE)
        return cached_recordings(cache, SYNTHETIC_SEED, sequences, people, mix)
    first, count, takes = HELD_OUT[split]
    people = subject_names(count, first)
    return cached_recordings(cache, SYNTHETIC_SEED + first, takes, people, mix)
