/** The face over time: it blinks, and shows attention or discomfort. */

import { Spring, smooth, type Chance } from "./maths.ts";
import type { Rig } from "./rig.ts";

const BLINK_S = 0.17;
/** Seconds between two blinks. */
const PAUSE = { least: 1.8, most: 5.5 } as const;
/** How fast an expression comes and goes, radians a second. */
const RATE = 5;

export class Face {
  attention = 0;
  discomfort = 0;
  readonly #rig: Rig;
  readonly #chance: Chance;
  readonly #lids: readonly string[];
  readonly #attention = new Spring();
  readonly #discomfort = new Spring();
  #untilBlink: number;
  #blinked = BLINK_S;

  constructor(rig: Rig, chance: Chance) {
    this.#rig = rig;
    this.#chance = chance;
    this.#lids = rig.morphs.filter((name) => name.startsWith("blink"));
    this.#untilBlink = chance.between(PAUSE.least, PAUSE.most);
  }

  /** Now, as one does when one's gaze goes far. */
  blink(): void {
    this.#untilBlink = 0;
  }

  step(dt: number): void {
    this.#untilBlink -= dt;
    this.#blinked += dt;
    if (this.#untilBlink <= 0) {
      this.#untilBlink = this.#chance.between(PAUSE.least, PAUSE.most);
      this.#blinked = 0;
    }
    // Lids fall in a third of the time that they take in all.
    const u = this.#blinked / BLINK_S;
    const closed = u >= 1 ? 0 : u < 0.33 ? smooth(u / 0.33) : 1 - smooth((u - 0.33) / 0.67);
    for (const name of this.#lids) this.#rig.morph(name, closed);
    this.#rig.morph("attention", this.#attention.step(this.attention, RATE, dt));
    this.#rig.morph("discomfort", this.#discomfort.step(this.discomfort, RATE, dt));
  }
}
