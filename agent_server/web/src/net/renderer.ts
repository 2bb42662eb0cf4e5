/**
 * The renderer's side of a session: commands come once, in order, and each is answered. The
 * application carries them out and says how far it is; connections may come and go meanwhile.
 */

import { jsonCodec, type Codec, type Incoming } from "../protocol/codec.ts";
import type { ProtocolError } from "../protocol/check.ts";
import type {
  CommandMessage,
  Difference,
  ErrorMessage,
  Hello,
  PoseStreamMessage,
  SceneState,
  Welcome,
} from "../protocol/messages.ts";
import { socketUrl } from "./address.ts";
import { Connection, type Client } from "./connection.ts";
import type { Host } from "./host.ts";
import { CommandLedger, type CancelReason, type Reported } from "./ledger.ts";
import type { Status } from "./status.ts";

/** State of each object by its name. */
export type Objects = Readonly<Record<string, string>>;

export interface RendererOptions {
  /** Address of the server, `ws://HOST:8765` for example. */
  readonly server: string | URL;
  readonly session: string;
  readonly client: Client;
  /** JSON, unless another coding is given. */
  readonly codec?: Codec;
  /** What it can do beside resuming and reporting steps. */
  readonly capabilities?: readonly string[];
  /** Whether to push aside the renderer that acts already. */
  readonly takesOver?: boolean;
  /** What is shown now, asked for each hello; without it the room's state is taken as it is. */
  readonly objects?: () => Objects;
}

/** What the application sees, in the order in which it happens. */
export interface RendererEvents {
  /** Carry this out: `start` it first, and do nothing if that is refused. */
  onCommand(command: CommandMessage): void;
  /** Stop carrying this out; nothing is to be said of it any more. */
  onCancel(command: CommandMessage, reason: CancelReason): void;
  /** More of the motion of the command that is under way; for the capability `pose_stream`. */
  onMotion?(stretch: PoseStreamMessage): void;
  /** The room as it is, or has become. */
  onScene?(scene: SceneState): void;
  /** Objects on which the room and `objects` did not agree, with whose state holds now. */
  onDifferences?(differences: readonly Difference[]): void;
  onStatus?(status: Status): void;
  onWelcome?(welcome: Welcome): void;
  onError?(error: ErrorMessage): void;
  /** The server's clock, or the own one, has jumped. */
  onClockJump?(byMs: number): void;
  /** The server sent something that cannot be read. */
  onUnreadable?(error: ProtocolError): void;
}

export class RendererClient {
  readonly #ledger = new CommandLedger();
  readonly #connection: Connection;
  readonly #host: Host;
  readonly #events: RendererEvents;

  constructor(options: RendererOptions, host: Host, events: RendererEvents) {
    this.#host = host;
    this.#events = events;
    const { server, session, client, codec = jsonCodec, takesOver = false, objects, capabilities = [] } = options;
    this.#connection = new Connection(
      {
        url: socketUrl(server, session, "renderer"),
        session,
        role: "renderer",
        client,
        codec,
        capabilities: ["resume", "progress", ...capabilities],
        greeting: () => ({ ...this.#known(), take_over: takesOver, objects: objects?.() ?? null }),
      },
      host,
      {
        onMessage: (message) => this.#hear(message),
        onStatus: (status) => {
          if (status.phase !== "live") this.#ledger.lost();
          events.onStatus?.(status);
        },
        onClockJump: (byMs) => events.onClockJump?.(byMs),
        onUnreadable: (error) => events.onUnreadable?.(error),
      },
    );
  }

  get status(): Status {
    return this.#connection.status;
  }

  /** The server's monotonic clock now, in nanoseconds, as in `server_ns` of a command; or null. */
  get serverNs(): number | null {
    return this.#connection.serverNs;
  }

  /** Smallest round trip of late, in nanoseconds; null before the first pong. */
  get roundTripNs(): number | null {
    return this.#connection.roundTripNs;
  }

  /** Connect, and stay connected; of no effect unless closed. */
  open(): void {
    this.#connection.start();
  }

  /** Do not wait any longer before the next attempt. */
  retryNow(): void {
    this.#connection.retryNow();
  }

  /** Say goodbye: the room goes on without this renderer at once. */
  close(): void {
    this.#connection.stop();
  }

  /**
   * @returns Whether to carry the command out; false when it was started already, is over, or its
   *   time is up.
   */
  start(id: string): boolean {
    return this.#reported(this.#ledger.start(id, this.#host.now()));
  }

  /**
   * A step has ended.
   *
   * @returns False when the command is not under way.
   */
  progress(id: string, step: number): boolean {
    return this.#reported(this.#ledger.progress(id, step));
  }

  /** @returns False when the command was not under way: what it did does not count. */
  done(id: string): boolean {
    return this.#reported(this.#ledger.done(id));
  }

  /**
   * @param reason In words for people.
   * @returns False when the command was over already.
   */
  fail(id: string, reason: string): boolean {
    return this.#reported(this.#ledger.fail(id, reason));
  }

  /**
   * Somebody changed an object by hand. Without a live connection it is not sent; `objects` of the
   * next hello tells.
   */
  reportObject(object: string, state: string): void {
    this.#connection.post({ type: "scene_event", object, state });
  }

  #known(): Partial<Hello> {
    const { name, lastSequence } = this.#ledger;
    return name === null ? {} : { ledger: name, last_sequence: lastSequence };
  }

  #reported({ say, isTaken }: Reported): boolean {
    for (const word of say) this.#connection.post(word);
    return isTaken;
  }

  #hear(message: Incoming): void {
    switch (message.type) {
      case "welcome":
        this.#welcomed(message);
        return;
      case "command": {
        const { say, cancel, isNew } = this.#ledger.receive(message, this.#host.now());
        for (const word of say) this.#connection.post(word);
        if (cancel !== null) this.#events.onCancel(cancel, "preempted");
        if (isNew) this.#events.onCommand(message);
        return;
      }
      case "pose_stream":
        if (message.command_id !== this.#ledger.running?.id) return;
        if (typeof message.positions === "string" || message.positions instanceof Uint8Array) return;
        this.#events.onMotion?.(message as PoseStreamMessage);
        return;
      case "scene":
        this.#events.onScene?.(message);
        return;
      case "error":
        this.#events.onError?.(message);
        return;
    }
  }

  #welcomed(welcome: Welcome): void {
    const { say, cancel } = this.#ledger.welcome(welcome.ledger);
    for (const word of say) this.#connection.post(word);
    if (cancel !== null) this.#events.onCancel(cancel, "forgotten");
    this.#events.onWelcome?.(welcome);
    if (welcome.differences.length > 0) this.#events.onDifferences?.(welcome.differences);
    this.#events.onScene?.(welcome.scene);
  }
}
