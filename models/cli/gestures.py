"""``python -m models gestures``: teach the agent gestures, and check what it learnt."""

from pathlib import Path
from typing import Annotated, Any, Literal

import torch
import typer
from rich.console import Console
from rich.table import Table

from agent_server.inference.manifest import MODEL_FILE, MotionManifest, read_manifest
from models.cli.options import (
    CACHE,
    CLASSIFIER,
    PREDICTOR,
    CacheOption,
    JsonOption,
    PredictorBundleOption,
    ReportOption,
    SeedOption,
    show,
)
from models.data.labelled import check_known, read_gestures
from models.evaluation.gesture_measures import measure
from models.evaluation.gesture_page import show_measures
from models.evaluation.readings import HELD, PREDICTED, TRUE
from models.export.teach import Lesson, taught_figures, teach
from models.ops.session import OnnxModel

app = typer.Typer(no_args_is_help=True, help="Teach gestures of one's own.")

FolderArgument = Annotated[
    Path, typer.Argument(metavar="DIR", help="Folder of labelled *.mcap, or of MSRC-12's files.")
]
EVERY = 3
"""Every third time is printed: 0.3 s, 0.6 s, ..."""
TagsOption = Annotated[
    bool, typer.Option("--tags", help="Learn the data set's own names, which convert keeps.")
]


@app.command("train")
def train(
    folder: FolderArgument,
    out: Annotated[Path, typer.Option("--out", help="Folder of the bundle to write.")],
    encoder: Annotated[
        Literal["fresh", "frozen"],
        typer.Option("--encoder", help="Train all weights anew, or the head alone (faster)."),
    ] = "fresh",
    only: Annotated[bool, typer.Option("--only", help="Leave out the built-in gestures.")] = False,
    held_out: Annotated[
        str | None,
        typer.Option("--held-out", help="The person whose recordings test; else the last."),
    ] = None,
    start: Annotated[
        Path, typer.Option("--start", help="Bundle whose encoder a frozen lesson keeps.")
    ] = CLASSIFIER,
    predictor: PredictorBundleOption = PREDICTOR,
    tags: TagsOption = False,
    steps: Annotated[int | None, typer.Option("--steps", help="Updates.")] = None,
    seed: SeedOption = 0,
    as_json: JsonOption = False,
    cache: CacheOption = CACHE,
) -> None:
    """Train a classifier on recordings of several people, one of whom is held out."""
    torch.set_num_threads(2)
    lesson = Lesson(out, start, predictor, cache, encoder, only, held_out, steps, seed)
    manifest = teach(read_gestures(folder, tags), lesson)
    if as_json:
        show({"bundle": str(out), **manifest.results}, as_json)
    else:
        _tell(manifest, out)


@app.command("check")
def check(
    bundle: Annotated[Path, typer.Argument(metavar="BUNDLE", help="Bundle of a classifier.")],
    folder: FolderArgument,
    subject: Annotated[
        list[str] | None,
        typer.Option("--subject", help="Check on this person only; may be repeated."),
    ] = None,
    predictor: PredictorBundleOption = PREDICTOR,
    tags: TagsOption = False,
    report: ReportOption = None,
    as_json: JsonOption = False,
) -> None:
    """Confusion matrix, accuracy against time seen and calibration on labelled recordings."""
    classes = tuple(read_manifest(bundle).labels)
    read_manifest(predictor)
    taught = read_gestures(folder, tags)
    check_known(taught.gestures, classes, str(bundle))
    people = tuple(subject) if subject else taught.subjects
    check_known(people, taught.subjects, str(folder))
    recordings = taught.of(*people)
    classify, predict = OnnxModel(bundle / MODEL_FILE), OnnxModel(predictor / MODEL_FILE)
    measured = measure(classify.batched, predict.batched, recordings, classes)
    if report is not None:
        title = f"{bundle.resolve().name} on recordings of {', '.join(people)}"
        Console(stderr=True).print(f"wrote {show_measures(report, title, measured)}")
    figures = taught_figures(classify, predict, measured)
    if as_json:
        show(figures, as_json)
    else:
        _print_figures(figures, classes)
        _print_time_seen(figures["time_seen"])


def _tell(manifest: MotionManifest, out: Path) -> None:
    people, minutes = manifest.results["people"], manifest.training.wall_s / 60
    _print_figures(manifest.results, tuple(manifest.labels))
    console = Console()
    console.print(
        f"\nTrained on {', '.join(people['train'])} in {minutes:.1f} minutes; the "
        f" figures are of {people['test']}. The bundle is {out}:\n"
        f"  agent-server serve --classifier {out}",
        highlight=False,
        soft_wrap=True,
    )


def _print_figures(figures: dict[str, Any], classes: tuple[str, ...]) -> None:
    console = Console()
    row = figures[PREDICTED]
    table = Table(title="Which window is taken for what (rows: what it shows)")
    table.add_column("")
    for name in classes:
        table.add_column(name, justify="right")
    table.add_column("right", justify="right")
    for name, counts in zip(classes, row["confusion"], strict=True):
        right = f"{100 * row['recall'][name]:.0f} %" if sum(counts) else "-"
        table.add_row(name, *(str(count or "") for count in counts), right)
    console.print(table)
    decided = figures["decisions"][PREDICTED]
    late = "-" if decided["delay_s_p50"] is None else f"{decided['delay_s_p50']:.2f} s"
    console.print(
        f"windows right: {100 * row['accuracy']:.1f} % "
        f"(last frame held {100 * figures[HELD]['accuracy']:.1f} %, "
        f"3 s seen {100 * figures[TRUE]['accuracy']:.1f} %)\n"
        f"calibration error: {row['ece']:.3f}\n"
        f"gestures decided on: {100 * decided['right']:.1f} % right, "
        f"{100 * decided['wrong']:.1f} % wrong, {100 * decided['missed']:.1f} % missed, "
        f"median {late} after onset\n"
        f"false reactions to idle virtual people: "
        f"{figures['idle_synthetic']['false_reactions']} in "
        f"{figures['idle_synthetic']['minutes']} minutes",
        highlight=False,
    )


def _print_time_seen(found: dict[str, Any]) -> None:
    table = Table(title="Gestures named right, by the time seen since their onset")
    for name in ("seen", "gestures", "2 s predicted", "last frame held", "2 s true"):
        table.add_column(name, justify="right")
    columns = (found[name] for name in ("seconds", "gestures", PREDICTED, HELD, TRUE))
    for place, (seconds, gestures, *shares) in enumerate(zip(*columns, strict=True)):
        if place % EVERY == 0:
            cells = ("-" if share is None else f"{100 * share:.0f} %" for share in shares)
            table.add_row(f"{seconds:.1f} s", str(gestures), *cells)
    Console().print(table)
