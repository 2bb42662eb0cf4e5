"""What a training run shows while it runs."""

from collections.abc import Mapping

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


class TrainingProgress:
    """A bar with the loss terms and the time left; plain lines where there is no terminal."""

    def __init__(self, title: str, steps: int, done: int) -> None:
        self._console = Console(stderr=True)  # stdout is for results
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            TextColumn("{task.fields[terms]}"),
            console=self._console,
            disable=not self._console.is_terminal,
        )
        self._task = self._bar.add_task(title, total=steps, completed=done, terms="")
        self._steps = steps

    def __enter__(self) -> "TrainingProgress":
        self._bar.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.stop()

    def advance(self, terms: Mapping[str, float]) -> None:
        """One update is done."""
        self._bar.update(self._task, advance=1, terms=_text(terms))

    def report(self, step: int, values: Mapping[str, float]) -> None:
        """A line that stays, for example after a validation."""
        self._console.print(
            f"{step}/{self._steps} {_text(values)}", highlight=False, soft_wrap=True
        )


def _text(values: Mapping[str, float]) -> str:
    return " ".join(f"{name} {value:.4g}" for name, value in values.items())
