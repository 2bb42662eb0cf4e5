"""Those who look after a running server: what they are told of each decision."""

import logging
from dataclasses import dataclass

from agent_server.domain.decision import Decision, Outcome
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Decided:
    """One decision and when each step to it was taken, on the server's clock in nanoseconds.

    Attributes:
        session: Id of the session.
        decision: The decision.
        arrival_ns: The last frame that it needed came.
        asked_ns: Its window was given to the models.
        answered_ns: Their answer came.
        decided_ns: It was made, and its command, if any, was on its way.
        predict_ms: Of the time between asking and answer, the predictor's, in milliseconds.
        classify_ms: ... and the classifier's.
    """

    session: str
    decision: Decision
    arrival_ns: int
    asked_ns: int
    answered_ns: int
    decided_ns: int
    predict_ms: float
    classify_ms: float

    @property
    def total_s(self) -> float:
        """From the last frame that it needed to its command, in seconds."""
        return (self.decided_ns - self.arrival_ns) / NS_PER_S

    @property
    def stages_s(self) -> dict[str, float]:
        """How long each stage took, in seconds; ``wait`` is all in which nothing was done."""
        predict_s = self.predict_ms / 1000
        classify_s = self.classify_ms / 1000
        decide_s = (self.decided_ns - self.answered_ns) / NS_PER_S
        busy_s = predict_s + classify_s + decide_s
        return {
            "wait": max(0.0, self.total_s - busy_s),
            "predict": predict_s,
            "classify": classify_s,
            "decide": decide_s,
        }


class Watcher:
    """Somebody who is told; each kind overrides what it cares for. It must not take long."""

    def decided(self, seen: Decided) -> None:
        """A decision was made, and its command has left."""

    def read_affect(self, seconds: float) -> None:
        """Affect was read from a face, which took this long."""

    def close(self) -> None:
        """The server stops."""


class DecisionLog(Watcher):
    """Writes decisions to the log: those with a command at INFO, all others at DEBUG."""

    def decided(self, seen: Decided) -> None:
        """Write one line, which carries the decision's id."""
        decision = seen.decision
        level = logging.INFO if decision.outcome is Outcome.COMMAND else logging.DEBUG
        if log.isEnabledFor(level):
            log.log(
                level,
                "%s after %.1f ms: %s",
                decision.outcome,
                seen.total_s * NS_PER_S / NS_PER_MS,
                decision.reason,
                extra={"session": seen.session, "decision": decision.id},
            )
