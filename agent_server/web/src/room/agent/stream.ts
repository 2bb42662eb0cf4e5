/**
 * A motion that is made while it plays: joint positions that come in stretches. It says where the
 * hands are and how the trunk leans; all else of the body stays as it is.
 */

import { Vector3 } from "three";
import type { Point, PoseStreamMessage } from "../../protocol/messages.ts";
import { clamp, norm } from "./maths.ts";
import { SIDES, type Side } from "./rig.ts";

/** Nothing came for so long: it is taken to be over, seconds. */
const PATIENCE_S = 0.5;
/** An arm counts as raised from this angle to the vertical on, until it is below the other, radians. */
const RAISED = { from: 0.6, until: 0.42 } as const;
/** Most that the trunk leans for it, radians. */
const MOST_LEAN = 0.35;
/** Joints that are read; a motion without one of them is not played. */
const NEEDED = [
  "torso",
  "neck",
  ...SIDES.flatMap((side) => ["shoulder", "elbow", "hand"].map((part) => `${side.toLowerCase()}_${part}`)),
];

/** How an arm is held, in the frame of a body that faces +z. */
export interface ArmPose {
  /** From the shoulder to the wrist, in lengths of the arm. */
  readonly reach: Vector3;
  /** From the elbow to the wrist, unit. */
  readonly fore: Vector3;
}

const armPose = (): ArmPose => ({ reach: new Vector3(), fore: new Vector3() });
const upper = new Vector3();

export class MotionStream {
  readonly arms: Readonly<Record<Side, ArmPose>> = { Left: armPose(), Right: armPose() };
  /** Of the trunk, forwards, radians. */
  lean = 0;
  readonly #raised: Record<Side, boolean> = { Left: false, Right: false };
  readonly #joints = new Map<string, number>();
  #frames: (readonly Point[])[] = [];
  #rate = 25;
  #time = 0;
  #starved = 0;
  #isWhole = false;

  /** Take the frames that come next; where some are missing nothing more is played. */
  push({ first_frame, rate_hz, joints, positions, is_last }: PoseStreamMessage): void {
    if (this.#isWhole) return;
    if (this.#frames.length === 0) {
      this.#joints.clear();
      joints.forEach((name, i) => this.#joints.set(name, i));
      this.#rate = rate_hz;
    }
    const isNext = first_frame === this.#frames.length;
    const isKnown = NEEDED.every((name) => this.#joints.has(name));
    if (isNext && isKnown) this.#frames.push(...positions);
    this.#isWhole = is_last || !isNext || !isKnown;
  }

  clear(): void {
    this.#frames = [];
    this.#time = 0;
    this.#starved = 0;
    this.#isWhole = false;
    this.#raised.Left = this.#raised.Right = false;
    this.lean = 0;
  }

  get isPlaying(): boolean {
    return this.#frames.length > 0;
  }

  /** Whether the motion leads this hand; one that hangs is left to what it does else. */
  leads(side: Side): boolean {
    return this.#raised[side];
  }

  step(dt: number): void {
    if (!this.isPlaying) {
      // What ended before it began leaves room for the next one at `clear`.
      return;
    }
    const end = (this.#frames.length - 1) / this.#rate;
    this.#time += dt;
    this.#starved = this.#time > end ? this.#starved + dt : 0;
    if (this.#starved > (this.#isWhole ? 0 : PATIENCE_S)) {
      this.clear();
      this.#isWhole = true;
      return;
    }
    this.#time = Math.min(this.#time, end);
    for (const side of SIDES) this.#pose(side);
    this.#between("torso", "neck", upper);
    this.lean = clamp(Math.atan2(upper.z, upper.y), -MOST_LEAN, MOST_LEAN);
  }

  #pose(side: Side): void {
    const { reach, fore } = this.arms[side];
    const name = side.toLowerCase();
    const upperLength = this.#between(`${name}_shoulder`, `${name}_elbow`, upper).length();
    const foreLength = this.#between(`${name}_elbow`, `${name}_hand`, fore).length();
    reach.addVectors(upper, fore).divideScalar(Math.max(1e-6, upperLength + foreLength));
    fore.normalize();
    const angle = Math.atan2(norm(reach.x, reach.z), -reach.y);
    this.#raised[side] = angle > (this.#raised[side] ? RAISED.until : RAISED.from);
  }

  /** From one joint to another, now. */
  #between(from: string, to: string, out: Vector3): Vector3 {
    const at = this.#time * this.#rate;
    const before = Math.min(Math.floor(at), this.#frames.length - 1);
    const after = Math.min(before + 1, this.#frames.length - 1);
    const share = at - before;
    const ends = [before, after].map((frame) => {
      const points = this.#frames[frame] ?? [];
      const [a, b] = [points[this.#joints.get(from) ?? -1], points[this.#joints.get(to) ?? -1]];
      return a === undefined || b === undefined ? [0, -1, 0] : b.map((value, axis) => value - (a[axis] ?? 0));
    });
    const [one = [], other = []] = ends;
    const mixed = [0, 1, 2].map((axis) => (one[axis] ?? 0) * (1 - share) + (other[axis] ?? 0) * share);
    return out.fromArray(mixed);
  }
}
