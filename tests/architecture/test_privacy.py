"""The server tells nobody of its use."""

import os
import subprocess
import sys

from agent_server import assets

LOAD = """
import sys
from pathlib import Path
from agent_server.inference.runtime import OnnxAffect
OnnxAffect(Path(sys.argv[1]), "mesh")
"""


def test_running_a_model_leaves_no_identifier_behind(tmp_path):
    """Where onnxruntime's telemetry is on, it keeps an identifier of the machine and a queue."""
    environment = {**os.environ, "HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    environment.pop("ORT_DISABLE_TELEMETRY", None)
    bundle = assets.bundles() / "affect_mesh"
    subprocess.run([sys.executable, "-c", LOAD, str(bundle)], env=environment, check=True)
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []
