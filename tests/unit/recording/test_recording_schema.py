"""The schemas in a recording fit its records, and simple viewers can parse them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from agent_server.recording.topics import TOPICS

SCALARS = ("boolean", "string", "number", "integer")


def records_with_schemas(path: Path) -> list[tuple[str, dict[str, Any], Any]]:
    with path.open("rb") as file:
        found = []
        for schema, channel, message in make_reader(file).iter_messages(log_time_order=False):
            assert schema is not None
            assert schema.encoding == "jsonschema"
            assert channel.message_encoding == "json"
            found.append((channel.topic, json.loads(schema.data), json.loads(message.data)))
        return found


def written(write: Callable[..., Path]) -> list[tuple[str, dict[str, Any], Any]]:
    return records_with_schemas(write("a.mcap", with_later=True))


def refused(schema: dict[str, Any], place: str) -> list[str]:
    """What a viewer gives up on that knows objects, scalars, and arrays of these, no more."""
    if schema.get("type") != "object" or "properties" not in schema:
        return [place]
    found = []
    for name, value in schema["properties"].items():
        field = f"{place}.{name}"
        if value.get("type") == "array":
            value, field = value["items"], f"{field}[]"  # noqa: PLW2901 - its items then count
        if value.get("type") == "object":
            found += refused(value, field)
        elif value.get("type") not in SCALARS:
            found.append(field)
    return found


def test_every_topic_has_a_schema_that_simple_viewers_take(write: Callable[[str], Path]) -> None:
    schemas = {topic: schema for topic, schema, _ in written(write)}
    assert schemas.keys() == TOPICS.keys()
    assert [place for topic, schema in schemas.items() for place in refused(schema, topic)] == []


def test_what_simple_viewers_refuse_is_still_described(write: Callable[[str], Path]) -> None:
    schemas = {topic: schema for topic, schema, _ in written(write)}
    joints = schemas["/skeleton"]["patternProperties"]["^joints$"]
    assert joints["items"]["minItems"] == 4
    assert "joints" in schemas["/skeleton"]["required"]
    gate = schemas["/decision"]["properties"]["decision"]["properties"]["gate"]
    assert gate["patternProperties"]["^valence$"]["anyOf"][1] == {"type": "null"}


def test_the_core_log_is_one_object_of_several_kinds(write: Callable[[str], Path]) -> None:
    schemas = {topic: schema for topic, schema, _ in written(write)}
    core = schemas["/core"]
    assert core["required"] == ["kind", "stamp_ns"]
    assert core["properties"]["kind"]["enum"] == [
        "body_lost",
        "models",
        "renderer",
        "restored",
        "sensor",
        "skipped",
        "tick",
        "window",
    ]
    assert len(core["oneOf"]) == len(core["properties"]["kind"]["enum"])


def test_every_record_fits_its_schema(write: Callable[[str], Path]) -> None:
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed")
    for topic, schema, record in written(write):
        validator = jsonschema.Draft202012Validator(schema)
        assert not list(validator.iter_errors(record)), topic
        required = next(iter(schema["required"]))
        broken = {name: value for name, value in record.items() if name != required}
        assert list(validator.iter_errors(broken)), topic
