"""Labels from a table that a spreadsheet writes."""

import csv
from collections.abc import Mapping
from math import isfinite
from pathlib import Path

from agent_server.domain.gesture import IDLE
from agent_server.domain.label import Label
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput

COLUMNS = ("gesture", "onset_s", "offset_s", "subject", "expected", "quiet")
_NEEDED = COLUMNS[:3]
_WORDS = {"": False, "no": False, "false": False, "0": False, "yes": True, "true": True, "1": True}


def read_label_table(path: Path) -> list[Label]:
    """The labels of a CSV file with a line of headings.

    ``gesture``, ``onset_s`` and ``offset_s`` are needed, in seconds from the recording's start;
    ``subject``, ``expected`` (a reaction) and ``quiet`` (yes or no) may be empty or missing.
    Columns are parted by commas or semicolons.

    Raises:
        InvalidInput: If something is wrong; the text names line and column.
    """
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path} cannot be read as UTF-8: {error}", field="labels") from error
    heading = text.partition("\n")[0]
    rows = csv.DictReader(text.splitlines(), delimiter=";" if ";" in heading else ",")
    names = [(name or "").strip() for name in rows.fieldnames or ()]
    rows.fieldnames = names
    missing = [name for name in _NEEDED if name not in names]
    unknown = [name for name in names if name not in COLUMNS]
    if missing or unknown:
        wrong = f"lacks {', '.join(missing)}" if missing else f"has {', '.join(unknown)}"
        raise InvalidInput(
            f"{path}, line 1: it {wrong}: the columns are {', '.join(COLUMNS)}, of which the first "
            "three are needed",
            field="labels",
        )
    labels = [
        _label({k: (v or "").strip() for k, v in row.items() if k}, f"{path}, line {rows.line_num}")
        for row in rows
    ]
    if not labels:
        raise InvalidInput(f"{path} holds no label: write one a line", field="labels")
    return labels


def _label(row: Mapping[str, str], where: str) -> Label:
    onset, offset = _seconds(row, "onset_s", where), _seconds(row, "offset_s", where)
    if onset >= offset:
        raise InvalidInput(
            f"{where}: onset_s is {onset:g} and offset_s {offset:g}: a label ends after it begins",
            field="offset_s",
        )
    said = row.get("quiet", "").lower()
    if said not in _WORDS:
        raise InvalidInput(f"{where}: quiet is {said!r}: write yes or no", field="quiet")
    return made_label(
        row["gesture"],
        to_ns(onset),
        to_ns(offset),
        row.get("subject", ""),
        row.get("expected") or None,
        quiet=_WORDS[said],
        where=where,
    )


def made_label(
    gesture: str,
    onset_ns: int,
    offset_ns: int,
    subject: str,
    expected: str | None,
    *,
    quiet: bool,
    where: str,
) -> Label:
    """A label that does not contradict itself.

    Raises:
        InvalidInput: If it has no gesture, or asks for a reaction and for quiet.
    """
    if expected is not None and quiet:
        raise InvalidInput(
            f"{where}: it expects {expected} and asks for quiet: leave one of them out",
            field="quiet",
        )
    if not gesture and not quiet:
        raise InvalidInput(
            f"{where}: gesture is empty: name one, or {IDLE!r} for everything that is none",
            field="gesture",
        )
    return Label(gesture or IDLE, onset_ns, offset_ns, subject, expected, quiet)


def _seconds(row: Mapping[str, str], column: str, where: str) -> float:
    try:
        value = float(row[column])
    except ValueError:
        value = float("nan")
    if not isfinite(value) or value < 0:
        raise InvalidInput(
            f"{where}: {column} is {row[column]!r}: write seconds from the start, such as 4.25",
            field=column,
        )
    return value
