"""A hundred thousand mutated messages on all roles in both codings, and a witness beside them."""

from tests.bench.bad_input import faults_of
from tests.support.bad_input import run_trial

COUNT = 100_000
MOST_S = 60
"""Where the machine has other things to do, fewer are sent, but never less than a fifth."""


async def test_nothing_that_clients_send_is_unhandled_or_disturbs_others():
    figures = await run_trial(COUNT, seed=1, within_s=MOST_S)
    assert faults_of(figures) == [], figures
    assert figures["messages"] >= COUNT / 5
    assert figures["refused"] > 0.9 * figures["messages"]
    assert len(figures["answers"]) > 10, "the mutations reach deep"
