"""``agent-server serve``."""

import json
import socket
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from agent_server.cli.options import (
    ClassifierOption,
    ConfigOption,
    HostOption,
    JsonOption,
    PortOption,
    PredictorOption,
    RulesOption,
    run,
    settings_with,
)
from agent_server.service.hub import Hub
from agent_server.transports.server import address, bind, build_hub, load_models, serving


def serve(
    config: ConfigOption = None,
    host: HostOption = None,
    port: PortOption = None,
    classifier: ClassifierOption = None,
    predictor: PredictorOption = None,
    rules: RulesOption = None,
    record: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Record every session into a file of this folder."),
    ] = None,
    state: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Remember sessions over a restart in this folder."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Take sensors, renderers and monitors until stopped."""
    settings = settings_with(
        config,
        host=host,
        port=port,
        state=state,
        predictor=predictor,
        classifier=classifier,
        rules=rules,
    )
    hub = build_hub(settings, load_models(settings), record)
    run(_serve(hub, bind(settings), as_json=as_json), interrupted_status=0)


async def _serve(hub: Hub, listener: socket.socket, *, as_json: bool) -> None:
    console = Console(stderr=True)
    async with serving(hub, listener) as stopped:
        if as_json:
            print(json.dumps({"address": address(listener)}), flush=True)
        console.print(f"agent-server listens on [bold]{address(listener)}[/]; Ctrl+C stops it")
        await stopped
