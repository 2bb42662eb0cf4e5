import numpy as np

from agent_server.synthetic.trajectory import (
    ORIGIN,
    Move,
    Oscillation,
    blend,
    drift,
    minimum_jerk,
    oscillate,
    sample_drift,
)

TIMES = np.arange(0.0, 4.0, 0.001)


def test_minimum_jerk_starts_and_ends_at_rest() -> None:
    tau = np.linspace(0, 1, 2001)
    profile = minimum_jerk(tau)
    velocity = np.gradient(profile, tau)
    acceleration = np.gradient(velocity, tau)
    assert profile[0] == 0 and profile[-1] == 1
    np.testing.assert_allclose(profile + profile[::-1], 1.0, atol=1e-12)
    np.testing.assert_allclose(velocity.max(), 1.875, atol=1e-3)  # Flash and Hogan 1985
    assert abs(velocity[[0, -1]]).max() < 1e-5
    assert abs(acceleration[[0, -1]]).max() < 0.1 < abs(acceleration).max()


def test_a_move_that_starts_before_the_last_has_ended_is_added_to_it() -> None:
    first = Move(0.0, 1.0, (1.0, 0.0, 0.0))
    second = Move(0.5, 1.0, (1.0, 2.0, 0.0), skew=1.2)
    both = blend([first, second], TIMES)
    np.testing.assert_allclose(both[:, 0], blend([first], TIMES)[:, 0])
    np.testing.assert_allclose(both[-1], (1.0, 2.0, 0.0))
    speed = np.linalg.norm(np.diff(both, axis=0), axis=1)
    assert (speed[510:990] > 0).all()  # no stop between both


def test_a_swing_has_its_frequency_and_leaves_the_rest_alone() -> None:
    swing = Oscillation(1.0, 3.0, 0.3, (0.1, 0.0, 0.0), (0.0, 0.05, 0.0), 2.0, 0.0)
    value = oscillate([swing], TIMES)
    assert not value[(TIMES <= 1.0) | (TIMES >= 3.0)].any()
    inside = value[(TIMES > 1.4) & (TIMES < 2.6), 0]
    crossings = np.count_nonzero(np.diff(np.sign(inside)))
    assert crossings in (4, 5)  # 1.2 s of 2 Hz
    np.testing.assert_allclose(abs(value).max(axis=0), (0.1, 0.05, 0.0), atol=1e-3)


def test_a_swing_on_an_arc_sinks_at_both_ends_and_not_in_its_middle() -> None:
    arc = (0.0, -0.04, 0.0)
    swing = Oscillation(0.0, 4.0, 0.3, (0.2, 0.0, 0.0), ORIGIN, 1.0, 0.0, arc=arc)
    inside = oscillate([swing], TIMES)[500:3500]
    ends, middle = abs(inside[:, 0]) > 0.199, abs(inside[:, 0]) < 0.01
    np.testing.assert_allclose(inside[ends, 1], -0.04, atol=1e-3)
    np.testing.assert_allclose(inside[middle, 1], 0.0, atol=1e-3)
    assert (inside[ends, 0] > 0).any() and (inside[ends, 0] < 0).any()


def test_drift_has_the_size_that_was_asked_for() -> None:
    rng = np.random.default_rng(0)
    times = np.arange(0.0, 400.0, 0.1)
    deviations = [drift(sample_drift(rng, (0.01, 0.02, 0.0)), times).std(axis=0) for _ in range(20)]
    np.testing.assert_allclose(np.mean(deviations, axis=0), (0.01, 0.02, 0.0), rtol=0.1)
