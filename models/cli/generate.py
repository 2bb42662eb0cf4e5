"""``python -m models generate``."""

from pathlib import Path
from typing import Annotated

import torch
import typer

from models.cli.options import DataOption, SeedOption
from models.data.interactions import interaction_set
from models.evaluation.forecasters import BENCHMARKS
from models.export.interaction import write_interaction
from models.interformer.generator.onnx_core import OnnxCore

app = typer.Typer(no_args_is_help=True)


@app.callback()
def _group() -> None:
    """Make motions with a research bundle."""


@app.command("interaction")
def generate_interaction(
    data: DataOption,
    label: Annotated[str, typer.Option("--label", help='What they do: "shaking hands".')],
    out: Annotated[Path, typer.Option("--out", help="FILE.bvh or FILE.npz.")],
    set_name: Annotated[str, typer.Option("--set", help="sbu or k3hi.")] = "sbu",
    seed: SeedOption = 0,
) -> None:
    """The reaction to a recorded action, as a motion file with a preview picture beside it."""
    torch.set_num_threads(1)
    spec = interaction_set(set_name)
    core, manifest = OnnxCore.of(BENCHMARKS / f"interformer_{spec.name}")
    test = spec.read(data, "test")
    preview = write_interaction(
        core, manifest.latent, manifest.frames, spec, test, label, seed, out
    )
    print(f"wrote {out} and {preview}")
