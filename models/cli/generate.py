"""``python -m models generate``."""

from pathlib import Path
from typing import Annotated, Literal

import torch
import typer

from models.bigraphdiff.onnx_denoiser import read_generator
from models.cli.options import SeedOption
from models.data.interaction_sets import two_person_set
from models.data.interactions import interaction_set
from models.evaluation.forecasters import BENCHMARKS
from models.export.drawn_interaction import drawn
from models.export.interaction import write_interaction
from models.export.pair_files import write_pair
from models.interformer.generator.onnx_core import OnnxCore

app = typer.Typer(no_args_is_help=True)


@app.callback()
def _group() -> None:
    """Make motions with a research bundle."""


@app.command("interaction")
def generate_interaction(
    label: Annotated[str, typer.Option("--label", help='What they do: "shaking hands".')],
    out: Annotated[Path, typer.Option("--out", help="FILE.bvh, .glb, .mcap or .npz.")],
    model: Annotated[
        Literal["interformer", "bigraphdiff"],
        typer.Option(
            "--model",
            help="interformer: the reaction to a recorded action. bigraphdiff: both people.",
        ),
    ] = "interformer",
    set_name: Annotated[str, typer.Option("--set", help="Which bundle: sbu or k3hi.")] = "sbu",
    data: Annotated[
        Path | None,
        typer.Option("--data", help="Folder of the set folders; interformer takes actions there."),
    ] = None,
    frames: Annotated[
        int | None,
        typer.Option("--frames", help="Length for bigraphdiff; a usual one if left out."),
    ] = None,
    seed: SeedOption = 0,
) -> None:
    """The motion of two people as a file, with a preview picture beside it."""
    torch.set_num_threads(1)
    if model == "bigraphdiff":
        spec = two_person_set(set_name)
        generator, manifest = read_generator(BENCHMARKS / f"bigraphdiff_{spec.name}")
        preview = write_pair(drawn(generator, manifest, label, seed, frames), out)
    elif data is None:
        raise typer.BadParameter(
            "name the folder that holds the set, whose actions are reacted to", param_hint="--data"
        )
    else:
        spec = interaction_set(set_name)
        core, reactions = OnnxCore.of(BENCHMARKS / f"interformer_{spec.name}")
        test = spec.read(data, "test")
        shape = (reactions.latent, reactions.frames)
        preview = write_interaction(core, *shape, spec, test, label, seed, out)
    print(f"wrote {out} and {preview}")
