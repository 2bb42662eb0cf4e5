"""``agent-server serve``."""

import gc
import json
import os
import socket
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from agent_server.cli.options import (
    ClassifierOption,
    ConfigOption,
    ConsentOption,
    FuturesOption,
    HostOption,
    JsonOption,
    KeysFileOption,
    ParticipantOption,
    PortOption,
    PredictorOption,
    RulesOption,
    SecretFileOption,
    run,
    settings_with,
)
from agent_server.service.auth import Access
from agent_server.service.hub import Hub
from agent_server.service.loading import load_models
from agent_server.service.secrets import load_access
from agent_server.transports.server import address, bind, build_hub, check_exposure, serving


def serve(
    config: ConfigOption = None,
    host: HostOption = None,
    port: PortOption = None,
    classifier: ClassifierOption = None,
    predictor: PredictorOption = None,
    futures: FuturesOption = None,
    rules: RulesOption = None,
    record: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Record every session into a file of this folder."),
    ] = None,
    participant: ParticipantOption = None,
    consent: ConsentOption = None,
    state: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Remember sessions over a restart in this folder."),
    ] = None,
    tls_cert: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Certificate chain (PEM), for https.")
    ] = None,
    tls_key: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The certificate's private key (PEM).")
    ] = None,
    secret_file: SecretFileOption = None,
    keys_file: KeysFileOption = None,
    insecure: Annotated[
        bool | None,
        typer.Option("--insecure", help="Let anybody in who reaches the port, without tokens."),
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
        futures=futures,
        rules=rules,
        tls_cert=tls_cert,
        tls_key=tls_key,
        secret_file=secret_file,
        keys_file=keys_file,
        insecure=insecure,
        participant=participant,
        consent=consent,
    )
    access = load_access(settings.access, os.environ)
    check_exposure(settings, access)
    hub = build_hub(settings, load_models(settings), record)
    run(_serve(hub, bind(settings), access, as_json=as_json), interrupted_status=0)


async def _serve(hub: Hub, listener: socket.socket, access: Access, *, as_json: bool) -> None:
    console = Console(stderr=True)
    here = address(listener, is_secure=hub.settings.server.tls_cert is not None)
    async with serving(hub, listener, access) as stopped:
        # Modules and models stay for good; no collection need look at them again.
        gc.freeze()
        if as_json:
            print(json.dumps({"address": here}), flush=True)
        console.print(f"agent-server listens on [bold]{here}[/]; Ctrl+C stops it")
        await stopped
