"""A suite: recordings, and what is expected of the agent on them."""

import tomllib
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from agent_server.errors import ConfigError

SUITE_FILE = "suite.toml"

_T = TypeVar("_T")


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of what a suite file holds: unknown keys are refused, numbers are checked."""

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            value = getattr(self, name)
            if isinstance(value, int | float) and not (isfinite(value) and value >= 0):
                raise ValueError(f"{name} is {value:g}: it must be 0 or more")


class Expected(_Table, frozen=True):
    """A reaction that must come, beside those of the labels.

    Attributes:
        reaction: Its name, for example ``close_window``.
        onset_s: When the gesture begins, in seconds of the recording.
        within_ms: How long after that it may come at the latest.
        gesture: The gesture that asks for it, for the reports.
    """

    reaction: str
    onset_s: float
    within_ms: int
    gesture: str | None = None


class Absent(_Table, frozen=True):
    """A reaction that must not come.

    Attributes:
        reaction: Its name; ``*`` for any.
        from_s: Start of the stretch in seconds ...
        to_s: ... and its end; None for the end of the recording.
    """

    reaction: str
    from_s: float = 0.0
    to_s: float | None = None


class Terms(_Table, frozen=True):
    """How a recording is judged.

    Attributes:
        within_ms: An expected reaction must come so long after the onset at the latest; None
            lets it come as long as it counts.
        late_ms: A reaction still answers a gesture so long after its end: windows look back.
        max_in_quiet: So many reactions may come where the agent must stay quiet.
        expect: Reactions that must come, beside those of the labels.
        absent: Reactions that must not come, beside the quiet of the labels.
    """

    within_ms: int | None = None
    late_ms: int = 1000
    max_in_quiet: int = 0
    expect: tuple[Expected, ...] = ()
    absent: tuple[Absent, ...] = ()


class Limits(_Table, frozen=True):
    """What is expected of the suite as a whole; None for nothing.

    Attributes:
        min_right: Share of expected reactions that come as expected, in [0, 1].
        max_false_per_hour: Reactions that nothing asks for, an hour of judged time.
        max_delay_p90_ms: Nine in ten right reactions come within this time.
    """

    min_right: float | None = None
    max_false_per_hour: float | None = None
    max_delay_p90_ms: float | None = None


class SuiteFile(_Table, frozen=True):
    """The content of a suite file.

    Attributes:
        name: Of the suite; None takes the folder's.
        recordings: Patterns of the recordings, relative to the file.
        defaults: For every recording.
        recording: File name -> what is different for it.
        limits: Over all.
    """

    name: str | None = None
    recordings: tuple[str, ...] = ("*.mcap",)
    defaults: Terms = Terms()
    recording: dict[str, Terms] = {}
    limits: Limits = Limits()


@dataclass(frozen=True, slots=True)
class Case:
    """A recording of a suite.

    Attributes:
        name: Its file, relative to the suite.
        path: Where it is.
        terms: How it is judged.
    """

    name: str
    path: Path
    terms: Terms


@dataclass(frozen=True, slots=True)
class Suite:
    """What is run.

    Attributes:
        name: For people.
        cases: The recordings, by name.
        limits: Over all.
    """

    name: str
    cases: tuple[Case, ...]
    limits: Limits


def load_suite(path: Path) -> Suite:
    """Read a suite: a TOML file, or a folder with or without a ``suite.toml``.

    Raises:
        ConfigError: If there is none, the file is wrong, or it names recordings that are not
            there.
    """
    if path.is_dir():
        folder, file = path, path / SUITE_FILE
        table: dict[str, Any] = _read(file) if file.exists() else {}
    elif path.suffix == ".toml":
        folder, file, table = path.parent, path, _read(path)
    else:
        raise ConfigError(
            f"{path} is no suite: give a folder of recordings, or a TOML file that describes one"
        )
    content = _convert(table, SuiteFile, file)
    # The tables themselves tell what a recording sets from what it leaves to the defaults.
    defaults, own = table.get("defaults", {}), table.get("recording", {})
    found = {
        recording.relative_to(folder).as_posix(): recording
        for pattern in content.recordings
        for recording in sorted(folder.glob(pattern))
    }
    if not found:
        raise ConfigError(
            f"{folder} holds no {', '.join(content.recordings)}: give a folder of recordings"
        )
    unknown = sorted(own.keys() - found.keys())
    if unknown:
        raise ConfigError(
            f"{file} says what is expected of {unknown[0]!r}, which is none of its recordings "
            f"({', '.join(sorted(found)[:5])}, ...): name a file as the pattern finds it"
        )
    cases = tuple(
        Case(name, found[name], _convert({**defaults, **own.get(name, {})}, Terms, file))
        for name in sorted(found)
    )
    return Suite(content.name or folder.resolve().name, cases, content.limits)


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not valid TOML: {error}") from error


def _convert(table: object, kind: type[_T], path: Path) -> _T:
    try:
        return msgspec.convert(table, kind)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {error}") from error
