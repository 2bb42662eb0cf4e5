"""Messages that are wrong in every way that a seed can think of, with a few that are right."""

import json
import random
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy

import msgspec

from tests.support.bodies import stream

WEIRD = (
    *(None, True, False, 0, -1, 1, 255, 2**31, 2**53, 2**53 + 1, 2**63 - 1, -(2**63)),
    *(0.5, -0.0, 1e-320, 1e308, -1e308, float("nan"), float("inf")),
    *("", "x", "\0", "\ud7ff", "😀" * 50, "9" * 400, "x" * 5000, "../../etc", "type"),
    *([], {}, [[]], {"type": "hello"}, [0] * 3000),
)
TYPES = ("hello", "skeleton", "affect", "ack", "scene_event", "ping", "image", "gaze", "", "nope")


def nested(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


def places(value, path=()):
    """Where every value within ``value`` stands."""
    yield path
    if isinstance(value, dict):
        for key, one in value.items():
            yield from places(one, (*path, key))
    elif isinstance(value, list):
        for index, one in enumerate(value[:4]):
            yield from places(one, (*path, index))


def at(value, path):
    for step in path:
        value = value[step]
    return value


class Mutator:
    """Makes one message after the other.

    Args:
        seed: Of all chance.
        coding: ``json`` or ``msgpack``.
        bases: Good messages, as dictionaries.
    """

    def __init__(self, seed, coding, bases):
        self._random = random.Random(seed)
        self._is_text = coding == "json"
        self._bases = [
            (msgspec.msgpack.encode(base), [path for path in places(base) if path])
            for base in bases
        ]
        self._inner = []
        self._kinds = (
            *(self._replace,) * 6,
            *(self._drop, self._rename, self._retype, self._grow, self._deepen),
            *(self._flip,) * 3,
            *(self._truncate, self._splice, self._garbage, self._other_coding, self._image),
        )

    def __iter__(self) -> Iterator[tuple[bool, bytes]]:
        """Whether it is a text frame, and its payload."""
        while True:
            made = self._random.choice(self._kinds)()
            if made is not None:
                yield made

    # ------------------------------------------------------------------ of values

    def _base(self):
        packed, self._inner = self._random.choice(self._bases)
        return msgspec.msgpack.decode(packed)

    def _somewhere(self, base):
        path = self._random.choice(self._inner)
        return at(base, path[:-1]), path[-1]

    def _replace(self):
        base = self._base()
        for _ in range(self._random.choice((1, 1, 1, 2, 4))):
            # A second place may lie within what the first one has replaced.
            with suppress(KeyError, IndexError, TypeError):
                table, key = self._somewhere(base)
                table[key] = deepcopy(self._random.choice(WEIRD))
        return self._encoded(base)

    def _drop(self):
        base = self._base()
        table, key = self._somewhere(base)
        del table[key]
        return self._encoded(base)

    def _rename(self):
        base = self._base()
        name = self._random.choice(list(base))
        base[self._random.choice(("", name.upper(), "x" * 300, name + "\0"))] = base.pop(name)
        return self._encoded(base)

    def _retype(self):
        base = self._base()
        base["type"] = self._random.choice(TYPES)
        return self._encoded(base)

    def _grow(self):
        base = self._base()
        table, key = self._somewhere(base)
        value = table[key]
        if isinstance(value, list):
            table[key] = value * self._random.choice((0, 2, 50))
        else:
            base.update({f"k{index}": index for index in range(200)})
        return self._encoded(base)

    def _deepen(self):
        depth = self._random.choice((10, 900, 5000))
        if self._is_text:
            return True, b'{"type":"hello","client":' + b"[" * depth + b"]" * depth + b"}"
        return False, b"\x81\xa4type" + b"\x91" * depth + b"\xc0"

    # ------------------------------------------------------------------ of bytes

    def _whole(self):
        return bytearray(self._encoded(self._base())[1])

    def _flip(self):
        data = self._whole()
        for _ in range(self._random.choice((1, 1, 3, 20))):
            data[self._random.randrange(len(data))] ^= 1 << self._random.randrange(8)
        return self._as_text(data)

    def _truncate(self):
        data = self._whole()
        return self._as_text(data[: self._random.randrange(len(data))])

    def _splice(self):
        one, other = self._whole(), self._whole()
        cut = self._random.randrange(len(one))
        return self._as_text(one[:cut] + other[self._random.randrange(len(other)) :])

    def _garbage(self):
        return self._as_text(self._random.randbytes(self._random.choice((0, 1, 7, 300, 4000))))

    def _other_coding(self):
        text = json.dumps(self._base(), default=repr).encode()
        return (not self._is_text), text

    def _image(self):
        head = b"AFJ1" + self._random.randbytes(self._random.choice((0, 4, 12)))
        jpeg = b"\xff\xd8\xff\xe0" + self._random.randbytes(self._random.choice((0, 40, 900)))
        return False, head + jpeg

    def _as_text(self, data):
        """Bytes as a frame of the coding; text has to be UTF-8 to get as far as a message."""
        data = bytes(data)
        return (True, data.decode(errors="replace").encode()) if self._is_text else (False, data)

    def _encoded(self, value):
        if self._is_text:
            return True, json.dumps(value, check_circular=False).encode()
        try:
            return False, msgspec.msgpack.encode(value)
        except (OverflowError, RecursionError):
            return False, b"\xc1"


def good(fixtures, coding, sends):
    """Good messages of a role: those of the fixtures that it may send, and some bodies.

    Args:
        fixtures: The entries of ``messages.json``.
        coding: ``json`` or ``msgpack``.
        sends: Types of messages.
    """
    client = [one for one in fixtures if one["direction"] == "client" and one["outcome"] == "ok"]
    if coding == "json":
        found = [json.loads(one["json"]) for one in client if one["json"]]
    else:
        packed = [bytes.fromhex(one["msgpack_hex"]) for one in client if one["msgpack_hex"]]
        found = [msgspec.msgpack.decode(one) for one in packed]
    bodies = [_body(frame, coding) for frame in stream(1)[:3]]
    return [one for one in found + bodies if one["type"] in sends]


def _body(frame, coding):
    joints = frame.joints.tolist() if coding == "json" else frame.joints.astype("<f4").tobytes()
    return {
        "type": "skeleton",
        "originating_ns": frame.originating_ns,
        "body_id": 0,
        "format": "core9",
        "joints": joints,
    }
