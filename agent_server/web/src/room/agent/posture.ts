/** What a pose is before it is bones: where the hips, feet and hands are, how trunk and head lie. */

import { Quaternion, Vector3 } from "three";
import type { Side } from "./rig.ts";

/** Of a foot: where its ankle stands over the floor when the sole is flat, and how it lies. */
export interface Footing {
  x: number;
  z: number;
  yaw: number;
  /** Of the sole over the floor. */
  lift: number;
  /** Above 0 the toes are up and the foot stands on its heel; below, on its ball. */
  pitch: number;
}

/** Of a hand: where its grip is and how it is turned against rest, both in the world. */
export interface HandGoal {
  readonly grip: Vector3;
  readonly turn: Quaternion;
  /** Which point of the hand is meant by its grip: 0 the fist, 1 where thumb and forefinger meet. */
  pinch: number;
  /** How far the fingers are closed, 0 to 1. */
  closed: number;
}

export interface Posture {
  readonly hips: Vector3;
  heading: number;
  /** Of the pelvis: forwards, and to the left. */
  tilt: number;
  roll: number;
  /** Of the pelvis about the vertical, against the heading. */
  sway: number;
  /** Of the chest against the pelvis: forwards, to the left, and turned to the left. */
  lean: number;
  bend: number;
  twist: number;
  /** 0 to 1: how full the lungs are. */
  breath: number;
  /** Of the face against the heading, and of the eyes against the head: left, and up. */
  headYaw: number;
  headPitch: number;
  headRoll: number;
  eyeYaw: number;
  eyePitch: number;
  readonly feet: Readonly<Record<Side, Footing>>;
  readonly hands: Readonly<Record<Side, HandGoal>>;
}

export function posture(): Posture {
  const foot = (): Footing => ({ x: 0, z: 0, yaw: 0, lift: 0, pitch: 0 });
  const hand = (): HandGoal => ({
    grip: new Vector3(),
    turn: new Quaternion(),
    pinch: 0,
    closed: 0.3,
  });
  return {
    hips: new Vector3(),
    heading: 0,
    tilt: 0,
    roll: 0,
    sway: 0,
    lean: 0,
    bend: 0,
    twist: 0,
    breath: 0,
    headYaw: 0,
    headPitch: 0,
    headRoll: 0,
    eyeYaw: 0,
    eyePitch: 0,
    feet: { Left: foot(), Right: foot() },
    hands: { Left: hand(), Right: hand() },
  };
}
