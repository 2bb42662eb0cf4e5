"""The messages as TypeScript."""

import json
import re
from dataclasses import replace

import pytest

from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES
from agent_server.protocol.schema import model
from agent_server.protocol.schema.typescript import FOLDER, typescript


@pytest.fixture(scope="module")
def files():
    return {path.removeprefix(f"{FOLDER}/"): text for path, text in typescript().items()}


def interface(files, name):
    """The body of one interface."""
    found = re.search(rf"^export interface {name} {{\n(.*?)^}}", files["messages.ts"], re.S | re.M)
    assert found is not None, name
    return found[1]


def layout(files, name):
    """The layout of one record, with the records that it refers to by their names."""
    found = re.search(
        rf"^const {name}: RecordLayout = ({{\n.*?^}});", files["layout.ts"], re.S | re.M
    )
    assert found is not None, name
    text = re.sub(r'\["record", (\w+)\]', r'["record", "\1"]', found[1])
    text = re.sub(r"\b(name|tag|omitsDefaults|fields|kind|isNullable|default): ", r'"\1": ', text)
    return json.loads(re.sub(r",(\s*[\]}])", r"\1", text))


def test_it_is_the_same_each_time():
    model.protocol.cache_clear()
    first = typescript()
    model.protocol.cache_clear()
    assert typescript() == first
    assert list(first) == [f"{FOLDER}/{name}" for name in ("messages.ts", "layout.ts", "codes.ts")]


def test_every_record_is_there_after_those_that_it_refers_to(files):
    names = list(model.protocol().records)
    assert re.findall(r"^export interface (\w+)", files["messages.ts"], re.M) == names
    assert re.findall(r"^const (\w+): RecordLayout", files["layout.ts"], re.M) == names
    for position, name in enumerate(names):
        for referred in re.findall(r'\["record", "(\w+)"\]', json.dumps(layout(files, name))):
            assert names.index(referred) < position


def test_a_layout_says_what_the_model_says(files):
    for record in model.protocol().records.values():
        written = layout(files, record.name)
        assert (written["name"], written["tag"]) == (record.name, record.tag)
        assert written["omitsDefaults"] == record.omits_defaults
        assert [field["name"] for field in written["fields"]] == [f.name for f in record.fields]
        for field, told in zip(written["fields"], record.fields, strict=True):
            assert field.get("isNullable", False) == told.is_nullable
            assert ("default" in field) != told.is_required
            assert field.get("default") == told.default


def test_kinds_keep_their_bounds(files):
    fields = {field["name"]: field["kind"] for field in layout(files, "Hello")["fields"]}
    assert fields["client"] == ["str", 1, 64]
    assert fields["protocol"] == ["str", 0, None, "^[0-9]{1,4}\\.[0-9]{1,4}$"]
    assert fields["last_sequence"] == ["int", 0, 2**53 - 1]
    assert fields["capabilities"] == ["list", ["str", 1, 64], 16]
    assert fields["objects"] == ["map", ["str", 1, 64], 64]
    seconds = next(f for f in layout(files, "Calibrate")["fields"] if f["name"] == "seconds")
    assert seconds["kind"] == ["float", 0, 30, True]
    packed = layout(files, "PackedSkeleton")["fields"][-1]
    assert packed["kind"] == ["bytes", 1024]
    (joints,) = (f for f in layout(files, "PoseMessage")["fields"] if f["name"] == "joints")
    assert joints["kind"][1] == ["tuple", [["float", -60000, 60000]] * 3 + [["float", 0, 1]]]


def test_clients_may_leave_out_what_has_a_default_and_servers_words_are_whole(files):
    hello = interface(files, "Hello")
    assert "  readonly client: string;" in hello
    assert "  readonly token?: string | null;" in hello
    assert "  readonly face?: FaceKind;" in hello
    scene = interface(files, "SceneState")
    assert "  readonly command_id: string | null;" in scene
    assert '  readonly type: "scene";' in scene
    assert "type:" not in interface(files, "StepMessage")


def test_fields_are_told_with_unit_range_and_default(files):
    assert "/** The asking side's own monotonic clock. (ns, 0..2^53 - 1) */" in interface(
        files, "Ping"
    )
    assert '(at most 64 characters) Default: `""`.' in interface(files, "Hello")
    assert "(s, above 0, at most 30)" in interface(files, "Calibrate")
    packed = " ".join(interface(files, "PackedSkeleton").replace("*", " ").split())
    assert "(m, float32, little-endian, four a joint, at most 1024 bytes)" in packed
    assert all(len(line) <= 100 for line in files["messages.ts"].splitlines())


def test_unions_are_those_of_the_protocol(files):
    protocol = model.protocol()
    for name, members in (
        ("ClientMessage", protocol.client_json),
        ("PackedClientMessage", protocol.client_msgpack),
        ("ServerMessage", protocol.server_json),
        ("PackedServerMessage", protocol.server_msgpack),
    ):
        found = re.search(rf"^export type {name} =(.*?);", files["messages.ts"], re.S | re.M)
        assert found is not None
        assert tuple(re.findall(r"\w+", found[1])) == members
        table = {
            "ClientMessage": "CLIENT_JSON",
            "PackedClientMessage": "CLIENT_MSGPACK",
            "ServerMessage": "SERVER_JSON",
            "PackedServerMessage": "SERVER_MSGPACK",
        }[name]
        found = re.search(rf"^export const {table}.*?= \[(.*?)\];", files["layout.ts"], re.S | re.M)
        assert found is not None
        assert tuple(re.findall(r"\w+", found[1])) == members


def test_codes_carry_their_retry_policy(files):
    for close in CLOSE_CODES:
        assert f"export const CLOSE_{close.name.upper()} = {close.code};" in files["codes.ts"]
        found = re.search(rf"^  {close.code}: {{(.*?)^  }}", files["codes.ts"], re.S | re.M)
        assert found is not None
        assert f'retry: "{close.retry.value}"' in found[1]
    for error in ERROR_CODES:
        assert re.search(rf"^  {error.code}: {{$", files["codes.ts"], re.M)


def test_a_change_of_the_messages_changes_the_files(monkeypatch):
    protocol = model.protocol()
    ping = protocol.records["Ping"]
    grown = replace(ping.fields[0], name="novelty", is_required=False, default=5)
    records = {**protocol.records, "Ping": replace(ping, fields=(*ping.fields, grown))}
    before = typescript()
    monkeypatch.setattr(model, "protocol", lambda: replace(protocol, records=records))
    after = typescript()
    changed = [path for path in after if after[path] != before[path]]
    assert changed == [f"{FOLDER}/messages.ts", f"{FOLDER}/layout.ts"]
    assert "readonly novelty?: number;" in after[f"{FOLDER}/messages.ts"]
    assert "default: 5" in after[f"{FOLDER}/layout.ts"]
