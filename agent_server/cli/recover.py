"""``agent-server recover``."""

from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console

from agent_server.cli.options import JsonOption
from agent_server.recording.recover import recover as recover_recording


def recover(
    damaged: Annotated[
        Path, typer.Argument(metavar="IN", help="A truncated or damaged recording.")
    ],
    output: Annotated[
        Path | None,
        typer.Argument(
            metavar="[OUT]", help="File to create; else IN with .recovered in its name."
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Save what is whole of a recording, and say what was lost."""
    output = output or damaged.with_suffix(f".recovered{damaged.suffix}")
    report = recover_recording(damaged, output)
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    console = Console(highlight=False)
    console.print(f"{output}: {report.records} records saved")
    if report.complete:
        console.print("nothing was lost")
        return
    if report.damaged_records:
        console.print(f"lost: {report.damaged_records} parts that cannot be read")
    if report.missing_records:
        console.print(f"lost: {report.missing_records} records that are known to have been there")
    if not report.finished:
        console.print(
            f"the writer did not come to an end: {report.lost_bytes} bytes make no whole record, "
            "and what was not yet written is unknown"
        )
