"""A run in figures."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from agent_server.qa.result import CaseResult, Check, FaultResult
from agent_server.qa.suite import Limits

MS_PER_HOUR = 3_600_000


@dataclass(frozen=True, slots=True)
class Totals:
    """All recordings together.

    Attributes:
        recordings: How many were replayed.
        failed: Of them, those with an expectation that was not met, or an error.
        checks: Expectations.
        met: Of them, those that were met.
        asked: Expected reactions.
        right: Of them, those that came as expected.
        false: Reactions that nothing asked for.
        hours: Time in which a reaction would have been one.
        delay_p50_ms: Median time from onset to the right reaction, or None without any.
        delay_p90_ms: The time that nine in ten stay under.
    """

    recordings: int
    failed: int
    checks: int
    met: int
    asked: int
    right: int
    false: int
    hours: float
    delay_p50_ms: float | None
    delay_p90_ms: float | None

    @property
    def right_share(self) -> float | None:
        """Share of expected reactions that came as expected, or None if none was expected."""
        return self.right / self.asked if self.asked else None

    @property
    def false_per_hour(self) -> float | None:
        """Reactions an hour that nothing asked for, or None without judged time."""
        return self.false / self.hours if self.hours else None


def total(cases: Iterable[CaseResult]) -> Totals:
    """Add recordings up."""
    cases = list(cases)
    checks = [check for case in cases for check in case.checks]
    asked = [check for check in checks if check.kind == "reaction"]
    delays = right_delays(cases)
    return Totals(
        recordings=len(cases),
        failed=sum(case.status in ("failed", "error") for case in cases),
        checks=len(checks),
        met=sum(check.passed for check in checks),
        asked=len(asked),
        right=sum(check.passed for check in asked),
        false=sum(len(case.false_at_ms) for case in cases),
        hours=sum(case.judged_ms for case in cases) / MS_PER_HOUR,
        delay_p50_ms=_percentile(delays, 50),
        delay_p90_ms=_percentile(delays, 90),
    )


def right_delays(cases: Iterable[CaseResult]) -> list[int]:
    """Time from onset to each reaction that came as expected, in ms."""
    return [
        check.delay_ms
        for case in cases
        for check in case.checks
        if check.kind == "reaction" and check.passed and check.delay_ms is not None
    ]


def fault_row(name: str, cases: Iterable[CaseResult]) -> FaultResult:
    """A row of the robustness table."""
    cases = list(cases)
    sums = total(cases)
    return FaultResult(
        name=name,
        right=sums.right,
        asked=sums.asked,
        false=sums.false,
        hours=round(sums.hours, 4),
        delay_p50_ms=sums.delay_p50_ms,
        refused=sum(case.refused for case in cases),
    )


def check_limits(sums: Totals, limits: Limits) -> list[Check]:
    """What the suite as a whole is held to."""
    share = None if sums.right_share is None else 100 * sums.right_share
    wanted = None if limits.min_right is None else 100 * limits.min_right
    return [
        *_limit("right reactions", share, wanted, "%", at_least=True),
        *_limit("false reactions an hour", sums.false_per_hour, limits.max_false_per_hour, ""),
        *_limit("nine in ten reactions within", sums.delay_p90_ms, limits.max_delay_p90_ms, " ms"),
    ]


def _limit(
    what: str, got: float | None, bound: float | None, unit: str, *, at_least: bool = False
) -> list[Check]:
    if bound is None:
        return []
    name = f"{what}: at {'least' if at_least else 'most'} {bound:g}{unit}"
    if got is None:
        return [Check("limit", name, None, passed=False, detail="nothing was measured")]
    passed = got >= bound if at_least else got <= bound
    return [Check("limit", name, None, passed, f"{got:.4g}{unit}")]


def _percentile(values: list[int], share: float) -> float | None:
    return round(float(np.percentile(values, share)), 1) if values else None
