"""The reference of all messages and codes, as Markdown for the docs and as a page for a browser."""

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from importlib import resources
from string import Template
from typing import get_args

import msgspec

from agent_server.domain.stamp import MAX_STAMP_NS
from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES
from agent_server.protocol.roles import CLIENT_SENDS, SERVER_SENDS
from agent_server.protocol.schema import model

GENERATED = "Generated from agent_server/protocol by `agent-server schema`; change it there."


@dataclass(frozen=True, slots=True)
class Section:
    """One heading with a text and a table, whose first row is its head."""

    level: int
    title: str
    text: str
    rows: tuple[tuple[str, ...], ...] = ()


def sections() -> Iterator[Section]:
    """The reference, in order."""
    records = model.protocol().records
    yield Section(1, f"Messages of protocol {m.PROTOCOL}", GENERATED)
    for title, text, names in _groups():
        yield Section(2, title, text)
        for name in names:
            yield _section(records[name])
    yield Section(2, "Parts", "What messages are made of.")
    for record in records.values():
        if record.tag is None:
            yield _section(record)
    yield Section(
        2,
        "Close codes",
        "`soon`: connect again after a random time below a bound that doubles; `later`: after 15 "
        "s; `never`: not by itself. Any other end means `soon`.",
        (
            ("code", "meaning", "what to do", "again"),
            *((str(c.code), c.meaning, c.advice, c.retry.value) for c in CLOSE_CODES),
        ),
    )
    yield Section(
        2,
        "Error codes",
        "An error costs the message, not the connection, unless it is `fatal`.",
        (
            ("code", "meaning", "what to do"),
            *((f"`{c.code}`", c.meaning, c.advice) for c in ERROR_CODES),
        ),
    )


def markdown() -> str:
    """The reference as Markdown."""
    blocks = []
    for section in sections():
        blocks.append(f"{'#' * section.level} {section.title}")
        if section.text:
            blocks.append(section.text)
        if section.rows:
            head, *rows = section.rows
            lines = [head, ("---",) * len(head), *rows]
            cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
            blocks.append("\n".join(f"| {' | '.join(line)} |" for line in cells))
    return "\n\n".join(blocks) + "\n"


def page() -> str:
    """The reference as a page that asks for nothing else."""
    body = []
    contents = []
    for section in sections():
        level = section.level
        anchor, title = escape(_anchor(section.title)), _marked(section.title)
        body.append(f'<h{level} id="{anchor}">{title}</h{level}>')
        if level > 1:
            contents.append(f'<a class="level{level}" href="#{anchor}">{title}</a>')
        if section.text:
            body.append(f"<p>{_marked(section.text)}</p>")
        if section.rows:
            head, *rows = section.rows
            body.append("<div><table><thead><tr>")
            body += [f"<th>{_marked(cell)}</th>" for cell in head]
            body.append("</tr></thead><tbody>")
            for row in rows:
                body.append("<tr>" + "".join(f"<td>{_marked(cell)}</td>" for cell in row) + "</tr>")
            body.append("</tbody></table></div>")
    template = Template(resources.files(__package__).joinpath("page.html").read_text("utf-8"))
    return template.substitute(
        title=f"agent-server protocol {m.PROTOCOL}",
        contents="\n".join(contents),
        body="\n".join(body),
    )


def _groups() -> Iterator[tuple[str, str, tuple[str, ...]]]:
    yield "Either side", "", ("Ping", "Pong")
    yield "Every client", "The first message of a connection.", ("Hello",)
    for role in get_args(m.Role):
        if names := tuple(one.__name__ for one in CLIENT_SENDS[role]):
            yield f"What a {role} sends", "", names
    yield "The server, to every client", "", ("Welcome", "ErrorMessage")
    told: set[str] = set()
    for role in get_args(m.Role):
        names = tuple(n for one in SERVER_SENDS[role] if (n := one.__name__) not in told)
        told.update(names)
        yield f"The server, to a {role}", "", names


def _section(record: model.Record) -> Section:
    title = f"`{record.name}`" if record.tag is None else f"`{record.tag}` ({record.name})"
    return Section(
        3,
        title,
        record.doc.replace("``", "`").replace("\n\n", " ").replace("\n", " "),
        (
            ("field", "type", "unit", "range", "default", "meaning"),
            *(
                (
                    f"`{field.name}`",
                    type_words(field.type) + (" or null" if field.is_nullable else ""),
                    "" if field.unit in (None, "1") else str(field.unit),
                    range_words(field.type),
                    "" if field.is_required else f"`{_default(field.default)}`",
                    field.sentence,
                )
                for field in record.fields
            ),
        ),
    )


def type_words(kind: model.Type) -> str:
    """A type in words."""
    match kind:
        case model.Bool():
            return "true or false"
        case model.Int():
            return "integer"
        case model.Float():
            return "number"
        case model.Str():
            return "text"
        case model.Bytes(layout=layout):
            return f"bytes: {layout}" if layout else "bytes"
        case model.Choice(values=values):
            return ", ".join(f"`{value}`" for value in values)
        case model.List(item=item):
            return f"list of {type_words(item)}"
        case model.Tuple(items=items):
            return f"[{', '.join(map(type_words, items))}]"
        case model.Map(value=value):
            return f"map of {type_words(value)}"
        case model.Ref(name=name):
            return f"`{name}`"


def range_words(kind: model.Type) -> str:
    """The range of a type in words; empty where there is none."""
    match kind:
        case model.Int(least=least, most=most):
            return f"{_number(least)}..{_number(most)}"
        case model.Float(range=str(words)):
            return words
        case model.Float(least=least, most=most, is_open=is_open):
            return f"{'over ' if is_open else ''}{_number(least)}..{_number(most)}"
        case model.Str(shortest=shortest, longest=int(longest)):
            return f"{shortest or 0}..{longest} letters"
        case model.Str(pattern=str(pattern)):
            return f"`{pattern}`"
        case model.Bytes(longest=int(longest)):
            return f"up to {longest} bytes"
        case model.List(item=item, longest=longest):
            many = f"up to {longest} of " if longest else ""
            return (many + range_words(item)).removesuffix(" of ")
        case model.Map(value=value, longest=longest):
            many = f"up to {longest} of " if longest else ""
            return (many + range_words(value)).removesuffix(" of ")
        case model.Tuple(items=items):
            return ", ".join(dict.fromkeys(map(range_words, items)))
    return ""


def _number(value: float | None) -> str:
    if value is None:
        return ""
    return "2^53-1" if value == MAX_STAMP_NS else f"{value:g}"


def _default(value: object) -> str:
    return msgspec.json.encode(value).decode()


def _anchor(title: str) -> str:
    """Where a heading is found: the words of its title."""
    return "-".join("".join(c if c.isalnum() else " " for c in title.lower()).split())


def _marked(text: str) -> str:
    """Text with `code` marked, for a page."""
    pieces = escape(text, quote=False).split("`")
    return "".join(f"<code>{one}</code>" if i % 2 else one for i, one in enumerate(pieces))
