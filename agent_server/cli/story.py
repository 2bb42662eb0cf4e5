"""Decisions told to a person: what changed, and nothing of what did not."""

from collections.abc import Callable

from rich.console import Console

from agent_server.domain.decision import Outcome
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol.messages import DecisionBody

_SILENT = {Outcome.IDLE.value, Outcome.UNSURE.value, Outcome.HANDLED.value}
_STYLE = {
    Outcome.COMMAND.value: "bold green",
    Outcome.GATED.value: "yellow",
    Outcome.BUSY.value: "yellow",
}


class Story:
    """Prints a line when something happens, and not again while it goes on.

    Args:
        console: Where to print.
    """

    Teller = Callable[[DecisionBody], None]

    def __init__(self, console: Console) -> None:
        self._console = console
        self._last = ""

    def tell(self, decision: DecisionBody) -> None:
        """Print the decision if it says something new."""
        said = f"{decision.outcome}: {decision.reason}"
        is_new, self._last = said != self._last, said
        if not is_new or decision.outcome in _SILENT:
            return
        probability = decision.probabilities.get(decision.gesture, 0.0)
        line = f"{decision.end_ns / NS_PER_S:7.2f} s  {decision.gesture:<7} p={probability:.2f}  "
        if decision.command is not None:
            steps = ", ".join(step.action.replace("_", " ") for step in decision.command.steps)
            line += f"-> {decision.command.reaction} ({steps})"
        else:
            line += decision.reason.partition(": ")[2] or decision.reason
        self._console.print(line, style=_STYLE.get(decision.outcome), soft_wrap=True)
