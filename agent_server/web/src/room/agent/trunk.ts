/** How the trunk helps a hand: it leans, turns and bends towards what is out of the arm's reach. */

import { Vector3 } from "three";
import { Spring, clamp, norm, smooth, softExcess } from "./maths.ts";
import type { Posture } from "./posture.ts";
import type { Arm, Rig } from "./rig.ts";

/** The trunk follows this fast, radians a second. */
const RATE = 9;
/** Share of the arm and hand that is used before the trunk helps. */
const EASY = 0.86;
/** Share of the lean that the pelvis takes. */
const PELVIS_SHARE = 0.45;
const MOST = { lean: 0.95, twist: 0.5, bend: 0.3 } as const;

const UP = new Vector3(0, 1, 0);
const reach = new Vector3();

export class Trunk {
  readonly #rig: Rig;
  readonly #lean = new Spring();
  readonly #twist = new Spring();
  readonly #bend = new Spring();
  /** What the posture asks for beside the reach. */
  lean = 0;
  twist = 0;
  #reachLean = 0;
  #reachTwist = 0;
  #reachBend = 0;

  constructor(rig: Rig) {
    this.#rig = rig;
  }

  /** Help nobody. */
  rest(): void {
    this.#reachLean = 0;
    this.#reachTwist = 0;
    this.#reachBend = 0;
  }

  /**
   * Help an arm towards a place in the world.
   *
   * @param pose Hips and heading are read.
   * @param hand From the wrist to the grip, metres.
   */
  help(pose: Posture, arm: Arm, place: Vector3, hand: number): void {
    const { Hips } = this.#rig.joints;
    reach.subVectors(place, pose.hips).applyAxisAngle(UP, -pose.heading);
    const shoulder = arm.upper.rest.place;
    const x = reach.x - (shoulder.x - Hips.rest.place.x);
    const y = reach.y - (shoulder.y - Hips.rest.place.y);
    const z = reach.z - (shoulder.z - Hips.rest.place.z);
    const easy = EASY * (arm.upperLength + arm.foreLength) + hand;
    const lacking = softExcess(norm(x, y, z) - easy, 0.08);
    const away = Math.atan2(x, Math.max(0.15, z));
    const ahead = Math.cos(away);
    // A trunk of this length brings the shoulder forwards by its sine.
    const length = shoulder.y - Hips.rest.place.y;
    this.#reachLean = Math.min(MOST.lean, Math.asin(clamp((1.25 * lacking * ahead) / length, 0, 1)));
    const forwards = -arm.sign * 0.55 * smooth(lacking / 0.25) * ahead;
    const towards = 0.4 * away * smooth(lacking / 0.2);
    this.#reachTwist = clamp(forwards + towards, -MOST.twist, MOST.twist);
    this.#reachBend = clamp(lacking * Math.sin(away), -MOST.bend, MOST.bend);
  }

  step(pose: Posture, dt: number): void {
    const lean = this.#lean.step(this.lean + this.#reachLean, RATE, dt);
    pose.tilt = PELVIS_SHARE * lean;
    pose.lean = (1 - PELVIS_SHARE) * lean;
    pose.twist = this.#twist.step(this.twist + this.#reachTwist, RATE, dt);
    pose.bend = this.#bend.step(this.#reachBend, RATE, dt);
  }
}
