/** A hand does something to an object: it goes there, takes hold, leads it, and lets go. */

import { Vector3, type Object3D } from "three";
import { minimumJerk } from "./maths.ts";
import type { Mover } from "./mover.ts";
import type { Grip } from "./places.ts";
import type { Props } from "./props.ts";

/** Seconds: the way of the hand, at least and for each metre; closing and opening the fingers. */
const GO_S = 0.4;
const GO_S_PER_M = 0.22;
const CLOSE_S = 0.08;
const OPEN_S = 0.08;

export interface Deed {
  readonly object: string;
  readonly state: string;
  readonly handle: Object3D;
  readonly grip: Grip;
  /** Of leading the object, in seconds. */
  readonly seconds: number;
}

type Phase = "going" | "closing" | "leading" | "opening" | "over";

const place = new Vector3();

export class Reach {
  readonly deed: Deed;
  phase: Phase = "going";
  readonly #mover: Mover;
  readonly #props: Props;
  #time = 0;

  constructor(mover: Mover, props: Props, deed: Deed) {
    this.#mover = mover;
    this.#props = props;
    this.deed = deed;
    const hand = mover.hands[deed.grip.side];
    const way = deed.handle.getWorldPosition(place).distanceTo(hand.place);
    hand.hold(deed.handle, deed.grip, GO_S + GO_S_PER_M * way);
  }

  /** Whether the hand is on the handle. */
  get isHolding(): boolean {
    return this.phase === "closing" || this.phase === "leading";
  }

  /** To be called before the body moves, so that the hand follows the object in the same step. */
  step(dt: number): void {
    const { grip, object, state, seconds, handle } = this.deed;
    const hand = this.#mover.hands[grip.side];
    this.#time += dt;
    switch (this.phase) {
      case "going":
        if (hand.isThere) this.#enter("closing");
        break;
      case "closing":
        hand.close();
        if (this.#time >= CLOSE_S) this.#enter("leading");
        break;
      case "leading":
        hand.share = minimumJerk(this.#time / seconds);
        this.#props.setProgress(object, state, hand.share);
        if (this.#time >= seconds) this.#enter("opening");
        break;
      case "opening":
        if (this.#time < OPEN_S) break;
        this.letGo();
        return;
      case "over":
        return;
    }
    handle.getWorldPosition(place);
    this.#mover.reachFor(grip.side, place);
    this.#mover.gaze.aim(place);
  }

  /** At any moment: the hand goes back to the body. */
  letGo(): void {
    this.#enter("over");
    this.#mover.hands[this.deed.grip.side].do("free");
    this.#mover.reachFor(null, null);
  }

  #enter(phase: Phase): void {
    this.phase = phase;
    this.#time = 0;
  }
}
