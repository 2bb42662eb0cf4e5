"""Write the .meta files of the Unity package.

Unity keeps a GUID beside each file and folder, and scenes refer to files by it. Here a GUID is the
MD5 of ``com.agentserver.bridge:`` and the path inside the package, so that it is unique and never
changes:

    python -m tests.unity.make_meta

writes those that are missing and takes away those whose file is gone. One that is there stays.
"""

import hashlib
import sys
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "unity_bridge"
NAME = "com.agentserver.bridge"

_PLUGIN_FOR_WEBGL = """\
PluginImporter:
  externalObjects: {}
  serializedVersion: 2
  iconMap: {}
  executionOrder: {}
  defineConstraints: []
  isPreloaded: 0
  isOverridable: 0
  isExplicitlyReferenced: 0
  validateReferences: 1
  platformData:
  - first:
      Any:
    second:
      enabled: 0
      settings: {}
  - first:
      Editor: Editor
    second:
      enabled: 0
      settings:
        DefaultValueInitialized: true
  - first:
      WebGL: WebGL
    second:
      enabled: 1
      settings: {}
"""

_SCRIPT = """\
MonoImporter:
  externalObjects: {}
  serializedVersion: 2
  defaultReferences: []
  executionOrder: 0
  icon: {instanceID: 0}
"""

_IMPORTERS = {
    ".cs": _SCRIPT,
    ".asmdef": "AssemblyDefinitionImporter:\n  externalObjects: {}\n",
    ".jslib": _PLUGIN_FOR_WEBGL,
    ".md": "TextScriptImporter:\n  externalObjects: {}\n",
    ".xml": "TextScriptImporter:\n  externalObjects: {}\n",
    ".json": "TextScriptImporter:\n  externalObjects: {}\n",
    ".txt": "TextScriptImporter:\n  externalObjects: {}\n",
}
_TAIL = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"


def guid(path: str) -> str:
    """The GUID of a file or folder, by its path inside the package with forward slashes."""
    return hashlib.md5(f"{NAME}:{path}".encode(), usedforsecurity=False).hexdigest()


def assets(package: Path) -> Iterator[Path]:
    """Every file and folder that Unity imports: none that is hidden or ends in ``~``."""
    for path in sorted(package.iterdir()):
        if path.name.startswith(".") or path.name.endswith("~") or path.suffix == ".meta":
            continue
        yield path
        if path.is_dir():
            yield from assets(path)


def meta_of(path: Path) -> Path:
    """Where the .meta file of a file or folder lies."""
    return path.with_name(path.name + ".meta")


def meta(path: Path, package: Path) -> str:
    """The text of the .meta file of a file or folder."""
    place = path.relative_to(package).as_posix()
    head = f"fileFormatVersion: 2\nguid: {guid(place)}\n"
    if path.is_dir():
        return head + "folderAsset: yes\nDefaultImporter:\n  externalObjects: {}\n" + _TAIL
    if place == "package.json":
        return head + "PackageManifestImporter:\n  externalObjects: {}\n" + _TAIL
    importer = _IMPORTERS.get(path.suffix, "DefaultImporter:\n  externalObjects: {}\n")
    return head + importer + _TAIL


def orphans(package: Path) -> Iterator[Path]:
    """The .meta files whose file or folder is gone."""
    for path in sorted(package.rglob("*.meta")):
        is_imported = not any(part.endswith("~") for part in path.relative_to(package).parts)
        if is_imported and not path.with_suffix("").exists():
            yield path


def main() -> int:
    """Write what is missing, take away what is left over, and say so."""
    for path in assets(PACKAGE):
        if not meta_of(path).exists():
            meta_of(path).write_text(meta(path, PACKAGE))
            print("wrote", meta_of(path).relative_to(PACKAGE))  # noqa: T201
    for path in list(orphans(PACKAGE)):
        path.unlink()
        print("took away", path.relative_to(PACKAGE))  # noqa: T201
    return 0


if __name__ == "__main__":
    sys.exit(main())
