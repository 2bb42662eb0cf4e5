"""``python -m models evaluate``, ``ablate`` and ``latency``."""

import sys
from pathlib import Path
from typing import Annotated, Literal

import torch
import typer

from models.cli.options import (
    CACHE,
    CLASSIFIER,
    PREDICTOR,
    CacheOption,
    DataOption,
    JsonOption,
    OutOption,
    PredictorBundleOption,
    ReportOption,
    SeedOption,
    model_of,
    show,
)
from models.evaluation.ablations import ablation_report
from models.evaluation.forecasters import bundled, forecaster
from models.evaluation.latency import bundle_latency
from models.evaluation.prediction import evaluate
from models.evaluation.protocols import SERVER_PROTOCOLS, protocol_named
from models.evaluation.real_streams import msrc12_stream_report
from models.evaluation.report import classifier_report, compare, server_report
from models.evaluation.sim2real import sim2real_report

app = typer.Typer(no_args_is_help=True, help="Measure a bundle.")


@app.command("prediction")
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
    report: ReportOption = None,
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
    show(results, as_json)


@app.command("gestures")
def evaluate_gestures(
    data: DataOption,
    bundle: Annotated[Path, typer.Option("--bundle", help="Folder of a bundle.")] = CLASSIFIER,
    predictor: PredictorBundleOption = PREDICTOR,
    benchmark: Annotated[
        Literal["synthetic", "sim2real", "msrc12-stream"],
        typer.Option("--benchmark", help="Held-out virtual people, or real recordings."),
    ] = "synthetic",
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Accuracy, calibration, delays and false reactions of a classifier."""
    classify, predict = model_of(bundle), model_of(predictor)
    if benchmark == "sim2real":
        show(sim2real_report(classify.batched, predict.batched, data), as_json)
    elif benchmark == "msrc12-stream":
        show(msrc12_stream_report(classify.batched, predict.batched, data), as_json)
    else:
        show(classifier_report(classify, predict, data, cache), as_json)


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
    show(ablation_report(out, seed, data, cache), as_json)


def latency(as_json: JsonOption = False) -> None:
    """Time of both shipped models for one window, on one thread."""
    show({path.name: bundle_latency(path) for path in (PREDICTOR, CLASSIFIER)}, as_json)
