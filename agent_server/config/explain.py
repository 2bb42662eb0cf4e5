"""What every setting means, out of the sentences that stand in its section's docstring."""

import json
import re
from collections.abc import Iterator
from inspect import cleandoc

import msgspec

from agent_server.config.load import ROOT, keys, sections
from agent_server.config.section import Section
from agent_server.config.settings import Settings

_ENTRY = re.compile(r"^    (\w+): ", re.MULTILINE)


def explain(settings: Settings, *, with_words: bool = True) -> str:
    """Settings as a TOML file.

    Args:
        settings: The values.
        with_words: Whether to say above each key what it means.
    """
    return "\n".join(_lines(settings, with_words=with_words)) + "\n"


def meanings(kind: type[Section]) -> dict[str, str]:
    """Key -> what it means, on one line."""
    _, _, listed = cleandoc(kind.__doc__ or "").partition("\nAttributes:\n")
    parts = _ENTRY.split(listed)
    return {
        name: " ".join(words.replace("``", "").split())
        for name, words in zip(parts[1::2], parts[2::2], strict=True)
    }


def _lines(settings: Settings, *, with_words: bool) -> Iterator[str]:
    for name, kind in sections().items():
        section = settings if name == ROOT else getattr(settings, name)
        if name != ROOT:
            yield ""
            if with_words:
                yield f"# {cleandoc(kind.__doc__ or '').partition(chr(10))[0].replace('``', '')}"
            yield f"[{name}]"
        words = meanings(kind)
        for key, field in keys(kind).items():
            if with_words:
                yield f"# {words[key]}"
            yield _setting(key, getattr(section, key), field)


def _setting(key: str, value: object, field: msgspec.structs.FieldInfo) -> str:
    remark = "" if value == field.default else f"  # default: {_toml(field.default)}"
    if value is None:
        return f"# {key} ="
    return f"{key} = {_toml(value)}{remark}"


def _toml(value: object) -> str:
    """A value of a setting; JSON's texts, numbers and lists are TOML's too."""
    return "none" if value is None else json.dumps(value, ensure_ascii=False)
