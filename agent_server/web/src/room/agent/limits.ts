/**
 * Normal ranges of motion, and where a pose leaves them.
 *
 * Degrees, after the American Academy of Orthopaedic Surgeons (Joint Motion: Method of Measuring
 * and Recording, 1965; The Clinical Measurement of Joint Motion, 1994). A range is about the
 * anatomical zero: upright, arms hanging, palms to the thighs.
 */

import { Quaternion, Vector3 } from "three";
import { twistAbout } from "./ik.ts";
import { SIDES, type Joint, type Rig, type Side } from "./rig.ts";
import { norm } from "./maths.ts";

export const RANGES = {
  elbowFlexion: [0, 150],
  forearmTurn: [-80, 80],
  wristFlexion: [-70, 80],
  wristDeviation: [-30, 30],
  shoulderBack: [-60, 180],
  kneeFlexion: [0, 135],
  hipFlexion: [-30, 120],
  hipAbduction: [-30, 45],
  hipRotation: [-45, 45],
  ankleFlexion: [-50, 20],
  neckFlexion: [-45, 45],
  neckBend: [-45, 45],
  neckTurn: [-60, 60],
  trunkFlexion: [-25, 80],
  trunkBend: [-35, 35],
  trunkTurn: [-45, 45],
} as const satisfies Readonly<Record<string, readonly [least: number, most: number]>>;

export type Motion = keyof typeof RANGES;

const DEGREE = Math.PI / 180;
const UP = new Vector3(0, 1, 0);
const LEFT = new Vector3(1, 0, 0);
const AHEAD = new Vector3(0, 0, 1);
const turn = new Quaternion();
const direction = new Vector3();

/** Angles of all joints, degrees, told one after the other; positive flexes. */
export function eachAngle(rig: Rig, tell: (motion: Motion, angle: number, side: Side | null) => void): void {
  const { Hips, Spine2, Head } = rig.joints;
  relative(Hips, Spine2);
  tell("trunkFlexion", twistAbout(turn, LEFT) / DEGREE, null);
  tell("trunkBend", twistAbout(turn, AHEAD) / DEGREE, null);
  tell("trunkTurn", twistAbout(turn, UP) / DEGREE, null);
  relative(Spine2, Head);
  tell("neckFlexion", twistAbout(turn, LEFT) / DEGREE, null);
  tell("neckBend", twistAbout(turn, AHEAD) / DEGREE, null);
  tell("neckTurn", twistAbout(turn, UP) / DEGREE, null);
  for (const side of SIDES) {
    eachOfArm(rig, side, tell);
    eachOfLeg(rig, side, tell);
  }
}

function eachOfArm(rig: Rig, side: Side, tell: (motion: Motion, angle: number, side: Side) => void): void {
  const { clavicle, upper, fore, hand, fingers, palm } = rig.arms[side];
  relative(upper, fore);
  const along = direction.copy(fore.offset).normalize().clone();
  const straight = along.clone().applyQuaternion(turn).angleTo(along);
  tell("elbowFlexion", straight / DEGREE, side);
  // Turn of the hand about the forearm, both bones together.
  const axis = hand.offset.clone().normalize();
  const twist = twistAbout(turn, axis);
  relative(fore, hand);
  tell("forearmTurn", (twist + twistAbout(turn, axis)) / DEGREE, side);
  direction.copy(fingers).applyQuaternion(turn);
  tell("wristFlexion", Math.asin(clampUnit(direction.dot(palm))) / DEGREE, side);
  const aside = new Vector3().crossVectors(fingers, palm);
  tell("wristDeviation", Math.asin(clampUnit(direction.dot(aside))) / DEGREE, side);
  // Of the upper arm behind the body, in the plane that faces ahead.
  direction.copy(fore.offset).applyQuaternion(upper.delta);
  direction.applyQuaternion(turn.copy(clavicle.delta).invert());
  tell("shoulderBack", Math.atan2(direction.z, norm(direction.x, direction.y)) / DEGREE, side);
}

function eachOfLeg(rig: Rig, side: Side, tell: (motion: Motion, angle: number, side: Side) => void): void {
  const { Hips } = rig.joints;
  const { sign, thigh, shank, foot } = rig.legs[side];
  relative(Hips, thigh);
  direction.copy(shank.offset).normalize().applyQuaternion(turn);
  tell("hipFlexion", Math.atan2(direction.z, -direction.y) / DEGREE, side);
  tell("hipAbduction", (sign * Math.asin(clampUnit(direction.x))) / DEGREE, side);
  tell("hipRotation", (sign * twistAbout(turn, shank.offset.clone().normalize())) / DEGREE, side);
  relative(thigh, shank);
  tell("kneeFlexion", twistAbout(turn, LEFT) / DEGREE, side);
  relative(shank, foot);
  tell("ankleFlexion", -twistAbout(turn, LEFT) / DEGREE, side);
}

/** How far a pose leaves the normal ranges at most, degrees; below 0 inside. */
export function worstExcess(rig: Rig): { readonly motion: Motion; readonly excess: number } {
  let motion: Motion = "elbowFlexion";
  let excess = Number.NEGATIVE_INFINITY;
  eachAngle(rig, (name, angle) => {
    const [least, most] = RANGES[name];
    const over = Math.max(least - angle, angle - most);
    if (over <= excess) return;
    motion = name;
    excess = over;
  });
  return { motion, excess };
}

function relative(parent: Joint, child: Joint): void {
  turn.copy(parent.delta).invert().multiply(child.delta);
}

const clampUnit = (value: number): number => Math.min(1, Math.max(-1, value));
