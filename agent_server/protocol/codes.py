"""Close codes and error codes, with what they mean and what a client is to do about them.

The one source: docs, schema and the clients' tables are generated from here.
"""

from dataclasses import dataclass
from enum import StrEnum


class Retry(StrEnum):
    """When a client whose connection was closed connects again by itself.

    Attributes:
        SOON: After a random time below a bound that doubles (full jitter).
        LATER: After 15 seconds: the same would happen again at once.
        NEVER: Not by itself; somebody has to decide.
    """

    SOON = "soon"
    LATER = "later"
    NEVER = "never"


@dataclass(frozen=True, slots=True)
class CloseCode:
    """Why a server closes a connection.

    Attributes:
        code: The websocket's close code.
        name: For programs.
        meaning: For people.
        advice: What to do.
        retry: When a client connects again by itself.
    """

    code: int
    name: str
    meaning: str
    advice: str
    retry: Retry


@dataclass(frozen=True, slots=True)
class ErrorCode:
    """A mistake that an ``error`` message names.

    Attributes:
        code: Its name.
        meaning: For people.
        advice: What to do.
    """

    code: str
    meaning: str
    advice: str


CLOSE_NORMAL = 1000
CLOSE_GOING_AWAY = 1001
CLOSE_TOO_LARGE = 1009
CLOSE_INTERNAL = 1011
CLOSE_BAD_HELLO = 4400
CLOSE_WRONG_VERSION = 4401
CLOSE_NOT_ADMITTED = 4403
CLOSE_HELLO_TIMEOUT = 4408
CLOSE_REPLACED = 4409
CLOSE_SILENT = 4410
CLOSE_TOO_SLOW = 4413
CLOSE_TOO_MANY_ERRORS = 4422
CLOSE_FULL = 4429

CLOSE_CODES: tuple[CloseCode, ...] = (
    CloseCode(CLOSE_NORMAL, "normal", "the client said goodbye", "nothing", Retry.NEVER),
    CloseCode(
        CLOSE_GOING_AWAY,
        "going_away",
        "the server is stopping, or the session was empty",
        "connect again and resume",
        Retry.SOON,
    ),
    CloseCode(
        CLOSE_TOO_LARGE,
        "too_large",
        "a message of more than twice the limit of an image was not even read",
        "send smaller messages",
        Retry.LATER,
    ),
    CloseCode(
        CLOSE_INTERNAL, "internal", "the session failed", "connect again and resume", Retry.SOON
    ),
    CloseCode(
        CLOSE_BAD_HELLO, "bad_hello", "wrong address or first message", "mend it", Retry.LATER
    ),
    CloseCode(
        CLOSE_WRONG_VERSION,
        "wrong_version",
        "another major version",
        "use a client of the server's version",
        Retry.LATER,
    ),
    CloseCode(
        CLOSE_NOT_ADMITTED,
        "not_admitted",
        "no token, one that is wrong or has expired, or one that does not go so far",
        "get a token of this role and session",
        Retry.NEVER,
    ),
    CloseCode(
        CLOSE_HELLO_TIMEOUT, "hello_timeout", "no hello in time", "say hello at once", Retry.SOON
    ),
    CloseCode(
        CLOSE_REPLACED,
        "replaced",
        "another client took over, or the place is taken",
        "ask to take over, or stay away",
        Retry.NEVER,
    ),
    CloseCode(
        CLOSE_SILENT,
        "silent",
        "a client with the capability heartbeat was not heard for 2.5 heartbeats",
        "connect again and resume",
        Retry.SOON,
    ),
    CloseCode(
        CLOSE_TOO_SLOW,
        "too_slow",
        "too many commands or answers waited",
        "read faster, or ask for fewer topics",
        Retry.SOON,
    ),
    CloseCode(
        CLOSE_TOO_MANY_ERRORS, "too_many_errors", "errors that went on", "mend it", Retry.LATER
    ),
    CloseCode(
        CLOSE_FULL,
        "full",
        "the server takes no more sessions, or the session no more clients",
        "try later",
        Retry.LATER,
    ),
)
"""Every close code of the server, by its number. Any other end means SOON."""

ERROR_CODES: tuple[ErrorCode, ...] = (
    ErrorCode("malformed", "no message can be read from it", "send valid JSON or MessagePack"),
    ErrorCode("invalid_field", "`field` does not fit", "mend it as the sentence says"),
    ErrorCode("unknown_type", "this version has no such message", "mend `type`"),
    ErrorCode("wrong_coding", "text in MessagePack, or binary in JSON", "send the agreed coding"),
    ErrorCode("too_large", "longer than `limits` of the welcome", "send less at once"),
    ErrorCode("hello_expected", "the first message was no hello", "say hello first"),
    ErrorCode("no_hello", "no hello came in time", "say hello at once"),
    ErrorCode("wrong_version", "another major version", "use a client of the server's version"),
    ErrorCode("wrong_address", "hello and address do not name the same", "mend either"),
    ErrorCode("bad_session_id", "the address names no session", "1 to 64 letters, digits, . _ -"),
    ErrorCode("unknown_role", "the address names no role", "sensor, renderer or monitor"),
    ErrorCode("wrong_role", "another role sends this", "connect in that role too"),
    ErrorCode("not_acting", "a mirror sent what the acting renderer sends", "take over, or watch"),
    ErrorCode("stream_taken", "another sensor sends this stream", "`take_over`, or stay away"),
    ErrorCode("renderer_taken", "another renderer acts", "`take_over` or `mirror`"),
    ErrorCode("unknown_format", "there is no such joint table", "use one of the docs' formats"),
    ErrorCode("wrong_joint_count", "not as many joints as the table", "send every joint"),
    ErrorCode("not_finite", "NaN or infinity", "send confidence 0 for what is not tracked"),
    ErrorCode("out_of_range", "a number cannot be true", "mind unit, range and clock"),
    ErrorCode("out_of_order", "not later than what came before", "send once, in capture order"),
    ErrorCode("wrong_point_count", "not as many points as the format", "send every point"),
    ErrorCode("wrong_point_size", "a point has too few or too many numbers", "x, y and mesh's z"),
    ErrorCode("face_too_small", "the face covers too few pixels", "send pixels, of a larger face"),
    ErrorCode("unknown_blendshape", "ARKit has no such name", "send ARKit's names"),
    ErrorCode("missing_blendshape", "one of ARKit's is missing", "send all 52"),
    ErrorCode("bad_image", "no JPEG can be read from it", "send a whole JPEG"),
    ErrorCode("image_too_large", "more than 1280 x 720 pixels", "send a smaller one"),
    ErrorCode("image_too_small", "less than 32 x 32 pixels", "send a larger one"),
    ErrorCode("no_model", "this server reads no faces of this kind", "send another, or affect"),
    ErrorCode("zero_vector", "a gaze without a direction", "send the direction of the eyes"),
    ErrorCode("unknown_object", "the rule file has no such object", "name one that it has"),
    ErrorCode("unknown_state", "the object has no such state", "name one that it has"),
    ErrorCode("no_token", "this server wants a token", "send `token` in hello"),
    ErrorCode("bad_token", "the token is not valid", "get another one"),
    ErrorCode("token_expired", "the token has expired", "get another one"),
    ErrorCode("not_allowed", "the token goes for another role or session", "get one for this"),
    ErrorCode("full", "no more sessions, or clients of one, are taken", "try later"),
    ErrorCode("stopping", "the server is stopping", "connect again and resume"),
    ErrorCode("silent", "nothing was heard for 2.5 heartbeats", "answer pings"),
    ErrorCode("classifier_failed", "telemetry: a window got no decision", "the next one may"),
    ErrorCode("affect_failed", "telemetry: affect was not read off a face", "the next one may be"),
    ErrorCode("face_failed", "telemetry: an image was not read", "the next one may be"),
    ErrorCode("face_skew", "telemetry: body and face too far apart", "one clock, more faces"),
    ErrorCode("clock_jump", "telemetry: a client's clock jumped", "use a monotonic clock"),
    ErrorCode("reaction_refused", "telemetry: a generated motion is no good", "authored plays"),
    ErrorCode("recording_failed", "telemetry: nothing is recorded any more", "see to the disk"),
    ErrorCode("forecast_drift", "telemetry: forecasts are worse than none", "see to the sensor"),
    ErrorCode("scene_differs", "telemetry: renderer and room did not agree", "see differences"),
)
"""Every code of an ``error`` message."""
