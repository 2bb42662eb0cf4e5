"""Two runs side by side: what got better, what got worse, and which decisions differ."""

from dataclasses import dataclass

from agent_server.qa.result import CaseResult, Check, Run, Step
from agent_server.qa.totals import Totals, total


@dataclass(frozen=True, slots=True)
class Flip:
    """An expectation that one run meets and the other does not.

    Attributes:
        before: In the baseline.
        after: Now.
    """

    before: Check
    after: Check


@dataclass(frozen=True, slots=True)
class CaseChange:
    """What changed on one recording.

    Attributes:
        name: The recording.
        other_file: Whether the file itself is another one.
        broken: Expectations that are met no longer.
        mended: Expectations that are met now.
        decisions: How many decisions there are to compare.
        differing: Pairs of decisions on the same window that came out differently.
        unpaired: Windows that only one of the runs decided on.
    """

    name: str
    other_file: bool
    broken: list[Flip]
    mended: list[Flip]
    decisions: int
    differing: list[tuple[Step, Step]]
    unpaired: int

    @property
    def is_change(self) -> bool:
        """Whether there is anything to tell."""
        return bool(
            self.broken or self.mended or self.differing or self.unpaired or self.other_file
        )


@dataclass(frozen=True, slots=True)
class Comparison:
    """A run against its baseline.

    Attributes:
        before: Figures of the baseline, over the recordings that both have.
        after: Figures of the run, over the same.
        changes: One a recording that both have, by name.
        added: Recordings that only the run has.
        removed: Recordings that only the baseline has.
    """

    before: Totals
    after: Totals
    changes: list[CaseChange]
    added: list[str]
    removed: list[str]

    @property
    def broken(self) -> int:
        """Expectations that are met no longer."""
        return sum(len(change.broken) for change in self.changes)

    @property
    def mended(self) -> int:
        """Expectations that are met now."""
        return sum(len(change.mended) for change in self.changes)

    @property
    def differing(self) -> int:
        """Decisions that came out differently."""
        return sum(len(change.differing) for change in self.changes)

    @property
    def decisions(self) -> int:
        """Decisions that were compared."""
        return sum(change.decisions for change in self.changes)


def compare(baseline: Run, run: Run) -> Comparison:
    """Compare two runs recording by recording, and decision by decision on each."""
    old = {case.name: case for case in baseline.cases}
    new = {case.name: case for case in run.cases}
    common = sorted(old.keys() & new.keys())
    return Comparison(
        before=total(old[name] for name in common),
        after=total(new[name] for name in common),
        changes=[_change(old[name], new[name]) for name in common],
        added=sorted(new.keys() - old.keys()),
        removed=sorted(old.keys() - new.keys()),
    )


def _change(old: CaseResult, new: CaseResult) -> CaseChange:
    before = {check.name: check for check in old.checks}
    flips = [
        Flip(before[check.name], check)
        for check in new.checks
        if check.name in before and before[check.name].passed != check.passed
    ]
    windows = {step.window: step for step in old.steps}
    pairs = [(windows[s.window], s) for s in new.steps if s.window in windows]
    return CaseChange(
        name=new.name,
        other_file=old.sha256 != new.sha256,
        broken=[flip for flip in flips if flip.before.passed],
        mended=[flip for flip in flips if flip.after.passed],
        decisions=len(pairs),
        differing=[(a, b) for a, b in pairs if _said(a) != _said(b)],
        unpaired=len(old.steps) + len(new.steps) - 2 * len(pairs),
    )


def _said(step: Step) -> tuple[str, str, str | None]:
    """What a decision comes to; probabilities may move without changing it."""
    return step.gesture, step.outcome, step.reaction
