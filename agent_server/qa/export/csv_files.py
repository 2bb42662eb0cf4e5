"""A recording as tables that spreadsheets and statistics programs read."""

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.qa.export.content import Content, in_camera
from agent_server.recording.label_table import COLUMNS, label_rows
from agent_server.skeleton.formats import get_format

Row = Sequence[object]


def write_csv(content: Content, folder: Path) -> list[Path]:
    """Write ``skeleton``, ``affect``, ``decisions`` and ``labels`` as ``*.csv``.

    Times are seconds from the recording's start, positions metres in the camera frame. The
    table of labels is what ``annotate`` reads.

    Returns:
        The files.

    Raises:
        InvalidInput: If a file cannot be written.
    """
    names = content.sights[0].decision.probabilities.keys() if content.sights else ()
    tables: dict[str, tuple[Row, Iterable[Row]]] = {
        "skeleton": (("time_s", "body_id", "joint", "x", "y", "z", "confidence"), _joints(content)),
        "affect": (
            ("time_s", "valence", "arousal"),
            ((_s(a.originating_ns), a.valence, a.arousal) for a in content.affect),
        ),
        "decisions": (
            ("time_s", "index", "gesture", "outcome", "reaction", "reason",
             *(f"p_{name}" for name in names)),
            _decisions(content),
        ),
        "labels": (COLUMNS, label_rows(content.labels)),
    }  # fmt: skip
    files = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, (heading, rows) in tables.items():
            path = folder / f"{name}.csv"
            with path.open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(heading)
                writer.writerows(rows)
            files.append(path)
    except OSError as error:
        raise InvalidInput(f"{folder} cannot be written: {error.strerror or error}") from error
    return files


def _joints(content: Content) -> Iterable[Row]:
    for frame in content.frames:
        time = _s(frame.originating_ns)
        names = get_format(frame.format).names
        for name, joint in zip(names, in_camera(frame).tolist(), strict=True):
            yield (time, frame.body_id, name, *(round(value, 5) for value in joint))


def _decisions(content: Content) -> Iterable[Row]:
    for sight in content.sights:
        d = sight.decision
        reaction = "" if d.command is None else d.command.reaction
        yield (
            _s(d.end_ns), d.index, d.gesture, d.outcome.value, reaction, d.reason,
            *d.probabilities.values(),
        )  # fmt: skip


def _s(stamp_ns: int) -> str:
    return f"{stamp_ns / NS_PER_S:.6f}"
