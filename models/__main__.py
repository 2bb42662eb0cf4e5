"""Command line of training, export and evaluation: ``python -m models --help``."""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import torch
import typer

from agent_server.errors import AgentServerError
from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import cut, join
from models.evaluation.ablations import ablation_report
from models.evaluation.forecasters import SERVER_BUNDLE, bundled, forecaster
from models.evaluation.latency import bundle_latency
from models.evaluation.prediction import evaluate
from models.evaluation.protocols import SERVER_PROTOCOLS, protocol_named
from models.evaluation.real_streams import msrc12_stream_report
from models.evaluation.report import classifier_report, compare, server_report
from models.evaluation.session import OnnxModel
from models.evaluation.sim2real import sim2real_report
from models.export.classifier import export_classifier
from models.export.predictor import export_predictor
from models.interformer.config import CONFIGS as INTERFORMER_CONFIGS
from models.interformer.config import TrainConfig as InterformerConfig
from models.interformer.train import train as train_classifier
from models.ma_wgan.config import CONFIGS as MA_WGAN_CONFIGS
from models.ma_wgan.config import TrainConfig as MaWganConfig
from models.ma_wgan.train import load_predictor
from models.ma_wgan.train import train as train_predictor
from models.simlpe.config import CONFIGS as SIMLPE_CONFIGS
from models.simlpe.config import TrainConfig as SimlpeConfig
from models.simlpe.train import train as train_baseline
from models.training.run import Run

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, help=__doc__)
train_app = typer.Typer(no_args_is_help=True, help="Train a model.")
app.add_typer(train_app, name="train")

DataOption = Annotated[Path, typer.Option("--data", help="Folder that holds the set folders.")]
OutOption = Annotated[Path, typer.Option("--out", help="Folder of the run.")]
ConfigOption = Annotated[str, typer.Option("--config", help="Name of the configuration.")]
SeedOption = Annotated[int, typer.Option("--seed", help="Of everything random.")]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with the run in --out.")]
StepsOption = Annotated[int | None, typer.Option("--steps", help="Instead of the config's.")]
CacheOption = Annotated[Path, typer.Option("--cache", help="Where generated recordings are kept.")]
CACHE = Path("runs/cache")
T = TypeVar("T")
C = TypeVar("C", MaWganConfig, SimlpeConfig, InterformerConfig)


def _command(model: str, config: str, seed: int, steps: int | None, extra: str = "") -> str:
    """The command for the card; folders are left to the reader."""
    count = "" if steps is None else f" --steps {steps}"
    return (
        f"python -m models train {model} --config {config} --data DIR{extra} --out RUN"
        f" --seed {seed}{count}"
    )


@train_app.command("ma_wgan")
def train_ma_wgan(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "server",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train a manifold-aware GAN: the server's predictor, or one of the literature's data."""
    chosen = _configured(MA_WGAN_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("ma_wgan", config, seed, steps), resume)
    train_predictor(chosen, run, data, cache)


@train_app.command("simlpe")
def train_simlpe(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "cpu",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train siMLPe, the baseline of the literature."""
    chosen = _configured(SIMLPE_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("simlpe", config, seed, steps), resume)
    train_baseline(chosen, run, data, cache)


@train_app.command("interformer")
def train_interformer(
    data: DataOption,
    out: OutOption,
    predictor: Annotated[Path, typer.Option("--predictor", help="Run of a trained predictor.")],
    config: ConfigOption = "server",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train the classifier on seen and predicted frames."""
    chosen = _configured(INTERFORMER_CONFIGS, config, steps)
    command = _command("interformer", config, seed, steps, " --predictor PREDICTOR_RUN")
    run = Run(out, chosen, seed, command, resume)
    training = join(
        [
            cut(synthetic_split(cache, "train", chosen.synthetic_sequences)),
            cut(cmu_split(data, "train")),
        ]
    )
    validation = join(
        [
            cut(synthetic_split(cache, "validation"), stride=5),
            cut(cmu_split(data, "validation"), stride=5),
        ]
    )
    train_classifier(chosen, run, training, validation, load_predictor(predictor))


export_app = typer.Typer(no_args_is_help=True, help="Write a bundle from a run.")
evaluate_app = typer.Typer(no_args_is_help=True, help="Measure a bundle.")
app.add_typer(export_app, name="export")
app.add_typer(evaluate_app, name="evaluate")

RunOption = Annotated[Path, typer.Option("--run", help="Run to export.")]
RunsOption = Annotated[list[Path], typer.Option("--run", help="Run to export; may be repeated.")]
VersionOption = Annotated[str, typer.Option("--version", help="Version of the model.")]
BundleOption = Annotated[Path, typer.Option("--bundle", help="Folder of a bundle.")]
PredictorBundleOption = Annotated[
    Path, typer.Option("--predictor", help="Bundle whose predictor completes the windows.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on one line.")]
CLASSIFIER = Path("models/artifacts/interformer_server")


@export_app.command("ma_wgan")
def export_ma_wgan(
    data: DataOption,
    run: RunsOption,
    out: Annotated[Path, typer.Option("--out", help="Folder of the bundle.")] = SERVER_BUNDLE,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Export, check and measure a manifold-aware GAN, or the average of several."""
    _export("ma_wgan", run, out, version, data, cache)


@export_app.command("simlpe")
def export_simlpe(
    data: DataOption,
    run: RunsOption,
    out: Annotated[Path, typer.Option("--out", help="Folder of the bundle.")],
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Export, check and measure a siMLPe."""
    _export("simlpe", run, out, version, data, cache)


def _export(
    family: str, runs: list[Path], out: Path, version: str, data: Path, cache: Path
) -> None:
    torch.set_num_threads(1)
    _show(export_predictor(family, runs, out, version, data, cache).results, as_json=False)


@export_app.command("interformer")
def export_interformer(
    data: DataOption,
    run: RunOption,
    predictor: PredictorBundleOption = SERVER_BUNDLE,
    seen_only: Annotated[
        Path | None, typer.Option("--seen-only", help="Run of the classifier of 1 s alone.")
    ] = None,
    out: Annotated[Path, typer.Option("--out", help="Folder of the bundle.")] = CLASSIFIER,
    version: VersionOption = "0.1.0",
    cache: CacheOption = CACHE,
) -> None:
    """Calibrate, export, check and measure a classifier."""
    torch.set_num_threads(1)
    manifest = export_classifier(run, predictor, seen_only, out, version, data, cache)
    _show(manifest.results, as_json=False)


@evaluate_app.command("prediction")
def evaluate_prediction(
    data: DataOption,
    model: Annotated[
        str,
        typer.Option("--model", help="zero_velocity, one_fc, simlpe, paper, best or server."),
    ] = "server",
    protocol: Annotated[
        str, typer.Option("--protocol", help="h36m-256, h36m-rms, cmu or server.")
    ] = "server",
    bundle: Annotated[
        Path | None, typer.Option("--bundle", help="Folder of a bundle, in place of --model.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", help="Folder to write an HTML page to.")
    ] = None,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Errors of a predictor, by action and on average."""
    how = protocol_named(protocol)
    what = forecaster(model, how, data) if bundle is None else bundled(bundle.name, bundle, how)
    names = SERVER_PROTOCOLS if protocol == "server" else (protocol,)
    windows = {name: protocol_named(name).windows(data, cache) for name in names}
    results = (
        server_report(what, windows)
        if protocol == "server"
        else evaluate(what, how, windows[protocol])
    )
    if report is not None:
        page = compare(what, how, data, windows[protocol], report)
        print(page, file=sys.stderr)
    _show(results, as_json)


@evaluate_app.command("gestures")
def evaluate_gestures(
    data: DataOption,
    bundle: BundleOption = CLASSIFIER,
    predictor: PredictorBundleOption = SERVER_BUNDLE,
    benchmark: Annotated[
        Literal["synthetic", "sim2real", "msrc12-stream"],
        typer.Option("--benchmark", help="Held-out virtual people, or real recordings."),
    ] = "synthetic",
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Accuracy, calibration, delays and false reactions of a classifier."""
    classify, predict = _model(bundle), _model(predictor)
    if benchmark == "sim2real":
        _show(sim2real_report(classify.batched, predict.batched, data), as_json)
    elif benchmark == "msrc12-stream":
        _show(msrc12_stream_report(classify.batched, predict.batched, data), as_json)
    else:
        _show(classifier_report(classify, predict, data, cache), as_json)


@app.command()
def ablate(
    data: DataOption,
    out: OutOption,
    seed: SeedOption = 0,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Train each ablation of the predictor on the same small budget, and measure it.

    Rows whose run is already in --out are only measured again.
    """
    torch.set_num_threads(1)
    _show(ablation_report(out, seed, data, cache), as_json)


@app.command()
def latency(as_json: JsonOption = False) -> None:
    """Time of both shipped models for one window, on one thread."""
    _show({path.name: bundle_latency(path) for path in (SERVER_BUNDLE, CLASSIFIER)}, as_json)


def _model(bundle: Path) -> OnnxModel:

    read_manifest(bundle)
    return OnnxModel(bundle / MODEL_FILE)


def _show(values: dict[str, Any], as_json: bool) -> None:
    print(json.dumps(values, indent=None if as_json else 2))


def _configured(configs: dict[str, C], name: str, steps: int | None) -> C:
    """A configuration by its name, with one core for the training: the other is the user's."""
    torch.set_num_threads(1)
    chosen = _choose(configs, name)
    return chosen if steps is None else replace(chosen, steps=steps)


def _choose(configs: dict[str, T], name: str) -> T:
    if name not in configs:
        raise typer.BadParameter(f"'{name}' is none of {', '.join(configs)}", param_hint="--config")
    return configs[name]


def main() -> None:
    """Run the command line; an error of the product is one sentence on stderr."""
    try:
        app()
    except AgentServerError as error:
        print(error, file=sys.stderr)
        raise SystemExit(1) from error


if __name__ == "__main__":
    main()
