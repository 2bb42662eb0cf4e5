/** Two-bone inverse kinematics: closed form, with a pole that says where the middle joint points. */

import { Matrix4, Quaternion, Vector3 } from "three";
import { clamp, norm, wrap } from "./maths.ts";

/** A limb is never stretched more than this share of its length. */
const STRETCHED = 0.998;

/** A twist beyond this is taken as one from the other side. */
const FULL = 1.6 * Math.PI;

const m = new Matrix4();
const q = new Quaternion();
const x = new Vector3();
const y = new Vector3();
const z = new Vector3();
const along = new Vector3();
const across = new Vector3();

/**
 * Distance that a limb of `length` takes for a target at `distance`.
 *
 * @param softFrom Share of the length from which on it comes softly to its bound.
 */
export function softReach(distance: number, length: number, softFrom: number): number {
  const from = softFrom * length;
  if (distance <= from) return distance;
  const room = (STRETCHED - softFrom) * length;
  return from + room * (1 - Math.exp((from - distance) / room));
}

/**
 * Where the middle joint and the end of a limb come to lie.
 *
 * @param pole Direction in which the middle joint bends out; any length, not along the limb.
 * @param end Set to the target, or as near to it as the limb reaches.
 * @param normal Set to the normal of the plane in which the limb bends: along it x pole.
 */
export function twoBone(
  root: Vector3,
  target: Vector3,
  upper: number,
  lower: number,
  pole: Vector3,
  softFrom: number,
  middle: Vector3,
  end: Vector3,
  normal: Vector3,
): void {
  along.subVectors(target, root);
  const distance = Math.max(1e-6, along.length());
  along.divideScalar(distance);
  across.copy(pole).addScaledVector(along, -pole.dot(along)).normalize();
  normal.crossVectors(along, across);
  const nearest = Math.abs(upper - lower) + 1e-3;
  const reach = Math.max(nearest, softReach(distance, upper + lower, softFrom));
  const cosine = clamp((upper * upper + reach * reach - lower * lower) / (2 * upper * reach), -1, 1);
  middle.copy(root).addScaledVector(along, upper * cosine);
  middle.addScaledVector(across, upper * Math.sqrt(1 - cosine * cosine));
  end.copy(root).addScaledVector(along, reach);
}

/** The turn of axes of which the first lies along `first` and the second as near to `second` as it can. */
export function basis(first: Vector3, second: Vector3, out: Quaternion): Quaternion {
  x.copy(first).normalize();
  y.copy(second).addScaledVector(x, -second.dot(x)).normalize();
  z.crossVectors(x, y);
  return out.setFromRotationMatrix(m.makeBasis(x, y, z));
}

/** Turns a bone so that it lies along a direction and bends about a normal. */
export class Aim {
  readonly #restInverse = new Quaternion();

  /** @param pole Where the limb's middle joint points at rest. */
  constructor(direction: Vector3, pole: Vector3) {
    basis(direction, across.crossVectors(direction, pole), this.#restInverse).invert();
  }

  turn(direction: Vector3, normal: Vector3, out: Quaternion): Quaternion {
    return basis(direction, normal, out).multiply(this.#restInverse);
  }
}

/** Angle of the part of a turn that is about `axis` (unit), -pi to pi. */
export function twistAbout(turn: Quaternion, axis: Vector3): number {
  const along = turn.x * axis.x + turn.y * axis.y + turn.z * axis.z;
  const angle = 2 * Math.atan2(along, turn.w);
  return angle > Math.PI ? angle - 2 * Math.PI : angle < -Math.PI ? angle + 2 * Math.PI : angle;
}

/** Bounds of a joint that twists about one axis and swings about two others. */
export interface Bounds {
  readonly twist: number;
  /** About the axis that is given with the bounds, and about the one across it. */
  readonly swing: number;
  readonly swingAcross: number;
}

/**
 * Bound a turn: its twist about `axis`, and its swing, within an ellipse, about `hinge` (unit,
 * across the axis) and the axis across both.
 *
 * @param before The twist that was asked for last: one that goes on beyond half a turn stays at the
 *   bound that it has reached.
 * @returns The twist that was asked for, in radians.
 */
export function bound(
  turn: Quaternion,
  axis: Vector3,
  hinge: Vector3,
  bounds: Bounds,
  before: number,
): number {
  const angle = before + wrap(twistAbout(turn, axis) - before);
  const twist = clamp(angle, -bounds.twist, bounds.twist);
  // turn = swing * twist
  turn.multiply(q.setFromAxisAngle(axis, -angle));
  if (turn.w < 0) turn.set(-turn.x, -turn.y, -turn.z, -turn.w);
  const sine = norm(turn.x, turn.y, turn.z);
  const swing = 2 * Math.atan2(sine, turn.w);
  if (sine > 1e-6) {
    const about = (turn.x * hinge.x + turn.y * hinge.y + turn.z * hinge.z) / sine;
    const across = Math.sqrt(Math.max(0, 1 - about * about));
    const most = 1 / norm(about / bounds.swing, across / bounds.swingAcross);
    if (swing > most) {
      const k = Math.sin(most / 2) / sine;
      turn.set(turn.x * k, turn.y * k, turn.z * k, Math.cos(most / 2));
    }
  }
  turn.multiply(q.setFromAxisAngle(axis, twist));
  return Math.abs(angle) < FULL ? angle : wrap(angle);
}
