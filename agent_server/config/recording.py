"""What is recorded of live sessions, and how long it is kept."""

import re
from collections.abc import Iterator

from agent_server.config.section import Section, unless

_PSEUDONYM = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")


class RecordingSettings(Section, frozen=True):
    """What ``serve --record DIR`` writes, and how long it is kept.

    Attributes:
        rotate_mb: A recording goes on in a new file when one has this many megabytes ...
        rotate_minutes: ... or was begun so long ago.
        keep_mb: Recordings of the folder together; beyond that the oldest are deleted, never one
            that is being written. 0 keeps all.
        keep_days: A recording that was last written so long ago is deleted. 0 keeps all.
        participant: Pseudonym of the person, for the recordings' metadata; never the name.
        consent: Whether the person has agreed to be recorded; stands in the metadata.
    """

    rotate_mb: float = 256.0
    rotate_minutes: float = 60.0
    keep_mb: float = 0.0
    keep_days: float = 0.0
    participant: str = ""
    consent: bool = False

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(self.rotate_mb >= 0.1, "rotate_mb must be at least 0.1")
        yield from unless(self.rotate_minutes >= 0.01, "rotate_minutes must be at least 0.01")
        yield from unless(
            self.keep_mb == 0 or self.keep_mb >= 2 * self.rotate_mb,
            "keep_mb must be 0, or at least twice rotate_mb: a file that is being written stays",
        )
        yield from unless(self.keep_days >= 0, "keep_days must not be negative")
        yield from unless(
            self.participant == "" or _PSEUDONYM.fullmatch(self.participant) is not None,
            "participant must be 1 to 40 letters, digits, '_' and '-': a pseudonym",
        )
