"""Options that several commands share."""

import asyncio
import sys
from collections.abc import Coroutine
from pathlib import Path
from typing import Annotated, Any, TypeVar

import msgspec
import typer

from agent_server.cli.status import INTERRUPTED
from agent_server.config import (
    AccessSettings,
    ModelSettings,
    RecordingSettings,
    ServerSettings,
    Settings,
    load_settings,
)
from agent_server.errors import ConfigError

_Section = TypeVar("_Section", RecordingSettings, ServerSettings, ModelSettings, AccessSettings)

ConfigOption = Annotated[
    Path | None, typer.Option("--config", "-c", help="TOML file with settings.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON on stdout and nothing else.")]
HostOption = Annotated[str | None, typer.Option(help="Address to listen on.")]
PortOption = Annotated[int | None, typer.Option(help="Port to listen on; 0 for any free one.")]
PredictorOption = Annotated[
    Path | None, typer.Option(metavar="BUNDLE", help="Predictor instead of the one that ships.")
]
ClassifierOption = Annotated[
    Path | None,
    typer.Option(metavar="BUNDLE", help="Classifier to use, for example one that was taught."),
]
FuturesOption = Annotated[
    int | None,
    typer.Option(metavar="K", help="Futures that a window is classified with; 1 is the forecast."),
]
ParticipantOption = Annotated[
    str | None,
    typer.Option(metavar="PSEUDONYM", help="Who is recorded, by pseudonym; never the name."),
]
ConsentOption = Annotated[
    bool | None,
    typer.Option("--consent", help="The person has agreed to be recorded."),
]
RulesOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="The room's rules: docs/rules.md.")
]
SecretFileOption = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Secret that tokens are signed with: docs/operations.md."),
]
KeysFileOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="TOML file with the hashes of API keys.")
]


def settings_with(
    config: Path | None,
    *,
    host: str | None = None,
    port: int | None = None,
    state: Path | None = None,
    predictor: Path | None = None,
    classifier: Path | None = None,
    futures: int | None = None,
    rules: Path | None = None,
    tls_cert: Path | None = None,
    tls_key: Path | None = None,
    secret_file: Path | None = None,
    keys_file: Path | None = None,
    insecure: bool | None = None,
    participant: str | None = None,
    consent: bool | None = None,
) -> Settings:
    """Settings from a file, with what the command line names in their place.

    Raises:
        ConfigError: If the file or a value is wrong.
    """
    settings = load_settings(config)
    try:
        return msgspec.structs.replace(
            settings,
            server=_changed(
                settings.server,
                host=host,
                port=port,
                state=state,
                tls_cert=tls_cert,
                tls_key=tls_key,
            ),
            access=_changed(
                settings.access, secret_file=secret_file, keys_file=keys_file, insecure=insecure
            ),
            models=_changed(
                settings.models, predictor=predictor, classifier=classifier, futures=futures
            ),
            recording=_changed(settings.recording, participant=participant, consent=consent),
            rules=settings.rules if rules is None else str(rules),
        )
    except ValueError as error:
        raise ConfigError(str(error)) from error


def _changed(section: _Section, **values: str | int | Path | None) -> _Section:
    """A section of the settings with the values that are not None; a path becomes a text."""
    given = {
        name: str(value) if isinstance(value, Path) else value
        for name, value in values.items()
        if value is not None
    }
    return msgspec.structs.replace(section, **given)


def run(main: Coroutine[Any, Any, None], *, interrupted_status: int = INTERRUPTED) -> None:
    """Run a coroutine until it ends or the user interrupts it.

    Args:
        main: What to run.
        interrupted_status: Exit status after an interruption; 0 where that is the way to stop.
    """
    try:
        with asyncio.Runner(loop_factory=_new_loop) as runner:
            runner.run(main)
    except KeyboardInterrupt:
        raise typer.Exit(interrupted_status) from None


def _new_loop() -> asyncio.AbstractEventLoop:
    if sys.platform == "win32":
        return asyncio.new_event_loop()
    import uvloop  # noqa: PLC0415 - there is none on Windows

    return uvloop.new_event_loop()
