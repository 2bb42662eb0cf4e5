"""Comma-separated numbers, as two of the published motion sets keep them."""

import math
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.errors import InvalidInput


def read_rows(path: Path, columns: int) -> Float64:
    """All rows of a file of comma-separated numbers.

    Args:
        path: The file; empty lines are skipped.
        columns: How many numbers a line has.

    Returns:
        Shape (rows, columns), at least one row.

    Raises:
        InvalidInput: If it cannot be read, is empty, or a line has another number of columns or
            something that is no finite number; names the line and the value.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path} cannot be read as text: {error}", code="unreadable") from error
    if not any(line.strip() for line in lines):
        raise InvalidInput(f"{path} is empty: fetch it again", code="empty")
    try:
        rows = np.loadtxt(lines, delimiter=",", comments=None, dtype=np.float64, ndmin=2)
    except ValueError:
        rows = np.empty((0, 0))
    if rows.shape[1] != columns or not np.isfinite(rows).all():
        raise InvalidInput(
            f"{path}, {_fault(lines, columns)}: give the file as it is published",
            code="malformed",
        )
    return rows


def _fault(lines: list[str], columns: int) -> str:
    """Where the first line is that does not fit, and what it has instead."""
    for number, line in enumerate(lines, start=1):
        cells = line.split(",")
        if not line.strip():
            continue
        if len(cells) != columns:
            return f"line {number} has {len(cells)} columns, expected {columns}"
        for column, cell in enumerate(cells, start=1):
            if not _is_finite(cell):
                return (
                    f"line {number}, column {column} is '{cell.strip()}', expected a finite number"
                )
    return f"expected {columns} comma-separated numbers a line"


def _is_finite(cell: str) -> bool:
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return False
