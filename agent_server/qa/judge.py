"""Reactions against expectations."""

from collections.abc import Sequence
from dataclasses import dataclass

from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_MS
from agent_server.qa.result import Check
from agent_server.qa.suite import Terms


@dataclass(frozen=True, slots=True)
class Reaction:
    """A reaction that came: when, in ms of the recording, and which."""

    at_ms: int
    name: str


@dataclass(frozen=True, slots=True)
class Judgement:
    """What a recording's reactions are worth.

    Attributes:
        checks: Every expectation.
        false_at_ms: Reactions that nothing asked for.
        judged_ms: Time in which a reaction would have been one.
    """

    checks: list[Check]
    false_at_ms: list[int]
    judged_ms: int


@dataclass(frozen=True, slots=True)
class _Asked:
    """An expected reaction: it answers from ``onset_ms`` to ``end_ms``, in time by ``due_ms``."""

    reaction: str
    gesture: str | None
    onset_ms: int
    due_ms: int
    end_ms: int


def judge(
    reactions: Sequence[Reaction], labels: Sequence[Label], terms: Terms, duration_ms: int
) -> Judgement:
    """Compare.

    The first reaction within the time of an expectation answers it, rightly or wrongly. What
    answers none is a false reaction, but for stretches whose label neither asks for a reaction
    nor for quiet.

    Args:
        reactions: Those of gestures, in order.
        labels: Ground truth of the recording.
        terms: How the suite judges it.
        duration_ms: Length of the recording.
    """
    asked = _asked(labels, terms)
    free = list(reactions)
    checks = []
    for one in asked:
        answer = next((r for r in free if one.onset_ms <= r.at_ms <= one.end_ms), None)
        if answer is not None:
            free.remove(answer)
        checks.append(_answered(one, answer))
    checks += _quiet(reactions, labels, terms)
    checks += _absent(reactions, terms, duration_ms)
    open_spans = [
        (_ms(label.onset_ns), _ms(label.offset_ns) + terms.late_ms)
        for label in labels
        if label.expected is None and not label.quiet
    ]
    spans = [(one.onset_ms, one.end_ms) for one in asked] + open_spans
    false = [r.at_ms for r in free if not any(a <= r.at_ms <= b for a, b in open_spans)]
    return Judgement(checks, false, max(duration_ms - _covered(spans, duration_ms), 0))


def _asked(labels: Sequence[Label], terms: Terms) -> list[_Asked]:
    asked = []
    for label in labels:
        if label.expected is not None:
            onset, end = _ms(label.onset_ns), _ms(label.offset_ns) + terms.late_ms
            due = end if terms.within_ms is None else onset + terms.within_ms
            asked.append(_Asked(label.expected, label.gesture, onset, due, max(end, due)))
    for extra in terms.expect:
        onset = round(extra.onset_s * 1000)
        due = onset + extra.within_ms
        asked.append(_Asked(extra.reaction, extra.gesture, onset, due, due))
    return sorted(asked, key=lambda one: one.onset_ms)


def _answered(one: _Asked, answer: Reaction | None) -> Check:
    within = one.due_ms - one.onset_ms
    passed = answer is not None and answer.name == one.reaction and answer.at_ms <= one.due_ms
    if answer is None:
        detail = "no reaction came"
    else:
        took = answer.at_ms - one.onset_ms
        wrong = "" if answer.name == one.reaction else f", not {one.reaction}"
        late = f", {took - within} ms late" if answer.at_ms > one.due_ms else ""
        detail = f"{answer.name} after {took} ms{wrong}{late}"
    subject = f"{one.gesture} at" if one.gesture else "at"
    return Check(
        "reaction",
        f"{subject} {one.onset_ms / 1000:.1f} s: {one.reaction} within {within} ms",
        one.onset_ms,
        passed,
        detail,
        gesture=one.gesture,
        expected=one.reaction,
        got=None if answer is None else answer.name,
        delay_ms=None if answer is None else answer.at_ms - one.onset_ms,
    )


def _quiet(reactions: Sequence[Reaction], labels: Sequence[Label], terms: Terms) -> list[Check]:
    spans = [
        (label.gesture, _ms(label.onset_ns), _ms(label.offset_ns))
        for label in labels
        if label.quiet
    ]
    if terms.max_in_quiet and spans:
        broken = [r for r in reactions if any(a <= r.at_ms <= b for _, a, b in spans)]
        name = f"at most {terms.max_in_quiet} reactions where it must stay quiet"
        passed = len(broken) <= terms.max_in_quiet
        return [Check("quiet", name, None, passed, _list(broken))]
    checks = []
    for gesture, start, end in spans:
        broken = [r for r in reactions if start <= r.at_ms <= end]
        name = f"{gesture}, {start / 1000:.1f} to {end / 1000:.1f} s: quiet"
        checks.append(Check("quiet", name, start, not broken, _list(broken), gesture=gesture))
    return checks


def _absent(reactions: Sequence[Reaction], terms: Terms, duration_ms: int) -> list[Check]:
    checks = []
    for absent in terms.absent:
        start = round(absent.from_s * 1000)
        end = duration_ms if absent.to_s is None else round(absent.to_s * 1000)
        broken = [
            r for r in reactions if absent.reaction in ("*", r.name) and start <= r.at_ms <= end
        ]
        what = "any reaction" if absent.reaction == "*" else absent.reaction
        name = f"{start / 1000:.1f} to {end / 1000:.1f} s: {what} is absent"
        checks.append(Check("absent", name, start, not broken, _list(broken)))
    return checks


def _list(reactions: Sequence[Reaction]) -> str:
    if not reactions:
        return "no reaction came"
    return ", ".join(f"{r.name} at {r.at_ms / 1000:.1f} s" for r in reactions)


def _covered(spans: Sequence[tuple[int, int]], duration_ms: int) -> int:
    """Length of the union of spans within the recording."""
    total = reached = 0
    for start, end in sorted(spans):
        start, end = max(start, reached), min(end, duration_ms)  # noqa: PLW2901
        total += max(end - start, 0)
        reached = max(reached, end)
    return total


def _ms(stamp_ns: int) -> int:
    return round(stamp_ns / NS_PER_MS)
