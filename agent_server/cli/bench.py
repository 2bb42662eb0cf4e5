"""``agent-server bench``."""

from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console

from agent_server import assets
from agent_server.bench.decision import measure_decisions
from agent_server.bench.face import measure_faces
from agent_server.bench.ingest import measure_ingest
from agent_server.bench.load import (
    STACKS,
    Coding,
    Load,
    LoadResult,
    Stack,
    find_capacity,
    largest,
    measure_load,
    told_in_a_line,
)
from agent_server.bench.load_plot import load_plot
from agent_server.bench.reactions import measure_reactions, played, recorded
from agent_server.bench.recording import measure_recording
from agent_server.bench.replay import measure_replay
from agent_server.cli.options import FuturesOption, JsonOption, run, settings_with
from agent_server.config import Settings
from agent_server.service.loading import load_models, load_room

bench = typer.Typer(
    name="bench",
    help="Measure the product on this machine.",
    no_args_is_help=True,
    add_completion=False,
)


@bench.command()
def ingest(
    rounds: Annotated[int, typer.Option(min=1, help="How often to run the stream.")] = 7,
    as_json: JsonOption = False,
) -> None:
    """Decode, validate, retarget, resample and window one frame."""
    _show(measure_ingest(rounds), as_json=as_json)


@bench.command()
def decision(
    rounds: Annotated[int, typer.Option(min=1, help="How often to run the stream.")] = 5,
    futures: FuturesOption = None,
    as_json: JsonOption = False,
) -> None:
    """One decision, stage by stage, on one thread."""
    models = load_models(settings_with(None, futures=futures))
    rules = load_room(Settings(), models)
    _show(measure_decisions(models, rules, rounds), as_json=as_json)


@bench.command()
def face(
    image: Annotated[
        Path | None,
        typer.Argument(metavar="IMAGE", help="Picture of a face; else one is painted."),
    ] = None,
    rounds: Annotated[int, typer.Option(min=1, help="How often to measure each stage.")] = 200,
    as_json: JsonOption = False,
) -> None:
    """One image of a face, stage by stage, on one thread."""
    _show(measure_faces(image, rounds), as_json=as_json)


@bench.command()
def replay(
    file: Annotated[
        Path | None, typer.Argument(metavar="FILE", help="Recording; else the demo's.")
    ] = None,
    runs: Annotated[int, typer.Option(min=1, help="How often to replay it.")] = 5,
    as_json: JsonOption = False,
) -> None:
    """Replay a recording with all models on one thread; each run must give the same bytes."""
    models = load_models()
    path = file or assets.demo_recording()
    result = measure_replay(path, Settings(), models, load_room(Settings(), models), runs)
    _show(result, as_json=as_json)
    if result.identical != runs:
        raise typer.Exit(1)


@bench.command()
def recording(
    minutes: Annotated[float, typer.Option(min=0.1, help="Length of the recording.")] = 60.0,
    as_json: JsonOption = False,
) -> None:
    """Write and read a long recording of a body and a face: size, memory, seeking."""
    _show(measure_recording(minutes), as_json=as_json)


@bench.command()
def reactions(
    folder: Annotated[
        Path | None, typer.Argument(metavar="DIR", help="Folder of labelled recordings.")
    ] = None,
    seeds: Annotated[
        int, typer.Option(min=1, help="Without DIR: how often to play each scenario anew.")
    ] = 3,
    as_json: JsonOption = False,
) -> None:
    """From a gesture's onset to the reaction, and reactions that nobody asked for."""
    models = load_models()
    rules = load_room(Settings(), models)
    streams = played(seeds) if folder is None else recorded(folder)
    _show(measure_reactions(models, rules, streams), as_json=as_json)


@bench.command()
def load(
    sessions: Annotated[
        int | None, typer.Option(min=1, help="People at once; else the most is looked for.")
    ] = None,
    seconds: Annotated[float, typer.Option(min=2.0, help="For how long, each time.")] = 15.0,
    body_only: Annotated[
        bool, typer.Option("--body-only", help="Send no landmarks beside the body.")
    ] = False,
    coding: Annotated[Coding, typer.Option(help="What the clients speak.")] = "json",
    stack: Annotated[Stack, typer.Option(help="What carries the websockets.")] = "uvicorn",
    servers: Annotated[
        int, typer.Option(min=1, help="Server processes over which the sessions are spread.")
    ] = 1,
    compare: Annotated[bool, typer.Option("--compare", help="Measure every stack.")] = False,
    start: Annotated[int, typer.Option(min=1, help="Where to begin to look.")] = 25,
    step: Annotated[int, typer.Option(min=1, help="How finely to look.")] = 10,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the runs into an SVG file.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Real websocket clients in other processes: latency, drops and memory."""
    chosen = [
        Load(each, coding, not body_only, seconds, servers)
        for each in (STACKS if compare else (stack,))
    ]
    console = Console(stderr=True)
    results: dict[str, list[LoadResult]] = {}

    async def measure() -> None:
        for one in chosen:

            async def told(people: int, one: Load = one) -> LoadResult:
                result = await measure_load(people, one)
                console.print(told_in_a_line(result))
                return result

            results[one.stack] = (
                await find_capacity(told, start, step)
                if sessions is None
                else [await told(sessions)]
            )

    run(measure())
    if plot is not None:
        plot.write_text(load_plot(results), "utf-8")
    if sessions is not None and not compare:
        _show(results[stack][0], as_json=as_json)
        return
    summary = {name: {"largest": largest(runs), "runs": runs} for name, runs in results.items()}
    _show(summary, as_json=as_json)


def _show(result: object, *, as_json: bool) -> None:
    data = msgspec.json.encode(result)
    print(data.decode() if as_json else msgspec.json.format(data, indent=2).decode())
