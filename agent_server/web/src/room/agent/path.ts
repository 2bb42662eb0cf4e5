/**
 * How the hips travel over the floor: along a smooth way, speeding up and slowing down, the body
 * turning with it. Worked out ahead when a walk begins, so that steps can be planned on it.
 */

import type { Spot } from "../layout.ts";
import { clamp, mix, norm, wrap } from "./maths.ts";
import type { Point } from "./route.ts";

/** Metres a second; and how fast it gets to that and away from it, metres a second squared. */
const PACE = 1.45;
const SPEED_UP = 2.6;
const SLOW_DOWN = 2.3;
/** Of the body's turning: radians a second, and the rate at which it follows the way. */
const TURN_SPEED = 3.3;
const TURN_RATE = 7.5;
/** It looks this far ahead along the way, in metres. */
const AHEAD = 0.25;
/** Turned further away from the way than this, it does not walk yet; radians. */
const AWAY = 1.9;
/** Share of the time of the last turn that may pass after arriving. */
const TURN_EARLY = 0.85;

/** Bends of the way are looked for this far ahead, metres. */
const BENDS_AHEAD = [0.04, 0.12, 0.22, 0.34] as const;

const STEP_S = 1 / 120;
const CAPACITY = 1_200;
/** The way is cut at its corners this often, which rounds them. */
const ROUNDINGS = 3;
const STILL = { speed: 0.02, turn: 0.05, angle: 0.02 } as const;

/** Where the body is over the floor, and how it moves. */
export interface Going {
  x: number;
  z: number;
  heading: number;
  speedX: number;
  speedZ: number;
  turning: number;
}

export class Path {
  /** Seconds until it has arrived and faces where it should. */
  duration = 0;
  readonly #x = new Float64Array(CAPACITY);
  readonly #z = new Float64Array(CAPACITY);
  readonly #heading = new Float64Array(CAPACITY);
  #count = 0;

  /** Stay where it is. */
  stay(x: number, z: number, heading: number): void {
    this.#count = 1;
    this.#x[0] = x;
    this.#z[0] = z;
    this.#heading[0] = heading;
    this.duration = 0;
  }

  /**
   * @param from Where and how the body moves now.
   * @param corners Of the way, the first one where it is now.
   * @param end Where it is to stand, and how to face.
   */
  plan(from: Going, corners: readonly Point[], end: Spot): void {
    const way = new Way(rounded(started(from, corners)));
    const { length } = way;
    const there: [number, number] = [0, 0];
    let along = 0;
    let speed = Math.min(PACE, norm(from.speedX, from.speedZ));
    let { heading, turning } = from;
    let n = 0;
    for (; n < CAPACITY; n += 1) {
      way.at(along, there);
      this.#x[n] = there[0];
      this.#z[n] = there[1];
      this.#heading[n] = heading;
      const left = length - along;
      const isThere = left < 0.002 && speed < STILL.speed;
      const last = wrap(end.heading - heading);
      if (isThere && Math.abs(last) < STILL.angle && Math.abs(turning) < STILL.turn) break;

      const tangent = way.heading(Math.min(length, along + AHEAD));
      // The last turn begins so early that it is done soon after arriving.
      const secondsLeft = left / Math.max(0.3, speed) + speed / (2 * SLOW_DOWN);
      const turnSeconds = Math.abs(last) / TURN_SPEED + 0.2;
      const isLast = left < 0.05 || secondsLeft < turnSeconds * TURN_EARLY;
      const away = wrap((isLast ? end.heading : tangent) - heading);

      const aligned = isLast ? 1 : clamp(1.25 - Math.abs(wrap(tangent - heading)) / AWAY, 0.12, 1);
      const bending = way.fastest(along);
      const braking = Math.sqrt(2 * SLOW_DOWN * Math.max(0, left));
      const wanted = Math.min(PACE * aligned, braking, bending);
      speed = clamp(wanted, speed - 1.3 * SLOW_DOWN * STEP_S, speed + SPEED_UP * STEP_S);
      along = Math.min(length, along + speed * STEP_S);
      if (left < 0.002) speed = 0;

      turning += (TURN_RATE * TURN_RATE * away - 2 * TURN_RATE * turning) * STEP_S;
      turning = clamp(turning, -TURN_SPEED, TURN_SPEED);
      heading += turning * STEP_S;
    }
    this.#count = Math.min(CAPACITY, n + 1);
    this.duration = n * STEP_S;
  }

  /** Where the body is `time` seconds after the start; it stays at the end. */
  at(time: number, out: Going): Going {
    const last = this.#count - 1;
    const t = clamp(time / STEP_S, 0, last);
    const i = Math.min(Math.floor(t), Math.max(0, last - 1));
    const j = Math.min(last, i + 1);
    const k = t - i;
    out.x = mix(this.#x[i] ?? 0, this.#x[j] ?? 0, k);
    out.z = mix(this.#z[i] ?? 0, this.#z[j] ?? 0, k);
    out.heading = mix(this.#heading[i] ?? 0, this.#heading[j] ?? 0, k);
    const isMoving = t < last ? 1 / STEP_S : 0;
    out.speedX = ((this.#x[j] ?? 0) - (this.#x[i] ?? 0)) * isMoving;
    out.speedZ = ((this.#z[j] ?? 0) - (this.#z[i] ?? 0)) * isMoving;
    out.turning = ((this.#heading[j] ?? 0) - (this.#heading[i] ?? 0)) * isMoving;
    return out;
  }
}

/** Whoever walks already goes on a little in the same direction. */
function started(from: Going, corners: readonly Point[]): Point[] {
  const speed = norm(from.speedX, from.speedZ);
  const first: Point = [from.x, from.z];
  const on = speed / (2 * SLOW_DOWN);
  if (speed * on < 0.02) return [first, ...corners.slice(1)];
  const next: Point = [from.x + from.speedX * on, from.z + from.speedZ * on];
  return [first, next, ...corners.slice(1)];
}

/** Chaikin's corner cutting; the ends stay. */
function rounded(corners: readonly Point[]): Point[] {
  let points = [...corners];
  for (let round = 0; round < ROUNDINGS; round += 1) {
    const next: Point[] = [];
    for (let i = 0; i + 1 < points.length; i += 1) {
      const [a, b] = [points[i], points[i + 1]];
      if (a === undefined || b === undefined) continue;
      if (i === 0) next.push(a);
      else next.push([mix(a[0], b[0], 0.25), mix(a[1], b[1], 0.25)]);
      if (i + 2 === points.length) next.push(b);
      else next.push([mix(a[0], b[0], 0.75), mix(a[1], b[1], 0.75)]);
    }
    points = next;
  }
  return points;
}

/** A polyline by its length. */
class Way {
  readonly length: number;
  readonly #points: readonly Point[];
  readonly #lengths: readonly number[];

  constructor(points: readonly Point[]) {
    let sum = 0;
    const lengths = [0];
    for (let i = 1; i < points.length; i += 1) {
      const [a, b] = [points[i - 1], points[i]];
      if (a !== undefined && b !== undefined) sum += norm(b[0] - a[0], b[1] - a[1]);
      lengths.push(sum);
    }
    this.length = sum;
    this.#points = points;
    this.#lengths = lengths;
  }

  at(along: number, out: [number, number]): void {
    const i = this.#segment(along);
    const [a, b] = [this.#points[i], this.#points[i + 1]];
    const from = this.#lengths[i] ?? 0;
    const span = (this.#lengths[i + 1] ?? from) - from;
    const k = span > 0 ? (along - from) / span : 0;
    out[0] = mix(a?.[0] ?? 0, b?.[0] ?? a?.[0] ?? 0, k);
    out[1] = mix(a?.[1] ?? 0, b?.[1] ?? a?.[1] ?? 0, k);
  }

  /** Heading of the way there. */
  heading(along: number): number {
    const i = this.#segment(along);
    const [a, b] = [this.#points[i], this.#points[i + 1]];
    return Math.atan2((b?.[0] ?? 0) - (a?.[0] ?? 0), (b?.[1] ?? 0) - (a?.[1] ?? 0));
  }

  /** How fast one may walk there, so that one is slow enough where the way bends. */
  fastest(along: number): number {
    const here = this.heading(along);
    let fastest: number = PACE;
    for (const ahead of BENDS_AHEAD) {
      const bend = Math.abs(wrap(this.heading(Math.min(this.length, along + ahead)) - here));
      const there = PACE * clamp(1.3 - bend / 1.5, 0.1, 1);
      fastest = Math.min(fastest, Math.sqrt(there * there + 2 * SLOW_DOWN * ahead));
    }
    return fastest;
  }

  #segment(along: number): number {
    let i = 0;
    while (i + 2 < this.#points.length && (this.#lengths[i + 1] ?? 0) < along) i += 1;
    return i;
  }
}
