"""``agent-server config`` and ``agent-server check-config``."""

import json
from pathlib import Path
from typing import Annotated

import typer

from agent_server.cli.options import ConfigOption, JsonOption
from agent_server.config import explain, load_settings, mistakes_in


def config(
    file: ConfigOption = None,
    with_words: Annotated[
        bool, typer.Option("--explain", help="Say above each key what it means.")
    ] = False,
) -> None:
    """Print the settings that hold: defaults, file and environment together, as a TOML file."""
    print(explain(load_settings(file), with_words=with_words), end="")


def check_config(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="TOML file with settings.")],
    as_json: JsonOption = False,
) -> None:
    """Name each mistake of a file of settings and its line; status 1 if there is any."""
    mistakes = mistakes_in(file)
    if as_json:
        print(json.dumps({"file": str(file), "mistakes": mistakes}))
    else:
        print("\n".join(mistakes or [f"{file}: no mistakes"]))
    if mistakes:
        raise typer.Exit(1)
