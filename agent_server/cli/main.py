"""The command line ``agent-server``. One file a group of commands."""

from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from agent_server import __version__
from agent_server.cli.commands import Commands
from agent_server.cli.status import ERROR
from agent_server.errors import AgentServerError
from agent_server.logs import LogFormat, set_up_logs

app = typer.Typer(
    name="agent-server",
    cls=Commands,
    help="Lets a virtual agent read a person's body and face, and react.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _show_version(wanted: bool) -> None:
    if wanted:
        print(__version__)
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version."),
    ] = False,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Log more.")] = False,
    log_format: Annotated[
        LogFormat, typer.Option(help="Log lines for people, or JSON objects for machines.")
    ] = "text",
) -> None:
    del version
    set_up_logs(log_format, verbose=verbose)


def main() -> None:
    """Run a command; what keeps it from its work ends it with a sentence and status 2."""
    try:
        app()
    except AgentServerError as error:
        words = f"[bold red]error:[/] {escape(str(error))}"
        Console(stderr=True).print(words, highlight=False, soft_wrap=True)
        raise SystemExit(ERROR) from None
