"""``agent-server schema``."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from agent_server.assets import checkout
from agent_server.cli.options import JsonOption
from agent_server.errors import ConfigError
from agent_server.protocol.schema import files


def schema(
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Where to write; default: this checkout."),
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; fail if a file is stale.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Generate schema, reference and clients' types from the messages of the protocol."""
    root = out or checkout()
    if root is None:
        raise ConfigError("this is no checkout: say with --out DIR where the files go")
    stale = files.check(root) if check else files.write(root)
    if as_json:
        print(json.dumps({"stale" if check else "written": stale}))
    else:
        console = Console(stderr=check and bool(stale), highlight=False, soft_wrap=True)
        for name in stale:
            console.print(f"{'stale' if check else 'written'}: {root / name}")
        if not stale:
            console.print(f"all {len(files.generated())} files are what the messages say")
        elif check:
            console.print("run `agent-server schema` and commit what it writes")
    if check and stale:
        raise typer.Exit(1)
