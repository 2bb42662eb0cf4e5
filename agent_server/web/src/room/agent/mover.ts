/**
 * The body as a whole: who carries the hips (seat or gait), hands, trunk, gaze, breath. It is told
 * where to go and what to do with its hands, and makes a pose of that at every step.
 */

import { Vector3 } from "three";
import type { Spot } from "../layout.ts";
import { Body } from "./body.ts";
import { Breath } from "./breath.ts";
import { AngleChannel, PlaceChannel } from "./channel.ts";
import { Foot } from "./foot.ts";
import { Gait } from "./gait.ts";
import { Gaze } from "./gaze.ts";
import { Hand, type Bearing } from "./hand.ts";
import { Spring, clamp, norm, type Chance } from "./maths.ts";
import type { Going } from "./path.ts";
import { BY_CHAIR, sideOf } from "./places.ts";
import { posture, type Posture } from "./posture.ts";
import { SIDES, type Rig, type Side } from "./rig.ts";
import { Seat } from "./seat.ts";
import { Trunk } from "./trunk.ts";

/** Seconds in which the hips go over from seat to gait, and back. */
const HAND_OVER_S = 0.4;
/** Risen this far, one may begin to walk. */
const MAY_WALK = 0.82;
/** How far one leans when one sits at the desk, and when one walks, radians. */
const LEAN = { seated: 0.09, walking: 0.07, standing: 0.01 } as const;
/** Turn of the pelvis for a metre between the feet, radians; and its drop on the swinging side. */
const SWAY = 0.28;
const DROP = 0.045;

export class Mover {
  readonly pose: Posture = posture();
  readonly body: Body;
  readonly gaze: Gaze;
  readonly hands: Readonly<Record<Side, Hand>>;
  readonly seat: Seat;
  readonly gait: Gait;
  readonly feet: Readonly<Record<Side, Foot>> = { Left: new Foot(), Right: new Foot() };
  isTyping = false;
  /** Of the trunk for a motion that is played, radians. */
  inclination = 0;
  readonly #rig: Rig;
  readonly #trunk: Trunk;
  readonly #breath = new Breath();
  readonly #hips = new PlaceChannel();
  readonly #heading = new AngleChannel();
  readonly #source = new Vector3();
  readonly #going: Going = { x: 0, z: 0, heading: 0, speedX: 0, speedZ: 0, turning: 0 };
  readonly #bearing: { -readonly [K in keyof Bearing]: Bearing[K] } = {
    risen: 0,
    otherFootAhead: 0,
    typed: 0,
  };
  readonly #risen = new Spring();
  #isUpright = false;
  #reaching: { readonly side: Side; readonly place: Vector3 } | null = null;
  readonly #reachPlace = new Vector3();

  constructor(rig: Rig, chance: Chance) {
    this.#rig = rig;
    this.body = new Body(rig);
    this.gaze = new Gaze(rig, chance);
    this.hands = { Left: new Hand(rig, "Left"), Right: new Hand(rig, "Right") };
    this.seat = new Seat(rig, this.feet);
    this.gait = new Gait(rig, this.feet);
    this.#trunk = new Trunk(rig);
    this.#hips.set(this.seat.hips(this.pose.hips));
    this.#heading.set(this.seat.heading);
  }

  /** Whether it stands or walks. */
  get isUpright(): boolean {
    return this.#isUpright;
  }

  /** Whether it sits at the desk and faces it. */
  get isSeated(): boolean {
    return !this.#isUpright && this.seat.isSeated;
  }

  get isWalking(): boolean {
    return this.#isUpright && !this.gait.isSettled;
  }

  /** Whether the hands may be on the desk. */
  get isAtDesk(): boolean {
    return !this.#isUpright && this.seat.goal === "seated" && this.seat.risen < 0.25 && Math.abs(this.seat.heading) < 0.25;
  }

  /** @param side Of the chair, where one has the choice. */
  standUp(side: Side): void {
    if (!this.#isUpright) this.seat.stand(side);
  }

  /** From where one gets up; it must stand there. */
  sitDown(): void {
    if (this.#isUpright) {
      this.#isUpright = false;
      this.seat.takeStanding(sideOf(this.gait.now.x));
      this.#hips.change(HAND_OVER_S);
      this.#heading.change(HAND_OVER_S);
    }
    this.seat.sit();
  }

  walkTo(spot: Spot): void {
    this.gait.walkTo(this.#goes(), spot);
  }

  /** Stand still, or go on to where one was sitting down or getting up. */
  halt(): void {
    if (this.#isUpright) {
      if (!this.gait.isSettled) this.gait.stop(this.#goes());
    } else if (this.seat.risen > 0.5) this.seat.stand(this.seat.side);
    else this.seat.sit();
  }

  isAt(spot: Spot): boolean {
    const { x, z, heading } = this.gait.now;
    const turned = Math.abs(Math.sin((heading - spot.heading) / 2));
    return this.#isUpright && this.gait.hasArrived && norm(x - spot.at[0], z - spot.at[1]) < 0.06 && turned < 0.06;
  }

  /** Lean towards a place for a hand; null: no longer. */
  reachFor(side: Side | null, place: Vector3 | null): void {
    if (side === null || place === null) {
      this.#reaching = null;
      return;
    }
    this.#reachPlace.copy(place);
    if (this.#reaching?.side !== side) this.#reaching = { side, place: this.#reachPlace };
  }

  step(dt: number): void {
    const { pose } = this;
    if (!this.#isUpright) {
      this.seat.step(dt);
      if (this.seat.goal === "standing" && this.seat.risen > MAY_WALK) this.#takeOver();
    }
    if (this.#isUpright) this.gait.step(dt);
    this.#moveFeet(dt);
    const source = this.#isUpright ? this.gait.hips(this.#source) : this.seat.hips(this.#source);
    const heading = this.#isUpright ? this.gait.now.heading : this.seat.heading;
    pose.heading = this.#heading.follow(heading, dt);
    pose.hips.copy(this.#hips.follow(source, pose.heading, dt));
    pose.breath = this.#breath.step(dt);
    this.#turnTrunk(dt);
    this.gaze.step(pose, dt);
    this.#moveHands(dt);
    this.body.solve(pose);
    for (const side of SIDES) this.feet[side].shown = pose.feet[side].pitch;
  }

  #takeOver(): void {
    const going = this.#goes();
    this.#isUpright = true;
    this.gait.stop(going);
    this.#hips.change(HAND_OVER_S);
    this.#heading.change(HAND_OVER_S);
  }

  #goes(): Going {
    const going = this.#going;
    if (this.#isUpright) return Object.assign(going, this.gait.now);
    const [x, z] = BY_CHAIR[this.seat.side].at;
    going.x = x;
    going.z = z;
    going.heading = this.seat.heading;
    going.speedX = 0;
    going.speedZ = 0;
    going.turning = 0;
    return going;
  }

  #moveFeet(dt: number): void {
    for (const side of SIDES) {
      const foot = this.feet[side];
      foot.step(dt);
      const goal = this.pose.feet[side];
      goal.x = foot.x;
      goal.z = foot.z;
      goal.yaw = foot.yaw;
      goal.lift = foot.lift;
      goal.pitch = foot.pitch;
    }
  }

  #turnTrunk(dt: number): void {
    const { pose } = this;
    const trunk = this.#trunk;
    if (this.#isUpright) {
      const { speedX, speedZ, heading } = this.gait.now;
      const ahead = speedX * Math.sin(heading) + speedZ * Math.cos(heading);
      trunk.lean = LEAN.standing + LEAN.walking * clamp(ahead, -0.3, 1.2);
      const apart = this.#footAhead("Right") - this.#footAhead("Left");
      pose.sway = SWAY * clamp(apart, -0.8, 0.8);
      // The pelvis drops a little on the side that swings.
      pose.roll = DROP * this.gait.weight * clamp(Math.abs(ahead), 0, 1);
    } else {
      trunk.lean = LEAN.seated + this.seat.bow;
      pose.sway *= Math.exp(-8 * dt);
      pose.roll *= Math.exp(-8 * dt);
    }
    trunk.lean += this.inclination;
    trunk.twist = this.gaze.chest;
    const reaching = this.#reaching;
    if (reaching === null) trunk.rest();
    else {
      const arm = this.#rig.arms[reaching.side];
      trunk.help(pose, arm, reaching.place, this.hands[reaching.side].length);
    }
    trunk.step(pose, dt);
  }

  #moveHands(dt: number): void {
    const bearing = this.#bearing;
    bearing.risen = this.#risen.step(this.#isUpright ? 1 : this.seat.risen, 20, dt);
    if (this.isTyping) bearing.typed += dt;
    for (const side of SIDES) {
      bearing.otherFootAhead = this.#isUpright ? this.#footAhead(side === "Left" ? "Right" : "Left") : 0;
      this.hands[side].step(this.pose, bearing, dt);
    }
  }

  /** How far a foot is ahead of the hips, metres. */
  #footAhead(side: Side): number {
    const { x, z, heading } = this.gait.now;
    const foot = this.feet[side];
    return (foot.x - x) * Math.sin(heading) + (foot.z - z) * Math.cos(heading);
  }
}
