"""The Unity package is in order, and the check that says so can fail."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.unity.build import BRIDGE
from tests.unity.make_meta import assets, guid, meta, meta_of

pytest.importorskip("tree_sitter_c_sharp", reason="install the extra dev: it parses C#")

from tests.unity.check_package import problems


def test_the_package_is_in_order():
    assert problems() == []


def test_guids_never_change():
    """Scenes of users refer to these files by them."""
    assert guid("Runtime/Unity/AgentClient.cs") == "561123cc933294ae1d837aaa6ac8747b"
    assert guid("Runtime/Unity/Agent/AgentAnimator.cs") == "9f5b22399be57015f30f282bdf95bc3d"


def test_metas_are_as_they_would_be_made():
    for path in assets(BRIDGE):
        assert meta_of(path).read_text() == meta(path, BRIDGE), path


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A copy to break."""
    return Path(shutil.copytree(BRIDGE, tmp_path / "package"))


def _manifest(field: str, value: object) -> Callable[[Path], None]:
    def change(package: Path) -> None:
        path = package / "package.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), field: value}))

    return change


def _replace(place: str, old: str, new: str) -> Callable[[Path], None]:
    def change(package: Path) -> None:
        path = package / place
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, 1))

    return change


def _remove(place: str) -> Callable[[Path], None]:
    return lambda package: (package / place).unlink()


def _add(place: str, text: str = "") -> Callable[[Path], None]:
    return lambda package: (package / place).write_text(text) and None


def _copy(place: str, to: str) -> Callable[[Path], None]:
    return lambda package: shutil.copy(package / place, package / to) and None


CLIENT = "Runtime/Unity/AgentClient.cs"
CORE = "Runtime/Core/AgentServer.Core.asmdef"
UNITY = "Runtime/Unity/AgentServer.Unity.asmdef"
BROKEN = {
    "no semantic version": (_manifest("version", "0.1"), "0.1 is no semantic version"),
    "another version": (_manifest("version", "9.9.9"), "CHANGELOG.md says nothing of 9.9.9"),
    "no version of Unity": (_manifest("unity", "latest"), "latest is no version of Unity"),
    "another name": (_manifest("name", "bridge"), "the name is not com.agentserver.bridge"),
    "no license": (_remove("LICENSE.md"), "LICENSE.md is missing"),
    "a dependency without a version": (
        _manifest("dependencies", {"com.unity.modules.xr": "new"}),
        "com.unity.modules.xr new is not a name and a version",
    ),
    "a sample that is not listed": (_manifest("samples", []), "Samples~/Room is not listed"),
    "a sample that is not there": (
        _replace("package.json", "Samples~/Room", "Samples~/Zoom"),
        "there is no folder Samples~/Zoom",
    ),
    "a reference to nothing": (
        _replace(UNITY, '"AgentServer.Core"', '"AgentServer.Cor"'),
        "there is no assembly AgentServer.Cor",
    ),
    "a circle": (
        _replace(CORE, '"references": []', '"references": ["AgentServer.Unity"]'),
        "AgentServer.Core refers to itself in a circle",
    ),
    "a core with an engine": (
        _replace(CORE, '"noEngineReferences": true', '"noEngineReferences": false'),
        "noEngineReferences is False",
    ),
    "an engine in the core": (
        _replace(
            "Runtime/Core/Transport/ITransport.cs", "namespace", "using UnityEngine;\nnamespace"
        ),
        "the core knows no engine",
    ),
    "a name that is not the file's": (
        _replace(UNITY, '"name": "AgentServer.Unity"', '"name": "AgentServer.Renamed"'),
        "the assembly is called AgentServer.Renamed",
    ),
    "no .meta": (_remove(f"{CLIENT}.meta"), f"{CLIENT}: its .meta is missing"),
    "no .meta of a folder": (_remove("Runtime/Unity.meta"), "Runtime/Unity: its .meta is missing"),
    "a .meta without a file": (
        _add("Runtime/Gone.cs.meta", "guid: 0"),
        "Runtime/Gone.cs.meta: its file is gone",
    ),
    "a GUID of another": (
        _copy(f"{CLIENT}.meta", "Runtime/Unity/Coordinates.cs.meta"),
        "its GUID is that of Runtime/Unity/AgentClient.cs too",
    ),
    "a .meta without a GUID": (
        _add(f"{CLIENT}.meta", "fileFormatVersion: 2\n"),
        "there is no GUID",
    ),
    "no C#": (_replace(CLIENT, "void Update()", "void Update("), "this is not C#"),
    "a script in no assembly": (
        _add("Samples~/Stray.cs", "class Stray {}"),
        "Samples~/Stray.cs: no assembly definition covers it",
    ),
    "an assembly that is stripped": (
        _replace("link.xml", "AgentServer.Unity", "AgentServer.Other"),
        "link.xml does not keep AgentServer.Unity",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_package_is_refused(package: Path, name: str):
    change, wanted = BROKEN[name]
    change(package)
    found = problems(package)
    assert any(wanted in problem for problem in found), found
