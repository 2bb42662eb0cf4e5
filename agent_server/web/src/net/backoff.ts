/** How long to wait before the next attempt to connect. */

export const BACKOFF_BASE_MS = 400;
export const BACKOFF_CAP_MS = 15_000;

/**
 * Full jitter: uniform between nothing and a bound that doubles with every failed attempt, so
 * that many pages do not come back to a restarted server in step.
 *
 * @param attempt Failed attempts so far, from 0.
 * @param random Uniform in [0, 1).
 */
export function fullJitter(attempt: number, random: () => number): number {
  const bound = Math.min(BACKOFF_CAP_MS, BACKOFF_BASE_MS * 2 ** Math.min(attempt, 16));
  return random() * bound;
}
