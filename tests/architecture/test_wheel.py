"""The wheel: it carries what the product needs, and works where no checkout is."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel built from this checkout with what is installed here."""
    pytest.importorskip("hatchling", reason="hatchling is not installed")
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps"]
    command += ["--no-build-isolation", "--wheel-dir", folder, ROOT]
    subprocess.run(command, check=True)
    return next(folder.glob("*.whl"))


def test_the_wheel_carries_bundles_page_rules_and_the_demo(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for needed in (
        "agent_server/assets/bundles/ma_wgan_server/model.onnx",
        "agent_server/assets/bundles/interformer_server/manifest.json",
        "agent_server/assets/bundles/face_mesh/model.onnx",
        "agent_server/assets/bundles/affect_mesh/model.onnx",
        "agent_server/synthetic/face_shapes.npz",
        "agent_server/assets/page/index.html",
        "agent_server/assets/streams/demo.mcap",
        "agent_server/scene/room.toml",
    ):
        assert needed in names
    tops = {name.partition("/")[0] for name in names}
    assert all(top == "agent_server" or top.endswith(".dist-info") for top in tops)
    assert not any("node_modules" in name or "benchmarks" in name for name in names)


def test_an_installed_wheel_decides_without_the_checkout(wheel, tmp_path):
    target = tmp_path / "site"
    zipfile.ZipFile(wheel).extractall(target)
    code = (
        "from agent_server import assets, __file__ as where\n"
        "from agent_server.cli.main import app\n"
        f"assert where.startswith({str(target)!r}), where\n"
        "app(['replay', str(assets.demo_recording()), '--json'])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(target)},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr.decode()
    assert len(done.stdout.splitlines()) > 100
    assert b'"outcome":"command"' in done.stdout
