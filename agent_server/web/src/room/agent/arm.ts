/** One arm: from a goal for the hand to the turns of clavicle, upper arm, forearm and hand. */

import { Quaternion, Vector3 } from "three";
import { Aim, bound, twoBone } from "./ik.ts";
import { clamp, smooth } from "./maths.ts";
import type { HandGoal } from "./posture.ts";
import type { Arm, Joint } from "./rig.ts";

const DEGREE = Math.PI / 180;
/** How far the hand may turn about the forearm, bend, and bend aside at the wrist. */
const BOUNDS = { twist: 78 * DEGREE, swing: 60 * DEGREE, swingAcross: 22 * DEGREE } as const;
/** An arm comes softly to its full length from this share on. */
const SOFT_FROM = 0.955;
/** Share of the turn about the forearm that is taken by the forearm's own bone. */
const FOREARM_SHARE = 0.5;
/** How far the clavicle helps: forwards, up. */
const PROTRACTION = 16 * DEGREE;
const ELEVATION = 18 * DEGREE;
/** The wrist depends on the hand's turn and the turn's bounds on the forearm: this often is enough. */
const ROUNDS = 3;

const UP = new Vector3(0, 1, 0);
const AHEAD = new Vector3(0, 0, 1);
const BACK = new Vector3(0, 0, -1);
const goal = new Vector3();
const pole = new Vector3();
const wrist = new Vector3();
const elbow = new Vector3();
const end = new Vector3();
const normal = new Vector3();
const grip = new Vector3();
const direction = new Vector3();
const part = new Quaternion();
const inverse = new Quaternion();

export class ArmSolver {
  readonly arm: Arm;
  /** How far the grip is from its goal, in metres. */
  error = 0;
  /** Of the goal before the shoulder, in lengths of the arm. */
  #ahead = 0;
  /** Turn about the forearm that was asked for last. */
  #asked = 0;
  readonly #chest: Joint;
  readonly #upperRest: Vector3;
  readonly #foreRest: Vector3;
  /** About which the wrist bends, at rest. */
  readonly #hinge: Vector3;
  readonly #upperAim: Aim;
  readonly #foreAim: Aim;
  readonly #relative = new Quaternion();

  constructor(arm: Arm, chest: Joint) {
    this.arm = arm;
    this.#chest = chest;
    this.#upperRest = arm.fore.offset.clone().normalize();
    this.#foreRest = arm.hand.offset.clone().normalize();
    this.#hinge = new Vector3().crossVectors(this.#foreRest, arm.palm).normalize();
    // At rest the elbows point backwards, in T and A pose alike.
    this.#upperAim = new Aim(this.#upperRest, BACK);
    this.#foreAim = new Aim(this.#foreRest, BACK);
  }

  /** Needs the chest in its place. */
  solve(hand: HandGoal, breath: number): void {
    const { arm } = this;
    this.#turnClavicle(hand, breath);
    arm.upper.delta.copy(arm.clavicle.delta);
    arm.upper.follow();
    grip.copy(arm.fist).lerp(arm.pinch, hand.pinch);
    arm.hand.delta.copy(hand.turn);
    for (let round = 0; round < ROUNDS; round += 1) {
      wrist.copy(grip).applyQuaternion(arm.hand.delta).negate().add(hand.grip);
      this.#bendElbow();
      this.#turnHand(hand.turn);
    }
    arm.fore.follow();
    arm.hand.follow();
    end.copy(grip).applyQuaternion(arm.hand.delta).add(arm.hand.place);
    this.error = end.distanceTo(hand.grip);
  }

  #turnClavicle(hand: HandGoal, breath: number): void {
    const { arm } = this;
    const chest = this.#chest;
    arm.clavicle.follow();
    arm.clavicle.delta.copy(chest.delta);
    arm.upper.follow();
    const length = arm.upperLength + arm.foreLength;
    goal.subVectors(hand.grip, arm.upper.place).applyQuaternion(inverse.copy(chest.delta).invert());
    goal.divideScalar(length);
    this.#ahead = goal.z;
    const far = smooth((goal.length() - 0.7) / 0.5);
    const forwards = PROTRACTION * far * clamp(goal.z, -0.3, 1);
    const up = ELEVATION * smooth((goal.y + 0.35) / 1.1) + 1.2 * DEGREE * breath;
    arm.clavicle.delta.multiply(part.setFromAxisAngle(UP, -arm.sign * forwards));
    arm.clavicle.delta.multiply(part.setFromAxisAngle(AHEAD, arm.sign * up));
  }

  #bendElbow(): void {
    const { arm } = this;
    // Elbows hang: down when the arm reaches forwards, back when it hangs, a little out always.
    const down = 0.25 + 0.65 * smooth(1.6 * this.#ahead);
    pole.set(arm.sign * 0.28, -down, -0.75).applyQuaternion(this.#chest.delta);
    twoBone(arm.upper.place, wrist, arm.upperLength, arm.foreLength, pole, SOFT_FROM, elbow, end, normal);
    this.#upperAim.turn(direction.subVectors(elbow, arm.upper.place), normal, arm.upper.delta);
    this.#foreAim.turn(direction.subVectors(end, elbow), normal, arm.fore.delta);
  }

  /** Hand and forearm share the turn about the forearm; the wrist bends no further than it can. */
  #turnHand(wanted: Quaternion): void {
    const { arm } = this;
    const relative = this.#relative.copy(arm.fore.delta).invert().multiply(wanted);
    this.#asked = bound(relative, this.#foreRest, this.#hinge, BOUNDS, this.#asked);
    const twist = clamp(this.#asked, -BOUNDS.twist, BOUNDS.twist);
    arm.hand.delta.copy(arm.fore.delta).multiply(relative);
    arm.fore.delta.multiply(part.setFromAxisAngle(this.#foreRest, twist * FOREARM_SHARE));
  }
}
