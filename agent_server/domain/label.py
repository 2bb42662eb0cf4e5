"""Ground truth on a recording: what happened when, and what the agent ought to do."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Label:
    """One labelled stretch of a recording.

    Attributes:
        gesture: What the person does.
        onset_ns: When the movement starts, on the session's time line.
        offset_ns: When the body is back at rest.
        subject: Who moves.
        expected: Reaction that ought to follow, for example ``close_window``, or None.
        quiet: Whether no reaction at all may happen in this stretch.
    """

    gesture: str
    onset_ns: int
    offset_ns: int
    subject: str
    expected: str | None
    quiet: bool
