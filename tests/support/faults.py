"""What is done to connections: where they are cut, and how."""

from dataclasses import dataclass
from enum import StrEnum

from tests.support.websocket_pieces import Form


class Where(StrEnum):
    """What is hit."""

    REQUEST = "handshake_request"
    RESPONSE = "handshake_response"
    COMMAND = "command"
    ACK = "ack"
    FRAME_UP = "frame_up"
    FRAME_DOWN = "frame_down"
    BETWEEN = "between_frames"


class How(StrEnum):
    """How a connection ends."""

    RESET = "reset"
    """Both sides get a RST."""
    FIN = "fin"
    """Both sides get the end of the stream, without a closing handshake."""
    HOLE = "hole"
    """Nothing passes any more, silently; in the end both sides get a RST."""


UP = frozenset({Where.REQUEST, Where.ACK, Where.FRAME_UP})
_PARTS = frozenset({Where.REQUEST, Where.RESPONSE, Where.FRAME_UP, Where.FRAME_DOWN})


@dataclass(frozen=True, slots=True)
class Fault:
    """What is done to one connection.

    Attributes:
        where: What is hit.
        how: How the connection ends.
        nth: Which of the pieces that fit is hit, counted from 1.
        share: How much of that piece still passes, 0 to 1. Of frames and handshakes at least one
            byte passes, and one is missing.
        after_s: Time after the upgrade at which a connection is cut between two frames, also
            where nothing that fits has come by then.
        hold_s: How long a hole lasts.
    """

    where: Where
    how: How
    nth: int = 1
    share: float = 0.5
    after_s: float = 1.0
    hold_s: float = 0.5

    def fits(self, piece, is_up):
        """Whether a piece that goes up to the server, or down, may be what is meant."""
        if self.where is Where.BETWEEN or (self.where in UP) is not is_up:
            return False
        if self.where in (Where.REQUEST, Where.RESPONSE):
            return piece.form is Form.HEAD
        if self.where in (Where.COMMAND, Where.ACK):
            return piece.type == self.where.value
        return piece.form is Form.DATA

    def passing(self, size):
        """How many bytes of a piece of ``size`` bytes still pass."""
        passed = round(self.share * size)
        return min(max(passed, 1), size - 1) if self.where in _PARTS else passed


def faults(random, most_after_s=1.2):
    """Faults without end, of all kinds."""
    places = {
        Where.REQUEST: 8,
        Where.RESPONSE: 8,
        Where.COMMAND: 24,
        Where.ACK: 24,
        Where.FRAME_UP: 13,
        Where.FRAME_DOWN: 13,
        Where.BETWEEN: 10,
    }
    ways = {How.RESET: 45, How.FIN: 35, How.HOLE: 20}
    most = {Where.COMMAND: 3, Where.ACK: 8}
    while True:
        (where,) = random.choices(list(places), list(places.values()))
        (how,) = random.choices(list(ways), list(ways.values()))
        # Nothing of it, all of it, or something in between: all three have their own consequences.
        share = random.choice((0.0, 1.0, random.random()))
        yield Fault(
            where=where,
            how=how,
            nth=random.randint(1, most.get(where, 16)),
            share=share,
            after_s=random.uniform(0.02, 1.0) if where is Where.BETWEEN else most_after_s,
            hold_s=random.uniform(0.2, 1.5),
        )


@dataclass(frozen=True, slots=True)
class Delay:
    """How late bytes pass: ``base_s``, and up to ``jitter_s`` more; the order is kept.

    A share ``loss`` is lost and sent again: late by ``resend_s`` more, and so is all behind it.
    """

    base_s: float = 0.0
    jitter_s: float = 0.0
    loss: float = 0.0
    resend_s: float = 0.2

    def draw(self, random):
        late_s = self.base_s + self.jitter_s * random.random()
        is_lost = self.loss > 0 and random.random() < self.loss
        return late_s + (self.resend_s if is_lost else 0.0)
