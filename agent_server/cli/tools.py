"""``agent-server info|cut|merge|annotate|anonymise``: work on recordings."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from agent_server.cli.options import JsonOption
from agent_server.config import Settings
from agent_server.domain.stamp import MAX_STAMP_NS, to_ns
from agent_server.errors import ConfigError
from agent_server.qa.tools.annotate import annotate as annotate_recording
from agent_server.qa.tools.anonymise import anonymise as anonymise_recording
from agent_server.qa.tools.cut import cut as cut_recording
from agent_server.qa.tools.cut import decision_time
from agent_server.qa.tools.info import RecordingInfo, describe
from agent_server.qa.tools.merge import merge as merge_recordings
from agent_server.service.loading import load_models
from agent_server.transports.websocket import SESSION_ID, SESSION_ID_RULE

InArgument = Annotated[Path, typer.Argument(metavar="IN.mcap", help="A recording.")]
OutArgument = Annotated[Path, typer.Argument(metavar="OUT.mcap", help="File to create.")]


class KeptFace(StrEnum):
    """What stays of a face."""

    AFFECT = "affect"
    NONE = "none"


def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A recording.")],
    as_json: JsonOption = False,
) -> None:
    """Show what is in a recording: bodies, faces, labels, topics."""
    found = describe(file)
    if as_json:
        print(msgspec.json.encode(found).decode())
        return
    _show(Console(highlight=False), found)


def cut(
    source: InArgument,
    output: OutArgument,
    start: Annotated[
        float | None, typer.Option("--from", min=0.0, metavar="S", help="Begin, in seconds.")
    ] = None,
    end: Annotated[
        float | None, typer.Option("--to", min=0.0, metavar="S", help="End, in seconds.")
    ] = None,
    decision: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Or: around a recorded decision, by its id or index."),
    ] = None,
    before: Annotated[
        float, typer.Option(min=0.0, metavar="S", help="With --decision: seconds before it.")
    ] = 10.0,
    after: Annotated[
        float, typer.Option(min=0.0, metavar="S", help="With --decision: seconds after it.")
    ] = 5.0,
    as_json: JsonOption = False,
) -> None:
    """Cut a part out of a recording, by time or around a decision."""
    if decision is not None:
        if start is not None or end is not None:
            raise ConfigError("--decision does not go together with --from and --to: use one way")
        at_ns = decision_time(source, decision)
        start_ns, end_ns = max(at_ns - to_ns(before), 0), at_ns + to_ns(after)
    elif start is None and end is None:
        raise ConfigError("say what to keep: --from S, --to S, or --decision ID")
    else:
        start_ns, end_ns = to_ns(start or 0.0), MAX_STAMP_NS if end is None else to_ns(end)
    report = cut_recording(source, output, start_ns, end_ns)
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    console = Console(highlight=False, soft_wrap=True)
    console.print(
        f"{output}: {report.duration_s:.1f} s, {report.records} records, {report.labels} labels"
    )
    if report.split_labels:
        console.print(
            f"  left out: {report.split_labels} labels whose gesture the cut goes through"
        )
    if not report.exact:
        console.print(
            f"  it begins at {report.start_s:.3f} s, where a window began: after a second windows "
            "are the same to the bit, gate and cool-down once they have settled"
        )


def merge(
    output: OutArgument,
    sources: Annotated[
        list[Path], typer.Argument(metavar="IN.mcap...", help="Recordings, in their order.")
    ],
    gap: Annotated[
        float, typer.Option(min=0.0, metavar="S", help="Pause between two, in seconds.")
    ] = 3.0,
    as_json: JsonOption = False,
) -> None:
    """Join recordings, one after the other."""
    report = merge_recordings(sources, output, to_ns(gap))
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    print(f"{output}: {report.duration_s:.1f} s, {report.records} records")
    for path, start_s in zip(sources, report.starts_s, strict=True):
        print(f"  {start_s:9.3f} s  {path}")


def annotate(
    source: InArgument,
    output: OutArgument,
    labels: Annotated[
        Path, typer.Option(metavar="FILE", help="Labels: a .csv, or an .eaf that ELAN saved.")
    ],
    shift: Annotated[
        float, typer.Option(metavar="S", help="Seconds to add to the times of the labels.")
    ] = 0.0,
    replace: Annotated[
        bool, typer.Option("--replace", help="Take out the labels that are there.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Add labels: gesture, onset, offset, expected reaction, or that it must stay quiet."""
    report = annotate_recording(source, output, labels, shift_ns=to_ns(shift), replace_all=replace)
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    added = ", ".join(f"{count} {gesture}" for gesture, count in report.added.items())
    print(f"{output}: added {added}; {report.kept} labels kept, {report.removed} removed")


def anonymise(
    source: InArgument,
    output: OutArgument,
    pseudonym: Annotated[
        str, typer.Option("--as", metavar="NAME", help="New name of the session.")
    ] = "anonymous",
    face: Annotated[
        KeptFace,
        typer.Option(help="What stays of the face: what was read from it, or nothing."),
    ] = KeptFace.AFFECT,
    as_json: JsonOption = False,
) -> None:
    """Take out faces, names, body ids and wall times; motion stays, and is still personal."""
    if not SESSION_ID.fullmatch(pseudonym):
        raise ConfigError(f"--as is {pseudonym!r}: {SESSION_ID_RULE}")
    settings = Settings()
    report = anonymise_recording(
        source, output, pseudonym, load_models(settings).affect, settings.face, face=face.value
    )
    if as_json:
        print(msgspec.json.encode(report).decode())
        return
    instead = ", valence and arousal in their place" if face is KeptFace.AFFECT else ""
    print(
        f"{output}: {report.records} records; taken out: {report.faces} faces{instead}, "
        f"{report.images} images, {report.outputs} outputs; renamed: {report.bodies} bodies, "
        f"{report.subjects} people"
    )


def _show(console: Console, found: RecordingInfo) -> None:
    console.print(
        f"[bold]{escape(found.file)}[/]  {found.duration_s:.1f} s, {found.size_bytes / 1e6:.2f} MB"
    )
    for name, value in found.metadata.items():
        console.print(f"  [dim]{name:<16}[/] {escape(value)}", soft_wrap=True)
    how = "follows the core's log" if found.has_core_log else "deals with the raw input"
    console.print(f"  [dim]{'replay':<16}[/] {how}\n")
    for body in found.bodies:
        rate = "" if body.rate_hz is None else f", {body.rate_hz:g} Hz"
        console.print(
            f"  body {body.body_id}: {body.frames} frames of {body.format}{rate}, "
            f"{body.from_s:.1f} to {body.to_s:.1f} s, longest gap {body.longest_gap_s:g} s"
        )
    for kind, count in found.faces.items():
        console.print(f"  face: {count} times {kind}")
    table = Table(box=None, header_style="dim", pad_edge=False)
    for heading in ("  label", "from", "to", "expected"):
        table.add_column(heading, justify="right" if heading in ("from", "to") else "left")
    for label in found.labels:
        then = label.expected or ("quiet" if label.quiet else "")
        table.add_row(
            f"  {label.gesture}",
            f"{label.onset_ms / 1000:.2f} s",
            f"{label.offset_ms / 1000:.2f} s",
            then,
        )
    console.print()
    console.print(table if found.labels else "  no labels: agent-server annotate adds some")
    counts = ", ".join(f"{name} {count}" for name, count in found.topics.items())
    console.print(f"\n  [dim]{escape(counts)}[/]", soft_wrap=True)
