/** Which decisions are worth going to. */

import type { DecisionBody } from "../protocol/messages.ts";

const OUTCOMES: ReadonlySet<string> = new Set(["command", "gated", "nothing_to_do", "busy"]);

/** Those of some entries, in order, whose decision is notable; of like ones in a row the first. */
export function notable<T>(
  entries: readonly T[],
  decisionOf: (entry: T) => Pick<DecisionBody, "outcome" | "gesture">,
): readonly T[] {
  let before: string | null = null;
  return entries.filter((entry) => {
    const { outcome, gesture } = decisionOf(entry);
    const kind = OUTCOMES.has(outcome) ? `${outcome} ${gesture}` : null;
    const isFirst = kind !== null && kind !== before;
    before = kind;
    return isFirst;
  });
}
