"""What became of every command: what the server issued and said of it, and what a client did."""

from collections import Counter
from dataclasses import dataclass, field

ENDS = ("done", "failed", "expired", "preempted", "timed_out", "assumed")
UNTOLD = "untold"
"""The end of a command that is over, but whose end nobody was told: the server died before it could
say so, and the client had not seen the command."""
PATIENT_MS = 10_000
"""A client that is to be back within seconds is back in time for a command that waits this long."""


def command_id(session, sequence):
    return f"{session}/c{sequence}"


@dataclass(slots=True)
class Observed:
    """What was seen of one session's commands.

    Attributes:
        session: Its id.
        sequence: Highest sequence that was seen.
        ttl_ms: How long each command that monitors were told of is worth starting.
        reissued: Ids that were told of a second command.
        ends: First end of each command that monitors were told of.
        late: Ends that were told of a command that had ended otherwise.
        effects: How often the client finished each command.
        received: How often the client's application got each command.
        cancelled: Commands that the client cut short.
        forgotten: Commands that were over when a server died, and whose end was not told before.
    """

    session: str
    sequence: int = 0
    ttl_ms: dict = field(default_factory=dict)
    reissued: list = field(default_factory=list)
    ends: dict = field(default_factory=dict)
    late: Counter = field(default_factory=Counter)
    effects: Counter = field(default_factory=Counter)
    received: Counter = field(default_factory=Counter)
    cancelled: Counter = field(default_factory=Counter)
    forgotten: set = field(default_factory=set)

    @property
    def ids(self):
        """All commands of the ledger: sequences have no gaps."""
        return [command_id(self.session, n) for n in range(1, self.sequence + 1)]

    @property
    def open(self):
        """Commands whose end was not told."""
        return [one for one in self.ids if one not in self.ends]

    def tell(self, message):
        """Take what a monitor was told."""
        if message["type"] == "command":
            self.sequence = max(self.sequence, message["sequence"])
            if message["id"] in self.ttl_ms:
                self.reissued.append(message["id"])
            self.ttl_ms[message["id"]] = message["ttl_ms"]
        elif message["type"] == "ack_state":
            end = message["status"]
            if end == "failed" and message.get("reason") in ("expired", "preempted"):
                end = message["reason"]
            if end in ENDS and self.ends.setdefault(message["command_id"], end) != end:
                self.late[f"{end} after {self.ends[message['command_id']]}"] += 1

    def hear(self, said):
        """Take a line of the client."""
        seen = {"effect": self.effects, "command": self.received, "cancel": self.cancelled}
        if said["event"] in seen:
            seen[said["event"]][said["id"]] += 1

    def die(self, room):
        """The server was killed and has written down ``room``; monitors got all that it told."""
        self.sequence = max(self.sequence, room.sequence)
        running = None if room.command is None else room.command.id
        self.forgotten |= set(self.open) - {running}

    def fate(self, one):
        """How a command ended; None if it is lost."""
        if one in self.ends:
            return self.ends[one]
        if one not in self.forgotten:
            return None
        if self.effects[one]:
            return "done"
        return "preempted" if self.cancelled[one] else UNTOLD

    def is_given_up(self, one):
        """Whether the server did not wait for a client that was to be back in time."""
        end = self.fate(one)
        is_late = end == "expired" and self.ttl_ms.get(one, 0) >= PATIENT_MS
        return is_late or end in ("timed_out", "assumed")


WRONG = (
    "lost",
    "doubled",
    "given_up",
    "reissued",
    "received_twice",
    "done_without_effect",
    "never_issued",
)
"""Figures that list the ids of what went wrong."""


def summary(sessions):
    """Figures of all sessions, with the ids of what went wrong."""
    fates = {one: (seen, seen.fate(one)) for seen in sessions for one in seen.ids}
    stray = {one for seen in sessions for one in seen.effects} - fates.keys()
    return {
        "commands": len(fates),
        "ends": dict(Counter(end for _, end in fates.values() if end is not None)),
        "late_ends": dict(sum((seen.late for seen in sessions), Counter())),
        "effects": sum(sum(seen.effects.values()) for seen in sessions),
        "effects_of_other_ends": dict(
            Counter(
                end
                for one, (seen, end) in fates.items()
                if seen.effects[one] and end not in ("done", None)
            )
        ),
        "lost": [one for one, (_, end) in fates.items() if end is None],
        "doubled": [one for one, (seen, _) in fates.items() if seen.effects[one] > 1],
        "given_up": [one for one, (seen, _) in fates.items() if seen.is_given_up(one)],
        "reissued": [one for seen in sessions for one in seen.reissued],
        "received_twice": [one for one, (seen, _) in fates.items() if seen.received[one] > 1],
        "done_without_effect": [
            one for one, (seen, end) in fates.items() if end == "done" and not seen.effects[one]
        ],
        "never_issued": sorted(stray),
    }
