"""Which of the bodies in front of a sensor is followed."""

from collections import deque
from typing import Literal

from agent_server.domain.motion import BodyLost
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import ConfigError

Policy = Literal["nearest", "first", "explicit"]


class SubjectLock:
    """Follows one body by its id until it has gone.

    ``nearest`` holds an election: it opens with the first frame while nobody is followed, and
    the first frame at least ``election_ns`` later closes it in favour of the body whose last
    frame was nearest (of two as near, the one that was seen first). ``first`` follows whoever
    is seen first, ``explicit`` only ``body_id``. Frames that come during an election belong to
    nobody.

    After ``release_ns`` without a frame of the followed body another one may take its place;
    until one has, the body is followed on when it comes back. After ``lost_ns`` it counts as
    gone, which is said once. A body whose place was taken before that is not reported: there
    still is somebody to attend to.

    Args:
        policy: How the body is chosen.
        body_id: The body to follow under ``explicit``.
        release_ns: After this long without a frame another body may be followed.
        lost_ns: After this long without a frame the body counts as gone.
        election_ns: How long ``nearest`` looks around before it chooses.

    Raises:
        ConfigError: If ``body_id`` does not go with the policy, or the times contradict
            each other.
    """

    __slots__ = (
        "_ballot",
        "_body_id",
        "_election_ends_ns",
        "_election_ns",
        "_followed",
        "_losses",
        "_lost_ns",
        "_policy",
        "_release_ns",
        "_seen_ns",
    )

    def __init__(
        self,
        policy: Policy = "nearest",
        *,
        body_id: int | None = None,
        release_ns: int = NS_PER_S,
        lost_ns: int = 2 * NS_PER_S,
        election_ns: int = 200 * NS_PER_MS,
    ) -> None:
        if (policy == "explicit") != (body_id is not None):
            raise ConfigError("body_id goes with policy = 'explicit' and with no other")
        if not 0 < release_ns <= lost_ns:
            raise ConfigError(
                f"release_ns must lie in 1..lost_ns, got {release_ns} with lost_ns {lost_ns}"
            )
        self._policy = policy
        self._body_id = body_id
        self._release_ns = release_ns
        self._lost_ns = lost_ns
        self._election_ns = election_ns
        self._followed: int | None = None
        self._seen_ns = 0
        self._ballot: dict[int, tuple[float, int]] = {}
        self._election_ends_ns = 0
        self._losses: deque[BodyLost] = deque()

    @property
    def followed(self) -> int | None:
        """The body that is followed, or None."""
        return self._followed

    def advance(self, now_ns: int) -> BodyLost | None:
        """Let time pass. Call it before each offer, and on a timer when nothing comes.

        Args:
            now_ns: Time on the session's time line.

        Returns:
            That the followed body has gone, stamped with the moment when it counted as gone
            and not with ``now_ns``; None if it has not, or if that has been said.
        """
        self._expire(now_ns)
        return self._losses.popleft() if self._losses else None

    def offer(self, body_id: int, distance: float, stamp_ns: int) -> bool:
        """Show the lock a body's frame.

        Args:
            body_id: The sensor's identity of the body.
            distance: z of its navel in metres; infinite if unknown.
            stamp_ns: Capture time of the frame.

        Returns:
            Whether the frame belongs to the followed body.
        """
        self._expire(stamp_ns)
        if body_id != self._followed:
            if self._followed is not None and stamp_ns - self._seen_ns < self._release_ns:
                return False
            if not self._choose(body_id, distance, stamp_ns):
                return False
        self._seen_ns = max(self._seen_ns, stamp_ns)
        return True

    def _choose(self, body_id: int, distance: float, stamp_ns: int) -> bool:
        """Whether this frame makes its body the followed one."""
        if self._policy != "nearest":
            if self._body_id not in (None, body_id):
                return False
            self._follow(body_id, stamp_ns)
            return True
        # Who has been away for as long as a followed body may be is no candidate any more.
        for other, (_, seen_ns) in list(self._ballot.items()):
            if stamp_ns - seen_ns >= self._release_ns:
                del self._ballot[other]
        if not self._ballot:
            self._election_ends_ns = stamp_ns + self._election_ns
        self._ballot[body_id] = (distance, stamp_ns)
        if stamp_ns < self._election_ends_ns:
            return False
        winner = min(self._ballot, key=lambda candidate: self._ballot[candidate][0])
        self._follow(winner, self._ballot[winner][1])
        self._ballot.clear()
        return winner == body_id

    def _follow(self, body_id: int, seen_ns: int) -> None:
        self._followed = body_id
        self._seen_ns = seen_ns

    def _expire(self, now_ns: int) -> None:
        """Let the followed body go when its time is over."""
        if self._followed is not None and now_ns - self._seen_ns >= self._lost_ns:
            self._losses.append(BodyLost(self._seen_ns + self._lost_ns, self._followed))
            self._followed = None
