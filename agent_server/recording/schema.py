"""JSON Schemas of the records, in a form that viewers with simple parsers take as well.

Viewers of the Foxglove family read a schema's ``properties`` and give up on what they do not
know there: references, alternatives, arrays of arrays. Here references are resolved, and a
property beyond them stands under ``patternProperties``, which they pass over and which means
the same to a validator. They show such a field all the same, as they show all of a message.
"""

from typing import Any, cast

import msgspec

Schema = dict[str, Any]

_SCALARS = ("boolean", "string", "number", "integer")


def json_schema(record: object) -> bytes:
    """The JSON Schema of a record type, or of a union of them, as canonical JSON text."""
    (schema,), definitions = msgspec.json.schema_components([record])
    resolved = cast(Schema, _resolve(schema, definitions))
    if "anyOf" in resolved:
        resolved = _union(resolved["anyOf"])
    return msgspec.json.encode(_simple(resolved), order="sorted")


def _resolve(node: object, definitions: dict[str, Schema]) -> object:
    if isinstance(node, list):
        return [_resolve(item, definitions) for item in node]
    if not isinstance(node, dict):
        return node
    if "$ref" in node:
        return _resolve(definitions[node["$ref"].rpartition("/")[2]], definitions)
    return {key: _resolve(value, definitions) for key, value in node.items()}


def _union(members: list[Schema]) -> Schema:
    """One object with the properties of all members, that must be exactly one of them."""
    properties: Schema = {}
    for member in members:
        for name, schema in member["properties"].items():
            known = properties.setdefault(name, dict(schema))
            if "enum" in known:
                known["enum"] = sorted({*known["enum"], *schema["enum"]})
    return {
        "type": "object",
        "properties": properties,
        "required": [name for name in properties if all(name in m["required"] for m in members)],
        "oneOf": members,
    }


def _simple(schema: Schema) -> Schema:
    """``schema``, an object's, with what simple parsers refuse moved out of ``properties``."""
    plain: Schema = {}
    beyond: Schema = {}
    for name, value in schema.get("properties", {}).items():
        if value.get("type") == "object":
            plain[name] = _simple(value)
        elif value.get("type") == "array" and _item_type(value) == "object":
            plain[name] = {**value, "items": _simple(value["items"])}
        elif value.get("type") == "array" and _item_type(value) not in _SCALARS:
            beyond[f"^{name}$"] = value
        elif "type" in value:
            plain[name] = value
        elif all(isinstance(choice, str) for choice in value.get("enum", [None])):
            plain[name] = {**value, "type": "string"}
        else:
            beyond[f"^{name}$"] = value
    simple = {**schema, "properties": plain}
    if beyond:
        simple["patternProperties"] = beyond
    return simple


def _item_type(array: Schema) -> object:
    """Type of an array's items; None for a tuple, whose items are listed one by one."""
    items = array["items"]
    return items.get("type") if isinstance(items, dict) else None
