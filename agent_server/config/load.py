"""Settings out of a TOML file and the environment; every mistake is named with its place."""

import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from agent_server.config.section import Contradiction, Section
from agent_server.config.settings import Settings
from agent_server.errors import ConfigError
from agent_server.suggest import suggest
from agent_server.toml_lines import locate

PREFIX = "AGENT_SERVER__"
"""Of environment variables that hold settings; sections and keys follow in capitals."""
ROOT = ""
_PLACE = re.compile(r" \(at (?:line (?P<line>\d+), column \d+|end of document)\)$")


@dataclass(frozen=True, slots=True)
class _Given:
    """A value and where it was given; a text of the environment stands for any kind of value."""

    value: Any
    place: str
    is_text: bool = False


def sections() -> dict[str, type[Section]]:
    """Every section by its name; the settings outside any stand under the empty name."""
    kinds: dict[str, type[Section]] = {ROOT: Settings}
    for field in msgspec.structs.fields(Settings):
        if isinstance(field.type, type) and issubclass(field.type, Section):
            kinds[field.name] = field.type
    return kinds


def keys(kind: type[Section]) -> dict[str, msgspec.structs.FieldInfo]:
    """The keys of a section, by name."""
    return {
        field.name: field
        for field in msgspec.structs.fields(kind)
        if not (isinstance(field.type, type) and issubclass(field.type, Section))
    }


def load_settings(path: Path | None, environment: Mapping[str, str] | None = None) -> Settings:
    """Read settings from a TOML file and from the environment, whose word holds.

    Args:
        path: The file; None gives the defaults.
        environment: Where variables are looked up; None takes the process's.

    Raises:
        ConfigError: If the file cannot be read or anything is refused; the text names each
            mistake and its place.
    """
    reader = _Reader()
    if path is not None:
        reader.read_file(path)
    reader.read_environment(os.environ if environment is None else environment)
    settings = reader.settings()
    if reader.mistakes:
        raise ConfigError("\n".join(reader.mistakes))
    return settings


def mistakes_in(path: Path) -> list[str]:
    """Every mistake of a file, each with its line; the environment is left aside.

    Raises:
        ConfigError: If the file cannot be read.
    """
    reader = _Reader()
    reader.read_file(path)
    reader.settings()
    return reader.mistakes


class _Reader:
    def __init__(self) -> None:
        self.mistakes: list[str] = []
        self._given: dict[str, dict[str, _Given]] = {name: {} for name in sections()}
        self._places: dict[str, str] = {}

    # ------------------------------------------------------------------ where values come from

    def read_file(self, path: Path) -> None:
        """Note what a file gives."""
        try:
            text = path.read_text("utf-8")
        except OSError as error:
            raise ConfigError(f"cannot read {path}: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise ConfigError(f"{path} is not valid TOML: {error}") from error
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            self._refuse_toml(path, text, str(error))
            return
        lines = locate(text)
        for name, value in table.items():
            place = f"{path}:{lines[name,]}"
            if name in sections() and name != ROOT:
                self._read_section(path, name, value, lines)
            else:
                self._give(ROOT, name, _Given(value, place))

    def _read_section(
        self, path: Path, name: str, value: object, lines: Mapping[tuple[str | int, ...], int]
    ) -> None:
        place = self._places[name] = f"{path}:{lines[name,]}"
        if not isinstance(value, dict):
            self._refuse(place, f"{name} is a section: write [{name}] and its keys below it")
            return
        for key, one in value.items():
            self._give(name, key, _Given(one, f"{path}:{lines[name, key]}"))

    def _refuse_toml(self, path: Path, text: str, sentence: str) -> None:
        line = text.rstrip().count("\n") + 1
        if place := _PLACE.search(sentence):
            sentence, line = sentence[: place.start()], int(place["line"] or line)
        self._refuse(f"{path}:{line}", f"not valid TOML: {sentence}; look there and just before")

    def read_environment(self, environment: Mapping[str, str]) -> None:
        """Note what environment variables give."""
        for variable in sorted(environment):
            if not variable.startswith(PREFIX):
                continue
            section, _, key = variable.removeprefix(PREFIX).lower().rpartition("__")
            given = _Given(environment[variable], variable, is_text=True)
            if section in sections():
                self._give(section, key, given)
            else:
                known = (name for name in sections() if name != ROOT)
                self._refuse(
                    variable,
                    f"there is no section {section!r}: {suggest(section, 'sections', known)}",
                )

    def _give(self, section: str, key: str, given: _Given) -> None:
        known = keys(sections()[section])
        if key in known:
            self._given[section][key] = given
            return
        title = f"[{section}] {key}" if section else key
        others = (*known, *(f"[{name}]" for name in sections() if name)) if not section else known
        self._refuse(given.place, f"{title}: unknown key; {suggest(key, 'keys here', others)}")

    # ------------------------------------------------------------------ what becomes of them

    def settings(self) -> Settings:
        """All settings; where something was refused, the default stands in."""
        made = {name: self._section(name, kind) for name, kind in sections().items() if name}
        settings: Settings = self._section(ROOT, Settings)
        return msgspec.structs.replace(settings, **made)

    def _section(self, name: str, kind: type[Section]) -> Any:
        given = self._given[name]
        values, is_sound = {}, True
        for key, field in keys(kind).items():
            if key not in given:
                continue
            try:
                values[key] = _converted(given[key], field.type)
            except (msgspec.ValidationError, tomllib.TOMLDecodeError) as error:
                is_sound = False
                self._refuse(given[key].place, f"{_title(name, key)}: {error}")
        try:
            return kind(**values)
        except Contradiction as error:
            # A default that stands in for a wrong value may contradict the others.
            if is_sound:
                for sentence in error.sentences:
                    place = self._place(name, sentence)
                    self._refuse(place, f"[{name}] {sentence}" if name else sentence)
            return kind()

    def _place(self, section: str, sentence: str) -> str:
        """Where the first value stands that a sentence names."""
        given = self._given[section]
        named: Iterable[str] = re.findall(r"\w+", sentence)
        return next(
            (given[word].place for word in named if word in given),
            self._places.get(section, section),
        )

    def _refuse(self, place: str, sentence: str) -> None:
        self.mistakes.append(f"{place}: {sentence}")


def _title(section: str, key: str) -> str:
    return f"[{section}] {key}" if section else key


def _converted(given: _Given, kind: Any) -> Any:
    value = given.value
    if given.is_text and value.startswith("["):
        value = tomllib.loads(f"value = {value}")["value"]
    return msgspec.convert(value, kind, strict=not given.is_text)
