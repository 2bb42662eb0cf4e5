/** How long to wait before the next attempt to connect. */

const FIRST_MS = 250;
/** A server that comes back is found within two seconds ... */
export const SOON_MS = 1_500;
/** ... but one that has been away for this long is asked less often. */
const PATIENCE_MS = 20_000;
export const LATER_MS = 15_000;

/**
 * Full jitter: uniform between nothing and a bound that doubles with every failed attempt, so
 * that many clients do not come back to a restarted server in step. Time is passed in, in
 * milliseconds.
 */
export class Backoff {
  readonly #random: () => number;
  #bound = FIRST_MS;
  #downSince: number | null = null;

  /** @param random Uniform in [0, 1). */
  constructor(random: () => number) {
    this.#random = random;
  }

  /** There is a connection, or somebody has just asked for one. */
  reset(): void {
    this.#bound = FIRST_MS;
    this.#downSince = null;
  }

  /** An attempt, or a connection, has ended; how long to wait for the next attempt. */
  next(now: number): number {
    this.#downSince ??= now;
    const delayMs = this.#random() * this.#bound;
    const cap = now - this.#downSince < PATIENCE_MS ? SOON_MS : LATER_MS;
    this.#bound = Math.min(2 * this.#bound, cap);
    return delayMs;
  }
}
