/** An object between its two states: set at once, on its own way, or led by the agent's hand. */

import { smooth } from "./noise.ts";

export class Transition {
  /** 0 in the first state, 1 in the second. */
  at = 0;

  readonly #states: readonly [string, string];
  readonly #durationMs: number;
  #from = 0;
  #to = 0;
  #passedMs: number;
  /** How far the hand has led it, or null when no hand does. */
  #led: number | null = null;

  constructor(states: readonly [string, string], durationMs: number) {
    this.#states = states;
    this.#durationMs = durationMs;
    this.#passedMs = durationMs;
  }

  /** Go to a state by itself. @returns Whether it is there already, and was not. */
  set(state: string, isGradual: boolean): boolean {
    const to = this.#states.indexOf(state);
    if (to < 0) return false;
    this.#led = null;
    if (isGradual && this.#durationMs > 0) {
      if (to === this.#to && this.#passedMs < this.#durationMs) return false;
      this.#from = this.at;
      this.#to = to;
      this.#passedMs = this.at === to ? this.#durationMs : 0;
      return false;
    }
    return this.#jump(to);
  }

  /**
   * Be led towards a state. A hand that begins takes it from where it is.
   *
   * @param share How far on the way, 0..1.
   * @returns Whether it moved.
   */
  lead(state: string, share: number): boolean {
    const to = this.#states.indexOf(state);
    if (to < 0) return false;
    if (this.#led === null || this.#to !== to || share < this.#led) this.#from = this.at;
    this.#led = share;
    this.#to = to;
    this.#passedMs = this.#durationMs;
    const before = this.at;
    this.at = share >= 1 ? to : this.#from + (to - this.#from) * Math.max(0, share);
    return this.at !== before;
  }

  /** @returns Whether it moved. */
  step(dtMs: number): boolean {
    if (this.#passedMs >= this.#durationMs) return false;
    this.#passedMs += dtMs;
    const share = smooth(0, this.#durationMs, this.#passedMs);
    this.at = share >= 1 ? this.#to : this.#from + (this.#to - this.#from) * share;
    return true;
  }

  #jump(to: number): boolean {
    const hasMoved = this.at !== to;
    this.#to = to;
    this.#passedMs = this.#durationMs;
    this.at = to;
    return hasMoved;
  }
}
