// Generated from agent_server/protocol; change it there.

/** Every record of the protocol as plain data, which the codecs follow. */

import type { RecordLayout } from "./kinds.ts";

export const PROTOCOL = "1.0";
export const PROTOCOL_MAJOR = 1;
export const SUBPROTOCOL_JSON = "agent-server.v1.json";
export const SUBPROTOCOL_MSGPACK = "agent-server.v1.msgpack";

const Hello: RecordLayout = {
  name: "Hello",
  tag: "hello",
  omitsDefaults: true,
  fields: [
    { name: "protocol", kind: ["str", 0, null, "^[0-9]{1,4}\\.[0-9]{1,4}$"] },
    { name: "client", kind: ["str", 1, 64] },
    { name: "client_version", kind: ["str", 0, 64], default: "" },
    { name: "instance", kind: ["str", 1, 64], isNullable: true, default: null },
    { name: "token", kind: ["str", 0, 4096], isNullable: true, default: null },
    { name: "session", kind: ["str", 1, 64], isNullable: true, default: null },
    { name: "role", kind: ["choice", ["monitor", "renderer", "sensor"]], isNullable: true, default: null },
    { name: "capabilities", kind: ["list", ["str", 1, 64], 16], default: [] },
    { name: "face", kind: ["choice", ["expected", "gaze", "none"]], default: "expected" },
    { name: "mirror", kind: ["bool"], default: false },
    { name: "take_over", kind: ["bool"], default: false },
    { name: "topics", kind: ["list", ["choice", ["ack", "affect", "calibration", "command", "decision", "error", "forecast", "pose", "scene", "stats"]], 16], isNullable: true, default: null },
    { name: "last_epoch", kind: ["str", 0, 64], isNullable: true, default: null },
    { name: "ledger", kind: ["str", 0, 64], isNullable: true, default: null },
    { name: "last_sequence", kind: ["int", 0, 9007199254740991], isNullable: true, default: null },
    { name: "objects", kind: ["map", ["str", 1, 64], 64], isNullable: true, default: null },
    { name: "time", kind: ["str", 0, 64], isNullable: true, default: null },
  ],
};

const Ping: RecordLayout = {
  name: "Ping",
  tag: "ping",
  omitsDefaults: true,
  fields: [
    { name: "sent_ns", kind: ["int", 0, 9007199254740991] },
  ],
};

const Pong: RecordLayout = {
  name: "Pong",
  tag: "pong",
  omitsDefaults: true,
  fields: [
    { name: "sent_ns", kind: ["int", 0, 9007199254740991] },
    { name: "time_ns", kind: ["int", 0, 9007199254740991] },
  ],
};

const Affect: RecordLayout = {
  name: "Affect",
  tag: "affect",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "valence", kind: ["float", -10, 10] },
    { name: "arousal", kind: ["float", -10, 10] },
  ],
};

const Blendshapes: RecordLayout = {
  name: "Blendshapes",
  tag: "blendshapes",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "values", kind: ["map", ["float", null, null], 80] },
  ],
};

const Gaze: RecordLayout = {
  name: "Gaze",
  tag: "gaze",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "origin", kind: ["tuple", [["float", null, null], ["float", null, null], ["float", null, null]]] },
    { name: "direction", kind: ["tuple", [["float", null, null], ["float", null, null], ["float", null, null]]] },
  ],
};

const Calibrate: RecordLayout = {
  name: "Calibrate",
  tag: "calibrate",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "seconds", kind: ["float", 0, 30, true], isNullable: true, default: null },
    { name: "valence", kind: ["float", -10, 10], isNullable: true, default: null },
    { name: "arousal", kind: ["float", -10, 10], isNullable: true, default: null },
  ],
};

const AckMessage: RecordLayout = {
  name: "AckMessage",
  tag: "ack",
  omitsDefaults: true,
  fields: [
    { name: "command_id", kind: ["str", 1, 160] },
    { name: "status", kind: ["choice", ["accepted", "done", "failed", "progress", "started"]] },
    { name: "step", kind: ["int", 0, 1000], isNullable: true, default: null },
    { name: "reason", kind: ["str", 0, 500], isNullable: true, default: null },
  ],
};

const SceneEvent: RecordLayout = {
  name: "SceneEvent",
  tag: "scene_event",
  omitsDefaults: true,
  fields: [
    { name: "object", kind: ["str", 1, 64] },
    { name: "state", kind: ["str", 1, 64] },
  ],
};

const Skeleton: RecordLayout = {
  name: "Skeleton",
  tag: "skeleton",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "body_id", kind: ["int", 0, 9007199254740991] },
    { name: "format", kind: ["str", 1, 64] },
    { name: "joints", kind: ["list", ["tuple", [["float", null, null], ["float", null, null], ["float", null, null], ["float", null, null]]], 64] },
  ],
};

const FacePoints: RecordLayout = {
  name: "FacePoints",
  tag: "face",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "format", kind: ["choice", ["dlib68", "mesh468", "mesh478"]] },
    { name: "width", kind: ["int", 16, 8192] },
    { name: "height", kind: ["int", 16, 8192] },
    { name: "points", kind: ["list", ["list", ["float", null, null], null], 478] },
  ],
};

const PackedSkeleton: RecordLayout = {
  name: "PackedSkeleton",
  tag: "skeleton",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "body_id", kind: ["int", 0, 9007199254740991] },
    { name: "format", kind: ["str", 1, 64] },
    { name: "joints", kind: ["bytes", 1024] },
  ],
};

const PackedFacePoints: RecordLayout = {
  name: "PackedFacePoints",
  tag: "face",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "format", kind: ["choice", ["dlib68", "mesh468", "mesh478"]] },
    { name: "width", kind: ["int", 16, 8192] },
    { name: "height", kind: ["int", 16, 8192] },
    { name: "points", kind: ["bytes", 5736] },
  ],
};

const Image: RecordLayout = {
  name: "Image",
  tag: "image",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "jpeg", kind: ["bytes", null] },
  ],
};

const GateLevels: RecordLayout = {
  name: "GateLevels",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "mode", kind: ["str", 0, 64] },
    { name: "enter_valence", kind: ["float", -10, 10] },
    { name: "enter_arousal", kind: ["float", -10, 10] },
    { name: "leave_valence", kind: ["float", -10, 10] },
    { name: "leave_arousal", kind: ["float", -10, 10] },
  ],
};

const DecideLevels: RecordLayout = {
  name: "DecideLevels",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "enter", kind: ["map", ["float", 0, 1], null] },
    { name: "leave", kind: ["float", 0, 1] },
  ],
};

const Limits: RecordLayout = {
  name: "Limits",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "max_message_bytes", kind: ["int", 0, 9007199254740991] },
    { name: "max_image_bytes", kind: ["int", 0, 9007199254740991] },
    { name: "max_errors", kind: ["int", 0, 9007199254740991] },
  ],
};

const ModelInfo: RecordLayout = {
  name: "ModelInfo",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "name", kind: ["str", 1, 64] },
    { name: "task", kind: ["str", 0, 64] },
    { name: "sha256", kind: ["str", 0, 64] },
  ],
};

const SceneState: RecordLayout = {
  name: "SceneState",
  tag: "scene",
  omitsDefaults: true,
  fields: [
    { name: "mode", kind: ["str", 0, 64] },
    { name: "objects", kind: ["map", ["str", 0, null], null] },
    { name: "command_id", kind: ["str", 1, 160], isNullable: true, default: null },
  ],
};

const Difference: RecordLayout = {
  name: "Difference",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "object", kind: ["str", 0, null] },
    { name: "renderer", kind: ["str", 0, null] },
    { name: "server", kind: ["str", 0, null] },
    { name: "kept", kind: ["choice", ["renderer", "server"]] },
  ],
};

const Welcome: RecordLayout = {
  name: "Welcome",
  tag: "welcome",
  omitsDefaults: true,
  fields: [
    { name: "protocol", kind: ["str", 0, null, "^[0-9]{1,4}\\.[0-9]{1,4}$"] },
    { name: "server", kind: ["str", 1, 64] },
    { name: "server_version", kind: ["str", 0, 64] },
    { name: "session", kind: ["str", 1, 64] },
    { name: "role", kind: ["choice", ["monitor", "renderer", "sensor"]] },
    { name: "epoch", kind: ["str", 0, 64] },
    { name: "ledger", kind: ["str", 0, 64] },
    { name: "resumed", kind: ["bool"] },
    { name: "sequence", kind: ["int", 0, 9007199254740991] },
    { name: "heartbeat_s", kind: ["float", 0, 1000000000] },
    { name: "labels", kind: ["list", ["str", 0, null], null] },
    { name: "gate", kind: ["record", GateLevels] },
    { name: "decide", kind: ["record", DecideLevels] },
    { name: "limits", kind: ["record", Limits] },
    { name: "models", kind: ["list", ["record", ModelInfo], null] },
    { name: "scene", kind: ["record", SceneState] },
    { name: "differences", kind: ["list", ["record", Difference], null], default: [] },
  ],
};

const ErrorMessage: RecordLayout = {
  name: "ErrorMessage",
  tag: "error",
  omitsDefaults: true,
  fields: [
    { name: "code", kind: ["str", 1, 64] },
    { name: "message", kind: ["str", 0, null] },
    { name: "field", kind: ["str", 0, null], isNullable: true, default: null },
    { name: "fatal", kind: ["bool"], default: false },
  ],
};

const StepMessage: RecordLayout = {
  name: "StepMessage",
  tag: null,
  omitsDefaults: true,
  fields: [
    { name: "action", kind: ["str", 1, 64] },
    { name: "duration_s", kind: ["float", 0, 1000000000] },
    { name: "target", kind: ["str", 1, 64], isNullable: true, default: null },
  ],
};

const CommandMessage: RecordLayout = {
  name: "CommandMessage",
  tag: "command",
  omitsDefaults: true,
  fields: [
    { name: "id", kind: ["str", 1, 160] },
    { name: "sequence", kind: ["int", 0, 9007199254740991] },
    { name: "epoch", kind: ["str", 0, 64] },
    { name: "reaction", kind: ["str", 1, 64] },
    { name: "cause", kind: ["str", 1, 64] },
    { name: "steps", kind: ["list", ["record", StepMessage], null] },
    { name: "priority", kind: ["int", 0, 1000] },
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "issued_ns", kind: ["int", 0, 9007199254740991] },
    { name: "ttl_ms", kind: ["int", 0, 1000000000000] },
    { name: "preempts", kind: ["str", 1, 160], isNullable: true, default: null },
    { name: "age_ms", kind: ["int", 0, 1000000000000], default: 0 },
    { name: "server_ns", kind: ["int", 0, 9007199254740991], default: 0 },
    { name: "motion", kind: ["choice", ["authored", "generated"]], default: "authored" },
  ],
};

const Missed: RecordLayout = {
  name: "Missed",
  tag: "missed",
  omitsDefaults: true,
  fields: [
    { name: "topics", kind: ["map", ["int", 0, 9007199254740991], null] },
  ],
};

const PoseMessage: RecordLayout = {
  name: "PoseMessage",
  tag: "pose",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "body_id", kind: ["int", 0, 9007199254740991] },
    { name: "joints", kind: ["list", ["tuple", [["float", -60000, 60000], ["float", -60000, 60000], ["float", -60000, 60000], ["float", 0, 1]]], null] },
  ],
};

const FutureBody: RecordLayout = {
  name: "FutureBody",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "quality", kind: ["float", 0, 1] },
    { name: "positions", kind: ["list", ["list", ["tuple", [["float", -60000, 60000], ["float", -60000, 60000], ["float", -60000, 60000]]], null], null] },
  ],
};

const ForecastMessage: RecordLayout = {
  name: "ForecastMessage",
  tag: "forecast",
  omitsDefaults: true,
  fields: [
    { name: "window", kind: ["int", 0, 9007199254740991] },
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "source", kind: ["str", 0, 64] },
    { name: "positions", kind: ["list", ["list", ["tuple", [["float", -60000, 60000], ["float", -60000, 60000], ["float", -60000, 60000]]], null], null] },
    { name: "futures", kind: ["list", ["record", FutureBody], null], default: [] },
  ],
};

const AffectTelemetry: RecordLayout = {
  name: "AffectTelemetry",
  tag: "affect_state",
  omitsDefaults: true,
  fields: [
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "valence", kind: ["float", -10, 10] },
    { name: "arousal", kind: ["float", -10, 10] },
    { name: "valence_sd", kind: ["float", 0, 20], isNullable: true, default: null },
    { name: "arousal_sd", kind: ["float", 0, 20], isNullable: true, default: null },
    { name: "source", kind: ["str", 0, 64], default: "client" },
    { name: "delay_ms", kind: ["float", 0, 1000000000000], isNullable: true, default: null },
  ],
};

const CalibrationState: RecordLayout = {
  name: "CalibrationState",
  tag: "calibration_state",
  omitsDefaults: true,
  fields: [
    { name: "valence", kind: ["float", -10, 10] },
    { name: "arousal", kind: ["float", -10, 10] },
    { name: "faces", kind: ["int", 0, 9007199254740991] },
    { name: "is_done", kind: ["bool"] },
  ],
};

const AckTelemetry: RecordLayout = {
  name: "AckTelemetry",
  tag: "ack_state",
  omitsDefaults: true,
  fields: [
    { name: "command_id", kind: ["str", 1, 160] },
    { name: "status", kind: ["str", 1, 64] },
    { name: "step", kind: ["int", 0, 1000], isNullable: true, default: null },
    { name: "reason", kind: ["str", 0, null], isNullable: true, default: null },
  ],
};

const QualityBody: RecordLayout = {
  name: "QualityBody",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "measured", kind: ["float", 0, 1] },
    { name: "filled", kind: ["float", 0, 1] },
    { name: "bone_deviation", kind: ["float", 0, 1000000] },
    { name: "warnings", kind: ["list", ["str", 0, null], null] },
  ],
};

const GateBody: RecordLayout = {
  name: "GateBody",
  tag: null,
  omitsDefaults: true,
  fields: [
    { name: "mode", kind: ["str", 0, 64] },
    { name: "is_open", kind: ["bool"] },
    { name: "reason", kind: ["str", 0, null] },
    { name: "valence", kind: ["float", -10, 10], isNullable: true },
    { name: "arousal", kind: ["float", -10, 10], isNullable: true },
    { name: "age_ms", kind: ["float", -10000000000000, 10000000000000], isNullable: true },
    { name: "face", kind: ["str", 0, 64], isNullable: true, default: null },
    { name: "source", kind: ["str", 0, 64], isNullable: true, default: null },
    { name: "gaze_deg", kind: ["float", 0, 180], isNullable: true, default: null },
  ],
};

const SceneBody: RecordLayout = {
  name: "SceneBody",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "mode", kind: ["str", 0, 64] },
    { name: "rule", kind: ["str", 0, null], isNullable: true },
    { name: "precondition", kind: ["str", 0, null], isNullable: true },
    { name: "met", kind: ["bool"] },
    { name: "reason", kind: ["str", 0, null] },
  ],
};

const CommandBody: RecordLayout = {
  name: "CommandBody",
  tag: null,
  omitsDefaults: true,
  fields: [
    { name: "id", kind: ["str", 1, 160] },
    { name: "sequence", kind: ["int", 0, 9007199254740991] },
    { name: "reaction", kind: ["str", 1, 64] },
    { name: "cause", kind: ["str", 1, 64] },
    { name: "steps", kind: ["list", ["record", StepMessage], null] },
    { name: "priority", kind: ["int", 0, 1000] },
    { name: "preempts", kind: ["str", 1, 160], isNullable: true },
    { name: "originating_ns", kind: ["int", 0, 9007199254740991] },
    { name: "issued_ns", kind: ["int", 0, 9007199254740991] },
    { name: "ttl_ms", kind: ["int", 0, 1000000000000] },
    { name: "motion", kind: ["choice", ["authored", "generated"]], default: "authored" },
  ],
};

const FuturesBody: RecordLayout = {
  name: "FuturesBody",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "classified", kind: ["int", 0, 9007199254740991] },
    { name: "left_out", kind: ["int", 0, 9007199254740991] },
    { name: "spread", kind: ["map", ["float", 0, 1], null] },
  ],
};

const DecisionBody: RecordLayout = {
  name: "DecisionBody",
  tag: null,
  omitsDefaults: true,
  fields: [
    { name: "id", kind: ["str", 1, 160] },
    { name: "index", kind: ["int", 0, 9007199254740991] },
    { name: "window", kind: ["int", 0, 9007199254740991] },
    { name: "start_ns", kind: ["int", 0, 9007199254740991] },
    { name: "end_ns", kind: ["int", 0, 9007199254740991] },
    { name: "body_id", kind: ["int", 0, 9007199254740991] },
    { name: "models", kind: ["map", ["str", 0, null], null] },
    { name: "quality", kind: ["record", QualityBody] },
    { name: "forecast", kind: ["str", 0, 64] },
    { name: "forecast_failure", kind: ["str", 0, null], isNullable: true },
    { name: "probabilities", kind: ["map", ["float", 0, 1], null] },
    { name: "gesture", kind: ["str", 1, 64] },
    { name: "gate", kind: ["record", GateBody] },
    { name: "scene", kind: ["record", SceneBody], isNullable: true },
    { name: "outcome", kind: ["str", 0, 64] },
    { name: "reason", kind: ["str", 0, null] },
    { name: "command", kind: ["record", CommandBody], isNullable: true },
    { name: "futures", kind: ["record", FuturesBody], isNullable: true, default: null },
  ],
};

const Timing: RecordLayout = {
  name: "Timing",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "wall", kind: ["str", 0, 64] },
    { name: "wait_ms", kind: ["float", 0, 1000000000000] },
    { name: "predict_ms", kind: ["float", 0, 1000000000000] },
    { name: "classify_ms", kind: ["float", 0, 1000000000000] },
    { name: "decide_ms", kind: ["float", 0, 1000000000000] },
    { name: "total_ms", kind: ["float", 0, 1000000000000] },
  ],
};

const DecisionMessage: RecordLayout = {
  name: "DecisionMessage",
  tag: "decision",
  omitsDefaults: true,
  fields: [
    { name: "decision", kind: ["record", DecisionBody] },
    { name: "timing", kind: ["record", Timing] },
  ],
};

const ClientStats: RecordLayout = {
  name: "ClientStats",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "role", kind: ["choice", ["monitor", "renderer", "sensor"]] },
    { name: "client", kind: ["str", 1, 64] },
    { name: "round_trip_ms", kind: ["float", 0, 1000000000000], isNullable: true },
    { name: "offset_ms", kind: ["float", -10000000000000, 10000000000000], isNullable: true },
    { name: "missed", kind: ["int", 0, 9007199254740991] },
  ],
};

const ForecastScoreBody: RecordLayout = {
  name: "ForecastScoreBody",
  tag: null,
  omitsDefaults: false,
  fields: [
    { name: "error_mm", kind: ["float", 0, 1000000] },
    { name: "zero_velocity_mm", kind: ["float", 0, 1000000] },
    { name: "forecasts", kind: ["int", 0, 9007199254740991] },
  ],
};

const StatsMessage: RecordLayout = {
  name: "StatsMessage",
  tag: "stats",
  omitsDefaults: true,
  fields: [
    { name: "frames", kind: ["int", 0, 9007199254740991] },
    { name: "windows", kind: ["int", 0, 9007199254740991] },
    { name: "decisions", kind: ["int", 0, 9007199254740991] },
    { name: "commands", kind: ["int", 0, 9007199254740991] },
    { name: "skipped_windows", kind: ["int", 0, 9007199254740991] },
    { name: "predictor_failures", kind: ["int", 0, 9007199254740991] },
    { name: "rejected_messages", kind: ["int", 0, 9007199254740991] },
    { name: "missed_telemetry", kind: ["int", 0, 9007199254740991] },
    { name: "counters", kind: ["map", ["int", 0, 9007199254740991], null] },
    { name: "clients", kind: ["list", ["record", ClientStats], null], default: [] },
    { name: "forecast_score", kind: ["record", ForecastScoreBody], isNullable: true, default: null },
  ],
};

const PoseStreamMessage: RecordLayout = {
  name: "PoseStreamMessage",
  tag: "pose_stream",
  omitsDefaults: true,
  fields: [
    { name: "command_id", kind: ["str", 1, 160] },
    { name: "first_frame", kind: ["int", 0, 1000000000] },
    { name: "rate_hz", kind: ["float", 0, 240, true] },
    { name: "joints", kind: ["list", ["str", 1, 64], 64] },
    { name: "positions", kind: ["list", ["list", ["tuple", [["float", -60000, 60000], ["float", -60000, 60000], ["float", -60000, 60000]]], null], 250] },
    { name: "is_last", kind: ["bool"], default: false },
    { name: "fallback", kind: ["str", 0, null], isNullable: true, default: null },
  ],
};

const PackedPoseStreamMessage: RecordLayout = {
  name: "PackedPoseStreamMessage",
  tag: "pose_stream",
  omitsDefaults: true,
  fields: [
    { name: "command_id", kind: ["str", 1, 160] },
    { name: "first_frame", kind: ["int", 0, 1000000000] },
    { name: "rate_hz", kind: ["float", 0, 240, true] },
    { name: "joints", kind: ["list", ["str", 1, 64], 64] },
    { name: "positions", kind: ["bytes", 192000] },
    { name: "is_last", kind: ["bool"], default: false },
    { name: "fallback", kind: ["str", 0, null], isNullable: true, default: null },
  ],
};

/** What a client sends as JSON text. */
export const CLIENT_JSON: readonly RecordLayout[] = [
  Hello,
  Ping,
  Pong,
  Affect,
  Blendshapes,
  Gaze,
  Calibrate,
  AckMessage,
  SceneEvent,
  Skeleton,
  FacePoints,
];

/** What a client sends in MessagePack. */
export const CLIENT_MSGPACK: readonly RecordLayout[] = [
  Hello,
  Ping,
  Pong,
  Affect,
  Blendshapes,
  Gaze,
  Calibrate,
  AckMessage,
  SceneEvent,
  PackedSkeleton,
  PackedFacePoints,
  Image,
];

/** What a server sends in the JSON coding. */
export const SERVER_JSON: readonly RecordLayout[] = [
  Welcome,
  ErrorMessage,
  Ping,
  Pong,
  CommandMessage,
  SceneState,
  Missed,
  PoseMessage,
  ForecastMessage,
  AffectTelemetry,
  CalibrationState,
  AckTelemetry,
  DecisionMessage,
  StatsMessage,
  PoseStreamMessage,
];

/** What a server sends in MessagePack. */
export const SERVER_MSGPACK: readonly RecordLayout[] = [
  Welcome,
  ErrorMessage,
  Ping,
  Pong,
  CommandMessage,
  SceneState,
  Missed,
  PoseMessage,
  ForecastMessage,
  AffectTelemetry,
  CalibrationState,
  AckTelemetry,
  DecisionMessage,
  StatsMessage,
  PackedPoseStreamMessage,
];
