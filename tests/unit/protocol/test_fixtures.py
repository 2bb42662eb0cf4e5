"""The fixture set in Python: the same messages go through C# and JavaScript elsewhere."""

import importlib.util
import json
from pathlib import Path

import msgspec
import pytest

from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.schema.model import protocol

FOLDER = Path(__file__).parents[2] / "fixtures" / "protocol"
ENTRIES = json.loads((FOLDER / "messages.json").read_text("utf-8"))
JSON, MSGPACK = CODECS[m.SUBPROTOCOL_JSON], CODECS[m.SUBPROTOCOL_MSGPACK]


def named(entries):
    return [pytest.param(entry, id=entry["name"]) for entry in entries]


def decode(codec, entry, data):
    return (codec.decode_client if entry["direction"] == "client" else codec.decode_server)(data)


def forms(entry):
    """Every coding that the entry has: codec, what comes in, what goes out."""
    if entry["json"] is not None:
        yield JSON, entry["json"], entry["json_again"]
    if entry["json_binary_hex"] is not None:
        binary = bytes.fromhex(entry["json_binary_hex"])
        yield JSON, binary, binary
    if entry["msgpack_hex"] is not None:
        again = entry["msgpack_hex_again"]
        yield MSGPACK, bytes.fromhex(entry["msgpack_hex"]), again and bytes.fromhex(again)


def test_the_file_is_what_its_script_makes():
    spec = importlib.util.spec_from_file_location("make_fixtures", FOLDER / "make.py")
    make = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make)
    assert (FOLDER / "messages.json").read_text("utf-8") == make.text()


def test_it_holds_every_message_and_enough_of_them():
    records = {entry["record"] for entry in ENTRIES}
    assert {name for name, one in protocol().records.items() if one.tag} <= records
    assert len(ENTRIES) >= 60
    assert len({entry["name"] for entry in ENTRIES}) == len(ENTRIES)


@pytest.mark.parametrize("entry", named(e for e in ENTRIES if e["outcome"] == "ok"))
def test_good_messages_are_read_and_written_alike(entry):
    seen = 0
    for codec, data, again in forms(entry):
        message = decode(codec, entry, data)
        assert type(message).__name__ == entry["record"]
        written = codec.encode(message)
        if codec is JSON and isinstance(written, str):
            assert json.loads(written) == json.loads(again)
        else:
            assert written == again
        seen += 1
    assert seen


@pytest.mark.parametrize("entry", named(e for e in ENTRIES if e["outcome"] != "ok"))
def test_others_are_refused(entry):
    for codec, data, _ in forms(entry):
        with pytest.raises(InvalidInput) as refused:
            decode(codec, entry, data)
        assert (refused.value.code == "unknown_type") == (entry["outcome"] == "unknown")


def test_every_field_has_a_sentence_and_every_number_a_unit_and_a_range():
    from agent_server.protocol.schema import model  # noqa: PLC0415

    def numbers(kind):
        match kind:
            case model.Int() | model.Float():
                yield kind
            case model.List(item=item):
                yield from numbers(item)
            case model.Map(value=value):
                yield from numbers(value)
            case model.Tuple(items=items):
                for item in items:
                    yield from numbers(item)

    for record in protocol().records.values():
        assert record.sentence
        for field in record.fields:
            assert field.sentence.endswith((".", "...")), (record.name, field.name)
            for number in numbers(field.type):
                assert field.unit, (record.name, field.name)
                is_bounded = None not in (number.least, number.most)
                assert is_bounded or number.range, (record.name, field.name)


def test_a_message_is_a_struct_with_a_tag():
    assert issubclass(m.Hello, msgspec.Struct)
    assert {one.tag for one in protocol().records.values() if one.name == "Hello"} == {"hello"}
