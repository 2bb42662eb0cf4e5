"""Command line of training, export and evaluation: ``python -m models --help``."""

import sys

import typer

from agent_server.errors import AgentServerError
from models.cli import evaluate, export, generate, gestures, train

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, help=__doc__)
for name, group in (
    ("train", train),
    ("export", export),
    ("evaluate", evaluate),
    ("gestures", gestures),
    ("generate", generate),
):
    app.add_typer(group.app, name=name)
for command in (evaluate.ablate, evaluate.latency):
    app.command()(command)


def main() -> None:
    """Run the command line; an error of the product is one sentence on stderr, and status 2."""
    try:
        app()
    except AgentServerError as error:
        print(error, file=sys.stderr)
        raise SystemExit(2) from error


if __name__ == "__main__":
    main()
