/** The last minute of telemetry, so that one can go back and look. */

import type { Incoming } from "../protocol/codec.ts";
import type {
  AffectTelemetry,
  DecisionMessage,
  ForecastMessage,
  PoseMessage,
} from "../protocol/messages.ts";
import { notable } from "./notable.ts";
import type { Moment, Timed } from "./store.ts";

export const SPAN_MS = 60_000;
/** The past stays for so long where somebody has stopped in it. */
const HELD_MS = 300_000;
/** So much affect goes before a moment, as a trail. */
const TRAIL_MS = 4_000;

/** Values of one kind in the order in which they came. */
class Track<T> {
  #entries: Timed<T>[] = [];

  add(value: T, at: number): void {
    this.#entries.push({ value, at });
  }

  forgetBefore(time: number): void {
    const first = this.#after(time);
    if (first > 0) this.#entries.splice(0, first);
  }

  clear(): void {
    this.#entries = [];
  }

  /** The last value that had come by then, or null. */
  at(time: number): Timed<T> | null {
    return this.#entries[this.#after(time) - 1] ?? null;
  }

  /** Values that came after `from` and not after `to`. */
  between(from: number, to: number): readonly Timed<T>[] {
    return this.#entries.slice(this.#after(from), this.#after(to));
  }

  /** Index of the first entry later than `time`. */
  #after(time: number): number {
    let low = 0;
    let high = this.#entries.length;
    while (low < high) {
      const middle = (low + high) >>> 1;
      if ((this.#entries[middle]?.at ?? Infinity) <= time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

export class History {
  readonly #poses = new Track<PoseMessage>();
  readonly #forecasts = new Track<ForecastMessage>();
  readonly #affect = new Track<AffectTelemetry>();
  readonly #decisions = new Track<DecisionMessage>();
  #epoch: string | null = null;

  /** @param isHeld Whether somebody looks at the past, which then stays longer. */
  add(message: Incoming, now: number, isHeld: boolean): void {
    switch (message.type) {
      case "welcome":
        if (message.epoch !== this.#epoch) this.#clear();
        this.#epoch = message.epoch;
        break;
      case "pose":
        this.#poses.add(message, now);
        break;
      case "forecast":
        this.#forecasts.add(message, now);
        break;
      case "affect_state":
        this.#affect.add(message, now);
        break;
      case "decision":
        this.#decisions.add(message, now);
        break;
      default:
        return;
    }
    const oldest = now - (isHeld ? HELD_MS : SPAN_MS);
    for (const track of this.#tracks) track.forgetBefore(oldest);
  }

  /** What the page knew at a time, on its clock. */
  at(time: number): Moment {
    return {
      pose: this.#poses.at(time),
      forecast: this.#forecasts.at(time),
      affect: this.#affect.between(time - TRAIL_MS, time),
      decision: this.#decisions.at(time),
    };
  }

  decisions(from: number, to: number): readonly Timed<DecisionMessage>[] {
    return this.#decisions.between(from, to);
  }

  /** Notable decisions that came after `from` and not after `to`; of like ones in a row the first. */
  marks(from: number, to: number): readonly Timed<DecisionMessage>[] {
    return notable(this.decisions(from, to), ({ value }) => value.decision);
  }

  /** When the mark before or after a time came, or null. */
  nextMark(time: number, direction: -1 | 1): number | null {
    const marks = this.marks(-Infinity, Infinity);
    const found =
      direction === 1 ? marks.find(({ at }) => at > time) : marks.findLast(({ at }) => at < time);
    return found?.at ?? null;
  }

  get #tracks() {
    return [this.#poses, this.#forecasts, this.#affect, this.#decisions];
  }

  #clear(): void {
    for (const track of this.#tracks) track.clear();
  }
}
