"""Commands that are imported only when they are called: most need packages that others do not."""

from importlib import import_module
from typing import Any, ClassVar

import typer
from typer.core import TyperGroup

_RECORDINGS = "Recordings"


class Commands(TyperGroup):
    """The commands of the program, by name: where each is, and the panel of the help for it."""

    places: ClassVar[dict[str, tuple[str, str | None]]] = {
        "demo": ("demo:demo", None),
        "serve": ("serve:serve", None),
        "replay": ("replay:replay", None),
        "convert": ("convert:convert", None),
        "record": ("record:record", None),
        "recover": ("recover:recover", None),
        "schema": ("schema:schema", None),
        "config": ("config:config", None),
        "check-config": ("config:check_config", None),
        "token": ("token:token", None),
        "doctor": ("doctor:doctor", None),
        "gestures": ("gestures:gestures", None),
        "bench": ("bench:bench", None),
        "info": ("tools:info", _RECORDINGS),
        "cut": ("tools:cut", _RECORDINGS),
        "merge": ("tools:merge", _RECORDINGS),
        "annotate": ("tools:annotate", _RECORDINGS),
        "anonymise": ("tools:anonymise", _RECORDINGS),
        "export": ("export:export", _RECORDINGS),
        "qa": ("qa:qa", _RECORDINGS),
    }

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # Where a name is not known typer proposes one of these.
        self.commands = dict.fromkeys(self.places)  # type: ignore[assignment]

    def list_commands(self, ctx: "typer.Context") -> list[str]:  # type: ignore[override]
        """Names in the order of the help."""
        del ctx
        return list(self.places)

    def get_command(self, ctx: "typer.Context", cmd_name: str):  # type: ignore[no-untyped-def,override]
        """A command, or None where there is none of this name."""
        del ctx
        if cmd_name not in self.places:
            return None
        place, panel = self.places[cmd_name]
        module, name = place.split(":")
        found = getattr(import_module(f"agent_server.cli.{module}"), name)
        if isinstance(found, typer.Typer):
            return typer.main.get_command(found)
        alone = typer.Typer(add_completion=False)
        alone.command(name=cmd_name, rich_help_panel=panel)(found)
        return typer.main.get_command(alone)
