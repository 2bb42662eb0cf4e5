"""``agent-server doctor``: what it finds, and that it finds it."""

import json
import resource
import shutil
import socket

from typer.testing import CliRunner

from agent_server import assets
from agent_server.cli.main import app


def doctor(*arguments):
    """Status, and the findings by their name."""
    result = CliRunner().invoke(app, ["doctor", "--json", *map(str, arguments)])
    told = json.loads(result.stdout)
    assert told["ok"] is (result.exit_code == 0)
    return result.exit_code, {one["check"]: one for one in told["checks"]}


def test_a_sound_machine_has_nothing_amiss(tmp_path):
    _, found = doctor("--port", 0, "--folder", tmp_path)
    # How busy the machine is that runs the tests, the clock's check alone says.
    amiss = [one for one in found.values() if not one["is_good"] and one["check"] != "clock"]
    assert not amiss or [one["check"] for one in amiss] == ["page"]
    assert set(found) == {"models", "port", "clock", "disk", "page", "files"}
    assert "ma_wgan_server" in found["models"]["found"]


def test_a_taken_port_is_told_with_the_way_out():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        status, found = doctor("--port", other.getsockname()[1])
    assert status == 1
    assert not found["port"]["is_good"]
    assert "--port" in found["port"]["remedy"] + found["port"]["found"]


def test_an_altered_model_is_told(tmp_path):
    bundle = tmp_path / "ma_wgan_server"
    shutil.copytree(assets.bundles() / "ma_wgan_server", bundle)
    with (bundle / "model.onnx").open("ab") as model:
        model.write(b"0")
    settings = tmp_path / "settings.toml"
    settings.write_text(f"[models]\npredictor = '{bundle}'\n")
    status, found = doctor("--port", 0, "-c", settings)
    assert status == 1
    assert "model.onnx" in found["models"]["found"] + found["models"]["remedy"]


def test_a_missing_page_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(assets, "page", lambda: tmp_path)
    status, found = doctor("--port", 0)
    assert (status, found["page"]["remedy"]) == (1, "run `make page`")


def test_too_few_files_are_told(monkeypatch):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (64, 64))
    status, found = doctor("--port", 0)
    assert (status, found["files"]["is_good"]) == (1, False)
    assert "ulimit -n" in found["files"]["remedy"]


def test_a_full_disk_is_told(tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)._replace(free=10 * 2**20)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage)
    status, found = doctor("--port", 0, "--folder", tmp_path / "not" / "yet")
    assert (status, found["disk"]["is_good"]) == (1, False)
    assert "10 MB are free" in found["disk"]["found"]


def test_people_get_a_line_a_check():
    told = CliRunner().invoke(app, ["doctor", "--port", "0"]).stdout
    for check in ("models", "port", "clock", "disk", "page", "files"):
        assert check in told


def test_one_check_can_be_asked_for():
    _, found = doctor("--only", "files", "--only", "clock")
    assert set(found) == {"files", "clock"}
