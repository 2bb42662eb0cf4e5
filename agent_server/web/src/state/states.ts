/** The states of the product's own room, so that an object can be changed by hand. */

const STATES: Readonly<Record<string, readonly string[]>> = {
  window: ["open", "closed"],
  curtain: ["open", "closed"],
  hifi: ["high", "low"],
  cigarette: ["lit", "out"],
};

/** The state after this one, or null for an object that the page does not know. */
export function nextState(object: string, state: string | undefined): string | null {
  const states = STATES[object];
  if (states === undefined || state === undefined) return null;
  return states[(states.indexOf(state) + 1) % states.length] ?? null;
}
