"""Generated reactions as files for animators."""

from pathlib import Path

import numpy as np
import torch

from agent_server.errors import InvalidInput
from models.data.bvh_writer import write_bvh
from models.data.interactions import Interaction, InteractionSet, facing
from models.evaluation.figures.pair_strip import write_pair_strip
from models.interformer.generator.generate import Core, react_to

JOINT_NAMES = (
    *("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand"),
    *("right_shoulder", "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot"),
    *("right_hip", "right_knee", "right_foot"),
)
PARENTS = (1, 2, -1, 1, 3, 4, 1, 6, 7, 2, 9, 10, 2, 12, 13)
WRITTEN = (".bvh", ".npz")


def write_interaction(
    core: Core,
    latent: int,
    frames: int,
    spec: InteractionSet,
    test: list[Interaction],
    label: str,
    seed: int,
    out: Path,
) -> Path:
    """React to a recorded action, write the motion, and a preview beside it.

    Args:
        core: The generator.
        latent: Size of its noise.
        frames: Longest piece that it reads.
        spec: The set that the actions are of.
        test: Recordings to choose the action from.
        label: What the people do.
        seed: Chooses the action and the noise.
        out: ``.bvh`` for the reaction alone, in metres and y up, ``.npz`` for both people
            (``action`` and ``reaction``, (T, 15, 3), metres, in the frame of the pair).

    Returns:
        The preview, ``out`` with the ending ``.png``.

    Raises:
        InvalidInput: If there is no such label, or the file has another ending.
    """
    if out.suffix not in WRITTEN:
        raise InvalidInput(f"--out {out} ends in none of {', '.join(WRITTEN)}", field="out")
    chosen = [one for one in test if one.label == label]
    if not chosen:
        raise InvalidInput(
            f"--label '{label}' is none of {spec.name}'s: {', '.join(spec.labels)}", field="label"
        )
    generator = torch.Generator().manual_seed(seed)
    one = chosen[int(torch.randint(len(chosen), (), generator=generator))]
    action, true = facing(one)
    noise = torch.randn(latent, generator=generator)
    reaction = react_to(core, action, true[0], noise, frames).numpy()
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".bvh":
        write_bvh(out, JOINT_NAMES, PARENTS, reaction, spec.rate_hz)
    else:
        np.savez_compressed(
            out,
            action=action.numpy(),
            reaction=reaction,
            joints=np.array(JOINT_NAMES),
            rate_hz=np.array(spec.rate_hz),
        )
    preview = out.with_suffix(".png")
    title = f"{label}: generated reaction (dark) to the action of {spec.name} {one.name}"
    write_pair_strip(preview, action.numpy(), reaction, title)
    return preview
