"""The Unity side of the package against a stand-in of the engine: it compiles, and what it does.

The stand-in (``stubs``) names exactly what the package uses of the engine's interface. Its maths,
its transforms and its components work, so that the package's tests run on it, and so does the
sample room; it draws nothing and plays no animation. It cannot show that Unity takes the package.
"""

import re
from functools import cache
from pathlib import Path

from agent_server.skeleton.formats import FORMATS
from tests.unity.build import BRIDGE, NUNIT, compiled, core, needs_mono, run_nunit, sources
from tests.unity.make_retarget_golden import GOLDEN, lines

HERE = Path(__file__).parent
UNITY = BRIDGE / "Runtime/Unity"
SAMPLES = BRIDGE / "Samples~"
EDIT_MODE = BRIDGE / "Tests/EditMode"


@cache
def engine() -> tuple[Path, ...]:
    """The stand-ins of UnityEngine and UnityEditor."""
    runtime = compiled("UnityEngine.dll", sources(HERE / "stubs/UnityEngine"))
    editor = compiled("UnityEditor.dll", sources(HERE / "stubs/UnityEditor"), (runtime,))
    return runtime, editor


@cache
def unity() -> Path:
    """The components."""
    return compiled("AgentServer.Unity.dll", sources(UNITY), (core(), engine()[0]))


@cache
def editor() -> Path:
    """The tools of the editor."""
    return compiled(
        "AgentServer.Unity.Editor.dll", sources(BRIDGE / "Editor"), (core(), unity(), *engine())
    )


def run_tests(name: str, folder: Path) -> str:
    """Compile a folder of NUnit tests and run them."""
    references = (core(), unity(), editor(), *engine(), NUNIT)
    return run_nunit(compiled(name, sources(folder), references))


@needs_mono
def test_the_edit_mode_tests_pass():
    assert "Failures: 0" in run_tests("AgentServer.Unity.Tests.dll", EDIT_MODE)


@needs_mono
def test_components_live_through_a_session():
    assert "Failures: 0" in run_tests("AgentServer.Unity.Lifecycle.dll", HERE / "lifecycle")


@needs_mono
def test_a_webgl_build_compiles():
    name, references = "AgentServer.Unity.WebGL.dll", (core(), engine()[0])
    assert compiled(name, sources(UNITY), references, "-define:UNITY_WEBGL").is_file()


@needs_mono
def test_the_samples_compile():
    kinect = compiled("Kinect.dll", sources(HERE / "stubs/Kinect"))
    references = (core(), unity(), engine()[0])
    for sample in ("Minimal", "Room", "Headset"):
        name = f"AgentServer.Samples.{sample}.dll"
        assert compiled(name, sources(SAMPLES / sample), references).is_file()
    cameras = compiled(
        "AgentServer.Samples.Cameras.dll",
        sources(SAMPLES / "Headset"),
        (*references, kinect),
        "-define:AGENT_SERVER_KINECT_V2",
        "-define:AGENT_SERVER_AZURE_KINECT",
    )
    assert cameras.is_file()


def test_the_golden_poses_are_those_of_the_server():
    written = [list(map(float, line.split())) for line in GOLDEN.read_text().splitlines()]
    for number, (old, new) in enumerate(zip(written, lines(), strict=True), start=1):
        largest = max(abs(a - b) for a, b in zip(old, new, strict=True))
        assert largest < 1e-5, f"line {number}: run python -m tests.unity.make_retarget_golden"


def test_joint_tables_are_those_of_the_server():
    text = (UNITY / "Sources/JointTable.cs").read_text()
    tables = re.findall(r'new JointTable\(("[^;]*)\);', text)
    assert len(tables) == 5
    for table in tables:
        name, *joints = "".join(re.findall(r'"([^"]*)"', table.replace('",', ' "', 1))).split()
        assert tuple(joints) == FORMATS[name].names, name


def test_tests_use_only_what_both_versions_of_nunit_share():
    text = "\n".join(path.read_text() for path in sources(EDIT_MODE))
    attributes = set(re.findall(r"^\s*\[(\w+)\]\s*$", text, re.MULTILINE))
    assert attributes == {"Test", "TestFixture", "SetUp", "TearDown"}
    assert set(re.findall(r"\bAssert\.(\w+)", text)) == {"AreEqual", "IsTrue", "Throws"}
