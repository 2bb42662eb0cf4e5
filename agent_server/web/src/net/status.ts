/** How a connection is, and why there is none. */

import { CLOSE_WRONG_VERSION } from "../protocol/codes.ts";
import type { ErrorMessage } from "../protocol/messages.ts";

export type Phase = "stopped" | "opening" | "greeting" | "live" | "waiting";

/** Why there is no live connection; `closeCode` is the websocket's. */
export type Fault =
  | { readonly kind: "unreachable" }
  | { readonly kind: "silent" }
  | { readonly kind: "lost"; readonly closeCode: number; readonly reason: string }
  | {
      readonly kind: "refused";
      readonly closeCode: number;
      readonly code: string;
      readonly message: string;
    }
  | { readonly kind: "version"; readonly message: string };

export interface Status {
  readonly phase: Phase;
  /** Why the last connection ended; null while all is well, and after `stop`. */
  readonly fault: Fault | null;
  /** When the next attempt starts on the host's clock; null unless waiting. */
  readonly retryAt: number | null;
  /** Time from the last ping to its pong, or null before the first one. */
  readonly roundTripMs: number | null;
  /** The server's clock less the host's, or null before the first pong. */
  readonly offsetMs: number | null;
}

/**
 * @param wasOpen Whether hello had been sent.
 * @param fatal The error that announced the end, or null.
 */
export function faultOf(
  closeCode: number,
  reason: string,
  wasOpen: boolean,
  fatal: ErrorMessage | null,
): Fault {
  if (fatal !== null && fatal.code !== "wrong_version") {
    return { kind: "refused", closeCode, code: fatal.code, message: fatal.message };
  }
  if (fatal !== null || closeCode === CLOSE_WRONG_VERSION) {
    const message = fatal?.message ?? reason;
    return { kind: "version", message: message || "the server asks for another protocol version" };
  }
  return wasOpen ? { kind: "lost", closeCode, reason } : { kind: "unreachable" };
}
