"""``agent-server qa``."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from agent_server.cli.options import ConfigOption, JsonOption, RulesOption, settings_with
from agent_server.cli.status import ERROR, FAILED
from agent_server.cli.verdicts import show_run
from agent_server.config import Settings
from agent_server.errors import ConfigError
from agent_server.inference.manifest import MANIFEST_FILE, read_task
from agent_server.qa.compare import compare
from agent_server.qa.faults.standard import FAULTS
from agent_server.qa.junit import write_junit
from agent_server.qa.report.page import write_report
from agent_server.qa.result import Run, load_run, save_run
from agent_server.qa.run import run_suite
from agent_server.qa.suite import load_suite


def qa(
    suite: Annotated[
        Path,
        typer.Argument(metavar="SUITE", help="Folder of recordings, or a suite.toml: docs/qa.md."),
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write report.html, junit.xml and run.json there."),
    ] = None,
    baseline: Annotated[
        Path | None, typer.Option(metavar="RUN", help="A run.json to compare with.")
    ] = None,
    models: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Try the bundles of this folder; without --baseline, against those in use.",
        ),
    ] = None,
    rules: RulesOption = None,
    faults: Annotated[
        bool, typer.Option("--faults", help="Also replay everything under each fault.")
    ] = False,
    jobs: Annotated[
        int, typer.Option("--jobs", "-j", min=1, help="Processes.", show_default="all cores")
    ] = os.cpu_count() or 1,
    config: ConfigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Replay a suite of labelled recordings and judge what the agent does.

    Ends with status 1 where an expectation is not met, and with 2 where something kept it from
    a verdict: a suite or a recording that cannot be read. --models and --rules name a candidate:
    it is judged, and compared decision by decision with what is in use.
    """
    described = load_suite(suite)
    before = None if baseline is None else load_run(baseline)
    in_use = settings_with(config)
    candidate = _candidate(in_use, config, models, rules)
    is_shadow = candidate != in_use and before is None
    console = Console(stderr=as_json, highlight=False)
    with _progress(Console(stderr=True), described.name) as tell:
        runs = run_suite(
            described,
            [in_use, candidate] if is_shadow else [candidate],
            jobs=jobs,
            faults=FAULTS if faults else (),
            progress=tell,
        )
    run = runs[-1]
    before = runs[0] if is_shadow else before
    comparison = None if before is None else compare(before, run)
    if out is not None:
        _write(run, before, out)
    if as_json:
        print(msgspec.json.encode(run).decode())
    else:
        show_run(console, run, comparison)
        if out is not None:
            console.print(f"\n[bold]{out / 'report.html'}[/], junit.xml and run.json are written")
    if run.has_errors:
        raise typer.Exit(ERROR)
    if not run.passed:
        raise typer.Exit(FAILED)


def _candidate(
    in_use: Settings, config: Path | None, models: Path | None, rules: Path | None
) -> Settings:
    """The settings with the bundles of a folder, and other rules, in their place."""
    if models is None and rules is None:
        return in_use
    chosen: dict[str, Path] = {} if models is None else _bundles(models)
    return settings_with(
        config, predictor=chosen.get("predict"), classifier=chosen.get("classify"), rules=rules
    )


def _bundles(folder: Path) -> dict[str, Path]:
    """Task -> bundle, of a folder that is one or holds some.

    Raises:
        ConfigError: If it has none that predicts or classifies, or several for one task.
    """
    is_one = (folder / MANIFEST_FILE).exists()
    paths = [folder] if is_one else sorted(p.parent for p in folder.glob(f"*/{MANIFEST_FILE}"))
    chosen: dict[str, Path] = {}
    for path in paths:
        task = read_task(path)
        if task not in ("predict", "classify"):
            continue
        if task in chosen:
            raise ConfigError(
                f"--models: {chosen[task]} and {path} both {task}: name a folder with one of each"
            )
        chosen[task] = path
    if not chosen:
        raise ConfigError(
            f"--models: {folder} holds no bundle that predicts or classifies: name a bundle, or a "
            "folder of bundles"
        )
    return chosen


def _write(run: Run, baseline: Run | None, folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"--out: {folder} cannot be made: {error.strerror or error}") from error
    save_run(run, folder / "run.json")
    write_junit(run, folder / "junit.xml")
    write_report(run, baseline, folder / "report.html")


class _Rate(ProgressColumn):
    """Recordings a second, over the last moments."""

    def render(self, task: Task) -> Text:
        """The rate as a text."""
        return Text(f"{task.speed:.1f}/s" if task.speed else "", style="progress.data.speed")


@contextmanager
def _progress(console: Console, name: str) -> Iterator[Callable[[int, int], None]]:
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(name, total=None)
        yield lambda done, of: bar.update(task, completed=done, total=of)
