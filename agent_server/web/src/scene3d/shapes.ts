/** What bodies are made of: bones between two points and joints, sized like a person's. */

import {
  CylinderGeometry,
  IcosahedronGeometry,
  Matrix4,
  Quaternion,
  SphereGeometry,
  Vector3,
  type BufferGeometry,
} from "three";
import { BONES, JOINT, JOINTS } from "../protocol/skeleton.ts";

/** Radius of each joint's ball, in metres, by core joint. */
export const JOINT_RADIUS: readonly number[] = Array.from({ length: JOINTS }, (_, joint) => {
  switch (joint) {
    case JOINT.head:
      return 0.088;
    case JOINT.neck:
      return 0.024;
    case JOINT.navel:
      return 0.036;
    case JOINT.leftWrist:
    case JOINT.rightWrist:
      return 0.03;
    default:
      return 0.03;
  }
});

/** Radius of each bone in the middle, in metres, by place in BONES. */
export const BONE_RADIUS: readonly number[] = BONES.map(([parent, child]) => {
  if (child === JOINT.head) return 0.017;
  if (parent === JOINT.navel) return 0.021;
  return child === JOINT.leftWrist || child === JOINT.rightWrist ? 0.016 : 0.019;
});

/** A bone of length 1 along y from the origin and radius 1, thinner towards its child. */
export function boneGeometry(): BufferGeometry {
  return new CylinderGeometry(0.82, 1.12, 1, 14, 1, true).translate(0, 0.5, 0);
}

/** A ball of radius 1. */
export function jointGeometry(): BufferGeometry {
  return new SphereGeometry(1, 20, 14);
}

/** A coarse ball for what the sensor only guesses: as a wire it reads as hollow. */
export function hollowGeometry(): BufferGeometry {
  return new IcosahedronGeometry(1, 1);
}

const UP = new Vector3(0, 1, 0);
const direction = new Vector3();
const scale = new Vector3();
const turn = new Quaternion();

/** Place a unit bone between two points. */
export function placeBone(into: Matrix4, from: Vector3, to: Vector3, radius: number): Matrix4 {
  direction.subVectors(to, from);
  const length = Math.max(direction.length(), 1e-6);
  turn.setFromUnitVectors(UP, direction.divideScalar(length));
  return into.compose(from, turn, scale.set(radius, length, radius));
}

/** Place a unit ball; the head is taller than it is wide. */
export function placeJoint(into: Matrix4, at: Vector3, joint: number, size = 1): Matrix4 {
  const radius = (JOINT_RADIUS[joint] ?? 0.03) * size;
  const height = joint === JOINT.head ? radius * 1.24 : radius;
  return into.compose(at, turn.identity(), scale.set(radius, height, radius));
}
