"""What a client sends to the server."""

from typing import Annotated

from msgspec import Meta

from agent_server.protocol.messages.fields import (
    COUNT,
    ONE,
    UNIT,
    AckStatus,
    CommandId,
    Epoch,
    FaceFormat,
    FaceKind,
    Identity,
    Label,
    Level,
    Message,
    Name,
    Nanoseconds,
    Role,
    Text,
    Topic,
    Version,
    told,
)

Number = Annotated[float, Meta(extra_json_schema={UNIT: "m", "x-range": "finite, within 50 m"})]
"""A coordinate as it comes in. Its range is checked with the format at hand, and the error says
which number of which joint it was."""
Confidence = Annotated[float, Meta(extra_json_schema={UNIT: ONE, "x-range": "0..1"})]
Pixels = Annotated[float, Meta(extra_json_schema={UNIT: "px", "x-range": "finite"})]
Shape = Annotated[float, Meta(extra_json_schema={UNIT: ONE, "x-range": "0..1"})]
SentPoint = tuple[Number, Number, Number]
SentJoint = tuple[Number, Number, Number, Confidence]
ImageSide = Annotated[int, Meta(ge=16, le=8192, extra_json_schema={UNIT: "px"})]
CaptureTime = Annotated[
    Nanoseconds, told("Capture time on the sensor's monotonic clock, which is zero at its start.")
]


class Hello(Message, frozen=True, tag="hello"):
    """First message on every connection."""

    protocol: Annotated[Version, told("Version that the client speaks, as MAJOR.MINOR.")]
    client: Annotated[Name, told("What the client is called, for people.")]
    client_version: Annotated[Label, told("Version of the client, for people.")] = ""
    instance: (
        Annotated[
            Name,
            told(
                "Random identity of this run of the client: a connection takes the place of an "
                "earlier one with the same."
            ),
        ]
        | None
    ) = None
    token: (
        Annotated[str, told("Secret that admits the client, where one is needed.", max_length=4096)]
        | None
    ) = None
    session: (
        Annotated[Name, told("Session that the client means; the address must name the same.")]
        | None
    ) = None
    role: (
        Annotated[Role, told("Role that the client means; the address must name the same.")] | None
    ) = None
    capabilities: Annotated[
        list[Name],
        told(
            "What the client can do: `heartbeat` answers pings, and lets itself be held to it; "
            "`resume` remembers which commands it has carried out; `progress` reports steps; "
            "`pose_stream` plays streamed poses; `stand_in` gives its place as a renderer to any "
            "other. Others are noted for people.",
            max_length=16,
        ),
    ] = []  # noqa: RUF012 - msgspec copies it
    face: Annotated[
        FaceKind,
        told(
            "Sensors: `expected` when a face or affect follows, `none` for a headset that hides "
            "the face, `gaze` for one that tells where the person looks."
        ),
    ] = "expected"
    mirror: Annotated[bool, told("Renderers: get commands, and send no acks.")] = False
    take_over: Annotated[
        bool, told("Replace the sensor or acting renderer that is there already.")
    ] = False
    topics: (
        Annotated[list[Topic], told("Monitors: kinds of telemetry that are wanted.", max_length=16)]
        | None
    ) = None
    last_epoch: (
        Annotated[Epoch, told("Epoch of the last welcome, after a lost connection.")] | None
    ) = None
    ledger: (
        Annotated[Epoch, told("Renderers: ledger of the last welcome, after a lost connection.")]
        | None
    ) = None
    last_sequence: (
        Annotated[
            int, told("Renderers: highest sequence that was received.", COUNT, ge=0, le=2**53 - 1)
        ]
        | None
    ) = None
    objects: (
        Annotated[
            dict[Name, Name],
            told(
                "Renderers: state of each object as it is shown, to be reconciled.", max_length=64
            ),
        ]
        | None
    ) = None
    time: Annotated[Label, told("Wall time in ISO 8601, for people.")] | None = None


class Skeleton(Message, frozen=True, tag="skeleton"):
    """One body at one instant (JSON coding)."""

    originating_ns: CaptureTime
    body_id: Annotated[Identity, told("The tracker's identity of the body.")]
    format: Annotated[Name, told("Joint table, for example `kinect_v2`.")]
    joints: Annotated[
        list[SentJoint],
        told(
            "x, y, z and confidence of every joint in the order of the table, in the format's unit "
            "and frame; confidence is 0 not tracked, 0.5 inferred, 1 tracked.",
            max_length=64,
        ),
    ]


class PackedSkeleton(Message, frozen=True, tag="skeleton"):
    """One body at one instant (MessagePack coding)."""

    originating_ns: CaptureTime
    body_id: Annotated[Identity, told("The tracker's identity of the body.")]
    format: Annotated[Name, told("Joint table, for example `kinect_v2`.")]
    joints: Annotated[
        bytes,
        told(
            "x, y, z and confidence of every joint, as in the JSON coding.",
            "m",
            packed="float32, little-endian, four a joint",
            max_length=64 * 16,
        ),
    ]


class Affect(Message, frozen=True, tag="affect"):
    """One estimate of the person's affect."""

    originating_ns: CaptureTime
    valence: Annotated[Level, told("From unpleasant to pleasant.")]
    arousal: Annotated[Level, told("From calm to excited.")]


class FacePoints(Message, frozen=True, tag="face"):
    """The landmarks of one face at one instant (JSON coding)."""

    originating_ns: CaptureTime
    format: Annotated[FaceFormat, told("Order of the points; `dlib68` is that of dlib and iBUG.")]
    width: Annotated[ImageSide, told("Width of the image.")]
    height: Annotated[ImageSide, told("Height of the image.")]
    points: Annotated[
        list[list[Pixels]],
        told(
            "x to the right and y down of every point, in pixels of the image; a mesh has the "
            "depth too, in the same unit, smaller towards the camera.",
            max_length=478,
        ),
    ]


class PackedFacePoints(Message, frozen=True, tag="face"):
    """The landmarks of one face at one instant (MessagePack coding)."""

    originating_ns: CaptureTime
    format: Annotated[FaceFormat, told("Order of the points; `dlib68` is that of dlib and iBUG.")]
    width: Annotated[ImageSide, told("Width of the image.")]
    height: Annotated[ImageSide, told("Height of the image.")]
    points: Annotated[
        bytes,
        told(
            "x, y and, of a mesh, z of every point, as in the JSON coding.",
            "px",
            packed="float32, little-endian, three a point, two of dlib68",
            max_length=478 * 12,
        ),
    ]


class Blendshapes(Message, frozen=True, tag="blendshapes"):
    """The expression of one face at one instant."""

    originating_ns: CaptureTime
    values: Annotated[
        dict[str, Shape], told("Each of ARKit's 52 blendshapes by its name.", max_length=80)
    ]


class Image(Message, frozen=True, tag="image"):
    """One frame of a camera that sees the face.

    In the JSON coding it is a binary frame: the four bytes ``AFJ1``, four bytes of flags (0),
    ``originating_ns`` in eight, both little-endian, and the JPEG.
    """

    originating_ns: CaptureTime
    jpeg: Annotated[bytes, told("The image as JPEG.", packed="JPEG")]


class Gaze(Message, frozen=True, tag="gaze"):
    """Where the person looks: a ray in the frame of the skeletons."""

    originating_ns: CaptureTime
    origin: Annotated[SentPoint, told("Where the eyes are.")]
    direction: Annotated[SentPoint, told("Where they look; its length does not matter.")]


class Calibrate(Message, frozen=True, tag="calibrate"):
    """Makes the person's neutral face the zero of valence and arousal.

    Either the face is neutral for the next ``seconds``, or ``valence`` and ``arousal`` are
    what an earlier calibration of this person found.
    """

    originating_ns: CaptureTime
    seconds: Annotated[float, told("How long the face is neutral.", "s", gt=0, le=30)] | None = None
    valence: Annotated[Level, told("What an earlier calibration found.")] | None = None
    arousal: Annotated[Level, told("What an earlier calibration found.")] | None = None


class AckMessage(Message, frozen=True, tag="ack"):
    """A renderer's word on a command."""

    command_id: Annotated[CommandId, told("Which command.")]
    status: Annotated[AckStatus, told("What became of it; `done` and `failed` are the end.")]
    step: Annotated[int, told("Index of the step that has ended.", ONE, ge=0, le=1000)] | None = (
        None
    )
    reason: (
        Annotated[
            Text,
            told("Why it failed: `expired`, `preempted`, `forgotten`, or words for people."),
        ]
        | None
    ) = None


class SceneEvent(Message, frozen=True, tag="scene_event"):
    """Somebody changed an object of the room by hand."""

    object: Annotated[Name, told("Name of the object.")]
    state: Annotated[Name, told("Its new state.")]
