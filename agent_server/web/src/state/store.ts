/**
 * What the page knows of the session: the latest of each kind of telemetry, and the log.
 *
 * Time is passed in (`now`, the page's clock in milliseconds), so that tests and `?step` own it.
 */

import type { Incoming } from "../protocol/codec.ts";
import type {
  AffectTelemetry,
  CommandBody,
  DecisionMessage,
  ErrorMessage,
  ForecastMessage,
  PoseMessage,
  SceneState,
  StatsMessage,
  Welcome,
} from "../protocol/messages.ts";
import { DecisionLog } from "./log.ts";
import { acknowledged, isOddEnd, type Running } from "./running.ts";

/** A value and when the page got it. */
export interface Timed<T> {
  readonly value: T;
  readonly at: number;
}

/** What is known of the person at one instant. */
export interface Moment {
  readonly pose: Timed<PoseMessage> | null;
  readonly forecast: Timed<ForecastMessage> | null;
  /** Recent affect, oldest first; the last entry is the present one. */
  readonly affect: readonly Timed<AffectTelemetry>[];
  readonly decision: Timed<DecisionMessage> | null;
}

const TRAIL_MS = 4_000;
const RATE_SPAN_NS = 2e9;
const ERRORS_KEPT = 5;

export class Store implements Moment {
  welcome: Welcome | null = null;
  scene: Timed<SceneState> | null = null;
  pose: Timed<PoseMessage> | null = null;
  forecast: Timed<ForecastMessage> | null = null;
  /** Recent affect, oldest first; the last entry is the present one. */
  affect: readonly Timed<AffectTelemetry>[] = [];
  decision: Timed<DecisionMessage> | null = null;
  running: Running | null = null;
  stats: StatsMessage | null = null;
  errors: readonly ErrorMessage[] = [];
  /** When each object of the room last changed, on the page's clock. */
  changedAt: ReadonlyMap<string, number> = new Map();
  /** Grows with every message, so that a view can tell whether anything is new. */
  revision = 0;

  readonly log = new DecisionLog();
  #poseStamps: number[] = [];

  apply(message: Incoming, now: number): void {
    this.revision += 1;
    switch (message.type) {
      case "welcome":
        if (this.welcome?.epoch !== message.epoch || this.welcome.session !== message.session) {
          this.#forget();
        }
        this.welcome = message;
        this.#setScene(message.scene, now);
        break;
      case "pose":
        this.#countPose(message);
        this.pose = { value: message, at: now };
        break;
      case "forecast":
        this.forecast = { value: message, at: now };
        break;
      case "affect_state":
        this.affect = [
          ...this.affect.filter(({ at }) => now - at <= TRAIL_MS),
          { value: message, at: now },
        ];
        break;
      case "decision":
        this.decision = { value: message, at: now };
        this.log.addDecision(message);
        if (message.decision.command !== null) this.#order(message.decision.command, now);
        break;
      case "command":
        this.log.addCommand(message);
        this.#order(message, now);
        break;
      case "ack_state":
        if (this.running?.command.id === message.command_id) {
          this.running = acknowledged(this.running, message);
        }
        if (isOddEnd(message)) this.log.addEnd(message);
        break;
      case "scene":
        this.#setScene(message, now);
        break;
      case "stats":
        this.stats = message;
        break;
      case "error":
        this.errors = [...this.errors, message].slice(-ERRORS_KEPT);
        this.log.addError(message);
        break;
      case "missed":
        this.log.addMissed(message.topics);
        break;
    }
  }

  /** Poses a second over the last two seconds of the session's own time; null below two poses. */
  get poseRateHz(): number | null {
    const [first] = this.#poseStamps;
    const last = this.#poseStamps.at(-1);
    if (first === undefined || last === undefined || last <= first) return null;
    return ((this.#poseStamps.length - 1) * 1e9) / (last - first);
  }

  #countPose({ originating_ns: stamp, body_id: body }: PoseMessage): void {
    const before = this.pose?.value;
    if (before !== undefined && (stamp < before.originating_ns || body !== before.body_id)) {
      this.#poseStamps = [];
    }
    this.#poseStamps.push(stamp);
    while ((this.#poseStamps[0] ?? stamp) < stamp - RATE_SPAN_NS) this.#poseStamps.shift();
  }

  #setScene(scene: SceneState, now: number): void {
    const before = this.scene?.value.objects;
    if (before !== undefined) {
      const changed = Object.keys(scene.objects).filter((o) => before[o] !== scene.objects[o]);
      if (changed.length > 0) {
        this.changedAt = new Map([...this.changedAt, ...changed.map((o) => [o, now] as const)]);
      }
    }
    this.scene = { value: scene, at: now };
  }

  #order(command: CommandBody, now: number): void {
    if (this.running?.command.id === command.id) return;
    this.running = { command, at: now, status: null, step: null, reason: null };
  }

  /** Another server process, or another session: nothing of before holds any more. */
  #forget(): void {
    this.scene = this.pose = this.forecast = this.decision = this.running = this.stats = null;
    this.affect = [];
    this.errors = [];
    this.changedAt = new Map();
    this.#poseStamps = [];
    this.log.clear();
  }
}
