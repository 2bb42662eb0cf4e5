/** What a connection needs of the world: sockets, timers, a clock, chance. */

import type { Wire } from "../protocol/codec.ts";

export interface Socket {
  send(data: Wire): void;
  /** Bytes that were sent and have not left yet. */
  readonly backlog: number;
  /** @param code A goodbye; without one the server takes it that the client may come back. */
  close(code?: number): void;
}

export interface SocketEvents {
  onOpen(): void;
  onMessage(data: Wire): void;
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
