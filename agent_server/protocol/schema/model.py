"""The messages as plain data, read from the msgspec types; every generator starts from here."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from inspect import cleandoc
from typing import Any, get_args

import msgspec
from msgspec import inspect as mi

from agent_server.protocol import messages as m
from agent_server.protocol.messages.fields import PACKED, UNIT

RANGE = "x-range"


@dataclass(frozen=True, slots=True)
class Bool:
    """A truth value."""


@dataclass(frozen=True, slots=True)
class Int:
    """An integer; its size stays below 2**53."""

    least: int | None
    most: int | None


@dataclass(frozen=True, slots=True)
class Float:
    """A double, finite.

    Attributes:
        least: Smallest value, or None.
        most: Largest value, or None.
        is_open: Whether ``least`` itself is left out.
        range: The range in words, where a stage behind the decoder checks it; else None.
    """

    least: float | None
    most: float | None
    is_open: bool
    range: str | None


@dataclass(frozen=True, slots=True)
class Str:
    """A text; lengths are in code points."""

    shortest: int | None
    longest: int | None
    pattern: str | None


@dataclass(frozen=True, slots=True)
class Bytes:
    """A string of bytes; ``layout`` says what lies in it."""

    longest: int | None
    layout: str | None


@dataclass(frozen=True, slots=True)
class Choice:
    """One of a few texts."""

    values: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class List:
    """Any number of items of one type."""

    item: "Type"
    longest: int | None


@dataclass(frozen=True, slots=True)
class Tuple:
    """A fixed number of items, each of its type."""

    items: "tuple[Type, ...]"


@dataclass(frozen=True, slots=True)
class Map:
    """Values of one type by name."""

    value: "Type"
    longest: int | None


@dataclass(frozen=True, slots=True)
class Ref:
    """Another record, by its name."""

    name: str


Type = Bool | Int | Float | Str | Bytes | Choice | List | Tuple | Map | Ref


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a record.

    Attributes:
        name: As on the wire.
        type: Its type, null aside.
        is_nullable: Whether it may be null.
        is_required: Whether it must be sent.
        default: What holds when it is left out; None where it is required.
        sentence: What it says, for people.
        unit: Unit of the number, or of the numbers in it; None where there is none.
    """

    name: str
    type: Type
    is_nullable: bool
    is_required: bool
    default: Any
    sentence: str
    unit: str | None


@dataclass(frozen=True, slots=True)
class Record:
    """A message, or a part of one.

    Attributes:
        name: Name of the type in Python.
        tag: Value of ``type`` on the wire; None for a part.
        doc: What it is for, for people.
        fields: In the order in which they are encoded, after ``type``.
        omits_defaults: Whether fields that hold their default are left out when it is encoded.
    """

    name: str
    tag: str | None
    doc: str
    fields: tuple[Field, ...]
    omits_defaults: bool

    @property
    def sentence(self) -> str:
        """The first sentence of its description."""
        return self.doc.split("\n\n")[0].replace("\n", " ")


@dataclass(frozen=True, slots=True)
class Protocol:
    """All records, and which messages go where.

    Attributes:
        records: By name; a record comes after those that it refers to.
        client_json: Names of what a client sends in the JSON coding; the others accordingly.
    """

    records: dict[str, Record]
    client_json: tuple[str, ...]
    client_msgpack: tuple[str, ...]
    server_json: tuple[str, ...]
    server_msgpack: tuple[str, ...]


@cache
def protocol() -> Protocol:
    """Read the messages."""
    records: dict[str, Record] = {}
    unions = (
        get_args(m.ClientMessage),
        get_args(m.PackedClientMessage),
        get_args(m.ServerMessage),
        get_args(m.PackedServerMessage),
    )
    for union in (*unions, (m.Image,)):
        for message in union:
            for record in _records(message):
                records.setdefault(record.name, record)
    return Protocol(records, *(tuple(message.__name__ for message in union) for union in unions))


def _records(struct: type[msgspec.Struct]) -> Iterator[Record]:
    """A record, after those that it refers to."""
    info = mi.type_info(struct)
    assert isinstance(info, mi.StructType)  # noqa: S101 - a struct has the info of one
    for field in info.fields:
        for part in _structs(field.type):
            yield from _records(part)
    yield Record(
        name=struct.__name__,
        tag=None if info.tag is None else str(info.tag),
        doc=cleandoc(struct.__doc__ or ""),
        fields=tuple(map(_field, info.fields)),
        omits_defaults=struct.__struct_config__.omit_defaults,
    )


def _structs(info: mi.Type) -> Iterator[type[msgspec.Struct]]:
    match info:
        case mi.StructType():
            yield info.cls
        case mi.Metadata():
            yield from _structs(info.type)
        case mi.UnionType():
            for option in info.types:
                yield from _structs(option)
        case mi.ListType():
            yield from _structs(info.item_type)
        case mi.DictType():
            yield from _structs(info.value_type)


def _field(field: mi.Field) -> Field:
    is_nullable = any(isinstance(one, mi.NoneType) for one in _options(field.type))
    told = list(_told(field.type))
    default: Any = None
    if not field.required:
        is_made = field.default_factory is not msgspec.NODEFAULT
        default = field.default_factory() if is_made else field.default
    return Field(
        name=field.encode_name,
        type=_type(field.type),
        is_nullable=is_nullable,
        is_required=field.required,
        default=default,
        sentence=next((extra["description"] for extra in told if "description" in extra), ""),
        unit=next((extra[UNIT] for extra in told if UNIT in extra), None),
    )


def _options(info: mi.Type) -> tuple[mi.Type, ...]:
    if isinstance(info, mi.Metadata):
        return _options(info.type)
    return info.types if isinstance(info, mi.UnionType) else (info,)


def _told(info: mi.Type) -> Iterator[dict[str, Any]]:
    """What was said about a type and the types in it, from the outside in."""
    match info:
        case mi.Metadata():
            yield info.extra_json_schema or {}
            yield from _told(info.type)
        case mi.UnionType():
            for option in info.types:
                yield from _told(option)
        case mi.ListType():
            yield from _told(info.item_type)
        case mi.TupleType():
            for item in info.item_types:
                yield from _told(item)
        case mi.DictType():
            yield from _told(info.value_type)


def _type(info: mi.Type, extra: dict[str, Any] | None = None) -> Type:
    extra = extra or {}
    match info:
        case mi.Metadata():
            return _type(info.type, {**(info.extra_json_schema or {}), **extra})
        case mi.UnionType():
            (inner,) = (one for one in info.types if not isinstance(one, mi.NoneType))
            return _type(inner)
        case mi.BoolType():
            return Bool()
        case mi.IntType():
            return Int(info.ge, info.le)
        case mi.FloatType():
            least = info.ge if info.gt is None else info.gt
            return Float(least, info.le, info.gt is not None, extra.get(RANGE))
        case mi.StrType():
            return Str(info.min_length, info.max_length, info.pattern)
        case mi.BytesType():
            return Bytes(info.max_length, extra.get(PACKED))
        case mi.LiteralType():
            return Choice(tuple(map(str, info.values)))
        case mi.ListType():
            return List(_type(info.item_type), info.max_length)
        case mi.TupleType():
            return Tuple(tuple(map(_type, info.item_types)))
        case mi.DictType():
            return Map(_type(info.value_type), info.max_length)
        case mi.StructType():
            return Ref(info.cls.__name__)
    raise TypeError(f"no message has a field of {info}")
