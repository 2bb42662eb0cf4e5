"""Compiles the C# of the Unity bridge with mono's mcs and runs it; each part once per process."""

import atexit
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest

BRIDGE = Path(__file__).parents[2] / "unity_bridge"
CORE = BRIDGE / "Runtime" / "Core"
CORE_TESTS = BRIDGE / "Tests" / "Core"
NUNIT = Path("/usr/lib/cli/nunit.framework-2.6.3/nunit.framework.dll")
COMPILE_S = 120
RUN_S = 300


def _missing() -> str | None:
    """What is not installed, and how to install it; None if all is there."""
    programs = {"mcs": "mono-mcs", "mono": "mono-runtime", "nunit-console": "nunit-console"}
    packages = [package for name, package in programs.items() if shutil.which(name) is None]
    if not NUNIT.exists():
        packages.append("libnunit-cil-dev")
    if not packages:
        return None
    return f"C# is not compiled here: install the Debian packages {' '.join(packages)}"


MISSING = _missing()
needs_mono = pytest.mark.skipif(MISSING is not None, reason=MISSING or "")
"""Marks a test that needs mono; it is skipped with what to install."""


@cache
def output() -> Path:
    """The folder of everything compiled, which goes with the process."""
    folder = tempfile.mkdtemp(prefix="agent-server-csharp-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def sources(*roots: Path) -> tuple[Path, ...]:
    """All C# files below some folders; a file stands for itself."""
    return tuple(
        path
        for root in roots
        for path in ([root] if root.is_file() else sorted(root.rglob("*.cs")))
    )


@cache
def compiled(
    name: str, files: tuple[Path, ...], references: tuple[Path, ...] = (), *flags: str
) -> Path:
    """Compile a library (``*.dll``) or a program (``*.exe``); warnings are errors.

    Args:
        name: Name of the file to make.
        files: Sources.
        references: Libraries; they are laid beside it.
        flags: Further flags of mcs.
    """
    out = output() / name
    target = "library" if out.suffix == ".dll" else "exe"
    for library in references:
        if library.parent != out.parent:
            shutil.copy(library, out.parent)
    command = [
        *(
            "mcs",
            "-langversion:7.2",
            "-warnaserror",
            "-r:System.Numerics.dll",
            f"-target:{target}",
            f"-out:{out}",
        ),
        *(f"-r:{library}" for library in references),
        *flags,
        *map(str, files),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=COMPILE_S, check=False)
    assert done.returncode == 0, f"{name} does not compile:\n{done.stdout}{done.stderr}"
    return out


def core() -> Path:
    """The engine-free client."""
    return compiled("AgentServer.Core.dll", sources(CORE))


def console_client() -> Path:
    """The console renderer and monitor; ``mono PATH --url ... --json`` runs it."""
    sample = BRIDGE / "Samples~" / "ConsoleClient"
    return compiled("ConsoleClient.exe", sources(sample), (core(),))


def run_nunit(library: Path) -> str:
    """Run the tests of a library; what the runner prints.

    Raises:
        AssertionError: If a test fails, or there is none.
    """
    command = ["nunit-console", "-nologo", "-noresult", str(library)]
    done = subprocess.run(
        command, cwd=library.parent, capture_output=True, text=True, timeout=RUN_S, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Tests run: 0," not in done.stdout, done.stdout
    return done.stdout


def run(program: Path, *arguments: str) -> Iterable[str]:
    """Run a program to its end; the lines that it prints.

    Raises:
        AssertionError: If it fails.
    """
    command = ["mono", str(program), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=RUN_S, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.rstrip("\n").split("\n")
