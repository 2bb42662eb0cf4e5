"""Generated reactions as files for animators."""

from pathlib import Path

import torch

from agent_server.errors import InvalidInput
from agent_server.skeleton.pair import JOINT_NAMES, PARENTS
from models.data.bvh_writer import write_bvh
from models.data.interactions import Interaction, InteractionSet, facing
from models.export.pair_files import PairMotion, checked_ending, write_pair, write_preview
from models.interformer.generator.generate import Core, react_to


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
        out: ``.bvh`` for the reaction alone, in metres and y up; the other endings of
            :mod:`models.export.pair_files` for both people.

    Returns:
        The preview, ``out`` with the ending ``.png``.

    Raises:
        InvalidInput: If there is no such label, or the file has another ending.
    """
    checked_ending(out)
    chosen = [one for one in test if one.label == label]
    if not chosen:
        raise InvalidInput(
            f"--label '{label}' is none of {spec.name}'s: {', '.join(spec.labels)}", field="label"
        )
    generator = torch.Generator().manual_seed(seed)
    one = chosen[int(torch.randint(len(chosen), (), generator=generator))]
    action, true = facing(one)
    noise = torch.randn(latent, generator=generator)
    motion = PairMotion(
        action.numpy(),
        react_to(core, action, true[0], noise, frames).numpy(),
        spec.rate_hz,
        label,
        f"interformer_{spec.name}_{seed}",
        f"{label}: generated reaction (dark) to the action of {spec.name} {one.name}",
    )
    if out.suffix != ".bvh":
        return write_pair(motion, out)
    out.parent.mkdir(parents=True, exist_ok=True)
    write_bvh(out, JOINT_NAMES, PARENTS, motion.reaction, spec.rate_hz)
    return write_preview(motion, out)
