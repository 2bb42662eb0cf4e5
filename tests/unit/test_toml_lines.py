import tomllib
from importlib import resources

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.toml_lines import line_of, locate

DOCUMENT = '''\
# a comment = 1
title = "a # b = [c]"

[objects]
window = { states = ["open", "closed"], initial = "open" }  # one line
"look_at screen" = 3.0
'literal "key"' = true
"escaped \\" key" = 1

[objects.door.lock]  # objects.door has no header
state = 'shut'

[[rules]]
gesture = "cold"
when.window = "open"
steps = [
  "stand_up",  # ] not the end

  "walk_to window", [1, 2],
  { do = "close", on = [
    "window"
  ] },
]

[[rules]]
gesture = """
many = "lines"
[not.a.header]
it ends in a quote""""
after = \'\'\'
x = 1\'\'\'\'

  [[rules.parts]]
  name = 1979-05-27 07:32:00

  [[rules.parts]]
  name = 2

  [rules.extra]
  on = false
'''

LINES = {
    ("title",): 2,
    ("objects",): 4,
    ("objects", "window"): 5,
    ("objects", "window", "states"): 5,
    ("objects", "window", "states", 1): 5,
    ("objects", "look_at screen"): 6,
    ("objects", 'literal "key"'): 7,
    ("objects", 'escaped " key'): 8,
    ("objects", "door"): 10,
    ("objects", "door", "lock", "state"): 11,
    ("rules",): 13,
    ("rules", 0): 13,
    ("rules", 0, "when"): 15,
    ("rules", 0, "when", "window"): 15,
    ("rules", 0, "steps"): 16,
    ("rules", 0, "steps", 0): 17,
    ("rules", 0, "steps", 1): 19,
    ("rules", 0, "steps", 2, 1): 19,
    ("rules", 0, "steps", 3): 20,
    ("rules", 0, "steps", 3, "on", 0): 21,
    ("rules", 1): 25,
    ("rules", 1, "gesture"): 26,
    ("rules", 1, "after"): 30,
    ("rules", 1, "parts", 0, "name"): 34,
    ("rules", 1, "parts", 1): 36,
    ("rules", 1, "parts", 1, "name"): 37,
    ("rules", 1, "extra", "on"): 40,
}


def paths(value, path=()):
    """Every path of what tomllib made of a document."""
    yield path
    if isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from paths(inner, (*path, key))


@pytest.mark.parametrize(("path", "line"), LINES.items(), ids=str)
def test_finds_each_line(path, line):
    assert locate(DOCUMENT)[path] == line


def packaged():
    return resources.files("agent_server.scene").joinpath("room.toml").read_text("utf-8")


@pytest.mark.parametrize("text", [DOCUMENT, packaged(), "", "\n\n# nothing\n"])
def test_finds_what_tomllib_finds_and_nothing_else(text):
    assert set(locate(text)) == set(paths(tomllib.loads(text)))


def test_a_missing_path_stands_where_its_table_does():
    assert line_of(DOCUMENT, ("rules", 0, "reaction", "name")) == 13
    assert line_of(DOCUMENT, ("nothing",)) == 1


def test_a_later_header_wins_over_the_first_mention():
    assert locate("[a.b]\n\n[a]\nc = 1\n")[("a",)] == 3


def test_carriage_returns_do_not_count():
    assert locate("a = 1\r\n[b]\r\nc = [\r\n2]\r\n") == {
        (): 1, ("a",): 1, ("b",): 2, ("b", "c"): 3, ("b", "c", 0): 4,
    }  # fmt: skip


@pytest.mark.parametrize("text", ["= 1", "a = [1", "a = {b = ", "[", "a ="])
def test_what_cannot_be_toml_is_refused(text):
    with pytest.raises(ValueError, match="not valid TOML"):
        locate(text)


# --- A generator of documents that knows the line of everything it writes.

KEYS = st.one_of(
    st.from_regex(r"[A-Za-z0-9_-]{1,6}", fullmatch=True),
    st.text(
        st.characters(min_codepoint=32, max_codepoint=0x24F, exclude_characters="\x7f"), max_size=6
    ),
)
GAPS = st.sampled_from(["", " ", "\n", "  # ],}\n", "\n\n# = [\n"])
SCALARS = st.sampled_from(
    [
        "1",
        "-2.5e3",
        "true",
        "1979-05-27 07:32:00",
        '"a # ] }"',
        "'[x] = \"'",
        '"\\""',
        "'''\n[t]\n'''",
        '"""\n\\"""x="""',
    ]
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(st.tuples(GAPS, inner), max_size=3),
        st.dictionaries(KEYS, inner, max_size=3),
    ),
    max_leaves=6,
)
TABLES = st.dictionaries(KEYS, VALUES, max_size=3)


def quoted(key):
    bare = key and all(c.isascii() and (c.isalnum() or c in "-_") for c in key)
    escaped = key.replace("\\", "\\\\").replace('"', '\\"')
    return key if bare else f'"{escaped}"'


class Writer:
    def __init__(self):
        self.text = ""
        self.lines = {(): 1}

    def mark(self, path):
        self.lines[path] = self.text.count("\n") + 1

    def value(self, path, value):
        if isinstance(value, str):
            self.text += value
        elif isinstance(value, list):
            self.text += "["
            for index, (gap, inner) in enumerate(value):
                self.text += gap
                self.mark((*path, index))
                self.value((*path, index), inner)
                self.text += gap + ","
            self.text += "]"
        else:
            self.text += "{"
            for index, (key, inner) in enumerate(value.items()):
                self.text += ", " if index else " "
                self.pair(path, key, inner)
            self.text += "}"

    def pair(self, path, key, value):
        self.mark((*path, key))
        self.text += quoted(key) + " = "
        self.value((*path, key), value)

    def body(self, path, table):
        for key, value in table.items():
            self.pair(path, key, value)
            self.text += "  # x = 1\n"


@settings(derandomize=True, deadline=None)
@given(
    root=TABLES,
    tables=st.dictionaries(
        KEYS, st.one_of(TABLES, st.lists(TABLES, min_size=1, max_size=3)), max_size=3
    ),
)
def test_knows_the_line_of_everything_in_any_document(root, tables):
    writer = Writer()
    writer.body((), {key: value for key, value in root.items() if key not in tables})
    for key, content in tables.items():
        if isinstance(content, dict):
            writer.mark((key,))
            writer.text += f"[ {quoted(key)} ]\n"
            writer.body((key,), content)
            continue
        for index, table in enumerate(content):
            if not index:
                writer.mark((key,))
            writer.mark((key, index))
            writer.text += f"[[{quoted(key)}]]  # [x]\n"
            writer.body((key, index), table)
    tomllib.loads(writer.text)
    assert locate(writer.text) == writer.lines
