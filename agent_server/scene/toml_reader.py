"""Typed reading of a TOML text, where every mistake names its line and the way out."""

import re
import tomllib
from dataclasses import dataclass
from typing import Any, TypeVar

from agent_server.errors import RuleError
from agent_server.suggest import suggest
from agent_server.toml_lines import Path, line_of

_Kind = TypeVar("_Kind", str, bool, int, list[Any], dict[str, Any])

_KINDS: dict[type, str] = {
    str: "a text in quotes",
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    list: "a list in [brackets]",
    dict: "a table",
}
_PLACE = re.compile(r" \(at (?:line (?P<line>\d+), column \d+|end of document)\)$")
_NAME = re.compile(r"[a-z][a-z0-9_]{0,63}")
NAME_FIX = "use 1 to 64 small letters, digits and underscores, a letter first"
"""The way out of a text that is not a name."""

_SMALLEST = 0.001
_LARGEST = 86_400


def is_name(text: str) -> bool:
    """Whether ``text`` may name an object, a state, a step or a reaction."""
    return _NAME.fullmatch(text) is not None


@dataclass(frozen=True, slots=True)
class Source:
    """A rule text and what it is called in messages.

    Attributes:
        name: File name, as the user gave it.
        text: The whole document.
    """

    name: str
    text: str

    def parse(self) -> "Table":
        """The root table.

        Raises:
            RuleError: If the text is not TOML.
        """
        try:
            return Table(self, (), tomllib.loads(self.text))
        except tomllib.TOMLDecodeError as error:
            what, line = str(error), self.text.rstrip().count("\n") + 1  # the end, if not told
            if place := _PLACE.search(what):
                what, line = what[: place.start()], int(place["line"] or line)
            raise RuleError(
                f"{self.name}:{line}: not valid TOML: {what}; look there and just before it: "
                "texts stand in quotes, brackets close, a name is given once"
            ) from error

    def error(self, path: Path, what: str, fix: str) -> RuleError:
        """The mistake at ``path``: what is wrong, and the way out."""
        return RuleError(f"{self.name}:{self.line(path)}: {what}; {fix}")

    def line(self, path: Path) -> int:
        """Where ``path`` stands, counted from 1."""
        return line_of(self.text, path)


class Table:
    """One table of a rule file, read key by key.

    Every method that reads raises RuleError when the value is missing or of another type.

    Args:
        source: Where it comes from.
        path: Where it stands in the document.
        values: What ``tomllib`` made of it.
    """

    def __init__(self, source: Source, path: Path, values: dict[str, Any]) -> None:
        self.source = source
        self.path = path
        self._values = values

    def __contains__(self, key: str) -> bool:
        return key in self._values

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys, in the order of the file."""
        return tuple(self._values)

    def error(self, key: str, what: str, fix: str) -> RuleError:
        """The mistake at ``key`` of this table."""
        return self.source.error((*self.path, key), f"{self._title(key)}: {what}", fix)

    def element_error(self, key: str, index: int, what: str, fix: str) -> RuleError:
        """The mistake at one element of the list at ``key``."""
        title = f"{self._title(key)}[{index}]: {what}"
        return self.source.error((*self.path, key, index), title, fix)

    def only(self, *keys: str) -> "Table":
        """This table, after refusing every key but ``keys``."""
        for key in self._values:
            if key not in keys:
                raise self.error(key, "unknown key", suggest(key, "keys here", keys))
        return self

    def text(self, key: str) -> str:
        """A text."""
        return self._read(key, str)

    def integer(self, key: str, limit: int) -> int:
        """A whole number from 0 to ``limit``."""
        value = self._read(key, int)
        if not 0 <= value <= limit:
            raise self.error(key, f"{value} is out of range", f"choose from 0 to {limit}")
        return value

    def flag(self, key: str) -> bool:
        """True or false; a missing key is false."""
        return key in self._values and self._read(key, bool)

    def positive(self, key: str) -> float:
        """A number above zero, within bounds that keep times exact and sensible."""
        value = self._values.get(key)
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise self._mistyped(key, float)
        if not _SMALLEST <= value <= _LARGEST:
            fix = f"choose from {_SMALLEST} to {_LARGEST}"
            raise self.error(key, f"{value} is out of range", fix)
        return float(value)

    def texts(self, key: str) -> list[str]:
        """A list of texts; a missing key is an empty list."""
        if key not in self._values:
            return []
        values = self._read(key, list)
        for index, value in enumerate(values):
            if not isinstance(value, str):
                raise self.element_error(
                    key, index, f"expected {_KINDS[str]}, got {_describe(value)}", 'write "text"'
                )
        return values

    def table(self, key: str, *, required: bool = True) -> "Table":
        """The table at ``key``; a missing one is empty when it is not required."""
        values = self._read(key, dict) if required or key in self._values else {}
        return Table(self.source, (*self.path, key), values)

    def tables(self, key: str) -> list["Table"]:
        """The tables of a ``[[key]]`` list."""
        values = self._values.get(key)
        if not (isinstance(values, list) and all(isinstance(value, dict) for value in values)):
            what = "is no list of tables" if key in self._values else "missing"
            raise self.error(key, what, f"write each one under a line [[{key}]]")
        return [
            Table(self.source, (*self.path, key, index), value)
            for index, value in enumerate(values)
        ]

    def named_tables(self, key: str) -> dict[str, "Table"]:
        """The tables under ``key``, each with the name that it defines."""
        parent = self.table(key)
        for name in parent.keys:
            if not is_name(name):
                raise parent.error(name, f"'{name}' is not a name", NAME_FIX)
        return {name: parent.table(name) for name in parent.keys}

    def _read(self, key: str, kind: type[_Kind]) -> _Kind:
        if type(value := self._values.get(key)) is kind:  # a bool is no whole number here
            return value
        raise self._mistyped(key, kind)

    def _mistyped(self, key: str, kind: type) -> RuleError:
        wanted = _KINDS[kind]
        if key not in self._values:
            fix = f"add [{self._title(key)}]" if kind is dict else f"add {key} = <{wanted}>"
            return self.error(key, "missing", fix)
        return self.error(
            key, f"expected {wanted}, got {_describe(self._values[key])}", f"write {wanted}"
        )

    def _title(self, key: str) -> str:
        title = ""
        for part in (*self.path, key):
            title += f"[{part}]" if isinstance(part, int) else f".{part}" if title else part
        return title


def _describe(value: object) -> str:
    kind = _KINDS.get(type(value), "a date or time")
    return kind if isinstance(value, list | dict) else f"{value!r} ({kind})"
