"""What the fields of messages are made of: types with a unit, a range and a sentence.

:func:`told` writes the sentence and the unit of one field where the field is declared; from there
they go into the schema, the clients' types and the reference in the docs.
"""

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from agent_server.domain.affect import AFFECT_LIMIT
from agent_server.domain.stamp import MAX_STAMP_NS

UNIT = "x-unit"
"""Where a schema keeps the unit of a number."""
PACKED = "x-packed"
"""Where a schema keeps the layout of bytes."""
COUNT = "count"
ONE = "1"
"""The unit of a number that has none."""

MAX_COORDINATE = 60_000.0
"""No coordinate is larger, in metres or in the millimetres of formats that have those."""
MAX_COUNT = MAX_STAMP_NS


def told(sentence: str, unit: str | None = None, packed: str | None = None, **bounds: Any) -> Meta:
    """A field's sentence, unit and bounds.

    Args:
        sentence: What the field says, for people.
        unit: Unit of the number, or of the numbers in it.
        packed: Layout of a field of bytes.
        bounds: What :class:`msgspec.Meta` takes: ``ge``, ``le``, ``max_length`` and so on.
    """
    extra = {key: value for key, value in ((UNIT, unit), (PACKED, packed)) if value is not None}
    return Meta(description=sentence, extra_json_schema=extra or None, **bounds)


class Message(msgspec.Struct, frozen=True, omit_defaults=True, tag_field="type"):
    """Base of all messages: a map with a ``type``; fields that hold their default are left out."""


class Part(msgspec.Struct, frozen=True):
    """Base of what messages are made of; every field is sent."""


Role = Literal["sensor", "renderer", "monitor"]
FaceKind = Literal["expected", "none", "gaze"]
FaceFormat = Literal["mesh478", "mesh468", "dlib68"]
Topic = Literal[
    "pose",
    "forecast",
    "affect",
    "calibration",
    "decision",
    "command",
    "ack",
    "scene",
    "stats",
    "error",
]
Motion = Literal["authored", "generated"]
AckStatus = Literal["accepted", "started", "progress", "done", "failed"]
CommandEnd = Literal["done", "failed", "expired", "preempted", "timed_out", "assumed"]
Authority = Literal["server", "renderer"]

Nanoseconds = Annotated[int, Meta(ge=0, le=MAX_STAMP_NS, extra_json_schema={UNIT: "ns"})]
Milliseconds = Annotated[float, Meta(ge=0, le=1e12, extra_json_schema={UNIT: "ms"})]
Seconds = Annotated[float, Meta(ge=0, le=1e9, extra_json_schema={UNIT: "s"})]
Count = Annotated[int, Meta(ge=0, le=MAX_COUNT, extra_json_schema={UNIT: COUNT})]
Identity = Annotated[int, Meta(ge=0, le=MAX_STAMP_NS, extra_json_schema={UNIT: ONE})]
Level = Annotated[float, Meta(ge=-AFFECT_LIMIT, le=AFFECT_LIMIT, extra_json_schema={UNIT: ONE})]
Deviation = Annotated[float, Meta(ge=0, le=2 * AFFECT_LIMIT, extra_json_schema={UNIT: ONE})]
Ratio = Annotated[float, Meta(ge=0, le=1, extra_json_schema={UNIT: ONE})]
Coordinate = Annotated[
    float, Meta(ge=-MAX_COORDINATE, le=MAX_COORDINATE, extra_json_schema={UNIT: "m"})
]
Name = Annotated[str, Meta(min_length=1, max_length=64)]
Label = Annotated[str, Meta(max_length=64)]
CommandId = Annotated[str, Meta(min_length=1, max_length=160)]
Text = Annotated[str, Meta(max_length=500)]
Version = Annotated[str, Meta(pattern=r"^[0-9]{1,4}\.[0-9]{1,4}$")]
Epoch = Annotated[str, Meta(max_length=64)]
Sha256 = Annotated[str, Meta(max_length=64)]
Point = tuple[Coordinate, Coordinate, Coordinate]
JointSample = tuple[Coordinate, Coordinate, Coordinate, Ratio]
