"""A sensor's client: what is captured while there is no connection is not worth sending later."""

from random import Random

from agent_server.client.link import Link, Options
from agent_server.client.running import Running
from agent_server.clock import Clock, SystemClock
from agent_server.domain.inputs import SensorInput
from agent_server.protocol import messages as m
from agent_server.protocol.inputs import input_to_message


class Sensor(Running):
    """Sends skeletons, faces, affect and gazes; use it as a context manager.

    Args:
        options: Server, session, and what the client is; ``hello={"face": "none"}`` says that
            no face can be seen.
        clock: Where to read the time.
        random: Where waiting times come from.

    Attributes:
        unsent: Messages that came while there was no connection.
        errors: What the server refused, the last 100.
    """

    def __init__(
        self, options: Options, *, clock: Clock | None = None, random: Random | None = None
    ) -> None:
        super().__init__()
        self._clock = clock or SystemClock()
        self._start_ns = self._clock.now_ns()
        self.unsent = 0
        self.errors: list[m.ErrorMessage] = []
        self.link = Link(
            options,
            "sensor",
            welcomed=lambda welcome: None,
            received=self._receive,
            clock=self._clock,
            random=random,
        )

    def now_ns(self) -> int:
        """A capture time: nanoseconds since this sensor was made."""
        return self._clock.now_ns() - self._start_ns

    async def send(self, value: SensorInput | m.Message) -> bool:
        """Send what was captured. False: there is no connection, and it is gone.

        Raises:
            ConnectionFailed: If the server says that coming back is of no use.
        """
        self.check()
        message = value if isinstance(value, m.Message) else input_to_message(value)
        is_sent = await self.link.send(message)
        self.unsent += not is_sent
        return is_sent

    def _receive(self, message: m.Message) -> None:
        if isinstance(message, m.ErrorMessage):
            self.errors = [*self.errors[-99:], message]
