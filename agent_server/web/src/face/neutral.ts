/** A person's neutral face, kept in the browser from one visit to the next. */

import type { CalibrationState } from "../protocol/messages.ts";

export type Neutral = Pick<CalibrationState, "valence" | "arousal">;

const STORED = "agent-server.neutral-face";

export function storedNeutral(): Neutral | null {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(STORED) ?? "null");
    if (typeof kept !== "object" || kept === null) return null;
    const { valence, arousal } = kept as Record<string, unknown>;
    return typeof valence === "number" && typeof arousal === "number" ? { valence, arousal } : null;
  } catch {
    return null;
  }
}

/** Keep it, or nothing; a browser that keeps nothing forgets it when the page is left. */
export function storeNeutral(neutral: Neutral | null): void {
  try {
    if (neutral === null) localStorage.removeItem(STORED);
    else localStorage.setItem(STORED, JSON.stringify(neutral));
  } catch {
    // It holds for this visit all the same.
  }
}
