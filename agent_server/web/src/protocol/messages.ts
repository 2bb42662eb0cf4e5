// Generated from agent_server/protocol; change it there.

/**
 * The messages of the protocol as types. Time stamps are integer nanoseconds. What a client sends
 * may leave out fields that have a default; what a server sent has every field, since the codecs
 * fill in what was left out.
 */

/** What a connection is for. */
export type Role = "sensor" | "renderer" | "monitor";

/** What a sensor tells of the person's face. */
export type FaceKind = "expected" | "none" | "gaze";

/** Order of the points of a face. */
export type FaceFormat = "mesh478" | "mesh468" | "dlib68";

/** A kind of telemetry. */
export type Topic =
  | "pose"
  | "forecast"
  | "affect"
  | "calibration"
  | "decision"
  | "command"
  | "ack"
  | "scene"
  | "stats"
  | "error";

/** A renderer's word on a command. */
export type AckStatus = "accepted" | "started" | "progress" | "done" | "failed";

/** How a command ended, for the server. */
export type CommandEnd = "done" | "failed" | "expired" | "preempted" | "timed_out" | "assumed";

/** Whose word holds. */
export type Authority = "server" | "renderer";

/** How the agent moves. */
export type Motion = "authored" | "generated";

/** x, y, z. */
export type Point = readonly [number, number, number];

/** x, y, z and the confidence. */
export type JointSample = readonly [number, number, number, number];

/** First message on every connection. */
export interface Hello {
  readonly type: "hello";
  /** Version that the client speaks, as MAJOR.MINOR. */
  readonly protocol: string;
  /** What the client is called, for people. (1..64 characters) */
  readonly client: string;
  /** Version of the client, for people. (at most 64 characters) Default: `""`. */
  readonly client_version?: string;
  /**
   * Random identity of this run of the client: a connection takes the place of an earlier one with
   * the same. (1..64 characters)
   */
  readonly instance?: string | null;
  /** Secret that admits the client, where one is needed. (at most 4096 characters) */
  readonly token?: string | null;
  /** Session that the client means; the address must name the same. (1..64 characters) */
  readonly session?: string | null;
  /** Role that the client means; the address must name the same. */
  readonly role?: Role | null;
  /**
   * What the client can do: `heartbeat` answers pings, and lets itself be held to it; `resume`
   * remembers which commands it has carried out; `progress` reports steps; `pose_stream` plays
   * streamed poses; `stand_in` gives its place as a renderer to any other. Others are noted for
   * people. (1..64 characters, at most 16 items)
   */
  readonly capabilities?: readonly string[];
  /**
   * Sensors: `expected` when a face or affect follows, `none` for a headset that hides the face,
   * `gaze` for one that tells where the person looks. Default: `"expected"`.
   */
  readonly face?: FaceKind;
  /** Renderers: get commands, and send no acks. Default: `false`. */
  readonly mirror?: boolean;
  /** Replace the sensor or acting renderer that is there already. Default: `false`. */
  readonly take_over?: boolean;
  /** Monitors: kinds of telemetry that are wanted. (at most 16 items) */
  readonly topics?: readonly Topic[] | null;
  /** Epoch of the last welcome, after a lost connection. (at most 64 characters) */
  readonly last_epoch?: string | null;
  /** Renderers: ledger of the last welcome, after a lost connection. (at most 64 characters) */
  readonly ledger?: string | null;
  /** Renderers: highest sequence that was received. (count, 0..2^53 - 1) */
  readonly last_sequence?: number | null;
  /**
   * Renderers: state of each object as it is shown, to be reconciled. (1..64 characters, at most 64
   * entries)
   */
  readonly objects?: Readonly<Record<string, string>> | null;
  /** Wall time in ISO 8601, for people. (at most 64 characters) */
  readonly time?: string | null;
}

/** Asks for a pong, which shows that the other side is there, and what its clock says. */
export interface Ping {
  readonly type: "ping";
  /** The asking side's own monotonic clock. (ns, 0..2^53 - 1) */
  readonly sent_ns: number;
}

/** Answers a ping. */
export interface Pong {
  readonly type: "pong";
  /** As it stood in the ping. (ns, 0..2^53 - 1) */
  readonly sent_ns: number;
  /** The answering side's own monotonic clock when it answered. (ns, 0..2^53 - 1) */
  readonly time_ns: number;
}

/** One estimate of the person's affect. */
export interface Affect {
  readonly type: "affect";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** From unpleasant to pleasant. (-10..10) */
  readonly valence: number;
  /** From calm to excited. (-10..10) */
  readonly arousal: number;
}

/** The expression of one face at one instant. */
export interface Blendshapes {
  readonly type: "blendshapes";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Each of ARKit's 52 blendshapes by its name. (0..1, at most 80 entries) */
  readonly values: Readonly<Record<string, number>>;
}

/** Where the person looks: a ray in the frame of the skeletons. */
export interface Gaze {
  readonly type: "gaze";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Where the eyes are. (m, finite, within 50 m) */
  readonly origin: Point;
  /** Where they look; its length does not matter. (m, finite, within 50 m) */
  readonly direction: Point;
}

/**
 * Makes the person's neutral face the zero of valence and arousal.
 *
 * Either the face is neutral for the next `seconds`, or `valence` and `arousal` are what an earlier
 * calibration of this person found.
 */
export interface Calibrate {
  readonly type: "calibrate";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** How long the face is neutral. (s, above 0, at most 30) */
  readonly seconds?: number | null;
  /** What an earlier calibration found. (-10..10) */
  readonly valence?: number | null;
  /** What an earlier calibration found. (-10..10) */
  readonly arousal?: number | null;
}

/** A renderer's word on a command. */
export interface AckMessage {
  readonly type: "ack";
  /** Which command. (1..160 characters) */
  readonly command_id: string;
  /** What became of it; `done` and `failed` are the end. */
  readonly status: AckStatus;
  /** Index of the step that has ended. (0..1000) */
  readonly step?: number | null;
  /**
   * Why it failed: `expired`, `preempted`, `forgotten`, or words for people. (at most 500
   * characters)
   */
  readonly reason?: string | null;
}

/** Somebody changed an object of the room by hand. */
export interface SceneEvent {
  readonly type: "scene_event";
  /** Name of the object. (1..64 characters) */
  readonly object: string;
  /** Its new state. (1..64 characters) */
  readonly state: string;
}

/** One body at one instant (JSON coding). */
export interface Skeleton {
  readonly type: "skeleton";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** The tracker's identity of the body. (0..2^53 - 1) */
  readonly body_id: number;
  /** Joint table, for example `kinect_v2`. (1..64 characters) */
  readonly format: string;
  /**
   * x, y, z and confidence of every joint in the order of the table, in the format's unit and
   * frame; confidence is 0 not tracked, 0.5 inferred, 1 tracked. (m, finite, within 50 m, then
   * 0..1, at most 64 items)
   */
  readonly joints: readonly JointSample[];
}

/** The landmarks of one face at one instant (JSON coding). */
export interface FacePoints {
  readonly type: "face";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Order of the points; `dlib68` is that of dlib and iBUG. */
  readonly format: FaceFormat;
  /** Width of the image. (px, 16..8192) */
  readonly width: number;
  /** Height of the image. (px, 16..8192) */
  readonly height: number;
  /**
   * x to the right and y down of every point, in pixels of the image; a mesh has the depth too, in
   * the same unit, smaller towards the camera. (px, finite, at most 478 items)
   */
  readonly points: readonly (readonly number[])[];
}

/** One body at one instant (MessagePack coding). */
export interface PackedSkeleton {
  readonly type: "skeleton";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** The tracker's identity of the body. (0..2^53 - 1) */
  readonly body_id: number;
  /** Joint table, for example `kinect_v2`. (1..64 characters) */
  readonly format: string;
  /**
   * x, y, z and confidence of every joint, as in the JSON coding. (m, float32, little-endian, four
   * a joint, at most 1024 bytes)
   */
  readonly joints: Uint8Array;
}

/** The landmarks of one face at one instant (MessagePack coding). */
export interface PackedFacePoints {
  readonly type: "face";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Order of the points; `dlib68` is that of dlib and iBUG. */
  readonly format: FaceFormat;
  /** Width of the image. (px, 16..8192) */
  readonly width: number;
  /** Height of the image. (px, 16..8192) */
  readonly height: number;
  /**
   * x, y and, of a mesh, z of every point, as in the JSON coding. (px, float32, little-endian,
   * three a point, two of dlib68, at most 5736 bytes)
   */
  readonly points: Uint8Array;
}

/**
 * One frame of a camera that sees the face.
 *
 * In the JSON coding it is a binary frame: the four bytes `AFJ1`, four bytes of flags (0),
 * `originating_ns` in eight, both little-endian, and the JPEG.
 */
export interface Image {
  readonly type: "image";
  /** Capture time on the sensor's monotonic clock, which is zero at its start. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** The image as JPEG. (JPEG) */
  readonly jpeg: Uint8Array;
}

/** Thresholds of the affect gate, so that a client can draw them. */
export interface GateLevels {
  /** `required`, `optional`, `off`, `thesis` or `gaze`. (at most 64 characters) */
  readonly mode: string;
  /** It opens below this valence ... (-10..10) */
  readonly enter_valence: number;
  /** ... and above this size of arousal. (-10..10) */
  readonly enter_arousal: number;
  /** It closes above this valence ... (-10..10) */
  readonly leave_valence: number;
  /** ... or below this size of arousal. (-10..10) */
  readonly leave_arousal: number;
}

/** Probabilities at which gestures start and end, so that a client can draw them. */
export interface DecideLevels {
  /** Where each gesture starts to count, by its label. (0..1) */
  readonly enter: Readonly<Record<string, number>>;
  /** Where one that is going on ends. (0..1) */
  readonly leave: number;
}

/** What the server takes from a client. */
export interface Limits {
  /** Longest message, in bytes. (byte, 0..2^53 - 1) */
  readonly max_message_bytes: number;
  /** Longest image, in bytes. (byte, 0..2^53 - 1) */
  readonly max_image_bytes: number;
  /** Bad messages that may be open at once. (count, 0..2^53 - 1) */
  readonly max_errors: number;
}

/** A model in use. */
export interface ModelInfo {
  /** Name of the bundle. (1..64 characters) */
  readonly name: string;
  /** What it is used for. (at most 64 characters) */
  readonly task: string;
  /** Hash of its weights, in hexadecimal. (at most 64 characters) */
  readonly sha256: string;
}

/** The room. */
export interface SceneState {
  readonly type: "scene";
  /** What the agent does: `working`, `attention` or `reacting`. (at most 64 characters) */
  readonly mode: string;
  /** State of every object that has any, by its name. */
  readonly objects: Readonly<Record<string, string>>;
  /** The command that is being carried out. (1..160 characters) */
  readonly command_id: string | null;
}

/** An object on which renderer and server did not agree when the renderer came. */
export interface Difference {
  /** Name of the object. */
  readonly object: string;
  /** State that the renderer showed. */
  readonly renderer: string;
  /** State that the server had; empty for an object it has not. */
  readonly server: string;
  /** Whose state holds now; the rule file says so. */
  readonly kept: Authority;
}

/** Answers hello when the client may stay. */
export interface Welcome {
  readonly type: "welcome";
  /** Version that the server speaks. */
  readonly protocol: string;
  /** What the server is called. (1..64 characters) */
  readonly server: string;
  /** Version of the server. (at most 64 characters) */
  readonly server_version: string;
  /** Session of this connection. (1..64 characters) */
  readonly session: string;
  /** Role of this connection. */
  readonly role: Role;
  /** Changes whenever the session is opened, after a restart too. (at most 64 characters) */
  readonly epoch: string;
  /**
   * Within one ledger an id means one command for good, over restarts too. A client that knew
   * another one forgets the commands of that one. (at most 64 characters)
   */
  readonly ledger: string;
  /** Whether hello named this ledger. */
  readonly resumed: boolean;
  /** Sequence of the last command, 0 before the first. (count, 0..2^53 - 1) */
  readonly sequence: number;
  /**
   * How often either side pings; one that hears nothing for 2.5 of these may leave. (s,
   * 0..1000000000)
   */
  readonly heartbeat_s: number;
  /** Gestures that the classifier tells apart. */
  readonly labels: readonly string[];
  /** Thresholds of the affect gate. */
  readonly gate: GateLevels;
  /** Thresholds of the decision. */
  readonly decide: DecideLevels;
  /** What the server takes. */
  readonly limits: Limits;
  /** Models in use. */
  readonly models: readonly ModelInfo[];
  /** The room, after differences were settled. */
  readonly scene: SceneState;
  /** On what the renderer's `objects` and the room did not agree. */
  readonly differences: readonly Difference[];
}

/** Something that the client sent was refused, or something went wrong. */
export interface ErrorMessage {
  readonly type: "error";
  /** Name of the mistake; docs/protocol.md lists them. (1..64 characters) */
  readonly code: string;
  /** What was expected, what was got, and what to do. */
  readonly message: string;
  /** Path of the field, for example `joints[3][1]`. */
  readonly field: string | null;
  /** Whether the connection closes now. Default: `false`. */
  readonly fatal: boolean;
}

/** One action of a reaction. */
export interface StepMessage {
  /** What to do, a step of the rule file. (1..64 characters) */
  readonly action: string;
  /** Nominal time that it takes. (s, 0..1000000000) */
  readonly duration_s: number;
  /** Object that it is done to. (1..64 characters) */
  readonly target: string | null;
}

/** An order to the renderer, carried out once whatever happens to the connection. */
export interface CommandMessage {
  readonly type: "command";
  /** Identity: the same id is carried out once. (1..160 characters) */
  readonly id: string;
  /** Counts the commands of a ledger from 1. (count, 0..2^53 - 1) */
  readonly sequence: number;
  /** Epoch in which it is sent. (at most 64 characters) */
  readonly epoch: string;
  /** Name of the reaction, for example `close_window`. (1..64 characters) */
  readonly reaction: string;
  /** Gesture or event that caused it. (1..64 characters) */
  readonly cause: string;
  /** What to do, in order. */
  readonly steps: readonly StepMessage[];
  /** Higher goes first. (0..1000) */
  readonly priority: number;
  /** Capture time of the last frame that led to it. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** When it was issued, on the session's time line. (ns, 0..2^53 - 1) */
  readonly issued_ns: number;
  /** It is not to be started later than this after it was issued. (ms, 0..1000000000000) */
  readonly ttl_ms: number;
  /** Command that is cut short by this one. (1..160 characters) */
  readonly preempts: string | null;
  /** Time since it was issued, when it is sent again. (ms, 0..1000000000000) Default: `0`. */
  readonly age_ms: number;
  /**
   * The server's monotonic clock when it was decided, as in pongs. (ns, 0..2^53 - 1) Default: `0`.
   */
  readonly server_ns: number;
  /**
   * `generated`: for a renderer with the capability `pose_stream` a motion follows that is made
   * while it plays; until it comes, and after it, the steps look as authored. Default:
   * `"authored"`.
   */
  readonly motion: Motion;
}

/** Telemetry that this client was too slow for since the last message of this kind. */
export interface Missed {
  readonly type: "missed";
  /** How many messages of each kind were replaced by newer ones. (count, 0..2^53 - 1) */
  readonly topics: Readonly<Record<string, number>>;
}

/** The nine core joints as observed, at 25 Hz. */
export interface PoseMessage {
  readonly type: "pose";
  /** Capture time. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Whose body it is. (0..2^53 - 1) */
  readonly body_id: number;
  /**
   * x, y, z and confidence of each core joint, in the camera frame. (m, -60000..60000, then 0..1)
   */
  readonly joints: readonly JointSample[];
}

/** One of several futures that are drawn beside the forecast. */
export interface FutureBody {
  /** How probably it is a real motion. (0..1) */
  readonly quality: number;
  /**
   * 10 frames at 5 Hz of the nine core joints' x, y, z, in the camera frame; the first is 0.2 s
   * after the window. (m, -60000..60000)
   */
  readonly positions: readonly (readonly Point[])[];
}

/** The motion that is expected after a window. */
export interface ForecastMessage {
  readonly type: "forecast";
  /** Index of the window. (count, 0..2^53 - 1) */
  readonly window: number;
  /** Capture time of the window's last frame. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** Bundle that made it, or `last_frame` where it failed. (at most 64 characters) */
  readonly source: string;
  /**
   * 50 frames at 25 Hz of the nine core joints' x, y, z, in the camera frame. (m, -60000..60000)
   */
  readonly positions: readonly (readonly Point[])[];
  /** What else may follow, where several futures are drawn; none of low quality. */
  readonly futures: readonly FutureBody[];
}

/** The affect that the gate goes by. */
export interface AffectTelemetry {
  readonly type: "affect_state";
  /** Capture time of the face. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** From unpleasant to pleasant. (-10..10) */
  readonly valence: number;
  /** From calm to excited. (-10..10) */
  readonly arousal: number;
  /** Standard deviation of an estimate. (0..20) */
  readonly valence_sd: number | null;
  /** Standard deviation of an estimate. (0..20) */
  readonly arousal_sd: number | null;
  /**
   * `client` for affect that came in as such, else what it was estimated from: `mesh`, `points68`
   * or `blendshapes`. (at most 64 characters) Default: `"client"`.
   */
  readonly source: string;
  /** How far an average lags behind the face. (ms, 0..1000000000000) */
  readonly delay_ms: number | null;
}

/** What the person's neutral face is held to be; also the answer to `calibrate`. */
export interface CalibrationState {
  readonly type: "calibration_state";
  /** Valence of the neutral face. (-10..10) */
  readonly valence: number;
  /** Arousal of the neutral face. (-10..10) */
  readonly arousal: number;
  /** Faces that were seen for it. (count, 0..2^53 - 1) */
  readonly faces: number;
  /** False when too few faces were seen; what was in force still is. */
  readonly is_done: boolean;
}

/**
 * What became of a command.
 *
 * Besides the renderer's own words the server says how a command ended: `expired`, `preempted`,
 * `timed_out` (the renderer fell silent) or `assumed` (done by its nominal time, since nobody
 * carried it out).
 */
export interface AckTelemetry {
  readonly type: "ack_state";
  /** Which command. (1..160 characters) */
  readonly command_id: string;
  /** A status of `ack`, or how the server ended it. (1..64 characters) */
  readonly status: string;
  /** Index of the step that has ended. (0..1000) */
  readonly step: number | null;
  /** Why it failed. */
  readonly reason: string | null;
}

/** How far the window could be trusted. */
export interface QualityBody {
  /** Share of joint samples that were tracked. (0..1) */
  readonly measured: number;
  /** Share of joint samples that repeat a last known position. (0..1) */
  readonly filled: number;
  /** Largest relative deviation of a bone's length. (0..1000000) */
  readonly bone_deviation: number;
  /** Names of what looks wrong. */
  readonly warnings: readonly string[];
}

/** What the affect gate said; numbers are null without a usable face, or gaze. */
export interface GateBody {
  /** `required`, `optional`, `off`, `thesis` or `gaze`. (at most 64 characters) */
  readonly mode: string;
  /** Whether a discomfort may pass. */
  readonly is_open: boolean;
  /** Why, in a few words. */
  readonly reason: string;
  /** Of the face that was used. (-10..10) */
  readonly valence: number | null;
  /** Of the face that was used. (-10..10) */
  readonly arousal: number | null;
  /**
   * Time from the face, or gaze, to the end of the window; negative if newer. (ms,
   * -10000000000000..10000000000000)
   */
  readonly age_ms: number | null;
  /** `paired`, `skewed`, `stale`, `missing` or `not_needed`. (at most 64 characters) */
  readonly face: string | null;
  /** What valence and arousal come from. (at most 64 characters) */
  readonly source: string | null;
  /** Angle from the gaze to the agent. (deg, 0..180) */
  readonly gaze_deg: number | null;
}

/** What the room said to the gesture. */
export interface SceneBody {
  /** What the agent was doing. (at most 64 characters) */
  readonly mode: string;
  /** The rule, for example `cold -> close_window`. */
  readonly rule: string | null;
  /** What must hold for it. */
  readonly precondition: string | null;
  /** Whether it held. */
  readonly met: boolean;
  /** Why, in a few words. */
  readonly reason: string;
}

/** The command in a decision, without what only its delivery knows. */
export interface CommandBody {
  /** Identity. (1..160 characters) */
  readonly id: string;
  /** Counts the commands of a ledger from 1. (count, 0..2^53 - 1) */
  readonly sequence: number;
  /** Name of the reaction. (1..64 characters) */
  readonly reaction: string;
  /** Gesture or event that caused it. (1..64 characters) */
  readonly cause: string;
  /** What to do, in order. */
  readonly steps: readonly StepMessage[];
  /** Higher goes first. (0..1000) */
  readonly priority: number;
  /** Command that is cut short by this one. (1..160 characters) */
  readonly preempts: string | null;
  /** Capture time of the last frame that led to it. (ns, 0..2^53 - 1) */
  readonly originating_ns: number;
  /** When it was issued, on the session's time line. (ns, 0..2^53 - 1) */
  readonly issued_ns: number;
  /** It is not to be started later than this after it was issued. (ms, 0..1000000000000) */
  readonly ttl_ms: number;
  /** How the agent moves: as authored, or generated. Default: `"authored"`. */
  readonly motion: Motion;
}

/** How far several futures of the window disagree. */
export interface FuturesBody {
  /** Futures that were classified, the forecast among them. (count, 0..2^53 - 1) */
  readonly classified: number;
  /** Drawn futures that were left out for their quality. (count, 0..2^53 - 1) */
  readonly left_out: number;
  /** Standard deviation of each gesture's probability over the futures. (0..1) */
  readonly spread: Readonly<Record<string, number>>;
}

/** A decision with its reasons. Deterministic: the line of a decision log. */
export interface DecisionBody {
  /** Identity: session and index. (1..160 characters) */
  readonly id: string;
  /** Counts the session's decisions from 0. (count, 0..2^53 - 1) */
  readonly index: number;
  /** Index of the window. (count, 0..2^53 - 1) */
  readonly window: number;
  /** Capture time of the window's first frame. (ns, 0..2^53 - 1) */
  readonly start_ns: number;
  /** Capture time of the window's last frame. (ns, 0..2^53 - 1) */
  readonly end_ns: number;
  /** Whose motion it is. (0..2^53 - 1) */
  readonly body_id: number;
  /** Hash of each model that took part, by its name. */
  readonly models: Readonly<Record<string, string>>;
  /** How far the window could be trusted. */
  readonly quality: QualityBody;
  /** Bundle that made the forecast, or `last_frame`. (at most 64 characters) */
  readonly forecast: string;
  /** Why the predictor could not be used. */
  readonly forecast_failure: string | null;
  /** Probability of each gesture, over several futures their mean. (0..1) */
  readonly probabilities: Readonly<Record<string, number>>;
  /** What is held to be going on. (1..64 characters) */
  readonly gesture: string;
  /** What the affect gate said. */
  readonly gate: GateBody;
  /** What the room said, if it was asked. */
  readonly scene: SceneBody | null;
  /**
   * `command`, `idle`, `unsure`, `cooling_down`, `handled`, `gated`, `busy` or `nothing_to_do`. (at
   * most 64 characters)
   */
  readonly outcome: string;
  /** Why, in a sentence. */
  readonly reason: string;
  /** The command that follows. */
  readonly command: CommandBody | null;
  /** How far several futures disagree; absent for one. */
  readonly futures: FuturesBody | null;
}

/** Where the time of one decision went, and when it was made. */
export interface Timing {
  /** Wall time in ISO 8601. (at most 64 characters) */
  readonly wall: string;
  /** From the last frame's arrival to the models' start. (ms, 0..1000000000000) */
  readonly wait_ms: number;
  /** The predictor. (ms, 0..1000000000000) */
  readonly predict_ms: number;
  /** The classifier. (ms, 0..1000000000000) */
  readonly classify_ms: number;
  /** Gate, decision and room. (ms, 0..1000000000000) */
  readonly decide_ms: number;
  /** From the last frame's arrival to the decision. (ms, 0..1000000000000) */
  readonly total_ms: number;
}

/** One decision and its timing. */
export interface DecisionMessage {
  readonly type: "decision";
  /** The decision with its reasons. */
  readonly decision: DecisionBody;
  /** Where its time went. */
  readonly timing: Timing;
}

/** One connection of the session. */
export interface ClientStats {
  /** What it came as. */
  readonly role: Role;
  /** What it calls itself. (1..64 characters) */
  readonly client: string;
  /** Round trip of its pings, smoothed; null before the first. (ms, 0..1000000000000) */
  readonly round_trip_ms: number | null;
  /**
   * Its clock less the server's, smoothed; null before the first ping. (ms,
   * -10000000000000..10000000000000)
   */
  readonly offset_ms: number | null;
  /** Telemetry that it was too slow for. (count, 0..2^53 - 1) */
  readonly missed: number;
}

/** How good the forecasts were whose two seconds have come within the last minute. */
export interface ForecastScoreBody {
  /** Mean distance of the joints. (mm, 0..1000000) */
  readonly error_mm: number;
  /** The same for a body that stands still from then on. (mm, 0..1000000) */
  readonly zero_velocity_mm: number;
  /** How many were scored. (count, 0..2^53 - 1) */
  readonly forecasts: number;
}

/** The session's counters since its start. */
export interface StatsMessage {
  readonly type: "stats";
  /** Skeleton frames taken. (count, 0..2^53 - 1) */
  readonly frames: number;
  /** Windows made of them. (count, 0..2^53 - 1) */
  readonly windows: number;
  /** Decisions made. (count, 0..2^53 - 1) */
  readonly decisions: number;
  /** Commands issued. (count, 0..2^53 - 1) */
  readonly commands: number;
  /** Windows whose place a newer one took. (count, 0..2^53 - 1) */
  readonly skipped_windows: number;
  /** Windows whose forecast failed. (count, 0..2^53 - 1) */
  readonly predictor_failures: number;
  /** Messages that were refused. (count, 0..2^53 - 1) */
  readonly rejected_messages: number;
  /** Telemetry that monitors were too slow for. (count, 0..2^53 - 1) */
  readonly missed_telemetry: number;
  /** Everything else that is counted, by its name. (count, 0..2^53 - 1) */
  readonly counters: Readonly<Record<string, number>>;
  /** The session's connections. */
  readonly clients: readonly ClientStats[];
  /** How good the forecasts of the last minute were. */
  readonly forecast_score: ForecastScoreBody | null;
}

/**
 * A stretch of a generated motion for the agent to play (JSON coding).
 *
 * A renderer without the capability `pose_stream` never gets one. Frames of a command come in order
 * and without gaps; where one is missing, nothing more is to be played. The authored motion stands
 * in before the first stretch, after the last, and where none comes.
 */
export interface PoseStreamMessage {
  readonly type: "pose_stream";
  /** Command that the motion belongs to. (1..160 characters) */
  readonly command_id: string;
  /** Index of the first frame. (count, 0..1000000000) */
  readonly first_frame: number;
  /** Frames a second. (Hz, above 0, at most 240) */
  readonly rate_hz: number;
  /** Names of the joints, in order. (1..64 characters, at most 64 items) */
  readonly joints: readonly string[];
  /**
   * Every joint's x, y, z in each frame; right-handed, y up, z forward out of the agent, origin on
   * the floor below its hips at the command's start. (m, -60000..60000, at most 250 items)
   */
  readonly positions: readonly (readonly Point[])[];
  /** Whether the motion ends with this stretch. Default: `false`. */
  readonly is_last: boolean;
  /** Why nothing more of it is good: the authored motion stands in. */
  readonly fallback: string | null;
}

/** A stretch of a generated motion for the agent to play (MessagePack coding). */
export interface PackedPoseStreamMessage {
  readonly type: "pose_stream";
  /** Command that the motion belongs to. (1..160 characters) */
  readonly command_id: string;
  /** Index of the first frame. (count, 0..1000000000) */
  readonly first_frame: number;
  /** Frames a second. (Hz, above 0, at most 240) */
  readonly rate_hz: number;
  /** Names of the joints, in order. (1..64 characters, at most 64 items) */
  readonly joints: readonly string[];
  /**
   * Every joint's x, y, z in each frame, as in the JSON coding. (m, float32, little-endian, three a
   * joint, joints of a frame together, at most 192000 bytes)
   */
  readonly positions: Uint8Array;
  /** Whether the motion ends with this stretch. Default: `false`. */
  readonly is_last: boolean;
  /** Why nothing more of it is good: the authored motion stands in. */
  readonly fallback: string | null;
}

/** What a client sends in the JSON coding. */
export type ClientMessage =
  | Hello
  | Ping
  | Pong
  | Affect
  | Blendshapes
  | Gaze
  | Calibrate
  | AckMessage
  | SceneEvent
  | Skeleton
  | FacePoints;

/** What it sends in MessagePack. */
export type PackedClientMessage =
  | Hello
  | Ping
  | Pong
  | Affect
  | Blendshapes
  | Gaze
  | Calibrate
  | AckMessage
  | SceneEvent
  | PackedSkeleton
  | PackedFacePoints
  | Image;

/** What a server sends in the JSON coding. */
export type ServerMessage =
  | Welcome
  | ErrorMessage
  | Ping
  | Pong
  | CommandMessage
  | SceneState
  | Missed
  | PoseMessage
  | ForecastMessage
  | AffectTelemetry
  | CalibrationState
  | AckTelemetry
  | DecisionMessage
  | StatsMessage
  | PoseStreamMessage;

/** What it sends in MessagePack. */
export type PackedServerMessage =
  | Welcome
  | ErrorMessage
  | Ping
  | Pong
  | CommandMessage
  | SceneState
  | Missed
  | PoseMessage
  | ForecastMessage
  | AffectTelemetry
  | CalibrationState
  | AckTelemetry
  | DecisionMessage
  | StatsMessage
  | PackedPoseStreamMessage;
