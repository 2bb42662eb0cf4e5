/**
 * A client's side of one session: says hello, keeps the connection alive, comes back after a
 * loss. It knows no browser: sockets, timers, clock and chance come from a {@link Host}.
 */

import {
  CLOSE_WRONG_VERSION,
  PROTOCOL,
  PROTOCOL_MAJOR,
  SUBPROTOCOL,
  parseMessage,
  type ErrorMessage,
  type Hello,
  type ServerMessage,
} from "../protocol.ts";
import { BACKOFF_CAP_MS, fullJitter } from "./backoff.ts";

export interface Socket {
  send(data: string | Uint8Array<ArrayBuffer>): void;
  /** Bytes that were sent and have not left yet. */
  readonly backlog: number;
  close(): void;
}

export interface SocketEvents {
  onOpen(): void;
  onText(text: string): void;
  onClose(code: number, reason: string): void;
}

export interface Host {
  /** Open a websocket; may throw when the address is refused outright. */
  open(url: string, subprotocol: string, events: SocketEvents): Socket;
  /** Monotonic time in milliseconds. */
  now(): number;
  /** Call back once after a delay; the returned function cancels it. */
  after(delayMs: number, callback: () => void): () => void;
  /** Uniform in [0, 1). */
  random(): number;
}

export type Phase = "stopped" | "opening" | "greeting" | "live" | "waiting";

/** Why there is no live connection. */
export type Fault =
  | { readonly kind: "unreachable" }
  | { readonly kind: "lost"; readonly code: number; readonly reason: string }
  | { readonly kind: "silent" }
  | { readonly kind: "refused"; readonly code: string; readonly message: string }
  | { readonly kind: "version"; readonly message: string };

export interface Status {
  readonly phase: Phase;
  /** Why the last connection ended; null while all is well. */
  readonly fault: Fault | null;
  /** When the next attempt starts on the host's clock; null unless waiting. */
  readonly retryAt: number | null;
  /** Time from a ping to its pong, or null before the first one. */
  readonly roundTripMs: number | null;
}

export interface Listener {
  onMessage(message: ServerMessage): void;
  onStatus(status: Status): void;
}

/** How the page introduces itself. */
export interface Client {
  readonly name: string;
  readonly version: string;
  readonly token: string | null;
  /** What a sensor has to say of itself. */
  readonly sensor?: Pick<Hello, "face" | "take_over">;
}

export const PING_EVERY_MS = 2_000;
const WELCOME_WITHIN_MS = 10_000;
const PINGS_UNTIL_SILENT = 4;

export class Connection {
  status: Status = { phase: "stopped", fault: null, retryAt: null, roundTripMs: null };

  readonly #url: string;
  readonly #hello: Hello;
  readonly #host: Host;
  readonly #listener: Listener;
  #socket: Socket | null = null;
  #cancelTimer: () => void = () => {};
  #attempt = 0;
  #unanswered = 0;
  #fatal: Fault | null = null;

  constructor(
    url: string,
    client: Client,
    host: Host,
    listener: Listener,
  ) {
    this.#url = url;
    this.#host = host;
    this.#listener = listener;
    this.#hello = {
      type: "hello",
      protocol: PROTOCOL,
      client: client.name,
      client_version: client.version,
      ...(client.token === null ? {} : { token: client.token }),
      ...client.sensor,
    };
  }

  start(): void {
    if (this.status.phase === "stopped") this.#open();
  }

  /** Do not wait any longer before the next attempt. */
  retryNow(): void {
    if (this.status.phase === "waiting") this.#open();
  }

  /** Bytes that wait to leave; what is not worth waiting for is better not sent meanwhile. */
  get backlog(): number {
    return this.#socket?.backlog ?? 0;
  }

  /** Send to the session; what comes while there is no live connection is lost. */
  post(data: object | Uint8Array<ArrayBuffer>): void {
    if (this.status.phase !== "live") return;
    if (data instanceof Uint8Array) this.#socket?.send(data);
    else this.#send(data);
  }

  stop(): void {
    this.#drop();
    this.#enter({ phase: "stopped", fault: null, retryAt: null, roundTripMs: null });
  }

  #open(): void {
    this.#cancelTimer();
    this.#fatal = null;
    this.#enter({ phase: "opening", retryAt: null });
    let opened: Socket | null = null;
    // A socket that was dropped may still speak; only the present one is heard.
    const heard = (act: () => void): void => {
      if (opened !== null && opened === this.#socket) act();
    };
    try {
      opened = this.#host.open(this.#url, SUBPROTOCOL, {
        onOpen: () => heard(() => this.#greet()),
        onText: (text) => heard(() => this.#receive(text)),
        onClose: (code, reason) => heard(() => this.#closed(code, reason)),
      });
    } catch {
      this.#fail({ kind: "unreachable" });
      return;
    }
    this.#socket = opened;
    this.#later(WELCOME_WITHIN_MS, () => this.#fail({ kind: "silent" }));
  }

  #greet(): void {
    this.#send(this.#hello);
    this.#enter({ phase: "greeting" });
  }

  #receive(text: string): void {
    const message = parseMessage(text);
    if (message === null) return;
    this.#unanswered = 0;
    switch (message.type) {
      case "ping":
        this.#send({ type: "pong", sent_ns: message.sent_ns, time_ns: this.#nowNs() });
        return;
      case "pong":
        this.#enter({ roundTripMs: Math.max(0, this.#host.now() - message.sent_ns / 1e6) });
        return;
      case "welcome": {
        const major = Number.parseInt(message.protocol, 10);
        if (major !== PROTOCOL_MAJOR) {
          this.#fail({
            kind: "version",
            message: `the server speaks protocol ${message.protocol}, this page speaks ${PROTOCOL}`,
          });
          return;
        }
        this.#attempt = 0;
        this.#enter({ phase: "live", fault: null });
        this.#ping();
        break;
      }
      case "error":
        if (message.fatal === true) this.#fatal = faultOf(message);
        break;
      default:
        if (this.status.phase !== "live") return;
    }
    this.#listener.onMessage(message);
  }

  #ping(): void {
    if (this.#unanswered >= PINGS_UNTIL_SILENT) {
      this.#fail({ kind: "silent" });
      return;
    }
    this.#unanswered += 1;
    this.#send({ type: "ping", sent_ns: this.#nowNs() });
    this.#later(PING_EVERY_MS, () => this.#ping());
  }

  #closed(code: number, reason: string): void {
    const wasOpen = this.status.phase === "live" || this.status.phase === "greeting";
    const fault: Fault =
      code === CLOSE_WRONG_VERSION && this.#fatal === null
        ? { kind: "version", message: reason || "the server asks for another protocol version" }
        : wasOpen
          ? { kind: "lost", code, reason }
          : { kind: "unreachable" };
    this.#fail(this.#fatal ?? fault);
  }

  #fail(fault: Fault): void {
    this.#drop();
    // Asking again at once does not help where the server said no.
    const isRefusal = fault.kind === "refused" || fault.kind === "version";
    const delayMs = isRefusal ? BACKOFF_CAP_MS : fullJitter(this.#attempt, this.#host.random);
    this.#attempt += 1;
    // First the timer: whoever hears of the loss may stop the connection for good.
    this.#later(delayMs, () => this.#open());
    this.#enter({
      phase: "waiting",
      fault,
      retryAt: this.#host.now() + delayMs,
      roundTripMs: null,
    });
  }

  #drop(): void {
    this.#cancelTimer();
    const socket = this.#socket;
    this.#socket = null;
    this.#unanswered = 0;
    socket?.close();
  }

  #later(delayMs: number, callback: () => void): void {
    this.#cancelTimer();
    this.#cancelTimer = this.#host.after(delayMs, callback);
  }

  #send(message: object): void {
    this.#socket?.send(JSON.stringify(message));
  }

  #nowNs(): number {
    return Math.round(this.#host.now() * 1e6);
  }

  #enter(change: Partial<Status>): void {
    this.status = { ...this.status, ...change };
    this.#listener.onStatus(this.status);
  }
}

function faultOf(error: ErrorMessage): Fault {
  return error.code === "wrong_version"
    ? { kind: "version", message: error.message }
    : { kind: "refused", code: error.code, message: error.message };
}
