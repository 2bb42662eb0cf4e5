"""Two decision logs side by side: what is a change, and what only other arithmetic.

On one machine with one version of onnxruntime a replay repeats a log byte for byte. Other
processors round the models' sums otherwise, and what follows from them may differ in its last
digits; all else must be the same.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

import msgspec

from agent_server.errors import RecordingError
from agent_server.protocol import messages as m

PROBABILITY_TOLERANCE = 0.02
"""Difference of two probabilities that is no change. The limits at which a gesture begins and ends
lie more than ten times as far apart."""
AFFECT_TOLERANCE = 0.05
"""The same for valence and arousal, on [-10, 10]."""
_AFFECT = ("valence", "arousal")


@dataclass(frozen=True, slots=True)
class Change:
    """One field of one decision that is another.

    Attributes:
        index: Which decision.
        field: Path of the field, for example ``gate.is_open``; empty for a whole decision that
            only one of the logs has.
        expected: Its value in the expected log, or None.
        actual: Its value now, or None.
    """

    index: int
    field: str
    expected: object
    actual: object

    def __str__(self) -> str:
        what = self.field or "the decision"
        return f"decision {self.index}: {what} is {self.actual!r}, expected {self.expected!r}"


def read_log(path: Path) -> list[m.DecisionBody]:
    """Read a decision log: one decision a line, as ``replay --json`` prints them.

    Raises:
        RecordingError: If it cannot be read; the text names file and line.
    """
    decisions: list[m.DecisionBody] = []
    try:
        lines = path.read_bytes().splitlines()
    except OSError as error:
        raise RecordingError(f"{path} cannot be read: {error.strerror or error}") from error
    decoder = msgspec.json.Decoder(m.DecisionBody)
    for number, line in enumerate(lines, 1):
        try:
            decisions.append(decoder.decode(line))
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            raise RecordingError(
                f"{path}, line {number} is no decision: {error}; give what replay --json printed"
            ) from error
    return decisions


def changes(
    expected: Sequence[m.DecisionBody], actual: Sequence[m.DecisionBody]
) -> Iterator[Change]:
    """What is another, decision by decision; rounding within the tolerances is not."""
    for index, (want, got) in enumerate(zip_longest(expected, actual)):
        if want is None or got is None:
            yield Change(index, "", want and want.id, got and got.id)
        elif want != got:
            pair = (msgspec.to_builtins(want), msgspec.to_builtins(got))
            yield from (Change(index, *found) for found in _fields("", *pair))


def _fields(path: str, want: object, got: object) -> Iterator[tuple[str, object, object]]:
    if isinstance(want, dict) and isinstance(got, dict):
        for key in [*want, *(key for key in got if key not in want)]:
            yield from _fields(f"{path}.{key}" if path else key, want.get(key), got.get(key))
    elif want != got and not _is_rounding(path, want, got):
        yield path, want, got


def _is_rounding(path: str, want: object, got: object) -> bool:
    if not (isinstance(want, float | int) and isinstance(got, float | int)):
        return False
    if path.startswith(("probabilities.", "spread.")):
        return abs(want - got) <= PROBABILITY_TOLERANCE
    is_affect = path.startswith("gate.") and path.rpartition(".")[2] in _AFFECT
    return is_affect and abs(want - got) <= AFFECT_TOLERANCE
