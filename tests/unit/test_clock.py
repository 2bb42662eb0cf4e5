"""Clocks: one that runs, and one that stands still."""

import pytest

from agent_server.clock import ManualClock, SystemClock


def test_the_system_clock_never_goes_back():
    clock = SystemClock()
    assert clock.now_ns() <= clock.now_ns()
    assert clock.wall().endswith("+00:00")


def test_a_manual_clock_moves_only_when_told():
    clock = ManualClock(5)
    assert clock.now_ns() == clock.now_ns() == 5
    clock.advance(2_000_000_000)
    assert clock.now_ns() == 2_000_000_005
    assert clock.wall().startswith("1970-01-01T00:00:02")
    with pytest.raises(ValueError, match="go back"):
        clock.advance(-1)
