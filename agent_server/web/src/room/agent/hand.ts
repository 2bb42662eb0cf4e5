/**
 * A hand and what it does: hang, rest, type, follow a motion, or hold something that moves. It goes from one to the
 * other on a straight and smooth way.
 */

import { Quaternion, Vector3, type Object3D } from "three";
import { DESK, ON_DESK } from "../layout.ts";
import { PlaceChannel, TurnChannel } from "./channel.ts";
import { basis } from "./ik.ts";
import { Spring, mix, smooth } from "./maths.ts";
import type { ArmPose } from "./stream.ts";
import type { Grip } from "./places.ts";
import type { HandGoal, Posture } from "./posture.ts";
import type { Arm, Rig, Side } from "./rig.ts";

export type HandTask = "free" | "desk" | "type" | "follow" | "hold";

/** Seconds to get there from anywhere. */
export const WAY_S: Readonly<Record<Exclude<HandTask, "hold">, number>> = {
  follow: 0.4,
  free: 0.55,
  desk: 0.6,
  type: 0.55,
};
/** How far the arm swings forwards for a foot that is a metre behind, radians; and a hanging arm's bend. */
const SWING = 0.75;
/** Of a hand that lies on the thigh: aside and above the hip joint, metres; along the thigh. */
const LAP = { aside: 0.03, above: 0.1, share: 0.62 } as const;
/** Who sits at the desk keeps a hand that follows a motion so far over its top. */
const OVER_DESK = 0.1;
/** Over the desk's top: of the fist that rests, and of the one over and before the keys. */
const REST = { height: 0.028, x: 0.16, z: -0.01 } as const;
const KEYS = { height: 0.048, before: 0.05, apart: 0.085, tap: 0.008 } as const;

const UP = new Vector3(0, 1, 0);
const source = new Vector3();
const other = new Vector3();
const fingers = new Vector3();
const palm = new Vector3();
const turn = new Quaternion();
const part = new Quaternion();

/** What a hand needs to know of the body. */
export interface Bearing {
  /** 0 seated, 1 up. */
  readonly risen: number;
  /** How far the other foot is ahead of the hips, metres. */
  readonly otherFootAhead: number;
  /** Seconds of typing so far. */
  readonly typed: number;
}

export class Hand {
  task: HandTask = "free";
  readonly arm: Arm;
  readonly #rig: Rig;
  readonly #side: Side;
  readonly #sign: 1 | -1;
  readonly #restInverse = new Quaternion();
  readonly #place = new PlaceChannel();
  readonly #turn = new TurnChannel();
  readonly #closed = new Spring(0.3);
  readonly #pinch = new Spring();
  readonly #swing = new Spring();
  #handle: Object3D | null = null;
  #grip: Grip | null = null;
  #pose: ArmPose | null = null;
  #isGripping = false;
  #tapping = 0;
  /** How far the action that it is holding on for has come. */
  share = 0;
  #isFirst = true;

  constructor(rig: Rig, side: Side) {
    this.#rig = rig;
    this.arm = rig.arms[side];
    this.#side = side;
    this.#sign = this.arm.sign;
    basis(this.arm.fingers, this.arm.palm, this.#restInverse).invert();
  }

  do(task: Exclude<HandTask, "hold" | "follow">): void {
    this.#go(task);
  }

  /** Be held as in a pose, which may change. */
  be(pose: ArmPose): void {
    this.#pose = pose;
    this.#go("follow");
  }

  #go(task: Exclude<HandTask, "hold">): void {
    if (task === this.task) return;
    this.task = task;
    this.#isGripping = false;
    this.#change(WAY_S[task]);
  }

  /** Go to a handle, and stay with it. */
  hold(handle: Object3D, grip: Grip, seconds: number): void {
    this.task = "hold";
    this.#handle = handle;
    this.#grip = grip;
    this.#isGripping = false;
    this.share = 0;
    this.#change(seconds);
  }

  /** Close the fingers on the handle. */
  close(): void {
    this.#isGripping = true;
  }

  /** Where its grip is meant to be now, in the world. */
  get place(): Vector3 {
    return this.#place.value;
  }

  /** Whether it is with its handle. */
  get isThere(): boolean {
    return this.task === "hold" && this.#place.isThere;
  }

  /** From the wrist to the grip, metres. */
  get length(): number {
    return this.#grip?.pinch === 1 ? this.arm.pinch.length() : this.arm.fist.length();
  }

  step(pose: Posture, bearing: Bearing, dt: number): void {
    const goal = pose.hands[this.#side];
    switch (this.task) {
      case "free":
        this.#hang(pose, bearing, dt);
        break;
      case "desk":
        this.#rest();
        break;
      case "type":
        this.#type(bearing.typed);
        break;
      case "follow":
        this.#follow(pose, bearing.risen);
        break;
      case "hold":
        this.#reach();
        break;
    }
    // `fingers` and `palm` say how the hand is to lie, `source` where its grip is to be.
    basis(fingers, palm, turn).multiply(this.#restInverse);
    if (this.#isFirst) {
      this.#place.set(source);
      this.#turn.set(turn);
      this.#isFirst = false;
    }
    goal.grip.copy(this.#place.follow(source, pose.heading, dt));
    goal.turn.copy(this.#turn.follow(turn, pose.heading, dt));
    this.#shape(goal, dt);
  }

  #change(seconds: number): void {
    this.#place.change(seconds);
    this.#turn.change(seconds);
  }

  #shape(goal: HandGoal, dt: number): void {
    const grip = this.task === "hold" ? this.#grip : null;
    const isTyping = this.task === "type";
    const idle = isTyping ? 0.3 + 0.1 * this.#tapping : 0.32;
    const closed = grip === null ? idle : this.#isGripping ? grip.closed : 0.18;
    goal.closed = this.#closed.step(closed, isTyping ? 40 : 14, dt);
    goal.pinch = this.#pinch.step(grip?.pinch ?? 0, 10, dt);
  }

  /** Beside the thighs, swinging against the legs; on them while one sits. */
  #hang(pose: Posture, bearing: Bearing, dt: number): void {
    const { arm } = this;
    const sign = this.#sign;
    const ahead = this.#swing.step(bearing.otherFootAhead, 14, dt);
    const angle = SWING * ahead + 0.1;
    const length = 0.94 * (arm.upperLength + arm.foreLength) + arm.fist.length();
    const shoulder = arm.upper.rest.place;
    const { Hips } = this.#rig.joints;
    source.set(
      shoulder.x - Hips.rest.place.x + sign * 0.045,
      shoulder.y - Hips.rest.place.y - length * Math.cos(angle),
      shoulder.z - Hips.rest.place.z + length * Math.sin(angle) + 0.05 * Math.max(0, ahead),
    );
    // The shoulders lean with the trunk; the hands hang under them.
    const lean = pose.tilt + pose.lean;
    source.z += (shoulder.y - Hips.rest.place.y) * Math.sin(lean);
    source.applyAxisAngle(UP, pose.heading).add(pose.hips);
    fingers.set(0, -Math.cos(angle + 0.15), Math.sin(angle + 0.15));
    palm.set(-sign, -0.05, -0.25);
    this.#onThigh(pose, bearing.risen);
    fingers.applyAxisAngle(UP, pose.heading);
    palm.applyAxisAngle(UP, pose.heading);
  }

  #onThigh(pose: Posture, risen: number): void {
    const seated = 1 - smooth((risen - 0.04) / 0.94);
    if (seated <= 0) return;
    const { thigh, thighLength } = this.#rig.legs[this.#side];
    other.set(this.#sign * LAP.aside, LAP.above, LAP.share * thighLength).add(thigh.offset);
    other.applyAxisAngle(UP, pose.heading).add(pose.hips);
    source.lerp(other, seated);
    fingers.lerp(other.set(-this.#sign * 0.25, -0.2, 1), seated);
    palm.lerp(other.set(0, -1, -0.2), seated);
  }

  /** On the desk, before the body. */
  #rest(): void {
    const sign = this.#sign;
    source.set(sign * REST.x, DESK.top + REST.height, DESK.centre[1] - DESK.depth / 2 + 0.09 + REST.z);
    fingers.set(-sign * 0.55, -0.12, 1);
    palm.set(-sign * 0.35, -1, -0.1);
  }

  /** Over the keys; fingertips go down and up, and the hand a little to and fro. */
  #type(typed: number): void {
    const sign = this.#sign;
    const [x, z] = ON_DESK.keyboard.at;
    const beat = typed * 4.6 + (sign > 0 ? 0 : 0.43);
    const tap = (0.5 - 0.5 * Math.cos(2 * Math.PI * beat)) * (0.6 + 0.4 * Math.sin(beat * 1.7));
    this.#tapping = tap * smooth(typed);
    source.set(
      x + sign * KEYS.apart + 0.018 * Math.sin(typed * 2.1 + sign),
      DESK.top + KEYS.height - KEYS.tap * this.#tapping,
      z - KEYS.before + 0.008 * Math.sin(typed * 3.3 + 2 * sign),
    );
    fingers.set(-sign * 0.28, -0.1, 1);
    palm.set(-sign * 0.25, -1, -0.1);
  }

  /** Where the pose has it, for arms of this length; the palm towards the body. */
  #follow(pose: Posture, risen: number): void {
    if (this.#pose === null) return;
    const { arm } = this;
    const { Hips } = this.#rig.joints;
    fingers.copy(this.#pose.fore);
    source.copy(this.#pose.reach).multiplyScalar(arm.upperLength + arm.foreLength);
    source.addScaledVector(fingers, arm.fist.length());
    other.subVectors(arm.upper.rest.place, Hips.rest.place);
    source.add(other);
    source.z += other.y * Math.sin(pose.tilt + pose.lean);
    source.applyAxisAngle(UP, pose.heading).add(pose.hips);
    if (risen < 0.5) source.y = Math.max(source.y, DESK.top + OVER_DESK);
    palm.set(-this.#sign, -0.3, -0.2).applyAxisAngle(UP, pose.heading);
    fingers.applyAxisAngle(UP, pose.heading);
  }

  /** At the handle, the fingers between the lines from the shoulder and from the elbow. */
  #reach(): void {
    const grip = this.#grip;
    if (grip === null || this.#handle === null) return;
    this.#handle.getWorldPosition(source);
    fingers.subVectors(source, this.arm.upper.place).normalize();
    fingers.add(other.subVectors(source, this.arm.fore.place).normalize()).normalize();
    other.crossVectors(UP, fingers).normalize();
    fingers.applyQuaternion(part.setFromAxisAngle(other, grip.droop));
    const roll = -this.#sign * (grip.roll + grip.turn * mix(-0.5, 0.5, this.share));
    palm.set(0, -1, 0);
    palm.addScaledVector(fingers, -palm.dot(fingers)).normalize();
    palm.applyQuaternion(part.setFromAxisAngle(fingers, roll));
  }
}
