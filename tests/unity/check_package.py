"""Check the Unity package without Unity: manifest, assemblies, .meta files and C# syntax.

    python -m tests.unity.check_package

prints what is wrong, one a line, and exits with 1 if anything is.
"""

import json
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tree_sitter_c_sharp
from tree_sitter import Language, Node, Parser

from tests.unity.make_meta import NAME, PACKAGE, assets, guid, meta_of, orphans

REQUIRED = (
    "name",
    "version",
    "displayName",
    "description",
    "unity",
    "author",
    "license",
    "samples",
)
# https://semver.org, without build metadata, which the package manager does not take.
SEMVER = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)(-[0-9A-Za-z.-]+)?")
UNITY = re.compile(r"(20\d\d|[6-9]\d{3})\.\d+")
PACKAGE_NAME = re.compile(r"[a-z0-9-]+(\.[a-z0-9-]+){2,}")
ROOT_FILES = ("README.md", "CHANGELOG.md", "LICENSE.md", "Documentation~/index.md")
TEST_ASSEMBLIES = {"UnityEngine.TestRunner", "UnityEditor.TestRunner"}
ENGINE = {b"UnityEngine", b"UnityEditor"}
DIRECTIVE = re.compile(rb"^[ \t]*#.*$", re.MULTILINE)
CORE = "Runtime/Core"


def problems(package: Path = PACKAGE) -> list[str]:
    """What is wrong with the package, in words."""
    return [
        *_manifest(package),
        *_assemblies(package),
        *_metas(package),
        *_sources(package),
        *_linker(package),
    ]


def _manifest(package: Path) -> Iterator[str]:
    manifest = _json(package / "package.json")
    yield from (f"package.json: {field} is missing" for field in REQUIRED if field not in manifest)
    if manifest.get("name") != NAME or not PACKAGE_NAME.fullmatch(NAME):
        yield f"package.json: the name is not {NAME}"
    version = str(manifest.get("version"))
    if not SEMVER.fullmatch(version):
        yield f"package.json: {version} is no semantic version"
    if not UNITY.fullmatch(str(manifest.get("unity"))):
        yield f"package.json: {manifest.get('unity')} is no version of Unity, such as 2021.3"
    for name, wanted in manifest.get("dependencies", {}).items():
        if not PACKAGE_NAME.fullmatch(name) or not SEMVER.fullmatch(wanted):
            yield f"package.json: the dependency {name} {wanted} is not a name and a version"
    yield from _samples(package, manifest)
    for name in ROOT_FILES:
        if not (package / name).is_file():
            yield f"{name} is missing"
    changes = package / "CHANGELOG.md"
    if changes.is_file() and f"[{version}]" not in changes.read_text():
        yield f"CHANGELOG.md says nothing of {version}"
    constant = package / "Runtime/Unity/PackageVersion.cs"
    if constant.is_file() and f'"{version}"' not in constant.read_text():
        yield f"Runtime/Unity/PackageVersion.cs has another version than package.json: {version}"


def _samples(package: Path, manifest: dict[str, Any]) -> Iterator[str]:
    listed = set()
    for sample in manifest.get("samples", []):
        listed.add(sample.get("path"))
        if not {"displayName", "description", "path"} <= set(sample):
            yield f"package.json: the sample {sample} lacks displayName, description or path"
        elif not (package / sample["path"]).is_dir():
            yield f"package.json: there is no folder {sample['path']}"
        elif not (package / sample["path"] / "README.md").is_file():
            yield f"{sample['path']}: README.md is missing"
    for folder in sorted((package / "Samples~").glob("*")):
        place = folder.relative_to(package).as_posix()
        if folder.is_dir() and place not in listed:
            yield f"package.json: the sample {place} is not listed"


def _assemblies(package: Path) -> Iterator[str]:
    found: dict[str, tuple[str, dict[str, Any]]] = {}
    folders: dict[Path, str] = {}
    for path in sorted(package.rglob("*.asmdef")):
        place = path.relative_to(package).as_posix()
        definition = _json(path)
        name = definition.get("name", "")
        if path.name != f"{name}.asmdef":
            yield f"{place}: the assembly is called {name}, and the file is not"
        if name in found:
            yield f"{place}: {name} is the name of {found[name][0]} too"
        if path.parent in folders:
            yield f"{place}: {folders[path.parent]} lies in the same folder"
        found[name] = (place, definition)
        folders[path.parent] = place
    for name, (place, definition) in found.items():
        is_test = "UNITY_INCLUDE_TESTS" in definition.get("defineConstraints", [])
        for reference in definition.get("references", []):
            if reference not in found and not (is_test and reference in TEST_ASSEMBLIES):
                yield f"{place}: there is no assembly {reference}"
        is_engine_free = definition.get("noEngineReferences", False)
        if is_engine_free != (place.startswith(f"{CORE}/")):
            yield f"{place}: noEngineReferences is {is_engine_free}"
        yield from _circle(name, found)
    for path in sorted(package.rglob("*.cs")):
        place = path.relative_to(package)
        is_program = place.parts[0] == "Tools~" or place.parts[1:2] == ("ConsoleClient",)
        if not is_program and not any(parent in folders for parent in path.parents):
            yield f"{place.as_posix()}: no assembly definition covers it"


def _circle(start: str, found: dict[str, tuple[str, dict[str, Any]]]) -> Iterator[str]:
    seen: set[str] = set()
    ahead = list(found[start][1].get("references", []))
    while ahead:
        name = ahead.pop()
        if name == start:
            yield f"{found[start][0]}: {start} refers to itself in a circle"
            return
        if name in found and name not in seen:
            seen.add(name)
            ahead += found[name][1].get("references", [])


def _metas(package: Path) -> Iterator[str]:
    owners: dict[str, str] = {}
    for path in assets(package):
        place = path.relative_to(package).as_posix()
        if not meta_of(path).is_file():
            yield f"{place}: its .meta is missing; run python -m tests.unity.make_meta"
            continue
        match = re.search(r"^guid: ([0-9a-f]{32})$", meta_of(path).read_text(), re.MULTILINE)
        if match is None:
            yield f"{place}.meta: there is no GUID in it"
        elif match[1] in owners:
            yield f"{place}.meta: its GUID is that of {owners[match[1]]} too"
        elif match[1] != guid(place):
            yield f"{place}.meta: its GUID is not that of its path; see tests/unity/make_meta.py"
        else:
            owners[match[1]] = place
    for path in orphans(package):
        yield f"{path.relative_to(package).as_posix()}: its file is gone"


def _sources(package: Path) -> Iterator[str]:
    parser = Parser(Language(tree_sitter_c_sharp.language()))
    for path in sorted(package.rglob("*.cs")):
        place = path.relative_to(package).as_posix()
        text = path.read_bytes()
        root = parser.parse(text).root_node
        if root.has_error:
            # The parser does not know conditions between the cases of a switch.
            root = parser.parse(DIRECTIVE.sub(b"", text)).root_node
        if root.has_error:
            wrong = next(node for node in _walk(root) if node.is_error or node.is_missing)
            yield f"{place}, line {wrong.start_point[0] + 1}: this is not C#"
        # In a comment the words may stand.
        if place.startswith(f"{CORE}/") and any(word in text for word in ENGINE):
            for node in _walk(root):
                if node.type == "identifier" and node.text in ENGINE:
                    yield f"{place}, line {node.start_point[0] + 1}: the core knows no engine"


def _walk(node: Node) -> Iterator[Node]:
    yield node
    for child in node.children:
        yield from _walk(child)


def _linker(package: Path) -> Iterator[str]:
    path = package / "link.xml"
    if not path.is_file():
        yield "link.xml is missing"
        return
    kept = {one.get("fullname") for one in ET.parse(path).getroot().iter("assembly")}  # noqa: S314
    for definition in sorted((package / "Runtime").rglob("*.asmdef")):
        name = _json(definition).get("name")
        if name not in kept:
            yield f"link.xml does not keep {name}"


def _json(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return value if isinstance(value, dict) else {}


def main() -> int:
    """Print what is wrong."""
    found = problems()
    for problem in found:
        print(problem)  # noqa: T201
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
