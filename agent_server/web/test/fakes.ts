/** A host with a clock that tests own, and messages as a server would send them. */

import type { Listener } from "../src/net/connection.ts";
import type { Host, Socket, SocketEvents } from "../src/net/host.ts";
import type { Status } from "../src/net/status.ts";
import type { Incoming } from "../src/protocol/codec.ts";
import type {
  AckTelemetry,
  AffectTelemetry,
  CommandBody,
  CommandMessage,
  DecisionBody,
  DecisionMessage,
  ErrorMessage,
  SceneState,
  Welcome,
} from "../src/protocol/messages.ts";

interface Timer {
  readonly at: number;
  readonly callback: () => void;
}

export class FakeSocket implements Socket {
  readonly sent: Record<string, unknown>[] = [];
  readonly sentBytes: Uint8Array[] = [];
  backlog = 0;
  isClosed = false;
  closeCode: number | undefined;
  readonly url: string;
  readonly subprotocol: string;
  readonly events: SocketEvents;

  constructor(url: string, subprotocol: string, events: SocketEvents) {
    this.url = url;
    this.subprotocol = subprotocol;
    this.events = events;
  }

  send(data: string | Uint8Array): void {
    if (typeof data === "string") this.sent.push(JSON.parse(data) as Record<string, unknown>);
    else this.sentBytes.push(data);
  }

  close(code?: number): void {
    this.isClosed = true;
    this.closeCode = code;
  }

  /** The server speaks. */
  say(message: object): void {
    this.events.onMessage(JSON.stringify(message));
  }
}

export class FakeHost implements Host {
  time = 0;
  chance = 0.5;
  /** Set to make the next attempts throw at once. */
  isForbidden = false;
  readonly sockets: FakeSocket[] = [];
  #timers: Timer[] = [];

  open(url: string, subprotocol: string, events: SocketEvents): Socket {
    if (this.isForbidden) throw new Error("forbidden");
    const socket = new FakeSocket(url, subprotocol, events);
    this.sockets.push(socket);
    return socket;
  }

  now = (): number => this.time;

  random = (): number => this.chance;

  after(delayMs: number, callback: () => void): () => void {
    const timer = { at: this.time + delayMs, callback };
    this.#timers.push(timer);
    return () => {
      this.#timers = this.#timers.filter((other) => other !== timer);
    };
  }

  /** Let time pass, ringing every timer on the way. */
  pass(ms: number): void {
    const end = this.time + ms;
    for (;;) {
      const [next] = this.#timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at);
      if (next === undefined) break;
      this.#timers = this.#timers.filter((other) => other !== next);
      this.time = next.at;
      next.callback();
    }
    this.time = end;
  }

  get socket(): FakeSocket {
    const last = this.sockets.at(-1);
    if (last === undefined) throw new Error("no socket was opened");
    return last;
  }
}

export class FakeListener implements Listener {
  readonly messages: Incoming[] = [];
  readonly statuses: Status[] = [];
  readonly jumps: number[] = [];
  readonly unreadable: (string | null)[] = [];

  onMessage(message: Incoming): void {
    this.messages.push(message);
  }

  onStatus(status: Status): void {
    this.statuses.push(status);
  }

  onClockJump(byMs: number): void {
    this.jumps.push(byMs);
  }

  onUnreadable({ field }: { readonly field: string | null }): void {
    this.unreadable.push(field);
  }
}

export const SCENE: SceneState = {
  type: "scene",
  mode: "working",
  objects: { window: "open", curtain: "open" },
  command_id: null,
};

export const WELCOME: Welcome = {
  type: "welcome",
  protocol: "1.0",
  server: "agent-server",
  server_version: "0.1.0",
  session: "demo",
  role: "monitor",
  epoch: "first",
  ledger: "book",
  resumed: false,
  sequence: 0,
  heartbeat_s: 2,
  labels: ["cold", "hot", "loud", "smell", "bright", "hello", "idle"],
  gate: {
    mode: "required",
    enter_valence: -3,
    enter_arousal: 3,
    leave_valence: -2,
    leave_arousal: 2,
  },
  decide: { enter: { cold: 0.65 }, leave: 0.4 },
  limits: { max_message_bytes: 65_536, max_image_bytes: 524_288, max_errors: 20 },
  models: [],
  scene: SCENE,
  differences: [],
};

export const COMMAND: CommandBody = {
  id: "demo-c1",
  sequence: 1,
  reaction: "close_window",
  cause: "cold",
  steps: [
    { action: "stand_up", duration_s: 1, target: null },
    { action: "close", duration_s: 2, target: "window" },
  ],
  priority: 2,
  preempts: null,
  originating_ns: 1,
  issued_ns: 2,
  ttl_ms: 3000,
  motion: "authored",
};

/** The command as it comes to a renderer. */
export function commanded(change: Partial<CommandMessage> = {}): CommandMessage {
  return { type: "command", epoch: "first", age_ms: 0, server_ns: 0, ...COMMAND, ...change };
}

export function ackState(status: string, change: Partial<AckTelemetry> = {}): AckTelemetry {
  const command_id = COMMAND.id;
  return { type: "ack_state", command_id, status, step: null, reason: null, ...change };
}

export function affectState(stampMs: number, valence: number, arousal: number): AffectTelemetry {
  return {
    type: "affect_state",
    originating_ns: stampMs * 1e6,
    valence,
    arousal,
    valence_sd: null,
    arousal_sd: null,
    source: "client",
    delay_ms: null,
  };
}

export function error(code: string, message = "m"): ErrorMessage {
  return { type: "error", code, message, field: null, fatal: false };
}

export function decision(index: number, change: Partial<DecisionBody> = {}): DecisionMessage {
  return {
    type: "decision",
    decision: {
      id: `demo-${index}`,
      index,
      window: index,
      start_ns: index * 2e8,
      end_ns: index * 2e8 + 96e7,
      body_id: 7,
      models: { predictor: "0123456789ab" },
      futures: null,
      quality: { measured: 1, filled: 0, bone_deviation: 0.02, warnings: [] },
      forecast: "predictor",
      forecast_failure: null,
      probabilities: { cold: 0.1, idle: 0.9 },
      gesture: "idle",
      gate: {
        mode: "required",
        is_open: false,
        reason: "the face looks pleased",
        valence: 2,
        arousal: 1,
        age_ms: 40,
        face: "paired",
        source: "mesh",
        gaze_deg: null,
      },
      scene: null,
      outcome: "idle",
      reason: "nothing is going on",
      command: null,
      ...change,
    },
    timing: {
      wall: "2024-01-01T00:00:00Z",
      wait_ms: 0.1,
      predict_ms: 0.8,
      classify_ms: 0.5,
      decide_ms: 0.1,
      total_ms: 1.6,
    },
  };
}
