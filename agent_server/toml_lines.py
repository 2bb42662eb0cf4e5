"""On which line of a TOML text each value stands.

``tomllib`` gives values without lines. This scanner walks over a text that ``tomllib`` has
already accepted and notes where every key and every array element starts; it checks nothing.
"""

import re
import tomllib

Path = tuple[str | int, ...]
"""Keys and array indices from the document's root, for example ``("rules", 0, "when")``."""

_BLANK = re.compile(r"(?:\s|#[^\n]*)*")
_SIMPLE_KEY = re.compile(r'[A-Za-z0-9_-]+|"(?:[^"\\]|\\.)*"|\'[^\']*\'')
_SCALAR = re.compile(
    r'"""(?:[^\\]|\\.)*?"""(?:"{0,2})'  # a text may end in up to two quotes of its own
    r"|'''.*?'''(?:'{0,2})"
    r'|"(?:[^"\\]|\\.)*"'
    r"|'[^']*'"
    r"|[^,\]}#\n]+",
    re.DOTALL,
)


def locate(text: str) -> dict[Path, int]:
    """The line of every table, key and array element.

    Args:
        text: A valid TOML document.

    Returns:
        Path -> line, counted from 1. A table that has no header of its own stands where it is
        first mentioned; the root stands on line 1.

    Raises:
        ValueError: If the text cannot be TOML. Not every such text is noticed.
    """
    scanner = _Scanner(text)
    scanner.document()
    return scanner.lines


def line_of(text: str, path: Path) -> int:
    """The line of ``path``, or of the nearest table around it when it is not in ``text``."""
    lines = locate(text)
    while path not in lines:
        path = path[:-1]
    return lines[path]


class _Scanner:
    def __init__(self, text: str) -> None:
        self.lines: dict[Path, int] = {(): 1}
        self._text = text
        self._position = 0
        self._elements: dict[Path, int] = {}  # how many [[headers]] each array has had so far

    def document(self) -> None:
        table: Path = ()
        while self._next() != "":
            if self._skip("[["):
                table = self._header(is_array=True)
                self._skip("]]")
            elif self._skip("["):
                table = self._header(is_array=False)
                self._skip("]")
            else:
                self._pair(table)

    def _header(self, *, is_array: bool) -> Path:
        line = self._line()
        *parents, last = self._key()
        path: Path = ()
        for parent in parents:
            path = self._mention((*path, parent), line)
            if path in self._elements:
                path = (*path, self._elements[path] - 1)
        path = (*path, last)
        if is_array:
            self._mention(path, line)
            index = self._elements.get(path, 0)
            self._elements[path] = index + 1
            path = (*path, index)
        self.lines[path] = line
        return path

    def _pair(self, table: Path) -> None:
        line = self._line()
        path = table
        for key in self._key():
            path = self._mention((*path, key), line)
        self._skip("=")
        self._value(path)

    def _value(self, path: Path) -> None:
        if self._skip("["):
            index = 0
            while self._next() != "]":
                element = self._mention((*path, index), self._line())
                self._value(element)
                self._skip(",")
                index += 1
            self._skip("]")
        elif self._skip("{"):
            while self._next() != "}":
                self._pair(path)
                self._skip(",")
            self._skip("}")
        else:
            self._next()
            self._take(_SCALAR)

    def _key(self) -> list[str]:
        keys = []
        while True:
            self._next()
            key = self._take(_SIMPLE_KEY)
            keys.append(_unquoted(key))
            if not self._skip("."):
                return keys

    def _mention(self, path: Path, line: int) -> Path:
        self.lines.setdefault(path, line)
        return path

    def _next(self) -> str:
        """The next character that is neither blank nor comment, or "" at the end."""
        self._take(_BLANK)
        return self._text[self._position : self._position + 1]

    def _skip(self, token: str) -> bool:
        self._next()
        if not self._text.startswith(token, self._position):
            return False
        self._position += len(token)
        return True

    def _take(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self._text, self._position)
        if match is None:
            raise ValueError(f"not valid TOML from line {self._line()} on: parse the text first")
        self._position = match.end()
        return match.group()

    def _line(self) -> int:
        return self._text.count("\n", 0, self._position) + 1


def _unquoted(key: str) -> str:
    if key[0] not in "\"'":
        return key
    text: str = tomllib.loads(f"key = {key}")["key"]
    return text
