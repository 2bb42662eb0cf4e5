"""``agent-server doctor``."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from agent_server.cli.checkup import Check, check_up
from agent_server.cli.options import ConfigOption, HostOption, JsonOption, PortOption, settings_with


def doctor(
    config: ConfigOption = None,
    host: HostOption = None,
    port: PortOption = None,
    folder: Annotated[
        list[Path] | None,
        typer.Option("--folder", metavar="DIR", help="Where the server is to write."),
    ] = None,
    only: Annotated[
        list[Check] | None, typer.Option(help="What alone to look at; may be given again.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Look at models, port, clock, disk and page; status 1 if anything is amiss."""
    settings = settings_with(config, host=host, port=port)
    state = settings.server.state
    folders = [Path(state)] if state is not None else []
    findings = check_up(settings, (*folders, *(folder or [Path.cwd()])), only or [])
    if as_json:
        told = [one.as_json() for one in findings]
        print(json.dumps({"ok": all(one.is_good for one in findings), "checks": told}))
    else:
        console = Console(highlight=False, soft_wrap=True)
        for one in findings:
            mark = "[green]good[/] " if one.is_good else "[bold red]amiss[/]"
            console.print(f"{mark} [bold]{one.check:6}[/] {escape(one.found)}")
            if one.remedy:
                console.print(f"             -> {escape(one.remedy)}")
    if not all(one.is_good for one in findings):
        raise typer.Exit(1)
