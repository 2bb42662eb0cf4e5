"""Motions of two people as files for animators and tools, each with a preview beside it."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput
from agent_server.skeleton.pair import JOINT_NAMES, PARENTS
from models.data.bvh_writer import write_bvh
from models.evaluation.figures.pair_strip import write_pair_strip
from models.export.glb import write_glb
from models.export.pair_recording import write_pair_recording

WRITTEN = (".bvh", ".glb", ".mcap", ".npz")


@dataclass(frozen=True, slots=True)
class PairMotion:
    """A motion of two people.

    Attributes:
        action: Shape (T, 15, 3), metres, in the frame of the pair.
        reaction: Shape (S, 15, 3), likewise; whoever ends first keeps the last pose.
        rate_hz: Frames a second.
        label: What they do.
        subject: Who they are, without spaces.
        description: In a sentence.
    """

    action: Float32
    reaction: Float32
    rate_hz: float
    label: str
    subject: str
    description: str


def checked_ending(out: Path) -> None:
    """Refuse a file that nobody can write.

    Raises:
        InvalidInput: If its ending is none of :data:`WRITTEN`.
    """
    if out.suffix not in WRITTEN:
        raise InvalidInput(f"--out {out} ends in none of {', '.join(WRITTEN)}", field="out")


def write_pair(motion: PairMotion, out: Path) -> Path:
    """Write both people in the form of the file's ending, and a preview beside it.

    Args:
        motion: What to write.
        out: ``.bvh`` for one tree below a joint that does not move, ``.glb``, ``.mcap``, or
            ``.npz`` (``action`` and ``reaction``).

    Returns:
        The preview, ``out`` with the ending ``.png``.

    Raises:
        InvalidInput: If the ending is another one.
        RecordingError: If a recording exists already.
    """
    checked_ending(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    people = _as_long(motion.action, motion.reaction)
    match out.suffix:
        case ".bvh":
            write_bvh(out, *_one_tree(), _below_one_joint(people), motion.rate_hz)
        case ".glb":
            write_glb(out, JOINT_NAMES, PARENTS, people, motion.rate_hz)
        case ".mcap":
            words = (motion.label, motion.subject, motion.description)
            write_pair_recording(out, people, motion.rate_hz, *words)
        case _:
            np.savez_compressed(
                out,
                action=motion.action,
                reaction=motion.reaction,
                joints=np.array(JOINT_NAMES),
                rate_hz=np.array(motion.rate_hz),
            )
    return write_preview(motion, out)


def write_preview(motion: PairMotion, out: Path) -> Path:
    """Write a picture of six moments beside ``out``; its path."""
    preview = out.with_suffix(".png")
    write_pair_strip(preview, motion.action, motion.reaction, motion.description)
    return preview


def _as_long(action: Float32, reaction: Float32) -> tuple[Float32, Float32]:
    """Both with as many frames as the longer one."""
    frames = max(len(action), len(reaction))
    first, second = (
        person[np.minimum(np.arange(frames), len(person) - 1)] for person in (action, reaction)
    )
    return first, second


def _one_tree() -> tuple[list[str], list[int]]:
    """Names and parents of both people's joints below one that does not move."""
    names, parents = ["pair"], [-1]
    for person in ("first", "second"):
        start = len(names)
        names += [f"{person}_{name}" for name in JOINT_NAMES]
        parents += [0 if parent == -1 else start + parent for parent in PARENTS]
    return names, parents


def _below_one_joint(people: tuple[Float32, Float32]) -> Float32:
    still = np.zeros_like(people[0][:, :1])
    both: Float32 = np.concatenate([still, *people], axis=1)
    return both
