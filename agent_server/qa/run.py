"""Running a suite, on as many processes as asked for."""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import resources
from multiprocessing import get_context
from pathlib import Path

from agent_server import __version__
from agent_server.config import Settings
from agent_server.errors import AgentServerError
from agent_server.qa.faults.base import Fault
from agent_server.qa.play import examine
from agent_server.qa.result import CaseResult, Run, Thresholds
from agent_server.qa.setup import Setup, load_setup
from agent_server.qa.suite import Case, Suite
from agent_server.qa.totals import check_limits, fault_row, total

_AHEAD = 4
"""Recordings that wait for each process: enough to keep it busy."""


@dataclass(frozen=True, slots=True)
class Task:
    """One replay: of which recording, with which of the settings, under which fault."""

    case: Case
    variant: int = 0
    fault: Fault | None = None


class QaError(AgentServerError):
    """A suite could not be run to its end."""


def run_suite(
    suite: Suite,
    variants: Sequence[Settings],
    *,
    jobs: int = 1,
    faults: Sequence[Fault] = (),
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> list[Run]:
    """Replay every recording with each of some settings.

    Args:
        suite: What to run.
        variants: Settings; they name models and rules.
        jobs: Processes; 1 runs it in this one.
        faults: The robustness table of the last of the settings is made with these.
        progress: Told how many replays are done, and of how many.

    Returns:
        One run for each of the settings, in their order. It does not depend on ``jobs``.

    Raises:
        AgentServerError: If models or rules cannot be loaded, or a process died.
    """
    last = len(variants) - 1
    tasks = [Task(case, variant) for variant in range(len(variants)) for case in suite.cases]
    tasks += [Task(case, last, fault) for fault in faults for case in suite.cases]
    setups = [load_setup(settings) for settings in variants]
    results: dict[int, CaseResult] = {}
    with _workers(setups, jobs) as work:
        for index, result in work(tasks):
            results[index] = result
            progress(len(results), len(tasks))
    size = len(suite.cases)
    parts = [
        [results[index] for index in range(start, start + size)]
        for start in range(0, len(tasks), size)
    ]
    rows = [
        fault_row(fault.name, part) for fault, part in zip(faults, parts[last + 1 :], strict=True)
    ]
    return [
        Run(
            suite=suite.name,
            server_version=__version__,
            models=_hashes(setup),
            rules=_rules(setup),
            gate=Thresholds(setup.settings.gate.enter_valence, setup.settings.gate.enter_arousal),
            cases=parts[variant],
            limits=check_limits(total(parts[variant]), suite.limits),
            faults=rows if variant == last else [],
        )
        for variant, setup in enumerate(setups)
    ]


_Work = Callable[[Sequence[Task]], Iterator[tuple[int, CaseResult]]]


@contextmanager
def _workers(setups: Sequence[Setup], jobs: int) -> Iterator[_Work]:
    if jobs == 1:

        def work(tasks: Sequence[Task]) -> Iterator[tuple[int, CaseResult]]:
            for index, task in enumerate(tasks):
                yield index, examine(task.case, setups[task.variant], task.fault)

        yield work
        return
    # Processes are spawned: a fork would copy threads of the parent half-way.
    variants = tuple(setup.settings for setup in setups)
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), _load, (variants,))
    try:
        yield lambda tasks: _spread(pool, tasks, jobs)
    except BrokenProcessPool as error:
        raise QaError(
            "a process of the run died, perhaps for want of memory: run it with --jobs 1"
        ) from error
    finally:
        pool.shutdown(cancel_futures=True)


def _spread(
    pool: ProcessPoolExecutor, tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[int, CaseResult]]:
    """Results as they come; only so many tasks wait, however long the suite is."""
    open_tasks: dict[Future[CaseResult], int] = {}
    todo = iter(enumerate(tasks))
    while True:
        while len(open_tasks) < jobs * _AHEAD and (item := next(todo, None)) is not None:
            open_tasks[pool.submit(_examine, item[1])] = item[0]
        if not open_tasks:
            return
        for future in wait(open_tasks, return_when=FIRST_COMPLETED).done:
            yield open_tasks.pop(future), future.result()


_SETUPS: list[Setup] = []
"""Of this process, if it is a worker."""


def _load(variants: Sequence[Settings]) -> None:
    _SETUPS.extend(load_setup(settings) for settings in variants)


def _examine(task: Task) -> CaseResult:
    return examine(task.case, _SETUPS[task.variant], task.fault)


def _hashes(setup: Setup) -> dict[str, str]:
    """Bundle name -> hash of the models that decide."""
    return {model.name: model.sha256[:12] for task, model in setup.models.by_task if task != "face"}


def _rules(setup: Setup) -> str:
    """Name and hash of the rule file."""
    shipped = resources.files("agent_server.scene") / "room.toml"
    path = shipped if setup.settings.rules is None else Path(setup.settings.rules)
    return f"{path.name} {hashlib.sha256(path.read_bytes()).hexdigest()[:12]}"
