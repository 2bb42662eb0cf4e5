"""The messages as TypeScript: types, layouts for the codecs, and the tables of codes.

A layout is a record as plain data. The codecs in ``agent_server/web/src/protocol`` are written by
hand and follow it; ``kinds.ts`` beside them says how it is spelled.
"""

from collections.abc import Iterable, Iterator
from typing import get_args

from agent_server.domain.stamp import MAX_STAMP_NS
from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES, Retry
from agent_server.protocol.messages import fields
from agent_server.protocol.messages.fields import ONE
from agent_server.protocol.schema import model
from agent_server.protocol.schema.typescript_text import (
    choice,
    comment,
    literal,
    number,
    text,
    union,
)

FOLDER = "agent_server/web/src/protocol"
HEAD = "// Generated from agent_server/protocol; change it there.\n"

CHOICES = {
    "Role": (get_args(fields.Role), "What a connection is for."),
    "FaceKind": (get_args(fields.FaceKind), "What a sensor tells of the person's face."),
    "FaceFormat": (get_args(fields.FaceFormat), "Order of the points of a face."),
    "Topic": (get_args(fields.Topic), "A kind of telemetry."),
    "AckStatus": (get_args(fields.AckStatus), "A renderer's word on a command."),
    "CommandEnd": (get_args(fields.CommandEnd), "How a command ended, for the server."),
    "Authority": (get_args(fields.Authority), "Whose word holds."),
    "Motion": (get_args(fields.Motion), "How the agent moves."),
}
"""What each choice between texts is called: its texts in order, and what it is for."""
_CHOICE_NAMES = {frozenset(values): name for name, (values, _) in CHOICES.items()}
_TUPLE_NAMES = {3: "Point", 4: "JointSample"}


def typescript() -> dict[str, str]:
    """The text of every generated file, by its path in the repository."""
    protocol = model.protocol()
    files = {
        "messages.ts": _messages(protocol),
        "layout.ts": _layout(protocol),
        "codes.ts": _codes(),
    }
    return {f"{FOLDER}/{name}": content for name, content in files.items()}


# Types


def _messages(protocol: model.Protocol) -> str:
    lines = [
        HEAD,
        *comment(
            "The messages of the protocol as types. Time stamps are integer nanoseconds. What a "
            "client sends may leave out fields that have a default; what a server sent has every "
            "field, since the codecs fill in what was left out."
        ),
        "",
    ]
    for name, (values, doc) in CHOICES.items():
        lines += [*comment(doc), *union(name, map(text, values)), ""]
    lines += [
        *comment("x, y, z."),
        "export type Point = readonly [number, number, number];",
        "",
        *comment("x, y, z and the confidence."),
        "export type JointSample = readonly [number, number, number, number];",
        "",
    ]
    sent = _reached(protocol, (*protocol.client_json, *protocol.client_msgpack))
    for record in protocol.records.values():
        lines += [*_interface(record, is_sent=record.name in sent), ""]
    for name, members, doc in (
        ("ClientMessage", protocol.client_json, "What a client sends in the JSON coding."),
        ("PackedClientMessage", protocol.client_msgpack, "What it sends in MessagePack."),
        ("ServerMessage", protocol.server_json, "What a server sends in the JSON coding."),
        ("PackedServerMessage", protocol.server_msgpack, "What it sends in MessagePack."),
    ):
        lines += [*comment(doc), *union(name, members), ""]
    return "\n".join(lines)


def _interface(record: model.Record, *, is_sent: bool) -> Iterator[str]:
    yield from comment(record.doc)
    yield f"export interface {record.name} {{"
    if record.tag is not None:
        yield f"  readonly type: {text(record.tag)};"
    for field in record.fields:
        yield from comment(_described(field), indent="  ")
        mark = "?" if is_sent and not field.is_required else ""
        null = " | null" if field.is_nullable else ""
        yield f"  readonly {field.name}{mark}: {_type(field.type)}{null};"
    yield "}"


def _reached(protocol: model.Protocol, names: Iterable[str]) -> set[str]:
    """The records, and those that they refer to."""
    reached = set(names)
    for record in reversed(protocol.records.values()):
        if record.name in reached:
            reached.update(name for field in record.fields for name in _references(field.type))
    return reached


def _references(kind: model.Type) -> Iterator[str]:
    match kind:
        case model.Ref(name):
            yield name
        case model.List(item):
            yield from _references(item)
        case model.Map(value):
            yield from _references(value)


def _type(kind: model.Type) -> str:
    match kind:
        case model.Bool():
            return "boolean"
        case model.Int() | model.Float():
            return "number"
        case model.Str():
            return "string"
        case model.Bytes():
            return "Uint8Array"
        case model.Choice(values):
            return _CHOICE_NAMES[frozenset(values)]
        case model.List(item):
            inner = _type(item)
            return f"readonly ({inner})[]" if " " in inner else f"readonly {inner}[]"
        case model.Tuple(items):
            return _TUPLE_NAMES[len(items)]
        case model.Map(value):
            return f"Readonly<Record<string, {_type(value)}>>"
        case model.Ref(name):
            return name


def _described(field: model.Field) -> str:
    """Sentence, unit, range and default of a field."""
    unit = [] if field.unit in (None, ONE) else [str(field.unit)]
    words = field.sentence
    if facts := ", ".join([*unit, *_facts(field.type)]):
        words += f" ({facts})"
    if field.default not in (None, []):
        words += f" Default: `{literal(field.default)}`."
    return words


def _facts(kind: model.Type) -> list[str]:
    """What is to be known of a value beside its unit."""
    match kind:
        case model.Int(least, most):
            return _range(least, most, "at least")
        case model.Float(least, most, is_open, said):
            return [said] if said else _range(least, most, "above" if is_open else "at least")
        case model.Str(shortest, longest):
            return _size(shortest, longest, "characters")
        case model.Bytes(longest, layout):
            return [*([layout] if layout else []), *_size(None, longest, "bytes")]
        case model.List(item, longest):
            return [*_facts(item), *_size(None, longest, "items")]
        case model.Map(value, longest):
            return [*_facts(value), *_size(None, longest, "entries")]
        case model.Tuple(items):
            ranges = dict.fromkeys(fact for item in items for fact in _facts(item))
            return [", then ".join(ranges)] if ranges else []
        case model.Bool() | model.Choice() | model.Ref():
            return []


def _range(least: float | None, most: float | None, above: str) -> list[str]:
    if least is None and most is None:
        return []
    if most is None:
        return [f"{above} {number(least)}"]
    end = "2^53 - 1" if most == MAX_STAMP_NS else number(most)
    return [
        f"above {number(least)}, at most {end}" if above == "above" else f"{number(least)}..{end}"
    ]


def _size(shortest: int | None, longest: int | None, of: str) -> list[str]:
    if longest is None:
        return []
    return [f"{shortest}..{longest} {of}" if shortest else f"at most {longest} {of}"]


# Layouts


def _layout(protocol: model.Protocol) -> str:
    lines = [
        HEAD,
        *comment("Every record of the protocol as plain data, which the codecs follow."),
        "",
        'import type { RecordLayout } from "./kinds.ts";',
        "",
        f"export const PROTOCOL = {text(m.PROTOCOL)};",
        f"export const PROTOCOL_MAJOR = {m.PROTOCOL_MAJOR};",
        f"export const SUBPROTOCOL_JSON = {text(m.SUBPROTOCOL_JSON)};",
        f"export const SUBPROTOCOL_MSGPACK = {text(m.SUBPROTOCOL_MSGPACK)};",
        "",
    ]
    for record in protocol.records.values():
        lines += [
            f"const {record.name}: RecordLayout = {{",
            f"  name: {text(record.name)},",
            f"  tag: {literal(record.tag)},",
            f"  omitsDefaults: {literal(record.omits_defaults)},",
            "  fields: [",
            *(f"    {{ {', '.join(_properties(field))} }}," for field in record.fields),
            "  ],",
            "};",
            "",
        ]
    for name, members, doc in (
        ("CLIENT_JSON", protocol.client_json, "What a client sends as JSON text."),
        ("CLIENT_MSGPACK", protocol.client_msgpack, "What a client sends in MessagePack."),
        ("SERVER_JSON", protocol.server_json, "What a server sends in the JSON coding."),
        ("SERVER_MSGPACK", protocol.server_msgpack, "What a server sends in MessagePack."),
    ):
        lines += [*comment(doc), f"export const {name}: readonly RecordLayout[] = ["]
        lines += [*(f"  {member}," for member in members), "];", ""]
    return "\n".join(lines)


def _properties(field: model.Field) -> Iterator[str]:
    yield f"name: {text(field.name)}"
    yield f"kind: {_kind(field.type)}"
    if field.is_nullable:
        yield "isNullable: true"
    if not field.is_required:
        yield f"default: {literal(field.default)}"


def _kind(kind: model.Type) -> str:
    match kind:
        case model.Bool():
            return '["bool"]'
        case model.Int(least, most):
            return f'["int", {number(least)}, {number(most)}]'
        case model.Float(least, most, is_open):
            above = ", true" if is_open else ""
            return f'["float", {number(least)}, {number(most)}{above}]'
        case model.Str(shortest, longest, pattern):
            shape = f", {text(pattern)}" if pattern else ""
            return f'["str", {shortest or 0}, {number(longest)}{shape}]'
        case model.Bytes(longest):
            return f'["bytes", {number(longest)}]'
        case model.Choice(values):
            return f'["choice", [{", ".join(map(text, values))}]]'
        case model.List(item, longest):
            return f'["list", {_kind(item)}, {number(longest)}]'
        case model.Tuple(items):
            return f'["tuple", [{", ".join(map(_kind, items))}]]'
        case model.Map(value, longest):
            return f'["map", {_kind(value)}, {number(longest)}]'
        case model.Ref(name):
            return f'["record", {name}]'


# Codes


def _codes() -> str:
    lines = [
        HEAD,
        *comment("Close codes and error codes, with what they mean and what to do about them."),
        "",
        *comment(
            "When a client whose connection was closed connects again by itself: after a random "
            "time below a bound that doubles, after 15 seconds, or not at all."
        ),
        f"export type Retry = {choice(Retry)};",
        "",
        "export interface CloseCode {",
        "  readonly name: string;",
        "  readonly meaning: string;",
        "  readonly advice: string;",
        "  readonly retry: Retry;",
        "}",
        "",
        "export interface ErrorCode {",
        "  readonly meaning: string;",
        "  readonly advice: string;",
        "}",
        "",
    ]
    lines += [f"export const CLOSE_{close.name.upper()} = {close.code};" for close in CLOSE_CODES]
    lines += ["", *comment("Every close code of the server. Any other end means `soon`.")]
    lines += ["export const CLOSE_CODES: Readonly<Record<number, CloseCode>> = {"]
    for close in CLOSE_CODES:
        lines += [
            f"  {close.code}: {{",
            *_members(
                name=close.name, meaning=close.meaning, advice=close.advice, retry=close.retry.value
            ),
            "  },",
        ]
    lines += ["};", "", *comment("Every code of an `error` message.")]
    lines += ["export const ERROR_CODES: Readonly<Record<string, ErrorCode>> = {"]
    for error in ERROR_CODES:
        lines += [
            f"  {error.code}: {{",
            *_members(meaning=error.meaning, advice=error.advice),
            "  },",
        ]
    return "\n".join([*lines, "};", ""])


def _members(**members: str) -> Iterator[str]:
    for name, value in members.items():
        yield f"    {name}: {text(value)},"
