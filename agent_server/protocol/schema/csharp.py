"""The messages as C#: types, readers and writers for the Unity client, without reflection.

Each record becomes a sealed, immutable class that reads itself from a ``WireReader`` and writes
itself to a ``WireWriter``; these two are written by hand and know the codings.
"""

from typing import get_args

from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES, Retry
from agent_server.protocol.messages import fields
from agent_server.protocol.schema import model
from agent_server.protocol.schema.csharp_text import (
    class_file,
    documented,
    enum_file,
    literal,
    parameter,
    pascal,
    text,
)

CHOICES = (
    ("Role", get_args(fields.Role), "What a connection is for."),
    ("FaceKind", get_args(fields.FaceKind), "What a sensor tells of the person's face."),
    ("FaceFormat", get_args(fields.FaceFormat), "Order of the points of a face."),
    ("Topic", get_args(fields.Topic), "A kind of telemetry."),
    ("AckStatus", get_args(fields.AckStatus), "What became of a command."),
    ("Authority", get_args(fields.Authority), "Whose word holds."),
    ("Motion", get_args(fields.Motion), "How the agent moves."),
)
"""What each choice between texts is called, its texts in order, and what it is for."""
CHOICE_NAMES = {frozenset(values): name for name, values, _ in CHOICES}

INNER = {"reader": "item", "writer": "item", "item": "inner"}
"""Name of a reader or writer inside another one."""

MAX_INT = 2**31 - 1
JOINT_NUMBERS = 4


def csharp() -> dict[str, str]:
    """The text of every generated file, by its path below ``unity_bridge/Runtime/Core``."""
    protocol = model.protocol()
    files = {f"{record.name}.cs": _record(record) for record in protocol.records.values()}
    for name, values, doc in CHOICES:
        files[f"{name}.cs"] = enum_file(name, doc, values)
    files["Dispatch.cs"] = _dispatch(protocol)
    files["ProtocolVersion.cs"] = _version()
    files["CloseCodes.cs"] = _close_codes()
    files["ErrorCodes.cs"] = _error_codes()
    return {f"Generated/{name}": content for name, content in sorted(files.items())}


# Types


def _type(kind: model.Type) -> str:
    """The type in C#, null aside."""
    match kind:
        case model.Bool():
            return "bool"
        case model.Int(most=most):
            return "int" if most is not None and most <= MAX_INT else "long"
        case model.Float():
            return "double"
        case model.Str():
            return "string"
        case model.Bytes():
            return "byte[]"
        case model.Choice(values):
            return CHOICE_NAMES[frozenset(values)]
        case model.List(item):
            return f"IReadOnlyList<{_type(item)}>"
        case model.Tuple(items):
            return "JointSample" if len(items) == JOINT_NUMBERS else "Point3"
        case model.Map(value):
            return f"IReadOnlyDictionary<string, {_type(value)}>"
        case model.Ref(name):
            return name


def _is_value(kind: model.Type) -> bool:
    """Whether C# needs ``T?`` for one that may be null."""
    return isinstance(kind, model.Bool | model.Int | model.Float | model.Choice | model.Tuple)


def _declared(field: model.Field) -> str:
    name = _type(field.type)
    return f"{name}?" if field.is_nullable and _is_value(field.type) else name


# Reading and writing


def _read(kind: model.Type, reader: str = "reader") -> str:
    """An expression that reads one value."""
    match kind:
        case model.Bool():
            return f"{reader}.Bool()"
        case model.Int(least, most):
            cast = "(int)" if _type(kind) == "int" else ""
            return f"{cast}{reader}.Int({least}, {most})"
        case model.Float(is_open=True):
            return f"{reader}.FloatAbove({_bounds(kind)})"
        case model.Float():
            return f"{reader}.Float({_bounds(kind)})"
        case model.Str(pattern=str(pattern)):
            return f"{reader}.Pattern({text(pattern)})"
        case model.Str(shortest, longest):
            return f"{reader}.Str({_lengths(shortest, longest)})"
        case model.Bytes(longest):
            return f"{reader}.Bytes({_length(longest)})"
        case model.Choice():
            return f"{_type(kind)}Text.Read({reader})"
        case model.List(item, longest):
            return f"{reader}.List({_length(longest)}, {_reads(item, reader)})"
        case model.Tuple(items):
            return f"{_type(kind)}.Read({reader}{_tuple_bounds(items)})"
        case model.Map(value, longest):
            return f"{reader}.Map({_length(longest)}, {_reads(value, reader)})"
        case model.Ref(name):
            return f"{name}.Read({reader})"


def _reads(kind: model.Type, outer: str) -> str:
    """A function that reads one item; C# wants another name for each nested parameter."""
    reader = INNER[outer]
    return f"{reader} => {_read(kind, reader)}"


def _bounds(kind: model.Float) -> str:
    if kind.least is None or kind.most is None:
        return ""
    return f"{literal(float(kind.least))}, {literal(float(kind.most))}"


def _tuple_bounds(items: tuple[model.Type, ...]) -> str:
    """Bounds of the coordinates; those of a confidence are the same everywhere."""
    first = items[0]
    limit = first.most if isinstance(first, model.Float) else None
    return "" if limit is None else f", {literal(float(limit))}"


def _length(longest: int | None) -> str:
    return "int.MaxValue" if longest is None else str(longest)


def _lengths(shortest: int | None, longest: int | None) -> str:
    return f"{shortest or 0}, {_length(longest)}"


def _write(kind: model.Type, value: str, writer: str = "writer") -> str:
    """A statement, without its semicolon, that writes one value."""
    match kind:
        case model.Bool():
            return f"{writer}.Bool({value})"
        case model.Int():
            return f"{writer}.Int({value})"
        case model.Float():
            return f"{writer}.Float({value})"
        case model.Str():
            return f"{writer}.Str({value})"
        case model.Bytes():
            return f"{writer}.Bytes({value})"
        case model.Choice():
            return f"{writer}.Str({value}.Text())"
        case model.List(item):
            return f"{writer}.List({value}, {_writes(item, writer)})"
        case model.Map(item):
            return f"{writer}.Map({value}, {_writes(item, writer)})"
        case model.Tuple() | model.Ref():
            return f"{value}.Write({writer})"


def _writes(kind: model.Type, outer: str) -> str:
    """A function that writes one item."""
    writer = INNER[outer]
    value = f"{writer}Value"
    return f"({writer}, {value}) => {_write(kind, value, writer)}"


# Records


def _record(record: model.Record) -> str:
    lines: list[str] = []
    for part in (_constructor, _properties, _reader, _writer):
        lines += [*part(record), ""]
    base = "" if record.tag is None else " : Message"
    return class_file(f"public sealed class {record.name}{base}", record.doc, lines[:-1])


def _constructor(record: model.Record) -> list[str]:
    lines = ["/// <summary>Makes one of its fields.</summary>", f"public {record.name}("]
    lines += [
        f"    {_declared(field)} {parameter(field.name)}{_default(field)}{end}"
        for field, end in zip(record.fields, _ends(len(record.fields), ")"), strict=True)
    ]
    lines += ["{"]
    for field in record.fields:
        name, value = pascal(field.name), parameter(field.name)
        is_reference = not _is_value(field.type) and not field.is_nullable
        if is_reference and field.is_required:
            value = f"{value} ?? throw new ArgumentNullException(nameof({value}))"
        elif isinstance(field.type, model.List) and not field.is_nullable:
            value = f"{value} ?? Array.Empty<{_type(field.type.item)}>()"
        elif is_reference:
            value = f"{value} ?? {_default_value(field)}"
        lines.append(f"    {name} = {value};")
    return [*lines, "}"]


def _ends(count: int, last: str) -> list[str]:
    return [","] * (count - 1) + [last]


def _default(field: model.Field) -> str:
    if field.is_required:
        return ""
    value = "null" if isinstance(field.type, model.List) else _default_value(field)
    return f" = {value}"


def _default_value(field: model.Field) -> str:
    """What holds when the field is left out, in C#."""
    if field.default is None:
        return "null"
    if isinstance(field.type, model.Choice):
        return f"{_type(field.type)}.{pascal(field.default)}"
    return literal(field.default)


def _properties(record: model.Record) -> list[str]:
    lines: list[str] = []
    if record.tag is not None:
        lines += ["/// <inheritdoc/>", f"public override string Type => {text(record.tag)};", ""]
    for field in record.fields:
        lines += documented(_told(field))
        lines += [f"public {_declared(field)} {pascal(field.name)} {{ get; }}", ""]
    return lines[:-1]


def _told(field: model.Field) -> str:
    """Sentence, unit, range and null of a field, for people."""
    words = [field.sentence]
    if field.unit is not None and field.unit != fields.ONE:
        words.append(f"Unit: {field.unit}.")
    if span := _range(field.type):
        words.append(f"Range: {span}.")
    if field.is_nullable:
        words.append("May be null.")
    return " ".join(words)


def _range(kind: model.Type) -> str:
    match kind:
        case model.Int(int(least), int(most)):
            return f"{least} to {most}"
        case model.Float(range=str(words)):
            return words
        case model.Float(least=float() | int() as least, most=most, is_open=is_open):
            return f"{'above ' if is_open else ''}{least:g} to {most:g}"
        case model.Str(shortest, int(longest)):
            return f"{shortest or 0} to {longest} characters"
        case model.Bytes(layout=str(layout)):
            return layout
        case model.List(longest=int(longest)) | model.Map(longest=int(longest)):
            return f"at most {longest}"
    return ""


def _reader(record: model.Record) -> list[str]:
    required = [field.name for field in record.fields if field.is_required]
    lines = []
    if required:
        names = ", ".join(map(text, required))
        lines += [f"static readonly string[] Required = {{ {names} }};", ""]
    lines += [f"internal static {record.name} Read(WireReader reader)", "{"]
    for field in record.fields:
        initial = f" = default({_declared(field)})" if field.is_required else _default(field)
        lines.append(f"    {_declared(field)} {_local(field)}{initial};")
    if required:
        lines.append("    uint seen = 0;")
    lines += [
        "    string key;",
        "    reader.BeginMap();",
        "    while ((key = reader.NextKey()) != null)",
    ]
    lines += ["    {", "        switch (key)", "        {"]
    for field in record.fields:
        value = _read(field.type)
        if field.is_nullable:
            value = f"reader.Null() ? {_null(field)} : {value}"
        lines += [f"            case {text(field.name)}:"]
        lines += [f"                {_local(field)} = {value};"]
        if field.is_required:
            lines += [f"                seen |= {hex(1 << required.index(field.name))};"]
        lines += ["                break;"]
    lines += ["            default:", "                reader.Skip();", "                break;"]
    lines += ["        }", "    }"]
    if required:
        lines += ["    reader.Require(seen, Required);"]
    arguments = ", ".join(map(_local, record.fields))
    return [*lines, f"    return new {record.name}({arguments});", "}"]


def _local(field: model.Field) -> str:
    """A local variable that cannot collide with the reader's own."""
    name = parameter(field.name).lstrip("@")
    return f"{name}Value"


def _null(field: model.Field) -> str:
    return f"({_declared(field)})null" if _is_value(field.type) else "null"


def _writer(record: model.Record) -> list[str]:
    scope = "internal override void" if record.tag is not None else "internal void"
    omitted = [field for field in record.fields if record.omits_defaults and not field.is_required]
    most = len(record.fields) + (record.tag is not None)
    lines = [f"{scope} Write(WireWriter writer)", "{"]
    if omitted:
        lines += [f"    int count = {most - len(omitted)};"]
        lines += [f"    if ({_is_told(field)}) count++;" for field in omitted]
        lines += [f"    writer.BeginMap(count, {most});"]
    else:
        lines += [f"    writer.BeginMap({most});"]
    if record.tag is not None:
        lines += ['    writer.Key("type");', f"    writer.Str({text(record.tag)});"]
    for field in record.fields:
        lines += _write_field(field, is_omitted=field in omitted)
    return [*lines, "    writer.EndMap();", "}"]


def _is_told(field: model.Field) -> str:
    """Whether a field differs from its default, in C#."""
    name = pascal(field.name)
    if isinstance(field.type, model.List) and not field.is_nullable:
        return f"{name}.Count != 0"
    if field.default is False:
        return name
    return f"{name} != {_default_value(field)}"


def _write_field(field: model.Field, is_omitted: bool) -> list[str]:
    name = pascal(field.name)
    value = f"{name}.Value" if field.is_nullable and _is_value(field.type) else name
    key, write = f"writer.Key({text(field.name)});", f"{_write(field.type, value)};"
    if is_omitted:
        return [
            f"    if ({_is_told(field)})",
            "    {",
            f"        {key}",
            f"        {write}",
            "    }",
        ]
    if field.is_nullable:
        return [f"    {key}", f"    if ({name} == null) writer.Null();", f"    else {write}"]
    return [f"    {key}", f"    {write}"]


# Tables


def _dispatch(protocol: model.Protocol) -> str:
    lines: list[str] = []
    for name, records in (
        ("ClientJson", protocol.client_json),
        ("ClientMsgpack", protocol.client_msgpack),
        ("ServerJson", protocol.server_json),
        ("ServerMsgpack", protocol.server_msgpack),
    ):
        lines += [f"internal static Message {name}(string type, WireReader reader)", "{"]
        lines += ["    switch (type)", "    {"]
        for record in records:
            tag = text(protocol.records[record].tag or "")
            lines += [f"        case {tag}: return {record}.Read(reader);"]
        lines += ["        default: return null;", "    }", "}", ""]
    doc = "Reads the message of a type; null for a type that this version does not know."
    return class_file("static class Dispatch", doc, lines[:-1])


def _version() -> str:
    constants = (
        ("Protocol", "Version that this client speaks, as MAJOR.MINOR.", m.PROTOCOL),
        ("JsonSubprotocol", "Websocket subprotocol of the JSON coding.", m.SUBPROTOCOL_JSON),
        ("MsgpackSubprotocol", "Of the MessagePack coding.", m.SUBPROTOCOL_MSGPACK),
    )
    lines: list[str] = []
    for name, doc, value in constants:
        lines += [*documented(doc), f"public const string {name} = {text(value)};", ""]
    return class_file("public static class ProtocolVersion", "What is spoken.", lines[:-1])


def _close_codes() -> str:
    lines: list[str] = []
    for code in CLOSE_CODES:
        lines += [*documented(f"{_capital(code.meaning)}."), _constant("int", code.name, code.code)]
    rows = [
        f"new CloseCode({pascal(code.name)}, {text(code.name)}, {text(code.meaning)}, "
        f"{text(code.advice)}, Retry.{pascal(code.retry)})"
        for code in CLOSE_CODES
    ]
    lines += ["", *_table("CloseCode", "Every close code of the server.", rows), ""]
    lines += documented("The entry of a code; null for one that the server does not send.")
    lines += _find("CloseCode Find(int code)", "code")
    lines += ["", *documented("When to connect again after a close with this code.")]
    lines += ["public static Retry RetryAfter(int code)", "{"]
    lines += ["    CloseCode entry = Find(code);"]
    lines += [f"    return entry == null ? Retry.{pascal(Retry.SOON)} : entry.Retry;", "}"]
    doc = "Why a server closes a connection, and what a client does about it."
    return class_file("public static class CloseCodes", doc, lines)


def _error_codes() -> str:
    lines: list[str] = []
    for code in ERROR_CODES:
        value = text(code.code)
        lines += [*documented(f"{_capital(code.meaning)}."), _constant("string", code.code, value)]
    rows = [
        f"new ErrorCode({pascal(code.code)}, {text(code.meaning)}, {text(code.advice)})"
        for code in ERROR_CODES
    ]
    lines += ["", *_table("ErrorCode", "Every code of an error message.", rows), ""]
    lines += documented("The entry of a code; null for one that this version does not know.")
    lines += _find("ErrorCode Find(string code)", "code")
    return class_file("public static class ErrorCodes", "The mistakes that errors name.", lines)


def _constant(kind: str, name: str, value: object) -> str:
    return f"public const {kind} {pascal(name)} = {value};"


def _table(kind: str, doc: str, rows: list[str]) -> list[str]:
    lines = [*documented(doc), f"public static readonly IReadOnlyList<{kind}> All = new[]", "{"]
    return [*lines, *(f"    {row}," for row in rows), "};"]


def _find(signature: str, value: str) -> list[str]:
    kind = signature.split(maxsplit=1)[0]
    return [
        f"public static {signature}",
        "{",
        f"    foreach ({kind} entry in All)",
        f"        if (entry.Code == {value}) return entry;",
        "    return null;",
        "}",
    ]


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
