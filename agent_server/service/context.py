"""What the parts of one session share."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from agent_server.clock import Clock
from agent_server.service.audience import Audience
from agent_server.service.avatar import Avatar
from agent_server.service.core import Core
from agent_server.service.journal import Journal
from agent_server.service.seats import Seats
from agent_server.service.timeline import Timeline
from agent_server.service.watching import Watcher


@dataclass(frozen=True, slots=True)
class Context:
    """One session's core and what stands around it.

    Attributes:
        id: The session's id.
        core: Its stages and its room.
        clock: Where to read the time.
        journal: Where everything that enters and leaves the core is written down.
        avatar: Where its person is shown.
        watchers: Who is told of its decisions.
        audience: Its clients.
        seats: Who of them may speak for what.
        timeline: Its time.
        counters: What is counted, by name.
    """

    id: str
    core: Core
    clock: Clock
    journal: Journal
    avatar: Avatar
    watchers: Sequence[Watcher] = ()
    audience: Audience = field(default_factory=Audience)
    seats: Seats = field(default_factory=Seats)
    timeline: Timeline = field(default_factory=Timeline)
    counters: Counter[str] = field(default_factory=Counter)

    def now(self) -> int:
        """The session's time."""
        return self.timeline.now(self.clock.now_ns())
