"""Labels as a table that spreadsheets read and write."""

import csv
from collections.abc import Iterable, Iterator, Mapping
from io import StringIO
from math import isfinite
from pathlib import Path

from agent_server.domain.gesture import IDLE
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import InvalidInput

COLUMNS = ("gesture", "onset_s", "offset_s", "subject", "expected", "quiet")
_NEEDED = COLUMNS[:3]
_WORDS = {"": False, "no": False, "false": False, "0": False, "yes": True, "true": True, "1": True}


def read_label_table(path: Path) -> list[Label]:
    """The labels of a CSV file, at least one: see :func:`parse_label_table`.

    Raises:
        InvalidInput: If something is wrong; the text names line and column.
    """
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path} cannot be read as UTF-8: {error}", field="labels") from error
    labels = parse_label_table(text, str(path))
    if not labels:
        raise InvalidInput(f"{path} holds no label: write one a line", field="labels")
    return labels


def parse_label_table(text: str, where: str) -> list[Label]:
    """The labels of a table with a line of headings.

    ``gesture``, ``onset_s`` and ``offset_s`` are needed, in seconds from the recording's start;
    ``subject``, ``expected`` (a reaction) and ``quiet`` (yes or no) may be empty or missing.
    Columns are parted by commas or semicolons.

    Args:
        text: The table.
        where: What it is called in a mistake.

    Raises:
        InvalidInput: If something is wrong; the text names line and column.
    """
    heading = text.partition("\n")[0]
    rows = csv.DictReader(text.splitlines(), delimiter=";" if ";" in heading else ",")
    names = [(name or "").strip() for name in rows.fieldnames or ()]
    rows.fieldnames = names
    missing = [name for name in _NEEDED if name not in names]
    unknown = [name for name in names if name not in COLUMNS]
    if missing or unknown:
        wrong = f"lacks {', '.join(missing)}" if missing else f"has {', '.join(unknown)}"
        raise InvalidInput(
            f"{where}, line 1: it {wrong}: the columns are {', '.join(COLUMNS)}, of which the "
            "first three are needed",
            field="labels",
        )
    return [
        _label(
            {k: (v or "").strip() for k, v in row.items() if k}, f"{where}, line {rows.line_num}"
        )
        for row in rows
    ]


def label_rows(labels: Iterable[Label]) -> Iterator[tuple[str, ...]]:
    """A row for each label, in the order of ``COLUMNS``; times keep every nanosecond."""
    for label in labels:
        yield (
            label.gesture,
            _text(label.onset_ns),
            _text(label.offset_ns),
            label.subject,
            label.expected or "",
            "yes" if label.quiet else "no",
        )


def format_label_table(labels: Iterable[Label]) -> str:
    """The table of some labels, which :func:`parse_label_table` reads."""
    text = StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(label_rows(labels))
    return text.getvalue()


def _text(stamp_ns: int) -> str:
    seconds, rest = divmod(stamp_ns, NS_PER_S)
    return f"{seconds}.{rest:09d}".rstrip("0").removesuffix(".")


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
