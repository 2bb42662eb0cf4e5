"""The generated C# against the Python codec: same bytes, same JSON, same refusals."""

import json
from pathlib import Path
from random import Random

import msgspec

from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.schema import model
from tests.unity.build import BRIDGE, CORE, compiled, needs_mono, run, sources

pytestmark = needs_mono

FIXTURES = Path(__file__).parents[1] / "fixtures" / "protocol" / "messages.json"
FORMS = ("json", "json_binary_hex", "msgpack_hex")
EACH = 40
NUMBERS = (0.1, 1 / 3, 5e-324, 1e-7, 2.5, 1e22, -1.7976931348623157e308, 123456789012345.67, 1e16)
LETTERS = 'abc"\\/\b\n\x00\x1f\x7fäß\u2028カ🎥𝄞'


def exchanged(path):
    """What the C# codec makes of each entry of a file of messages."""
    program = compiled("Fixtures.exe", sources(CORE, BRIDGE / "Tools~" / "Fixtures"))
    return [json.loads(line) for line in run(program, str(path))]


def test_the_shared_messages_come_out_as_in_python():
    entries = json.loads(FIXTURES.read_text("utf-8"))
    results = exchanged(FIXTURES)
    assert [result["name"] for result in results] == [entry["name"] for entry in entries]
    for entry, result in zip(entries, results, strict=True):
        told = [result[form] for form in FORMS if form in result]
        assert told, entry["name"]
        for one in told:
            assert one["outcome"] == entry["outcome"], (entry["name"], one)
            if entry["outcome"] != "ok":
                continue
            assert one["record"] == entry["record"]
            if entry["json_again"] is not None:
                assert json.loads(one["json"]) == json.loads(entry["json_again"]), entry["name"]
            if entry["msgpack_hex_again"] is not None:
                assert one["msgpack_hex"] == entry["msgpack_hex_again"], entry["name"]


def test_messages_of_every_record_come_out_as_in_python(tmp_path):
    random = Random(7)
    protocol = model.protocol()
    packed = set(protocol.client_msgpack + protocol.server_msgpack)
    text = set(protocol.client_json + protocol.server_json)
    clients = set(protocol.client_json + protocol.client_msgpack)
    entries = []
    for name in sorted(packed | text):
        for _ in range(EACH):
            message = _message(random, protocol, name)
            is_image = isinstance(message, m.Image)
            entries.append(
                {
                    "name": name,
                    "direction": "client" if name in clients else "server",
                    "json": msgspec.json.encode(message).decode() if name in text else None,
                    "json_binary_hex": _image(message) if is_image else None,
                    "msgpack_hex": _msgpack(message) if name in packed else None,
                }
            )
    path = tmp_path / "messages.json"
    path.write_text(json.dumps(entries), "utf-8")
    results = exchanged(path)
    assert len(results) == len(entries)
    for entry, result in zip(entries, results, strict=True):
        for form in FORMS:
            if entry[form] is None:
                continue
            assert result[form]["outcome"] == "ok", (entry, result[form])
            if entry["json"] is not None:
                assert _exact(result[form]["json"]) == _exact(entry["json"])
            if entry["msgpack_hex"] is not None:
                assert result[form]["msgpack_hex"] == entry["msgpack_hex"], entry
            if entry["json_binary_hex"] is not None:
                assert result[form]["json_binary_hex"] == entry["json_binary_hex"]


def _exact(text):
    """What a JSON text says, with the digits of its numbers' values and the order of its keys."""
    return json.loads(text, parse_float=lambda digits: repr(float(digits)), object_pairs_hook=list)


def _msgpack(message):
    return msgspec.msgpack.encode(message).hex()


def _image(message):
    return CODECS[m.SUBPROTOCOL_JSON].encode(message).hex()


def _message(random, protocol, name):
    """A random message of a record."""
    value = _record(random, protocol, name)
    return msgspec.convert(value, getattr(m, name), builtin_types=(bytes,))


def _record(random, protocol, name):
    record = protocol.records[name]
    value = {} if record.tag is None else {"type": record.tag}
    for field in record.fields:
        if not field.is_required and random.random() < 0.5:
            continue
        is_null = field.is_nullable and random.random() < 0.3
        value[field.name] = None if is_null else _value(random, protocol, field.type)
    return value


def _value(random, protocol, kind):  # noqa: PLR0911 - one for each type
    match kind:
        case model.Bool():
            return random.random() < 0.5
        case model.Int(least, most):
            edges = [least, most, 127, 128, 255, 256, 65535, 65536, 2**32 - 1, 2**32]
            edges.append(random.randint(least, most))
            return min(max(random.choice(edges), least), most)
        case model.Float(None):
            return random.choice(NUMBERS) * random.choice((1, -1))
        case model.Float(least, most):
            return random.choice((most, random.uniform(least, most) or most))
        case model.Str(pattern=str()):
            return f"{random.randint(0, 9999)}.{random.randint(0, 9999)}"
        case model.Str(shortest, longest):
            # Not empty: whether a default is left out goes by identity in Python.
            length = random.choice((max(shortest or 0, 1), min(longest or 300, 300)))
            return "".join(random.choice(LETTERS) for _ in range(length))
        case model.Bytes(longest):
            return random.randbytes(random.choice((1, 255, 256, min(longest or 70000, 70000))))
        case model.Choice(values):
            return random.choice(values)
        case model.List(item, longest):
            count = random.choice((0, 1, 3, min(longest or 20, 20)))
            return [_value(random, protocol, item) for _ in range(count)]
        case model.Tuple(items):
            return tuple(_value(random, protocol, item) for item in items)
        case model.Map(value):
            keys = ["z", "a", "é", *(f"k{index}" for index in range(random.choice((0, 14))))]
            return {key: _value(random, protocol, value) for key in keys}
        case model.Ref(name):
            return _record(random, protocol, name)
    raise AssertionError(kind)
