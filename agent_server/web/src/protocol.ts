/**
 * The part of protocol 1 that a monitor and a camera speak, as `agent_server/protocol/messages.py`
 * has it.
 *
 * Time stamps (`*_ns`) are integer nanoseconds on the session's time line, below 2^53. Positions
 * are metres in the camera frame: y up, z away from the sensor, the person's right at larger x.
 * Valence and arousal lie in [-10, 10]. Optional fields are left out when they hold their default.
 */

export const PROTOCOL = "1.0";
export const PROTOCOL_MAJOR = 1;
export const SUBPROTOCOL = "agent-server.v1.json";

export const CLOSE_WRONG_VERSION = 4401;
export const CLOSE_REPLACED = 4409;

export type Point = readonly [number, number, number];
/** x, y, z and the confidence in [0, 1]. */
export type JointSample = readonly [number, number, number, number];

export interface Hello {
  readonly type: "hello";
  readonly protocol: string;
  readonly client: string;
  readonly client_version: string;
  readonly token?: string;
  /** Sensors: a face follows. */
  readonly face?: "expected";
  /** Sensors: replace the one that sends the same. */
  readonly take_over?: boolean;
}

/** The landmarks of one face, x, y, z each, in pixels of the picture. */
export interface FacePoints {
  readonly type: "face";
  readonly format: "mesh478";
  readonly width: number;
  readonly height: number;
  readonly points: readonly (readonly number[])[];
  readonly originating_ns: number;
}

/** The next seconds show a neutral face, or this is what an earlier one came to. */
export type Calibrate = {
  readonly type: "calibrate";
  readonly originating_ns: number;
} & ({ readonly seconds: number } | { readonly valence: number; readonly arousal: number });

/** What the person's neutral face is held to be. */
export interface CalibrationState {
  readonly type: "calibration_state";
  readonly valence: number;
  readonly arousal: number;
  readonly faces: number;
  /** False when too few faces were seen; what was in force is in force still. */
  readonly is_done: boolean;
}

export interface Ping {
  readonly type: "ping";
  readonly sent_ns: number;
}

export interface Pong {
  readonly type: "pong";
  readonly sent_ns: number;
  readonly time_ns: number;
}

export interface ModelInfo {
  readonly name: string;
  readonly task: string;
  readonly sha256: string;
}

export interface GateLevels {
  readonly mode: string;
  readonly enter_valence: number;
  readonly enter_arousal: number;
  readonly leave_valence: number;
  readonly leave_arousal: number;
}

/** Probability from which a gesture is a candidate, and below which one that goes on ends. */
export interface DecideLevels {
  readonly enter: Readonly<Record<string, number>>;
  readonly leave: number;
}

export interface SceneState {
  readonly type: "scene";
  readonly mode: string;
  readonly objects: Readonly<Record<string, string>>;
  readonly command_id?: string | null;
}

export interface Welcome {
  readonly type: "welcome";
  readonly protocol: string;
  readonly server: string;
  readonly server_version: string;
  readonly session: string;
  readonly role: string;
  readonly epoch: string;
  readonly sequence: number;
  readonly heartbeat_s: number;
  readonly labels: readonly string[];
  readonly gate: GateLevels;
  readonly decide?: DecideLevels;
  readonly models: readonly ModelInfo[];
  readonly scene: SceneState;
}

export interface ErrorMessage {
  readonly type: "error";
  readonly code: string;
  readonly message: string;
  readonly field?: string | null;
  readonly fatal?: boolean;
}

export interface Step {
  readonly action: string;
  readonly duration_s: number;
  readonly target?: string | null;
}

/** What a command in a decision and one on its way to the renderer have in common. */
export interface CommandBody {
  readonly id: string;
  readonly sequence: number;
  readonly reaction: string;
  readonly cause: string;
  readonly steps: readonly Step[];
  readonly priority: number;
  readonly originating_ns: number;
  readonly issued_ns: number;
  readonly ttl_ms: number;
  readonly preempts?: string | null;
}

export interface CommandMessage extends CommandBody {
  readonly type: "command";
  readonly epoch: string;
}

export interface PoseMessage {
  readonly type: "pose";
  readonly originating_ns: number;
  readonly body_id: number;
  readonly joints: readonly JointSample[];
}

export interface ForecastMessage {
  readonly type: "forecast";
  readonly window: number;
  readonly originating_ns: number;
  readonly source: string;
  /** 50 frames of nine points at 25 Hz. */
  readonly positions: readonly (readonly Point[])[];
}

export interface AffectTelemetry {
  readonly type: "affect_state";
  readonly originating_ns: number;
  readonly valence: number;
  readonly arousal: number;
  /** Standard deviations, where the server estimated it. */
  readonly valence_sd?: number | null;
  readonly arousal_sd?: number | null;
  /** What it was estimated from; a client's own word without it. */
  readonly source?: string;
}

export interface AckTelemetry {
  readonly type: "ack_state";
  readonly command_id: string;
  readonly status: string;
  readonly step?: number | null;
  readonly reason?: string | null;
}

export interface Quality {
  readonly measured: number;
  readonly filled: number;
  readonly bone_deviation: number;
  readonly warnings: readonly string[];
}

export interface GateVerdict {
  readonly mode: string;
  readonly is_open: boolean;
  readonly reason: string;
  readonly valence: number | null;
  readonly arousal: number | null;
  readonly age_ms: number | null;
}

export interface SceneVerdict {
  readonly mode: string;
  readonly rule: string | null;
  readonly precondition: string | null;
  readonly met: boolean;
  readonly reason: string;
}

export interface Decision {
  readonly id: string;
  readonly index: number;
  readonly window: number;
  readonly start_ns: number;
  readonly end_ns: number;
  readonly body_id: number;
  readonly models: Readonly<Record<string, string>>;
  readonly quality: Quality;
  readonly forecast: string;
  readonly forecast_failure: string | null;
  readonly probabilities: Readonly<Record<string, number>>;
  readonly gesture: string;
  readonly gate: GateVerdict;
  readonly scene: SceneVerdict | null;
  readonly outcome: string;
  readonly reason: string;
  readonly command: CommandBody | null;
}

export interface Timing {
  readonly wall: string;
  readonly wait_ms: number;
  readonly predict_ms: number;
  readonly classify_ms: number;
  readonly decide_ms: number;
  readonly total_ms: number;
}

export interface DecisionMessage {
  readonly type: "decision";
  readonly decision: Decision;
  readonly timing: Timing;
}

export interface StatsMessage {
  readonly type: "stats";
  readonly frames: number;
  readonly windows: number;
  readonly decisions: number;
  readonly commands: number;
  readonly skipped_windows: number;
  readonly predictor_failures: number;
  readonly rejected_messages: number;
  readonly missed_telemetry: number;
  readonly counters: Readonly<Record<string, number>>;
}

export type Telemetry =
  | CommandMessage
  | SceneState
  | PoseMessage
  | ForecastMessage
  | AffectTelemetry
  | CalibrationState
  | AckTelemetry
  | DecisionMessage
  | StatsMessage;

export type ServerMessage = Welcome | ErrorMessage | Ping | Pong | Telemetry;

/** One session in the answer to `GET v1/sessions`. */
export interface SessionInfo {
  readonly id: string;
  readonly sensor: boolean;
}

/** Index of each core joint in every array of nine. */
export const JOINT = {
  head: 0,
  neck: 1,
  navel: 2,
  leftShoulder: 3,
  leftElbow: 4,
  leftWrist: 5,
  rightShoulder: 6,
  rightElbow: 7,
  rightWrist: 8,
} as const;

export const JOINTS = 9;

/** (parent, child) of the eight bones, outwards from the navel. */
export const BONES: readonly (readonly [number, number])[] = [
  [JOINT.navel, JOINT.neck],
  [JOINT.neck, JOINT.head],
  [JOINT.neck, JOINT.leftShoulder],
  [JOINT.leftShoulder, JOINT.leftElbow],
  [JOINT.leftElbow, JOINT.leftWrist],
  [JOINT.neck, JOINT.rightShoulder],
  [JOINT.rightShoulder, JOINT.rightElbow],
  [JOINT.rightElbow, JOINT.rightWrist],
];

/**
 * Read one text message.
 *
 * @returns The message, or null for text that is no tagged JSON object. A type that this page
 *   does not know is passed on: a minor version of the protocol may add some.
 */
export function parseMessage(text: string): ServerMessage | null {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return null;
  }
  if (typeof value !== "object" || value === null || !("type" in value)) return null;
  return typeof value.type === "string" ? (value as ServerMessage) : null;
}
