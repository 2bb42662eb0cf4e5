import math

import pytest

from agent_server.domain.motion import BodyLost
from agent_server.errors import ConfigError
from agent_server.skeleton.subject import SubjectLock

MS = 1_000_000
S = 1_000 * MS


def show(lock: SubjectLock, ms: int, body_id: int, distance: float = 2.0) -> bool:
    return lock.offer(body_id, distance, ms * MS)


def test_first_follows_whoever_comes_first_and_ignores_nearer_ones() -> None:
    lock = SubjectLock("first")
    assert show(lock, 0, 7, 3.0)
    assert not show(lock, 10, 8, 1.0)
    assert show(lock, 33, 7, 3.0)
    assert lock.followed == 7


def test_nearest_looks_around_before_it_chooses() -> None:
    lock = SubjectLock("nearest")
    assert not show(lock, 0, 1, 3.0)
    assert not show(lock, 5, 2, 1.5)
    assert not show(lock, 199, 1, 3.0)
    assert lock.followed is None
    assert not show(lock, 200, 1, 3.0)
    assert lock.followed == 2
    assert show(lock, 201, 2, 1.5)


def test_nearest_goes_by_the_last_distance_and_keeps_its_choice() -> None:
    lock = SubjectLock("nearest")
    show(lock, 0, 1, 1.0)
    show(lock, 5, 2, 2.0)
    show(lock, 180, 1, 4.0)
    assert show(lock, 205, 2, 2.0)
    assert not show(lock, 240, 1, 0.5)
    assert show(lock, 245, 2, 5.0)


def test_of_two_as_near_the_first_seen_is_chosen() -> None:
    lock = SubjectLock("nearest")
    for ms, body_id in ((0, 9), (1, 3), (100, 9), (101, 3)):
        show(lock, ms, body_id, math.inf)
    assert not show(lock, 201, 3, math.inf)
    assert lock.followed == 9


def test_explicit_follows_nobody_else() -> None:
    lock = SubjectLock("explicit", body_id=4)
    assert not show(lock, 0, 1, 0.5)
    assert show(lock, 33, 4, 4.0)
    assert not show(lock, 5_000, 1, 0.5)
    assert lock.advance(5 * S) == BodyLost(2_033 * MS, 4)
    assert not show(lock, 9_000, 1, 0.5)
    assert show(lock, 9_033, 4)


def test_the_elected_body_counts_from_its_own_last_frame() -> None:
    lock = SubjectLock("nearest")
    show(lock, 0, 1, 1.0)
    show(lock, 195, 1, 1.0)
    show(lock, 200, 2, 2.0)
    assert lock.followed == 1
    # A second after the frame of body 1 its place is free, and a new election begins.
    assert not show(lock, 1_195, 2, 2.0)
    assert lock.followed == 1
    assert show(lock, 1_395, 2, 2.0)


def test_a_short_absence_does_not_pass_the_lock_on() -> None:
    lock = SubjectLock("first")
    show(lock, 0, 1)
    assert not show(lock, 999, 2)
    assert show(lock, 1_000, 2)
    assert lock.followed == 2
    assert not show(lock, 1_001, 1)


def test_a_body_that_comes_back_before_its_place_is_taken_is_followed_on() -> None:
    lock = SubjectLock("nearest")
    show(lock, 0, 1)
    show(lock, 200, 1)
    assert not show(lock, 1_300, 2, 0.5)
    assert show(lock, 1_400, 1)
    # The election that had begun is over, and a new one looks around for its full time.
    assert not show(lock, 2_450, 2, 0.5)
    assert not show(lock, 2_600, 2, 0.5)
    assert show(lock, 2_650, 2, 0.5)


def test_a_lost_body_is_reported_once_and_at_its_deadline() -> None:
    lock = SubjectLock("first", lost_ns=2 * S)
    show(lock, 100, 1)
    assert lock.advance(2_100 * MS - 1) is None
    assert lock.followed == 1
    assert lock.advance(7 * S) == BodyLost(2_100 * MS, 1)
    assert lock.followed is None
    assert lock.advance(8 * S) is None


def test_the_deadline_itself_is_too_late() -> None:
    lock = SubjectLock("first", lost_ns=2 * S)
    show(lock, 0, 1)
    assert lock.advance(2 * S) == BodyLost(2 * S, 1)


def test_a_loss_that_an_offer_finds_is_told_by_the_next_advance() -> None:
    lock = SubjectLock("first", lost_ns=2 * S)
    show(lock, 0, 1)
    assert show(lock, 3_000, 2)
    assert lock.advance(3 * S) == BodyLost(2 * S, 1)
    assert lock.advance(3 * S) is None
    assert lock.followed == 2


def test_a_body_whose_place_was_taken_is_not_reported() -> None:
    lock = SubjectLock("first", release_ns=S, lost_ns=2 * S)
    show(lock, 0, 1)
    assert show(lock, 1_500, 2)
    assert lock.advance(3 * S) is None
    assert lock.advance(4 * S) == BodyLost(3_500 * MS, 2)


def test_candidates_who_left_are_forgotten() -> None:
    lock = SubjectLock("nearest", release_ns=S)
    show(lock, 0, 1, 0.5)
    # Nobody for ten seconds: the first election came to nothing, and a new one begins.
    assert not show(lock, 10_000, 2, 3.0)
    assert not show(lock, 10_100, 3, 2.0)
    assert not show(lock, 10_200, 2, 3.0)
    assert lock.followed == 3


def test_a_frame_that_came_late_does_not_shorten_the_deadline() -> None:
    lock = SubjectLock("first", lost_ns=2 * S)
    show(lock, 0, 1)
    show(lock, 500, 1)
    assert show(lock, 400, 1)
    assert lock.advance(2_499 * MS) is None
    assert lock.advance(2_500 * MS) == BodyLost(2_500 * MS, 1)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"policy": "explicit"}, "body_id goes with"),
        ({"policy": "first", "body_id": 1}, "body_id goes with"),
        ({"release_ns": 0}, "release_ns must lie"),
        ({"release_ns": 3 * S, "lost_ns": 2 * S}, "release_ns must lie"),
    ],
)
def test_contradictions_are_refused(settings: dict[str, object], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        SubjectLock(**settings)  # type: ignore[arg-type]
