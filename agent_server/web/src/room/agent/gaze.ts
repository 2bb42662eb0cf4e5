/** Where the agent looks: eyes first, then the head, then the chest. */

import { Vector3 } from "three";
import { Spring, clamp, norm, smooth, type Chance } from "./maths.ts";
import type { Posture } from "./posture.ts";
import type { Rig } from "./rig.ts";

const DEGREE = Math.PI / 180;
/** How fast they follow, radians a second: natural frequencies. */
const EYE_RATE = 42;
const HEAD_RATE = 8.5;
/** Share of a gaze's angle that the head takes, and that the chest takes beyond an easy angle. */
const HEAD_SHARE = { yaw: 0.82, pitch: 0.68 } as const;
const CHEST_SHARE = 0.38;
const EASY_YAW = 22 * DEGREE;
const MOST = {
  chest: 24 * DEGREE,
  neckYaw: 52 * DEGREE,
  headUp: 26 * DEGREE,
  headDown: -34 * DEGREE,
  eyeYaw: 28 * DEGREE,
  eyePitch: 22 * DEGREE,
} as const;
/** What is further behind than this is not looked at; the head comes back to the front. */
const BEHIND = { from: 115 * DEGREE, over: 35 * DEGREE } as const;
/** Eyes are never quite still. */
const FIXATION = { angle: 1.1 * DEGREE, least: 0.5, most: 1.9 } as const;
const NOD = { angle: 11 * DEGREE, duration: 0.75 } as const;

const UP = new Vector3(0, 1, 0);
const eye = new Vector3();

export class Gaze {
  readonly target = new Vector3(0, 1.4, 2);
  /** Of the chest, wanted: the trunk turns this far. */
  chest = 0;
  readonly #rig: Rig;
  readonly #chance: Chance;
  readonly #headYaw = new Spring();
  readonly #headPitch = new Spring();
  readonly #eyeYaw = new Spring();
  readonly #eyePitch = new Spring();
  #fixation = { yaw: 0, pitch: 0, left: 0 };
  #nod = Number.POSITIVE_INFINITY;

  constructor(rig: Rig, chance: Chance) {
    this.#rig = rig;
    this.#chance = chance;
  }

  aim(target: Vector3): void {
    this.target.copy(target);
  }

  nod(): void {
    if (this.#nod >= NOD.duration) this.#nod = 0;
  }

  step(pose: Posture, dt: number): void {
    const { Head } = this.#rig.joints;
    eye.copy(this.#rig.gaze).applyQuaternion(Head.delta).add(Head.place);
    eye.subVectors(this.target, eye).applyAxisAngle(UP, -pose.heading);
    const angle = Math.atan2(eye.x, eye.z);
    const isSeen = 1 - smooth((Math.abs(angle) - BEHIND.from) / BEHIND.over);
    const yaw = angle * isSeen;
    const pitch = Math.atan2(eye.y, norm(eye.x, eye.z)) * isSeen;

    const over = Math.sign(yaw) * Math.max(0, Math.abs(yaw) - EASY_YAW);
    this.chest = clamp(CHEST_SHARE * over, -MOST.chest, MOST.chest);
    const headYaw = pose.twist + clamp(HEAD_SHARE.yaw * yaw - pose.twist, -MOST.neckYaw, MOST.neckYaw);
    const headPitch = clamp(HEAD_SHARE.pitch * pitch, MOST.headDown, MOST.headUp);
    pose.headYaw = this.#headYaw.step(headYaw, HEAD_RATE, dt);
    pose.headPitch = this.#headPitch.step(headPitch, HEAD_RATE, dt) + this.#nodding(dt);
    pose.headRoll = 0.08 * (pose.headYaw - pose.twist);

    this.#fixate(dt);
    const eyeYaw = yaw - pose.headYaw + this.#fixation.yaw;
    const eyePitch = pitch - pose.headPitch + this.#fixation.pitch;
    pose.eyeYaw = this.#eyeYaw.step(clamp(eyeYaw, -MOST.eyeYaw, MOST.eyeYaw), EYE_RATE, dt);
    pose.eyePitch = this.#eyePitch.step(
      clamp(eyePitch, -MOST.eyePitch, MOST.eyePitch),
      EYE_RATE,
      dt,
    );
  }

  #nodding(dt: number): number {
    if (this.#nod >= NOD.duration) return 0;
    this.#nod += dt;
    const wave = Math.sin(Math.PI * clamp(this.#nod / NOD.duration, 0, 1));
    return -NOD.angle * wave * wave;
  }

  #fixate(dt: number): void {
    const fixation = this.#fixation;
    fixation.left -= dt;
    if (fixation.left > 0) return;
    const chance = this.#chance;
    fixation.left = chance.between(FIXATION.least, FIXATION.most);
    fixation.yaw = FIXATION.angle * chance.between(-1, 1);
    fixation.pitch = FIXATION.angle * chance.between(-0.6, 0.6);
  }
}
