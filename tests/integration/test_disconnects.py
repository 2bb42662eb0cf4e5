"""Commands take effect once, whatever the network and the server do: 50 forced disconnects each.

`make verify-long` does 1,000.
"""

import pytest

from agent_server.protocol.codes import CLOSE_NORMAL
from tests.support.command_fates import UNTOLD, WRONG
from tests.support.console_clients import LANGUAGES, Missing, command
from tests.support.disconnects import Trial, run_trial

DISCONNECTS = 50
BACK_WITHIN_MS = 2000


@pytest.mark.parametrize("language", LANGUAGES)
async def test_commands_take_effect_once_over_forced_disconnects(language):
    try:
        command(language)
    except Missing as reason:
        pytest.skip(str(reason))
    figures = await run_trial(Trial(language, DISCONNECTS, seed=1))
    assert figures["disconnects"] >= DISCONNECTS
    assert figures["restarts"] >= DISCONNECTS // 20
    assert figures["effects"] > DISCONNECTS // 5
    assert {fault: figures[fault] for fault in WRONG if figures[fault]} == {}, figures
    assert figures["ends"].get(UNTOLD, 0) <= figures["restarts"], figures
    assert figures["settled"], figures
    assert figures["not_resumed"] == 0, figures
    assert figures["resume_ms"]["p95"] < BACK_WITHIN_MS, figures
    assert figures["restart_resume_ms"]["p95"] < BACK_WITHIN_MS, figures
    assert set(figures["goodbyes"]) == {CLOSE_NORMAL}, figures
