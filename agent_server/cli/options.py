"""Options that several commands share."""

import asyncio
import sys
from collections.abc import Coroutine
from pathlib import Path
from typing import Annotated, Any

import msgspec
import typer

from agent_server.config import Settings, load_settings
from agent_server.errors import ConfigError

ConfigOption = Annotated[
    Path | None, typer.Option("--config", "-c", help="TOML file with settings.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON on stdout and nothing else.")]
HostOption = Annotated[str | None, typer.Option(help="Address to listen on.")]
PortOption = Annotated[int | None, typer.Option(help="Port to listen on; 0 for any free one.")]


def settings_with(config: Path | None, host: str | None, port: int | None) -> Settings:
    """Settings from a file, with the address overridden from the command line.

    Raises:
        ConfigError: If the file or the address is wrong.
    """
    settings = load_settings(config)
    changes = {name: value for name, value in (("host", host), ("port", port)) if value is not None}
    try:
        server = msgspec.structs.replace(settings.server, **changes)
    except ValueError as error:
        raise ConfigError(str(error)) from error
    return msgspec.structs.replace(settings, server=server)


def run(main: Coroutine[Any, Any, None], *, interrupted_status: int = 130) -> None:
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
