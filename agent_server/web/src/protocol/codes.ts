// Generated from agent_server/protocol; change it there.

/** Close codes and error codes, with what they mean and what to do about them. */

/**
 * When a client whose connection was closed connects again by itself: after a random time below a
 * bound that doubles, after 15 seconds, or not at all.
 */
export type Retry = "soon" | "later" | "never";

export interface CloseCode {
  readonly name: string;
  readonly meaning: string;
  readonly advice: string;
  readonly retry: Retry;
}

export interface ErrorCode {
  readonly meaning: string;
  readonly advice: string;
}

export const CLOSE_NORMAL = 1000;
export const CLOSE_GOING_AWAY = 1001;
export const CLOSE_TOO_LARGE = 1009;
export const CLOSE_INTERNAL = 1011;
export const CLOSE_BAD_HELLO = 4400;
export const CLOSE_WRONG_VERSION = 4401;
export const CLOSE_NOT_ADMITTED = 4403;
export const CLOSE_HELLO_TIMEOUT = 4408;
export const CLOSE_REPLACED = 4409;
export const CLOSE_SILENT = 4410;
export const CLOSE_TOO_SLOW = 4413;
export const CLOSE_TOO_MANY_ERRORS = 4422;
export const CLOSE_FULL = 4429;

/** Every close code of the server. Any other end means `soon`. */
export const CLOSE_CODES: Readonly<Record<number, CloseCode>> = {
  1000: {
    name: "normal",
    meaning: "the client said goodbye",
    advice: "nothing",
    retry: "never",
  },
  1001: {
    name: "going_away",
    meaning: "the server is stopping, or the session was empty",
    advice: "connect again and resume",
    retry: "soon",
  },
  1009: {
    name: "too_large",
    meaning: "a message of more than twice the limit of an image was not even read",
    advice: "send smaller messages",
    retry: "later",
  },
  1011: {
    name: "internal",
    meaning: "the session failed",
    advice: "connect again and resume",
    retry: "soon",
  },
  4400: {
    name: "bad_hello",
    meaning: "wrong address or first message",
    advice: "mend it",
    retry: "later",
  },
  4401: {
    name: "wrong_version",
    meaning: "another major version",
    advice: "use a client of the server's version",
    retry: "later",
  },
  4403: {
    name: "not_admitted",
    meaning: "no token, one that is wrong or has expired, or one that does not go so far",
    advice: "get a token of this role and session",
    retry: "never",
  },
  4408: {
    name: "hello_timeout",
    meaning: "no hello in time",
    advice: "say hello at once",
    retry: "soon",
  },
  4409: {
    name: "replaced",
    meaning: "another client took over, or the place is taken",
    advice: "ask to take over, or stay away",
    retry: "never",
  },
  4410: {
    name: "silent",
    meaning: "a client with the capability heartbeat was not heard for 2.5 heartbeats",
    advice: "connect again and resume",
    retry: "soon",
  },
  4413: {
    name: "too_slow",
    meaning: "too many commands or answers waited",
    advice: "read faster, or ask for fewer topics",
    retry: "soon",
  },
  4422: {
    name: "too_many_errors",
    meaning: "errors that went on",
    advice: "mend it",
    retry: "later",
  },
  4429: {
    name: "full",
    meaning: "the server takes no more sessions, or the session no more clients",
    advice: "try later",
    retry: "later",
  },
};

/** Every code of an `error` message. */
export const ERROR_CODES: Readonly<Record<string, ErrorCode>> = {
  malformed: {
    meaning: "no message can be read from it",
    advice: "send valid JSON or MessagePack",
  },
  invalid_field: {
    meaning: "`field` does not fit",
    advice: "mend it as the sentence says",
  },
  unknown_type: {
    meaning: "this version has no such message",
    advice: "mend `type`",
  },
  wrong_coding: {
    meaning: "text in MessagePack, or binary in JSON",
    advice: "send the agreed coding",
  },
  too_large: {
    meaning: "longer than `limits` of the welcome",
    advice: "send less at once",
  },
  hello_expected: {
    meaning: "the first message was no hello",
    advice: "say hello first",
  },
  no_hello: {
    meaning: "no hello came in time",
    advice: "say hello at once",
  },
  wrong_version: {
    meaning: "another major version",
    advice: "use a client of the server's version",
  },
  wrong_address: {
    meaning: "hello and address do not name the same",
    advice: "mend either",
  },
  bad_session_id: {
    meaning: "the address names no session",
    advice: "1 to 64 letters, digits, . _ -",
  },
  unknown_role: {
    meaning: "the address names no role",
    advice: "sensor, renderer or monitor",
  },
  wrong_role: {
    meaning: "another role sends this",
    advice: "connect in that role too",
  },
  not_acting: {
    meaning: "a mirror sent what the acting renderer sends",
    advice: "take over, or watch",
  },
  stream_taken: {
    meaning: "another sensor sends this stream",
    advice: "`take_over`, or stay away",
  },
  renderer_taken: {
    meaning: "another renderer acts",
    advice: "`take_over` or `mirror`",
  },
  unknown_format: {
    meaning: "there is no such joint table",
    advice: "use one of the docs' formats",
  },
  wrong_joint_count: {
    meaning: "not as many joints as the table",
    advice: "send every joint",
  },
  not_finite: {
    meaning: "NaN or infinity",
    advice: "send confidence 0 for what is not tracked",
  },
  out_of_range: {
    meaning: "a number cannot be true",
    advice: "mind unit, range and clock",
  },
  out_of_order: {
    meaning: "not later than what came before",
    advice: "send once, in capture order",
  },
  wrong_point_count: {
    meaning: "not as many points as the format",
    advice: "send every point",
  },
  wrong_point_size: {
    meaning: "a point has too few or too many numbers",
    advice: "x, y and mesh's z",
  },
  face_too_small: {
    meaning: "the face covers too few pixels",
    advice: "send pixels, of a larger face",
  },
  unknown_blendshape: {
    meaning: "ARKit has no such name",
    advice: "send ARKit's names",
  },
  missing_blendshape: {
    meaning: "one of ARKit's is missing",
    advice: "send all 52",
  },
  bad_image: {
    meaning: "no JPEG can be read from it",
    advice: "send a whole JPEG",
  },
  image_too_large: {
    meaning: "more than 1280 x 720 pixels",
    advice: "send a smaller one",
  },
  image_too_small: {
    meaning: "less than 32 x 32 pixels",
    advice: "send a larger one",
  },
  no_model: {
    meaning: "this server reads no faces of this kind",
    advice: "send another, or affect",
  },
  zero_vector: {
    meaning: "a gaze without a direction",
    advice: "send the direction of the eyes",
  },
  unknown_object: {
    meaning: "the rule file has no such object",
    advice: "name one that it has",
  },
  unknown_state: {
    meaning: "the object has no such state",
    advice: "name one that it has",
  },
  no_token: {
    meaning: "this server wants a token",
    advice: "send `token` in hello",
  },
  bad_token: {
    meaning: "the token is not valid",
    advice: "get another one",
  },
  token_expired: {
    meaning: "the token has expired",
    advice: "get another one",
  },
  not_allowed: {
    meaning: "the token goes for another role or session",
    advice: "get one for this",
  },
  full: {
    meaning: "no more sessions, or clients of one, are taken",
    advice: "try later",
  },
  stopping: {
    meaning: "the server is stopping",
    advice: "connect again and resume",
  },
  silent: {
    meaning: "nothing was heard for 2.5 heartbeats",
    advice: "answer pings",
  },
  classifier_failed: {
    meaning: "telemetry: a window got no decision",
    advice: "the next one may",
  },
  affect_failed: {
    meaning: "telemetry: affect was not read off a face",
    advice: "the next one may be",
  },
  face_failed: {
    meaning: "telemetry: an image was not read",
    advice: "the next one may be",
  },
  face_skew: {
    meaning: "telemetry: body and face too far apart",
    advice: "one clock, more faces",
  },
  clock_jump: {
    meaning: "telemetry: a client's clock jumped",
    advice: "use a monotonic clock",
  },
  reaction_refused: {
    meaning: "telemetry: a generated motion is no good",
    advice: "authored plays",
  },
  recording_failed: {
    meaning: "telemetry: nothing is recorded any more",
    advice: "see to the disk",
  },
  forecast_drift: {
    meaning: "telemetry: forecasts are worse than none",
    advice: "see to the sensor",
  },
  scene_differs: {
    meaning: "telemetry: renderer and room did not agree",
    advice: "see differences",
  },
};
