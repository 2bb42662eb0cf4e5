/** From a posture to the turns of all bones. */

import { Quaternion, Vector3 } from "three";
import { ArmSolver } from "./arm.ts";
import { closeHand } from "./fingers.ts";
import { LegSolver } from "./leg.ts";
import type { Posture } from "./posture.ts";
import { SIDES, type Joint, type Rig, type Side } from "./rig.ts";

const UP = new Vector3(0, 1, 0);
const LEFT = new Vector3(1, 0, 0);
const AHEAD = new Vector3(0, 0, 1);
const NONE = new Quaternion();
const part = new Quaternion();
const whole = new Quaternion();

/** Share of a turn of the chest against the pelvis that is reached at each bone of the spine. */
const SPINE_SHARES = { Spine: 0.4, Spine1: 0.75, Spine2: 1 } as const;
/** Of the head against the chest, at the neck. */
const NECK_SHARE = 0.5;
/** Share of the trunk's lean that the head goes along with, whatever it looks at. */
const HEAD_LEANS = 0.3;

export class Body {
  readonly rig: Rig;
  readonly arms: Readonly<Record<Side, ArmSolver>>;
  readonly legs: Readonly<Record<Side, LegSolver>>;

  constructor(rig: Rig) {
    this.rig = rig;
    const { Spine2, Hips } = rig.joints;
    this.arms = {
      Left: new ArmSolver(rig.arms.Left, Spine2),
      Right: new ArmSolver(rig.arms.Right, Spine2),
    };
    this.legs = {
      Left: new LegSolver(rig.legs.Left, Hips),
      Right: new LegSolver(rig.legs.Right, Hips),
    };
  }

  /** The hips come down where a leg would not reach its foot. */
  solve(pose: Posture): void {
    const { joints } = this.rig;
    this.#placePelvis(pose, joints.Hips);
    this.#turnSpine(pose);
    this.#turnHead(pose);
    for (const side of SIDES) {
      this.legs[side].solve(pose.feet[side]);
      this.arms[side].solve(pose.hands[side], pose.breath);
      closeHand(this.rig.arms[side], pose.hands[side].closed, pose.hands[side].pinch);
    }
    this.#turnEyes(pose);
    this.rig.write();
  }

  #placePelvis(pose: Posture, hips: Joint): void {
    hips.delta.setFromAxisAngle(UP, pose.heading + pose.sway);
    hips.delta.multiply(part.setFromAxisAngle(LEFT, pose.tilt));
    hips.delta.multiply(part.setFromAxisAngle(AHEAD, -pose.roll));
    hips.place.copy(pose.hips);
    const { Left, Right } = this.legs;
    Left.raiseHeel(pose.feet.Left);
    Right.raiseHeel(pose.feet.Right);
    hips.place.y -= Math.max(Left.lowering(pose.feet.Left), Right.lowering(pose.feet.Right));
  }

  #turnSpine(pose: Posture): void {
    const { Hips, Spine, Spine1, Spine2 } = this.rig.joints;
    // The chest does not go along with what the pelvis does in walking.
    whole.setFromAxisAngle(UP, pose.twist - pose.sway);
    whole.multiply(part.setFromAxisAngle(LEFT, pose.lean - 0.02 * pose.breath));
    whole.multiply(part.setFromAxisAngle(AHEAD, pose.roll - pose.bend));
    Spine.follow();
    Spine.delta.copy(Hips.delta).multiply(part.copy(NONE).slerp(whole, SPINE_SHARES.Spine));
    Spine1.follow();
    Spine1.delta.copy(Hips.delta).multiply(part.copy(NONE).slerp(whole, SPINE_SHARES.Spine1));
    Spine2.follow();
    Spine2.delta.copy(Hips.delta).multiply(part.copy(NONE).slerp(whole, SPINE_SHARES.Spine2));
  }

  #turnHead(pose: Posture): void {
    const { Spine2, Neck, Head } = this.rig.joints;
    const lean = (pose.tilt + pose.lean) * HEAD_LEANS;
    Head.delta.setFromAxisAngle(UP, pose.heading + pose.headYaw);
    Head.delta.multiply(part.setFromAxisAngle(LEFT, lean - pose.headPitch));
    Head.delta.multiply(part.setFromAxisAngle(AHEAD, -pose.headRoll));
    Neck.follow();
    Neck.delta.copy(Spine2.delta).slerp(Head.delta, NECK_SHARE);
    Head.follow();
  }

  #turnEyes(pose: Posture): void {
    const { eyes } = this.rig;
    for (const eye of eyes) {
      eye.reset();
      eye.turn(LEFT, -pose.eyePitch);
      eye.turn(UP, pose.eyeYaw);
    }
  }
}
