/** One clip after the other as one motion: what is asked for at once, and rest in between. */

import type { Skeleton } from "../protocol/messages.ts";
import type { Clip } from "./clips.ts";

type Joints = Skeleton["joints"];

/** So many frames lead from one clip into the next. */
const BLEND_FRAMES = 8;

export class Reel {
  #clip: Clip | null = null;
  #rests: readonly Clip[] = [];
  #nextRest = 0;
  #frame = 0;
  #last: Joints | null = null;
  #from: Joints | null = null;

  /** What is played when nothing else is; at least one. */
  set rests(clips: readonly Clip[]) {
    this.#rests = clips;
  }

  get doing(): string | null {
    return this.#clip?.gesture ?? null;
  }

  /** Play a clip now; what is going on ends where it is. */
  play(clip: Clip): void {
    this.#clip = clip;
    this.#frame = 0;
    this.#from = this.#last;
  }

  /** The next frame, or null while there is nothing to play. */
  next(): Skeleton | null {
    if (this.#clip === null || this.#frame >= this.#clip.frames.length) {
      const rest = this.#rests[this.#nextRest++ % Math.max(1, this.#rests.length)];
      if (rest === undefined) return null;
      this.play(rest);
    }
    const frame = this.#clip?.frames[this.#frame];
    if (frame === undefined) return null;
    const k = (this.#frame + 1) / (BLEND_FRAMES + 1);
    const from = this.#from;
    const joints =
      from === null || k >= 1
        ? frame.joints
        : frame.joints.map((joint, index) => blended(from[index] ?? joint, joint, k));
    this.#frame += 1;
    this.#last = joints;
    return { ...frame, joints };
  }
}

function blended(from: Joints[number], to: Joints[number], k: number): Joints[number] {
  const smooth = k * k * (3 - 2 * k);
  const at = (a: number, b: number): number => a + (b - a) * smooth;
  return [at(from[0], to[0]), at(from[1], to[1]), at(from[2], to[2]), Math.min(from[3], to[3])];
}
