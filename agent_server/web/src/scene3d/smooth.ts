/** Exponential smoothing of joint positions, exact for any length of step. */

import { Vector3 } from "three";

/** A change below this, in metres, is not worth a new picture. */
const STILL_M = 2e-4;

/** Share of the way to go in `dtMs` for a time constant of `tauMs`. */
export function share(dtMs: number, tauMs: number): number {
  return tauMs <= 0 ? 1 : 1 - Math.exp(-dtMs / tauMs);
}

/** Points that follow their targets. */
export class Follower {
  readonly points: readonly Vector3[];
  readonly #targets: readonly Vector3[];
  readonly #tauMs: number;
  #isSet = false;

  constructor(count: number, tauMs: number) {
    this.points = Array.from({ length: count }, () => new Vector3());
    this.#targets = Array.from({ length: count }, () => new Vector3());
    this.#tauMs = tauMs;
  }

  /** Aim at new positions; the first ones, and those after {@link forget}, are taken at once. */
  aim(positions: Iterable<readonly [number, number, number, ...number[]]>): void {
    let i = 0;
    for (const [x, y, z] of positions) {
      this.#targets[i]?.set(x, y, z);
      if (!this.#isSet) this.points[i]?.set(x, y, z);
      i += 1;
    }
    this.#isSet = true;
  }

  forget(): void {
    this.#isSet = false;
  }

  /** @returns Whether anything moved. */
  step(dtMs: number): boolean {
    const k = share(dtMs, this.#tauMs);
    let moved = false;
    for (const [i, target] of this.#targets.entries()) {
      const point = this.points[i];
      if (point === undefined || point.distanceToSquared(target) < STILL_M ** 2) continue;
      point.lerp(target, k);
      moved = true;
    }
    return moved;
  }
}
