"""``agent-server export``."""

from pathlib import Path
from typing import Annotated

import typer

from agent_server.cli.options import (
    ClassifierOption,
    ConfigOption,
    PredictorOption,
    RulesOption,
    settings_with,
)
from agent_server.errors import ConfigError
from agent_server.qa.export.content import gather
from agent_server.qa.export.csv_files import write_csv
from agent_server.qa.export.foxglove import write_foxglove
from agent_server.qa.export.npz import write_npz
from agent_server.qa.export.rerun import write_rerun
from agent_server.qa.setup import load_setup


def export(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A recording.")],
    csv: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Tables into this folder.")
    ] = None,
    npz: Annotated[Path | None, typer.Option(metavar="OUT.npz", help="Arrays for numpy.")] = None,
    rerun: Annotated[
        Path | None, typer.Option(metavar="OUT.rrd", help="For the Rerun viewer.")
    ] = None,
    foxglove: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT.mcap", help="A copy with bodies and forecasts for Foxglove's 3D panel."
        ),
    ] = None,
    config: ConfigOption = None,
    classifier: ClassifierOption = None,
    predictor: PredictorOption = None,
    rules: RulesOption = None,
) -> None:
    """Write a recording for other tools, with the decisions that the models in use come to."""
    wanted = [path for path in (csv, npz, rerun, foxglove) if path is not None]
    if not wanted:
        raise ConfigError("say what to write: --csv DIR, --npz, --rerun or --foxglove FILE")
    settings = settings_with(config, predictor=predictor, classifier=classifier, rules=rules)
    content = gather(file, load_setup(settings))
    if csv is not None:
        write_csv(content, csv)
    if npz is not None:
        write_npz(content, npz)
    if rerun is not None:
        write_rerun(content, rerun)
    if foxglove is not None:
        write_foxglove(content, foxglove)
    for path in wanted:
        print(path)
