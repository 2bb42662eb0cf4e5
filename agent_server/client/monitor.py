"""A monitor's client: telemetry, over lost connections."""

from collections.abc import Sequence
from dataclasses import replace
from random import Random

from agent_server.client.link import Link, Options
from agent_server.client.running import Listening
from agent_server.clock import Clock
from agent_server.protocol import messages as m


class Monitor(Listening[m.Message]):
    """Watches a session; use it as a context manager and iterate it.

    Args:
        options: Server, session, and what the client is.
        topics: Kinds of telemetry that are wanted; None wants all.
        clock: Where to read the time.
        random: Where waiting times come from.

    Iterating it gives welcomes and telemetry, in order.
    """

    def __init__(
        self,
        options: Options,
        topics: Sequence[m.Topic] | None = None,
        *,
        clock: Clock | None = None,
        random: Random | None = None,
    ) -> None:
        super().__init__()
        if topics is not None:
            options = replace(options, hello={**options.hello, "topics": list(topics)})
        self.link = Link(
            options,
            "monitor",
            welcomed=self._events.put_nowait,
            received=self._events.put_nowait,
            clock=clock,
            random=random,
        )
