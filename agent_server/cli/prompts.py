"""What a person whose gesture is recorded is told."""

from rich.console import Console

from agent_server.domain.stamp import NS_PER_S
from agent_server.recording.takes import (
    Again,
    Count,
    Done,
    Go,
    Gone,
    Left,
    Seen,
    Spoilt,
    Taken,
    TakePlan,
)
from agent_server.service.take_recorder import Notice, OtherSession, SensorMoved

_REASONS = {
    Spoilt.STILL: "no arm moved",
    Spoilt.HIDDEN: "the sensor did not see your hands: face it, with nothing in between",
    Spoilt.LOST: "the sensor lost you",
}


class Prompter:
    """Tells a person who stands away from the screen what to do; a bell marks begin and end.

    Args:
        console: Where to print.
        plan: What is recorded.
        session: Id of the session that is waited for.
    """

    def __init__(self, console: Console, plan: TakePlan, session: str) -> None:
        self._console = console
        self._plan = plan
        self._session = session
        self._is_counting = False

    def tell(self, notice: Notice) -> None:
        """Say what is new."""
        goes_on = self._is_counting and isinstance(notice, Count | Go)
        if self._is_counting and not goes_on:
            self._console.print()
        self._is_counting = isinstance(notice, Count)
        words = self._words(notice)
        if goes_on and isinstance(notice, Count):
            words = str(notice.left)
        self._console.print(words, end="  " if self._is_counting else "\n", soft_wrap=True)
        if isinstance(notice, Go | Taken | Again | Gone):
            self._console.bell()

    def _words(self, notice: Notice) -> str:
        match notice:
            case SensorMoved(is_here):
                words = "A sensor is here." if is_here else "The sensor has gone."
            case OtherSession(session):
                words = (
                    f"[yellow]Somebody came to session {session}, this waits for session "
                    f"{self._session}:[/] mend the sensor's address, or say --session {session}."
                )
            case Seen():
                words = f"I see you. Let your arms rest; {self._task()}."
            case Gone():
                words = "[yellow]I do not see you any more.[/] It goes on when you are back."
            case Count(repetition, left):
                words = f"{self._which(repetition)}{left}"
            case Go(_, for_ns):
                words = f"[bold green]go[/]  ({for_ns / NS_PER_S:g} s)"
            case Left(left_ns):
                words = f"{left_ns / NS_PER_S:g} s left"
            case Taken(_, label, is_cut):
                length_s = (label.offset_ns - label.onset_ns) / NS_PER_S
                words = f"good, {length_s:.1f} s"
                if is_cut:
                    words += " [yellow](cut off: be back at rest in time, or raise --seconds)[/]"
            case Again(_, reason):
                words = f"[yellow]that did not count: {_REASONS[reason]}. Once more.[/]"
            case Done():
                words = "[bold]That was all, thank you.[/]"
        return words

    def _task(self) -> str:
        if self._plan.is_idle:
            return "from [bold]go[/] on move as you like, but do none of your gestures"
        return f"at [bold]go[/] show [bold]{self._plan.gesture}[/] once and come back to rest"

    def _which(self, repetition: int) -> str:
        return "" if self._plan.is_idle else f"{repetition} of {self._plan.repetitions}:  "
