/**
 * A client's side of one session: says hello, keeps the connection alive, comes back after a
 * loss. It knows no browser: sockets, timers, clock and chance come from a {@link Host}.
 */

import { ProtocolError } from "../protocol/check.ts";
import { CLOSE_CODES, CLOSE_NORMAL, CLOSE_WRONG_VERSION, type Retry } from "../protocol/codes.ts";
import type { Codec, Incoming, Outgoing, Wire } from "../protocol/codec.ts";
import { PROTOCOL, PROTOCOL_MAJOR } from "../protocol/layout.ts";
import type { ErrorMessage, Hello, Pong, Role, Welcome } from "../protocol/messages.ts";
import { Backoff, LATER_MS } from "./backoff.ts";
import { ClockEstimate } from "./clock.ts";
import type { Host, Socket } from "./host.ts";
import { faultOf, type Fault, type Status } from "./status.ts";

export interface Listener {
  /** What the server sent; a message comes after the status that it brought about. */
  onMessage(message: Incoming): void;
  onStatus(status: Status): void;
  /** The server's clock, or the own one, has jumped. */
  onClockJump?(byMs: number): void;
  /** The server sent something that cannot be read; the connection goes on. */
  onUnreadable?(error: ProtocolError): void;
}

/** How an application introduces itself. */
export interface Client {
  readonly name: string;
  readonly version: string;
  readonly token: string | null;
}

export interface ConnectionOptions {
  readonly url: string;
  readonly session: string;
  readonly role: Role;
  readonly client: Client;
  readonly codec: Codec;
  /** What the client can do beside answering pings. */
  readonly capabilities?: readonly string[];
  /** What else hello says; asked for each hello. */
  readonly greeting?: () => Partial<Hello>;
}

const ANSWER_WITHIN_MS = 10_000;
const SILENT_HEARTBEATS = 2.5;
/** A heartbeat below or above would be a mistake of the server's. */
const HEARTBEAT_S = { least: 0.1, most: 3600 };

const AWAY = { retryAt: null, roundTripMs: null, offsetMs: null };

export class Connection {
  status: Status = { phase: "stopped", fault: null, ...AWAY };

  readonly #options: ConnectionOptions;
  readonly #host: Host;
  readonly #listener: Listener;
  readonly #instance: string;
  readonly #backoff: Backoff;
  #clock = new ClockEstimate();
  #socket: Socket | null = null;
  /** One for the attempt, the answer or the wait; in a live connection one for its silence. */
  #cancelTimer: () => void = () => {};
  #cancelPing: () => void = () => {};
  #heardAt = 0;
  #lastEpoch: string | null = null;
  #fatal: ErrorMessage | null = null;

  constructor(options: ConnectionOptions, host: Host, listener: Listener) {
    this.#options = options;
    this.#host = host;
    this.#listener = listener;
    this.#backoff = new Backoff(() => host.random());
    this.#instance = Array.from({ length: 32 }, () =>
      Math.floor(host.random() * 16).toString(16),
    ).join("");
  }

  /** Connect; of no effect unless stopped. */
  start(): void {
    if (this.status.phase !== "stopped") return;
    this.#backoff.reset();
    this.#enter({ fault: null });
    this.#open();
  }

  /** Do not wait any longer before the next attempt. */
  retryNow(): void {
    if (this.status.phase === "waiting") this.#open();
  }

  /** Say goodbye. */
  stop(): void {
    this.#drop(CLOSE_NORMAL);
    this.#enter({ phase: "stopped", fault: null, ...AWAY });
  }

  /** Bytes that wait to leave; what is not worth waiting for is better not sent meanwhile. */
  get backlog(): number {
    return this.#socket?.backlog ?? 0;
  }

  /** The server's monotonic clock now, in nanoseconds; null before the first pong. */
  get serverNs(): number | null {
    const { offsetNs } = this.#clock;
    return offsetNs === null ? null : this.#nowNs() + offsetNs;
  }

  /** Smallest round trip of late, in nanoseconds; null before the first pong. */
  get roundTripNs(): number | null {
    return this.#clock.roundTripNs;
  }

  /**
   * Send to the session; what comes while there is no live connection is lost.
   *
   * @throws {ProtocolError} If the message does not fit the protocol.
   */
  post(message: Outgoing): void {
    if (this.status.phase === "live") this.#send(message);
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
      opened = this.#host.open(this.#options.url, this.#options.codec.subprotocol, {
        onOpen: () => heard(() => this.#greet()),
        onMessage: (data) => heard(() => this.#receive(data)),
        onClose: (code, reason) => heard(() => this.#closed(code, reason)),
      });
    } catch {
      this.#fail({ kind: "unreachable" }, "soon");
      return;
    }
    this.#socket = opened;
    this.#later(ANSWER_WITHIN_MS, () => this.#fail({ kind: "unreachable" }, "soon"));
  }

  #greet(): void {
    const { session, role, client, capabilities = [], greeting } = this.#options;
    this.#clock = new ClockEstimate();
    this.#send({
      type: "hello",
      protocol: PROTOCOL,
      client: client.name,
      client_version: client.version,
      instance: this.#instance,
      token: client.token,
      session,
      role,
      capabilities: ["heartbeat", ...capabilities],
      last_epoch: this.#lastEpoch,
      ...greeting?.(),
    });
    this.#later(ANSWER_WITHIN_MS, () => this.#fail({ kind: "silent" }, "soon"));
    this.#enter({ phase: "greeting" });
  }

  #receive(data: Wire): void {
    this.#heardAt = this.#host.now();
    const message = this.#read(data);
    if (message === null) return;
    switch (message.type) {
      case "ping":
        this.#send({ type: "pong", sent_ns: message.sent_ns, time_ns: this.#nowNs() });
        return;
      case "pong":
        this.#hearPong(message);
        return;
      case "welcome":
        if (!this.#accept(message)) return;
        break;
      case "error":
        if (message.fatal) this.#fatal = message;
        break;
      default:
        if (this.status.phase !== "live") return;
    }
    this.#listener.onMessage(message);
  }

  #read(data: Wire): Incoming | null {
    try {
      return this.#options.codec.decodeServer(data);
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      this.#listener.onUnreadable?.(error);
      return null;
    }
  }

  #accept(welcome: Welcome): boolean {
    if (this.status.phase !== "greeting") return false;
    if (Number.parseInt(welcome.protocol, 10) !== PROTOCOL_MAJOR) {
      const message = `the server speaks protocol ${welcome.protocol}, this client speaks ${PROTOCOL}`;
      this.#fail({ kind: "version", message }, CLOSE_CODES[CLOSE_WRONG_VERSION]?.retry ?? "later");
      return false;
    }
    this.#lastEpoch = welcome.epoch;
    this.#backoff.reset();
    const { least, most } = HEARTBEAT_S;
    const heartbeatMs = 1000 * Math.min(most, Math.max(least, welcome.heartbeat_s));
    this.#listenFor(heartbeatMs * SILENT_HEARTBEATS);
    this.#ping(heartbeatMs);
    this.#enter({ phase: "live", fault: null });
    return true;
  }

  #ping(everyMs: number): void {
    this.#send({ type: "ping", sent_ns: this.#nowNs() });
    this.#cancelPing = this.#host.after(everyMs, () => this.#ping(everyMs));
  }

  #hearPong({ sent_ns, time_ns }: Pong): void {
    const nowNs = this.#nowNs();
    const jumpNs = this.#clock.push(sent_ns, time_ns, nowNs);
    const { offsetNs } = this.#clock;
    this.#enter({
      roundTripMs: Math.max(0, nowNs - sent_ns) / 1e6,
      offsetMs: offsetNs === null ? null : offsetNs / 1e6,
    });
    if (jumpNs !== null) this.#listener.onClockJump?.(jumpNs / 1e6);
  }

  /** Give the connection up when nothing at all is heard for so long. */
  #listenFor(silentMs: number): void {
    const leftMs = this.#heardAt + silentMs - this.#host.now();
    if (leftMs <= 0) this.#fail({ kind: "silent" }, "soon");
    else this.#later(leftMs, () => this.#listenFor(silentMs));
  }

  #closed(closeCode: number, reason: string): void {
    const wasOpen = this.status.phase === "live" || this.status.phase === "greeting";
    const retry = CLOSE_CODES[closeCode]?.retry ?? "soon";
    // A server that says why it cuts a connection, and lets come back at once, refuses nobody.
    const fatal = retry === "soon" ? null : this.#fatal;
    this.#fail(faultOf(closeCode, this.#fatal?.message ?? reason, wasOpen, fatal), retry);
  }

  #fail(fault: Fault, retry: Retry): void {
    this.#drop();
    if (retry === "never") {
      this.#enter({ phase: "stopped", fault, ...AWAY });
      return;
    }
    const now = this.#host.now();
    const soonMs = this.#backoff.next(now);
    const delayMs = retry === "later" ? LATER_MS : soonMs;
    // First the timer: whoever hears of the loss may stop the connection for good.
    this.#later(delayMs, () => this.#open());
    this.#enter({ phase: "waiting", fault, ...AWAY, retryAt: now + delayMs });
  }

  #drop(closeCode?: number): void {
    this.#cancelTimer();
    this.#cancelPing();
    const socket = this.#socket;
    this.#socket = null;
    socket?.close(closeCode);
  }

  #later(delayMs: number, callback: () => void): void {
    this.#cancelTimer();
    this.#cancelTimer = this.#host.after(delayMs, callback);
  }

  #send(message: Outgoing): void {
    const data = this.#options.codec.encode(message);
    this.#socket?.send(data);
  }

  #nowNs(): number {
    return Math.round(this.#host.now() * 1e6);
  }

  #enter(change: Partial<Status>): void {
    this.status = { ...this.status, ...change };
    this.#listener.onStatus(this.status);
  }
}
