/**
 * Sitting down and getting up: two movements, one that turns on the seat and one that rises, each
 * of which may be turned back at any moment. Feet step while the seat bears the weight.
 */

import { Vector3 } from "three";
import { CHAIR } from "../layout.ts";
import { AngleChannel } from "./channel.ts";
import type { Foot, Landing } from "./foot.ts";
import { mix, norm, smooth, wrap } from "./maths.ts";
import { BY_CHAIR } from "./places.ts";
import type { Rig, Side } from "./rig.ts";

/** Seconds: to turn on the seat, to rise, to sink. */
const TURN_S = 0.48;
const RISE_S = 0.78;
const SINK_S = 0.78;
/** One rises once one has turned this far, and turns in once one has sunk this far. */
const TURNED = 0.5;
const SUNK = 0.3;
/** From here on (0 seated, 1 up) the feet bear the weight and stay. */
const BEARS = 0.2;
/** Hip joints over the seat, metres. */
const OVER_SEAT = 0.085;
/** Where the feet stand when one sits at the desk, before the hips and to each side; and when one rises. */
const FEET = { ahead: 0.37, aside: 0.12, turned: 0.12, risen: 0.095 } as const;
const STEP = { duration: 0.3, lift: 0.035, landing: 0 } as const;
/** A foot may leave the floor when the other one lands within this time. */
const OVERLAP_S = 0.12;
/** Of the trunk while one rises, radians; shared by pelvis and spine. */
const BOW = 0.75;
const OFF = 0.03;
const FAR_OFF = 0.65;

export type SeatGoal = "seated" | "standing";

export class Seat {
  readonly #feet: Readonly<Record<Side, Foot>>;
  readonly #standing: number;
  readonly #seated: number;
  readonly #ankleAhead: number;
  readonly #turn = new AngleChannel();
  readonly #rise = new AngleChannel();
  #goal: SeatGoal = "seated";
  /** On which one gets up, or has come to sit down. */
  #side: Side = "Left";
  readonly #landing: Landing = { x: 0, z: 0, yaw: 0 };
  #turnGoal = 0;
  #riseGoal = 0;

  constructor(rig: Rig, feet: Readonly<Record<Side, Foot>>) {
    const { Hips } = rig.joints;
    this.#feet = feet;
    this.#standing = rig.hipHeight - 0.012;
    const overJoints = Hips.rest.place.y - rig.legs.Left.thigh.rest.place.y;
    this.#seated = CHAIR.seat + OVER_SEAT + overJoints;
    this.#ankleAhead = rig.legs.Left.foot.rest.place.z - Hips.rest.place.z;
    for (const side of ["Left", "Right"] as const) {
      const { x, z, yaw } = this.#home(side);
      feet[side].set(x, z, yaw);
    }
  }

  /** 0 seated, 1 up. */
  get risen(): number {
    return this.#rise.value;
  }

  get isSeated(): boolean {
    return this.#goal === "seated" && this.#turn.value < 0.05 && this.#rise.value < 0.01;
  }

  get goal(): SeatGoal {
    return this.#goal;
  }

  /** The body stands before the chair already, its back to it. */
  takeStanding(side: Side): void {
    this.#side = side;
    this.#turn.set(1);
    this.#rise.set(1);
    this.#turnGoal = 1;
    this.#riseGoal = 1;
    this.#goal = "standing";
  }

  sit(): void {
    this.#goal = "seated";
  }

  /** @param side Only taken while one faces the desk, both feet under it. */
  stand(side: Side): void {
    this.#goal = "standing";
    const isFree = this.#turnGoal === 0 && this.#turn.value < 0.05;
    if (isFree && this.#off("Left") < 0.1 && this.#off("Right") < 0.1) this.#side = side;
  }

  get side(): Side {
    return this.#side;
  }

  step(dt: number): void {
    const isUp = this.#goal === "standing";
    // Who is on the way up turns in only after sinking; who sits rises only after turning out.
    const isSunk = this.#rise.value < SUNK && this.#rise.speed <= 0;
    const turn = isUp ? 1 : isSunk ? 0 : this.#turnGoal;
    const rise = !isUp ? 0 : this.#turn.value > TURNED && this.#areFeetReady() ? 1 : this.#riseGoal;
    if (turn !== this.#turnGoal) {
      this.#turnGoal = turn;
      this.#turn.change(TURN_S);
    }
    if (rise !== this.#riseGoal) {
      this.#riseGoal = rise;
      this.#rise.change(rise === 1 ? RISE_S : SINK_S);
    }
    this.#turn.follow(this.#turnGoal, dt);
    this.#rise.follow(this.#riseGoal, dt);
    this.#moveFeet();
  }

  get heading(): number {
    return BY_CHAIR[this.#side].heading * this.#turn.value;
  }

  /** Of the trunk forwards, radians. */
  get bow(): number {
    const u = this.#rise.value;
    return BOW * smooth(u / 0.38) * (1 - smooth((u - 0.36) / 0.6));
  }

  /** Where the hips are. They go forwards before they go up. */
  hips(out: Vector3): Vector3 {
    const u = this.#rise.value;
    const [x, z] = BY_CHAIR[this.#side].at;
    const over = smooth(u / 0.85);
    out.set(mix(CHAIR.at[0], x, over), 0, mix(CHAIR.at[1], z, over));
    out.y = mix(this.#seated, this.#standing, smooth((u - 0.12) / 0.88));
    return out;
  }

  /** Feet are where they can bear the body up, or about to be. */
  #areFeetReady(): boolean {
    return this.#isNear("Left") && this.#isNear("Right");
  }

  #isNear(side: Side): boolean {
    const foot = this.#feet[side];
    return foot.remaining < 0.15 && this.#off(side) < 0.12;
  }

  #moveFeet(): void {
    if (this.#rise.value > BEARS) return;
    // Turning out begins with the foot on that side, turning in with the other one.
    const isOut = this.#turnGoal > 0.5;
    const inTurn = (this.#side === "Left") === isOut ? "Left" : "Right";
    const last = inTurn === "Left" ? "Right" : "Left";
    // A foot that would be left far behind goes first.
    const first = this.#off(last) > FAR_OFF && this.#off(last) > this.#off(inTurn) ? last : inTurn;
    this.#bring(first);
    this.#bring(first === "Left" ? "Right" : "Left");
  }

  /** How far a foot is from where it belongs, metres. */
  #off(side: Side): number {
    const { x, z } = this.#home(side);
    return norm(this.#feet[side].x - x, this.#feet[side].z - z);
  }

  #bring(side: Side): void {
    const foot = this.#feet[side];
    if (!foot.isPlanted) return;
    foot.peel = 0;
    const { x, z, yaw } = this.#home(side);
    const isOff = this.#off(side) > OFF || Math.abs(wrap(foot.yaw - yaw)) > 0.1;
    if (isOff && this.#feet[side === "Left" ? "Right" : "Left"].remaining < OVERLAP_S) {
      foot.swingTo(x, z, yaw, STEP);
    }
  }

  /** Where a foot belongs: under the desk, or where one stands before the turned seat. */
  #home(side: Side): Readonly<Landing> {
    const sign = side === "Left" ? 1 : -1;
    const home = this.#landing;
    if (this.#turnGoal < 0.5) {
      home.x = CHAIR.at[0] + sign * FEET.aside;
      home.z = CHAIR.at[1] + FEET.ahead;
      home.yaw = sign * FEET.turned;
      return home;
    }
    const { at, heading } = BY_CHAIR[this.#side];
    const [sine, cosine] = [Math.sin(heading), Math.cos(heading)];
    home.x = at[0] + sign * FEET.risen * cosine + this.#ankleAhead * sine;
    home.z = at[1] - sign * FEET.risen * sine + this.#ankleAhead * cosine;
    home.yaw = heading + sign * 0.06;
    return home;
  }
}
