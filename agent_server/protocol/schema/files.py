"""All generated files, and whether those of a checkout are what the messages say."""

import json
from pathlib import Path

from agent_server.errors import ConfigError
from agent_server.protocol.schema import csharp, json_schema, reference, typescript

CORE = "unity_bridge/Runtime/Core"
"""Where the C# client lies."""


def generated() -> dict[str, str]:
    """Every generated file: its path below the checkout, and its text."""
    return {
        "docs/messages.md": reference.markdown(),
        "docs/protocol.schema.json": _json(json_schema.json_schema()),
        "docs/asyncapi.json": _json(json_schema.asyncapi()),
        **{f"{CORE}/{name}": text for name, text in csharp.csharp().items()},
        **typescript.typescript(),
    }


def write(root: Path) -> list[str]:
    """Write every file that is not what it should be; gives their paths.

    Raises:
        ConfigError: If one cannot be written.
    """
    stale = check(root)
    texts = generated()
    for name in stale:
        path = root / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(texts[name], "utf-8", newline="\n")
        except OSError as error:
            raise ConfigError(f"cannot write {path}: {error.strerror}") from error
    return stale


def check(root: Path) -> list[str]:
    """Paths of the files below ``root`` that are missing or not what the messages say."""
    return [name for name, text in generated().items() if _read(root / name) != text]


def _read(path: Path) -> str | None:
    try:
        return path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return None


def _json(document: object) -> str:
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"
