"""Options and small things that several commands share."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, TypeVar

import torch
import typer

from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.affect.config import Source
from models.bigraphdiff.config import TrainConfig as BiGraphDiffConfig
from models.hp_gan.config import TrainConfig as HpGanConfig
from models.interformer.config import TrainConfig as InterformerConfig
from models.interformer.generator.config import TrainConfig as GeneratorConfig
from models.ma_wgan.config import TrainConfig as MaWganConfig
from models.ops.session import OnnxModel
from models.simlpe.config import TrainConfig as SimlpeConfig

DataOption = Annotated[Path, typer.Option("--data", help="Folder that holds the set folders.")]
OutOption = Annotated[Path, typer.Option("--out", help="Folder of the run.")]
BundleOutOption = Annotated[Path, typer.Option("--out", help="Folder of the bundle.")]
SeedOption = Annotated[int, typer.Option("--seed", help="Of everything random.")]
CacheOption = Annotated[Path, typer.Option("--cache", help="Where generated recordings are kept.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on one line.")]
ReportOption = Annotated[
    Path | None, typer.Option("--report", help="Folder to write an HTML page to.")
]
ClassifierBundleOption = Annotated[
    Path, typer.Option("--bundle", help="Folder of a classifier's bundle.")
]
PredictorBundleOption = Annotated[
    Path, typer.Option("--predictor", help="Bundle whose predictor completes the windows.")
]
AffectInputOption = Annotated[Source, typer.Option("--input", help="What a face is given as.")]
InteractionRunsOption = Annotated[
    Path, typer.Option("--runs", help="Where judges and rows of benchmarks are kept.")
]
CACHE = Path("runs/cache")
INTERACTION_RUNS = Path("runs/interaction")
ARTIFACTS = Path(__file__).parents[1] / "artifacts"
PREDICTOR = ARTIFACTS / "ma_wgan_server"
SAMPLER = ARTIFACTS / "sampler_server"
CLASSIFIER = ARTIFACTS / "interformer_server"
C = TypeVar(
    "C",
    MaWganConfig,
    SimlpeConfig,
    HpGanConfig,
    InterformerConfig,
    GeneratorConfig,
    BiGraphDiffConfig,
)


def model_of(bundle: Path) -> OnnxModel:
    """The model of a bundle that is whole."""
    read_manifest(bundle)
    return OnnxModel(bundle / MODEL_FILE)


def show(values: dict[str, Any], as_json: bool) -> None:
    """Print results, on one line for a program."""
    print(json.dumps(values, indent=None if as_json else 2))


def configured(configs: dict[str, C], name: str, steps: int | None) -> C:
    """A configuration by its name, with one core for the training: the other is the user's."""
    torch.set_num_threads(1)
    if name not in configs:
        raise typer.BadParameter(f"'{name}' is none of {', '.join(configs)}", param_hint="--config")
    chosen = configs[name]
    return chosen if steps is None else replace(chosen, steps=steps)
