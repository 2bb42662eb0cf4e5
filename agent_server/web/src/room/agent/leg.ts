/** One leg: from a footing to the turns of thigh, shank, foot and toes. */

import { Quaternion, Vector3 } from "three";
import { Aim, twoBone } from "./ik.ts";
import { norm, smooth, softExcess } from "./maths.ts";
import type { Footing } from "./posture.ts";
import type { Joint, Leg } from "./rig.ts";

/** The hips come down so far that no leg is stretched more than this share of its length, ... */
export const STRETCH = 0.986;
/** ... gently, over this height in metres. */
const GENTLY = 0.015;
/** Beyond this share of its length a leg does not quite reach its foot. */
const SOFT_FROM = 0.992;
/** The heel comes up before the ankle is bent further than this, radians. */
const MOST_BENT = 0.28;
const ROUNDS = 3;
/** Radians that the heel comes up for each metre that a leg lacks, and at most. */
const HEEL_RATE = 4;
const MOST_RAISED = 1.05;
/** A foot this far behind the hip does all of it with its heel, metres. */
const BEHIND = 0.2;

const UP = new Vector3(0, 1, 0);
const LEFT = new Vector3(1, 0, 0);
const AHEAD = new Vector3(0, 0, 1);
const ankle = new Vector3();
const hip = new Vector3();
const knee = new Vector3();
const end = new Vector3();
const normal = new Vector3();
const pole = new Vector3();
const part = new Quaternion();
const direction = new Vector3();

/** Where the ankle is: the foot turns about the toes' joint when the heel is up, about the heel else. */
export function ankleOf(leg: Leg, foot: Footing, out: Vector3): Vector3 {
  const isOnBall = foot.pitch < 0;
  const along = isOnBall ? leg.ball : -leg.heel;
  const height = isOnBall ? leg.ballHeight : 0;
  const over = leg.ankleHeight - height;
  const [sine, cosine] = [Math.sin(foot.pitch), Math.cos(foot.pitch)];
  const ahead = along - along * cosine - over * sine;
  const above = height + over * cosine - along * sine;
  return out.set(
    foot.x + ahead * Math.sin(foot.yaw),
    foot.lift + above,
    foot.z + ahead * Math.cos(foot.yaw),
  );
}

export class LegSolver {
  readonly leg: Leg;
  readonly #pelvis: Joint;
  readonly #thighAim: Aim;
  readonly #shankAim: Aim;

  constructor(leg: Leg, pelvis: Joint) {
    this.leg = leg;
    this.#pelvis = pelvis;
    this.#thighAim = new Aim(leg.shank.offset, AHEAD);
    this.#shankAim = new Aim(leg.foot.offset, AHEAD);
  }

  /** A leg that the body leaves behind brings its heel up, so that it reaches the floor. */
  raiseHeel(foot: Footing): void {
    for (let round = 0; round < ROUNDS; round += 1) {
      const lacking = this.lowering(foot);
      if (lacking <= 0) return;
      const behind = (hip.x - ankle.x) * Math.sin(foot.yaw) + (hip.z - ankle.z) * Math.cos(foot.yaw);
      const raise = HEEL_RATE * lacking * smooth(behind / BEHIND);
      foot.pitch = Math.max(-MOST_RAISED, foot.pitch - raise);
    }
  }

  /** How far the hips must come down, in metres, for this leg to reach its foot. */
  lowering(foot: Footing): number {
    const { leg } = this;
    ankleOf(leg, foot, ankle);
    hip.copy(leg.thigh.offset).applyQuaternion(this.#pelvis.delta).add(this.#pelvis.place);
    const away = norm(hip.x - ankle.x, hip.z - ankle.z);
    const length = STRETCH * (leg.thighLength + leg.shankLength);
    const height = Math.sqrt(Math.max(0.01, length * length - away * away));
    return softExcess(hip.y - ankle.y - height, GENTLY);
  }

  /** Needs the pelvis in its place. */
  solve(foot: Footing): void {
    const { leg } = this;
    leg.thigh.follow();
    this.#bendKnee(foot);
    for (let round = 0; round < ROUNDS; round += 1) {
      const beyond = this.#bent(foot) - MOST_BENT;
      if (beyond <= 0) break;
      foot.pitch -= beyond;
      this.#bendKnee(foot);
    }
    leg.foot.delta.setFromAxisAngle(UP, foot.yaw).multiply(part.setFromAxisAngle(LEFT, -foot.pitch));
    // Toes stay flat on the floor while the heel comes up.
    leg.toes.delta.setFromAxisAngle(UP, foot.yaw);
    leg.toes.delta.multiply(part.setFromAxisAngle(LEFT, -Math.max(0, foot.pitch)));
    leg.shank.follow();
    leg.foot.follow();
    leg.toes.follow();
  }

  /** How far the shank leans over the foot, against rest, radians. */
  #bent(foot: Footing): number {
    direction.copy(AHEAD).applyQuaternion(this.leg.shank.delta);
    const ahead = direction.x * Math.sin(foot.yaw) + direction.z * Math.cos(foot.yaw);
    return foot.pitch + Math.atan2(-direction.y, ahead);
  }

  #bendKnee(foot: Footing): void {
    const { leg } = this;
    const pelvis = this.#pelvis;
    ankleOf(leg, foot, ankle);
    // The knee points between where the pelvis faces and where the toes point.
    pole.set(Math.sin(foot.yaw), 0.1, Math.cos(foot.yaw));
    direction.set(leg.sign * 0.06, 0, 1).applyQuaternion(pelvis.delta);
    pole.add(direction);
    twoBone(leg.thigh.place, ankle, leg.thighLength, leg.shankLength, pole, SOFT_FROM, knee, end, normal);
    this.#thighAim.turn(direction.subVectors(knee, leg.thigh.place), normal, leg.thigh.delta);
    this.#shankAim.turn(direction.subVectors(end, knee), normal, leg.shank.delta);
  }
}
