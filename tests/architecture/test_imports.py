"""What the run time loads, and what it must not."""

import subprocess
import sys

LOADS_ALL = """
import pkgutil, sys, importlib, agent_server
for module in pkgutil.walk_packages(agent_server.__path__, "agent_server."):
    if not module.name.startswith("agent_server.web") and module.name != "agent_server.__main__":
        importlib.import_module(module.name)
print(" ".join(sorted(name.partition(".")[0] for name in sys.modules)))
"""


def loaded(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_no_module_of_the_run_time_loads_what_only_training_needs():
    found = loaded(LOADS_ALL)
    assert "onnxruntime" in found
    heavy = {"torch", "kornia", "models", "matplotlib", "scipy", "sklearn", "onnx", "onnxscript"}
    assert not found & heavy


def test_one_module_loads_onnxruntime():
    code = LOADS_ALL.replace(
        "importlib.import_module(module.name)",
        "module.name.startswith(('agent_server.domain', 'agent_server.stages', "
        "'agent_server.scene', 'agent_server.protocol', 'agent_server.recording', "
        "'agent_server.skeleton', 'agent_server.synthetic')) and "
        "importlib.import_module(module.name)",
    )
    assert "onnxruntime" not in loaded(code)
