"""``agent-server convert``."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console

from agent_server.cli.options import JsonOption
from agent_server.recording.convert import ConstantAffect
from agent_server.recording.convert import convert as convert_recording


class Source(StrEnum):
    """Where a recording may come from."""

    MSRC12 = "msrc12"
    NTU = "ntu"
    KINECT_JSON = "kinect-json"
    UTD_MHAD = "utd-mhad"


def convert(
    source_path: Annotated[Path, typer.Argument(metavar="IN", help="File to convert.")],
    output: Annotated[Path, typer.Argument(metavar="OUT.mcap", help="File to create.")],
    source: Annotated[Source, typer.Option("--from", help="What kind of file it is.")],
    affect: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="VALENCE AROUSAL",
            help="Invent a constant face, so that a body-only recording can pass the gate.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Turn a recording of another tool or data set into an MCAP file that can be replayed."""
    face = None if affect is None else ConstantAffect(*affect)
    report = convert_recording(source.value, source_path, output, affect=face)
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    console = Console(highlight=False, soft_wrap=True)
    console.print(
        f"{output}: {report.frames} frames of {report.bodies} bodies, {report.duration_s:.1f} s, "
        f"format {report.format}, subject {report.subject}"
    )
    for gesture, count in report.labels.items():
        console.print(f"  label {gesture}: {count}")
    for reason, count in report.dropped.items():
        console.print(f"  left out, {reason}: {count}")
