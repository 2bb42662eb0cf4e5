/** Breathing: in for two fifths of the time, out for the rest. */

import { smooth } from "./maths.ts";

/** Seconds of one breath. */
const BREATH_S = 4.2;
const IN_SHARE = 0.4;

export class Breath {
  #time = 0;

  /** @returns How full the lungs are, 0 to 1. */
  step(dt: number): number {
    this.#time = (this.#time + dt) % BREATH_S;
    const u = this.#time / BREATH_S;
    return u < IN_SHARE ? smooth(u / IN_SHARE) : 1 - smooth((u - IN_SHARE) / (1 - IN_SHARE));
  }
}
