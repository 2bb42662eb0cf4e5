"""``python -m models evaluate``, ``ablate`` and ``latency``."""

import sys
from pathlib import Path
from typing import Annotated, Any, Literal

import torch
import typer

from agent_server.domain.gesture import GESTURES
from agent_server.inference.manifest import MODEL_FILE, AffectManifest, read_manifest
from models.affect.data import features_of
from models.affect.views import Pipeline, look_at
from models.cli.options import (
    ARTIFACTS,
    CACHE,
    CLASSIFIER,
    INTERACTION_RUNS,
    PREDICTOR,
    SAMPLER,
    AffectInputOption,
    CacheOption,
    ClassifierBundleOption,
    DataOption,
    InteractionRunsOption,
    JsonOption,
    OutOption,
    PredictorBundleOption,
    ReportOption,
    SeedOption,
    model_of,
    show,
)
from models.data.interaction_sets import two_person_set
from models.data.interactions import INTERACTION_SETS, interaction_set
from models.data.labelled_faces import is_training_set, read_faces, test_split
from models.data.splits import synthetic_split
from models.evaluation.ablations import ablation_report
from models.evaluation.affect import affect_report, read_affect
from models.evaluation.affect_baselines import affect_baselines
from models.evaluation.affect_page import write_affect_page
from models.evaluation.forecasters import bundled, forecaster
from models.evaluation.futures_page import futures_report
from models.evaluation.gesture_page import write_gesture_page
from models.evaluation.interaction_pair_rows import (
    bundled_sets,
    pair_bundle_report,
    pair_rows_report,
)
from models.evaluation.interaction_rows import bundle_report, folds_report, rows_report
from models.evaluation.landmarks import compare_with_mediapipe, on_one_core
from models.evaluation.latency import bundle_latency, reaction_bundle_latency
from models.evaluation.msrc12_stream import msrc12_stream_report
from models.evaluation.msrc12_windows import msrc12_report
from models.evaluation.prediction import evaluate
from models.evaluation.protocols import SERVER_PROTOCOLS, protocol_named
from models.evaluation.real_streams import shipped_report
from models.evaluation.report import classifier_report, compare, server_report
from models.evaluation.sampled import bundled_sampler
from models.evaluation.sim2real import sim2real_report
from models.evaluation.thesis import thesis_report
from models.export.face import landmarker_file
from models.ops.session import OnnxModel

app = typer.Typer(no_args_is_help=True, help="Measure a bundle.")

Benchmark = Literal["synthetic", "thesis", "sim2real", "live", "msrc12", "msrc12-stream"]


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


@app.command("affect")
def evaluate_affect(
    data: DataOption,
    source: AffectInputOption = "mesh",
    split: Annotated[
        Literal["test", "all"] | None,
        typer.Option(help="Which pictures: test for the training set itself, else all."),
    ] = None,
    report: ReportOption = None,
    as_json: JsonOption = False,
) -> None:
    """Valence and arousal of pictures beside a labels.csv, read by the pipeline that ships."""
    torch.set_num_threads(1)
    faces = read_faces(data)
    if (split or ("test" if is_training_set(faces) else "all")) == "test":
        faces = faces.take(test_split(faces)[1])
    bundle = ARTIFACTS / f"affect_{source}"
    read_manifest(bundle, AffectManifest)
    reading = read_affect(faces, source, bundle / MODEL_FILE, ARTIFACTS)
    if report is not None:
        print(write_affect_page(reading, source, report), file=sys.stderr)
    show(affect_report(reading), as_json)


@app.command("affect-baselines")
def evaluate_affect_baselines(
    data: DataOption,
    source: AffectInputOption = "mesh",
    folds: Annotated[int, typer.Option(help="Of the cross-validation.")] = 5,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Ridge regression, boosted trees and the thesis's network, on the faces that we train on."""
    torch.set_num_threads(1)
    faces = read_faces(data)
    seen = features_of(source, look_at(faces, Pipeline(ARTIFACTS), cache), faces.affect)
    show(affect_baselines(source, seen, *test_split(faces), folds), as_json)


@app.command("landmarks")
def evaluate_landmarks(
    data: DataOption,
    wheels: Annotated[
        Path | None, typer.Option(help="Folder of the packages' wheels; fetched if left out.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Our landmarks and blendshapes against the real MediaPipe, and the time of both."""
    on_one_core()
    task_file = landmarker_file(wheels)
    show(compare_with_mediapipe(read_faces(data), ARTIFACTS, task_file), as_json)


@app.command("gestures")
def evaluate_gestures(
    data: DataOption,
    bundle: ClassifierBundleOption = CLASSIFIER,
    predictor: PredictorBundleOption = PREDICTOR,
    benchmark: Annotated[
        Benchmark,
        typer.Option(
            "--benchmark",
            help="synthetic: held-out virtual people. thesis: its Table 5.2 on virtual people. "
            "sim2real, live: the shipped models on real people. msrc12, msrc12-stream: models "
            "trained on other people of MSRC-12.",
        ),
    ] = "synthetic",
    runs: Annotated[
        Path, typer.Option("--runs", help="Where benchmarks keep what they train.")
    ] = Path("runs/gestures"),
    report: ReportOption = None,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Accuracy, calibration, delays and false reactions of a classifier.

    Benchmarks that train keep their runs, and only measure again what they find there. The page
    shows the synthetic one.
    """
    if report is not None:
        if benchmark != "synthetic":
            raise typer.BadParameter("there is a page of --benchmark synthetic only")
        title = f"SYNTHETIC benchmark: `{bundle.name}` with `{predictor.name}` on virtual people"
        recordings = synthetic_split(cache, "test")
        models = model_of(bundle).batched, model_of(predictor).batched
        print(write_gesture_page(report, title, *models, recordings, GESTURES), file=sys.stderr)
    match benchmark:
        case "thesis":
            found = thesis_report(runs / "thesis")
        case "msrc12":
            found = msrc12_report(data, runs / "msrc12")
        case "msrc12-stream":
            found = msrc12_stream_report(data, runs / "msrc12")
        case _:
            found = _shipped(benchmark, model_of(bundle), model_of(predictor), data, cache)
    show(found, as_json)


@app.command("futures")
def evaluate_futures(
    data: DataOption,
    sampler: Annotated[Path, typer.Option("--sampler", help="Bundle that draws.")] = SAMPLER,
    bundle: ClassifierBundleOption = CLASSIFIER,
    predictor: PredictorBundleOption = PREDICTOR,
    runs: Annotated[
        Path, typer.Option("--runs", help="HP-GAN's run `hp_gan`, and those of its losses.")
    ] = Path("runs/futures"),
    report: ReportOption = None,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Diversity, seam and quality of drawn futures, and what they are worth to decisions.

    Runs of the losses are trained where they are missing, and only measured again else.
    """
    models = model_of(bundle).batched, model_of(predictor).batched
    found = futures_report(*models, bundled_sampler(sampler), runs, data, cache, report)
    show(found, as_json)


def _shipped(
    benchmark: Benchmark, classify: OnnxModel, predict: OnnxModel, data: Path, cache: Path
) -> dict[str, Any]:
    match benchmark:
        case "sim2real":
            return sim2real_report(classify.batched, predict.batched, data)
        case "live":
            return shipped_report(classify.batched, predict.batched, data)
        case _:
            return classifier_report(classify, predict, data, cache)


@app.command("interaction")
def evaluate_interaction(
    data: DataOption,
    model: Annotated[
        Literal["interformer", "bigraphdiff"],
        typer.Option(
            "--model", help="interformer: reactions to an action. bigraphdiff: both, from a label."
        ),
    ] = "interformer",
    sets: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="sbu or k3hi, and for bigraphdiff ntu or duetdance; all with a bundle if left "
            "out.",
        ),
    ] = None,
    benchmark: Annotated[
        Literal["bundle", "rows", "folds"],
        typer.Option(
            "--benchmark",
            help="bundle: the research bundles. rows: the paper's ablation S1 to S4, trained "
            "where it has not been. folds: SBU's five folds of people, likewise (interformer).",
        ),
    ] = "bundle",
    row: Annotated[
        list[str] | None,
        typer.Option("--row", help="Of rows: S1 to S4, or bigraphdiff's guided; all if left out."),
    ] = None,
    steps: Annotated[
        int | None,
        typer.Option("--steps", help="Of bigraphdiff's rows: updates of each.", min=1),
    ] = None,
    runs: InteractionRunsOption = INTERACTION_RUNS,
    as_json: JsonOption = False,
) -> None:
    """Generated motion by judges of real one: accuracy, spread and distance of its features."""
    torch.set_num_threads(1)
    if model == "bigraphdiff":
        show(_both_people(data, sets, benchmark, row, steps, runs), as_json)
        return
    chosen = [interaction_set(name) for name in sets or INTERACTION_SETS]
    match benchmark:
        case "bundle":
            found = {spec.name: bundle_report(spec, data, runs, model) for spec in chosen}
        case "rows":
            found = {spec.name: rows_report(spec, data, runs, row) for spec in chosen}
        case "folds":
            found = {"sbu": folds_report(data, runs)}
    show(found, as_json)


def _both_people(
    data: Path,
    sets: list[str] | None,
    benchmark: str,
    row: list[str] | None,
    steps: int | None,
    runs: Path,
) -> dict[str, Any]:
    chosen = [two_person_set(name) for name in sets] if sets else bundled_sets()
    match benchmark:
        case "bundle":
            return {spec.name: pair_bundle_report(spec, data, runs) for spec in chosen}
        case "rows":
            return {spec.name: pair_rows_report(spec, data, runs, row, steps) for spec in chosen}
        case _:
            raise typer.BadParameter(
                f"there is no {benchmark} of bigraphdiff: bundle or rows", param_hint="--benchmark"
            )


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


def latency(
    reaction: Annotated[
        Path | None, typer.Option("--reaction", help="Bundle of a generator: time of a frame.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Time of both shipped models for one window, or of a generator for a frame; one thread."""
    if reaction is not None:
        torch.set_num_threads(1)
        show({reaction.name: reaction_bundle_latency(reaction)}, as_json)
    else:
        show({path.name: bundle_latency(path) for path in (PREDICTOR, CLASSIFIER)}, as_json)
