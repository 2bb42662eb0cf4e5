/** Curves and followers that depend on time steps alone. Seconds, metres, radians. */

export const clamp = (value: number, low: number, high: number): number =>
  Math.min(high, Math.max(low, value));

export const mix = (from: number, to: number, k: number): number => from + (to - from) * k;

/** Length of a vector: unlike `Math.hypot` it makes no objects. */
export const norm = (x: number, y: number, z = 0): number => Math.sqrt(x * x + y * y + z * z);

/** 0 before 0, 1 after 1, with no speed at either end. */
export function smooth(u: number): number {
  const k = clamp(u, 0, 1);
  return k * k * (3 - 2 * k);
}

/** The same with no acceleration at either end: the way a hand moves (minimum jerk). */
export function minimumJerk(u: number): number {
  const k = clamp(u, 0, 1);
  return k * k * k * (10 + k * (6 * k - 15));
}

/**
 * What is left at `u` of a distance that was 1 at rest: the rest of a minimum jerk movement.
 */
export const remains = (u: number): number => 1 - minimumJerk(u);

/** What an initial speed of 1 (per whole movement) adds at `u`, when all of it ends at rest. */
export function coasts(u: number): number {
  const k = clamp(u, 0, 1);
  return k * (1 + k * k * (-6 + k * (8 - 3 * k)));
}

/** An angle between -pi and pi. */
export function wrap(angle: number): number {
  const turn = 2 * Math.PI;
  return angle - turn * Math.round(angle / turn);
}

/** 0 below `-width`, the excess itself above `width`, and smooth between. */
export function softExcess(excess: number, width: number): number {
  if (excess <= -width) return 0;
  if (excess >= width) return excess;
  return (excess + width) ** 2 / (4 * width);
}

/** Follows a target without overshoot; exact for any length of step. */
export class Spring {
  value: number;
  speed = 0;

  constructor(value = 0) {
    this.value = value;
  }

  /** @param rate Natural frequency in radians a second: it is there after about 5 / rate seconds. */
  step(target: number, rate: number, dt: number): number {
    const gap = this.value - target;
    const pull = this.speed + rate * gap;
    const fade = Math.exp(-rate * dt);
    this.value = target + (gap + pull * dt) * fade;
    this.speed = (this.speed - rate * pull * dt) * fade;
    return this.value;
  }
}

/** A seeded source of chance (mulberry32). */
export class Chance {
  #state: number;

  constructor(seed: number) {
    this.#state = seed >>> 0;
  }

  /** Uniform in [0, 1). */
  next(): number {
    this.#state = (this.#state + 0x6d2b79f5) >>> 0;
    let t = this.#state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4_294_967_296;
  }

  between(low: number, high: number): number {
    return mix(low, high, this.next());
  }
}
