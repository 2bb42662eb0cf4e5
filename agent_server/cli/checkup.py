"""What ``agent-server doctor`` looks at: each check says what it found, and the way out."""

import os
import shutil
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import partial
from pathlib import Path

from agent_server import assets
from agent_server.clock import SystemClock
from agent_server.config import Settings
from agent_server.errors import AgentServerError
from agent_server.service.loading import load_models, load_room
from agent_server.transports.server import address, bind

LEAST_FREE_MB = 200
"""A recording takes some 60 MB an hour, and a full disk ends it."""
CLIENTS_OF_A_SESSION = 3
NAPS = 20
NAP_S = 0.01
MOST_LATE_S = 0.02
"""A thread that wakes later than this leaves little of 50 ms for the work."""


class Check(StrEnum):
    """What is looked at."""

    MODELS = "models"
    PORT = "port"
    CLOCK = "clock"
    DISK = "disk"
    PAGE = "page"
    FILES = "files"


@dataclass(frozen=True, slots=True)
class Finding:
    """What a check came to.

    Attributes:
        check: What was looked at.
        is_good: Whether the server can do its work with it.
        found: What was found, in a sentence.
        remedy: What to do about it; empty where nothing is to be done.
    """

    check: Check
    is_good: bool
    found: str
    remedy: str = ""

    def as_json(self) -> dict[str, object]:
        """For ``--json``."""
        return asdict(self)


def check_up(settings: Settings, folders: tuple[Path, ...], only: Sequence[Check]) -> list[Finding]:
    """Look at everything, one after the other.

    Args:
        settings: How the server would be started.
        folders: Where it would write.
        only: What alone to look at; empty for everything.
    """
    checks: list[tuple[Check, Callable[[], Finding]]] = [
        (Check.MODELS, lambda: _guarded(Check.MODELS, lambda: _models(settings))),
        (Check.PORT, lambda: _guarded(Check.PORT, lambda: _port(settings))),
        (Check.CLOCK, _clock),
        *((Check.DISK, partial(_disk, folder)) for folder in folders),
        (Check.PAGE, _page),
        (Check.FILES, lambda: _files(settings)),
    ]
    return [look() for name, look in checks if not only or name in only]


def _guarded(check: Check, look: Callable[[], str]) -> Finding:
    """A check whose own error says what is wrong and what to do."""
    try:
        return Finding(check, True, look())
    except AgentServerError as error:
        found, _, remedy = str(error).rpartition(": ")
        return Finding(check, False, found or str(error), remedy)


def _models(settings: Settings) -> str:
    began_s = time.perf_counter()
    models = load_models(settings)
    load_room(settings, models)
    names = ", ".join(dict.fromkeys(model.name for _, model in models.by_task))
    seconds = time.perf_counter() - began_s
    return f"{names}: hashes hold and golden outputs are met, in {seconds:.1f} s"


def _port(settings: Settings) -> str:
    with closing(bind(settings)) as listener:
        return f"{address(listener)} is free"


def _clock() -> Finding:
    resolution_ns = time.get_clock_info("monotonic").resolution * 1e9
    clock, late_s, last_ns = SystemClock(), 0.0, 0
    for _ in range(NAPS):
        before_ns = clock.now_ns()
        if before_ns < last_ns:
            return Finding(
                Check.CLOCK,
                False,
                "the monotonic clock has gone back",
                "use another clock source: see /sys/devices/system/clocksource",
            )
        time.sleep(NAP_S)
        last_ns = clock.now_ns()
        late_s = max(late_s, (last_ns - before_ns) / 1e9 - NAP_S)
    found = (
        f"monotonic, {resolution_ns:.0f} ns fine; a thread wakes up to {late_s * 1000:.1f} ms late"
    )
    if late_s <= MOST_LATE_S:
        return Finding(Check.CLOCK, True, found)
    return Finding(Check.CLOCK, False, found, "the machine is too busy: give the server a core")


def _disk(folder: Path) -> Finding:
    nearest = next(one for one in (folder, *folder.absolute().parents) if one.exists())
    if not os.access(nearest, os.W_OK):
        return Finding(
            Check.DISK,
            False,
            f"{nearest} cannot be written",
            "mount a folder there that the server's user owns, or name another",
        )
    free_mb = shutil.disk_usage(nearest).free // 2**20
    found = f"{folder}: {free_mb} MB are free"
    if free_mb >= LEAST_FREE_MB:
        return Finding(Check.DISK, True, found)
    return Finding(
        Check.DISK, False, found, f"free {LEAST_FREE_MB} MB or more, or name another folder"
    )


def _page() -> Finding:
    index = assets.page() / "index.html"
    if index.is_file():
        return Finding(Check.PAGE, True, f"the browser page is in {index.parent}")
    return Finding(
        Check.PAGE, False, f"there is no browser page in {index.parent}", "run `make page`"
    )


def _files(settings: Settings) -> Finding:
    if sys.platform == "win32":
        return Finding(Check.FILES, True, "Windows has no limit that matters")
    import resource  # noqa: PLC0415 - there is none on Windows

    limit = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    needed = settings.server.max_sessions * CLIENTS_OF_A_SESSION
    found = f"{limit} files and connections may be open, {needed} are needed for max_sessions"
    if limit == resource.RLIM_INFINITY or limit >= needed:
        return Finding(Check.FILES, True, found)
    return Finding(
        Check.FILES,
        False,
        found,
        f"say `ulimit -n {2 * needed}` before, or lower server.max_sessions",
    )
