/** What a recording shows, by time: the followed body, and what was decided while it was made. */

import type { Incoming } from "../protocol/codec.ts";
import type { DecisionBody, PoseMessage } from "../protocol/messages.ts";
import { notable } from "../state/notable.ts";

/** A body that was seen so long ago is not there any more. */
const STALE_S = 0.25;
/** Where no body is seen, a step is as long as a frame. */
const FRAME_S = 0.04;
/** Half of the last digit of a time that was read as text. */
const CLOSE_S = 1e-6;

export class Film {
  /** Decisions that are worth looking at; of like ones in a row the first. */
  readonly decisions: readonly DecisionBody[];
  readonly #poses: readonly PoseMessage[];
  readonly #startS: number;
  readonly #endS: number;

  constructor(messages: readonly Incoming[], startS: number, endS: number) {
    this.#startS = startS;
    this.#endS = endS;
    this.#poses = messages
      .filter((message) => message.type === "pose")
      .toSorted((a, b) => a.originating_ns - b.originating_ns);
    const decided = messages.filter((message) => message.type === "decision");
    this.decisions = notable(decided.map(({ decision }) => decision), (one) => one);
  }

  get isEmpty(): boolean {
    return this.#poses.length === 0;
  }

  /** The body that is seen at a time, or null. */
  poseAt(timeS: number): PoseMessage | null {
    const pose = this.#poses[this.#after(timeS) - 1];
    if (pose === undefined || timeS - pose.originating_ns / 1e9 > STALE_S) return null;
    return pose;
  }

  /** The time of the frame before or after. */
  step(timeS: number, direction: -1 | 1): number {
    const after = this.#after(timeS);
    const here = this.#poses[after - 1];
    const isOnFrame = here !== undefined && timeS - here.originating_ns / 1e9 < CLOSE_S;
    const pose = this.#poses[direction === 1 ? after : after - (isOnFrame ? 2 : 1)];
    const next = pose === undefined ? Number.NaN : pose.originating_ns / 1e9;
    const isNear = Math.abs(next - timeS) <= STALE_S;
    return this.within(isNear ? next : timeS + direction * FRAME_S);
  }

  within(timeS: number): number {
    return Math.min(this.#endS, Math.max(this.#startS, timeS));
  }

  /** Index of the first pose later than a time. */
  #after(timeS: number): number {
    const untilNs = (timeS + CLOSE_S) * 1e9;
    let low = 0;
    let high = this.#poses.length;
    while (low < high) {
      const middle = (low + high) >>> 1;
      if ((this.#poses[middle]?.originating_ns ?? Infinity) <= untilNs) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}
