/**
 * Standing and walking: where the body goes, when which foot steps, and where it lands.
 *
 * A foot lands where the body will be over it in the middle of its stance, so starts, stops,
 * curves and turns on the spot are all the same thing.
 */

import { Vector3 } from "three";
import type { Spot } from "../layout.ts";
import type { Foot, Landing, Swing } from "./foot.ts";
import { Spring, clamp, mix, norm, smooth, wrap } from "./maths.ts";
import { STRETCH } from "./leg.ts";
import { Path, type Going } from "./path.ts";
import { SIDES, type Rig, type Side } from "./rig.ts";
import { route } from "./route.ts";

/** Seconds: of a swing, and of both feet on the floor between two. */
const SWING = { long: 0.36, short: 0.28 } as const;
const DOUBLE_SUPPORT = { long: 0.09, short: 0.06 } as const;
/** After landing, the body passes over a foot in this time; its turn is planned for less. */
const LEAD = { place: 0.19, turn: 0.16 } as const;
/** A stride from which it is a long one, metres. */
const LONG = 0.7;
/** A foot is put right when it is further off than this, metres and radians. */
const OFF = { place: 0.025, turn: 0.1 } as const;
/** Half the distance between the feet, and the least one between a foot and the other's line. */
const HALF_WIDTH = 0.085;
/** A foot that has this much further to go than the other one steps first. */
const LEFT_BEHIND = 0.1;
const LEAST_APART = 0.13;
/** No landing is moved aside further than this for it. */
const MOST_ASIDE = 0.1;
/** Heel up before the swing, toes up at its end, and the sole's height, for a long stride. */
const PEEL = 0.62;
const PEEL_BEFORE = 0.24;
const TOES = 0.2;
const LIFT = { long: 0.035, short: 0.03 } as const;
/** No foot is turned further in or out against the body, radians. */
const MOST_TURNED = 0.6;
/** From where on the body waits for a standing foot, metres and radians, and over how much. */
const WAIT = { place: 0.48, turn: 0.85, over: 0.3 } as const;
const LEAST_EASE = 0.12;
/** Slack of the knees when it stands, and how far the body moves over the standing foot. */
const SLACK = 0.012;
const SHIFT = 0.028;
/** The hips come down for a landing this long before it, at this rate (radians a second). */
const DROP_BEFORE = 0.24;
const DROP_RATE = 17;

export class Gait {
  readonly #feet: Readonly<Record<Side, Foot>>;
  readonly #path = new Path();
  readonly #ankleAhead: number;
  readonly #height: number;
  /** Of the hip joints over the ankles, when it stands. */
  readonly #hipOverAnkle: number;
  readonly #shift = new Spring();
  readonly #drop = new Spring();
  readonly #legLength: number;
  /** Of the hips when the foot that swings will land, metres. */
  #landingDrop = 0;
  readonly #now: Going = { x: 0, z: 0, heading: 0, speedX: 0, speedZ: 0, turning: 0 };
  readonly #then: Going = { x: 0, z: 0, heading: 0, speedX: 0, speedZ: 0, turning: 0 };
  readonly #landing: Landing = { x: 0, z: 0, yaw: 0 };
  /** Since the walk began; the body's way along its path may lag behind it. */
  #time = 0;
  #along = 0;
  /** When the next foot may leave the floor, and which one. */
  #liftAt = 0;
  #next: Side = "Left";
  #end: Spot = { at: [0, 0], heading: 0 };
  #isSettled = true;

  constructor(rig: Rig, feet: Readonly<Record<Side, Foot>>) {
    this.#feet = feet;
    this.#height = rig.hipHeight - SLACK;
    const { thigh, thighLength, shankLength, ankleHeight } = rig.legs.Left;
    this.#legLength = STRETCH * (thighLength + shankLength);
    this.#hipOverAnkle = thigh.rest.place.y - SLACK - ankleHeight;
    this.#ankleAhead = rig.legs.Left.foot.rest.place.z - rig.joints.Hips.rest.place.z;
  }

  /** Whether the body is where it was to go, both feet under it. */
  get isSettled(): boolean {
    return this.#isSettled;
  }

  /** Whether the body is where it was to go; a foot may still follow. */
  get hasArrived(): boolean {
    return this.#along >= this.#path.duration;
  }

  /** Seconds until it has arrived. */
  get remaining(): number {
    return Math.max(0, this.#path.duration - this.#along);
  }

  get now(): Readonly<Going> {
    return this.#now;
  }

  /** Begin to go from where the body is, as it moves, to a spot. */
  walkTo(from: Going, end: Spot): void {
    this.#end = end;
    this.#path.plan(from, route([from.x, from.z], end.at), end);
    this.#begin(from);
  }

  /** Stop as soon as one can. */
  stop(from: Going): void {
    const speed = norm(from.speedX, from.speedZ);
    const on = speed * 0.22;
    const k = speed > 0.05 ? on / speed : 0;
    const at = [from.x + from.speedX * k, from.z + from.speedZ * k] as const;
    this.#end = { at, heading: from.heading + from.turning * 0.12 };
    if (k > 0) this.#path.plan(from, [[from.x, from.z], at], this.#end);
    else this.#path.stay(from.x, from.z, from.heading);
    this.#begin(from);
  }

  #begin(from: Going): void {
    this.#time = 0;
    this.#along = 0;
    this.#isSettled = false;
    this.#now.x = from.x;
    this.#now.z = from.z;
    this.#now.heading = from.heading;
    const { Left, Right } = this.#feet;
    const swinging = !Left.isPlanted ? Left : !Right.isPlanted ? Right : null;
    if (swinging === null) {
      this.#liftAt = 0;
      this.#next = this.#first();
    } else {
      const side = swinging === Left ? "Left" : "Right";
      this.#liftAt = swinging.remaining + DOUBLE_SUPPORT.short;
      this.#next = side === "Left" ? "Right" : "Left";
      if (swinging.remaining > 0.12) {
        const { x, z, yaw } = this.#landingOf(side, swinging.remaining);
        swinging.divert(x, z, yaw);
      }
    }
  }

  /** The foot that is left behind, or the one on the side to which it goes or turns. */
  #first(): Side {
    const { x, z, heading } = this.#now;
    const behind = this.#off("Left") - this.#off("Right");
    if (Math.abs(behind) > LEFT_BEHIND) return behind > 0 ? "Left" : "Right";
    this.#path.at(0.6, this.#then);
    const [dx, dz] = [this.#then.x - x, this.#then.z - z];
    const left = dx * Math.cos(heading) - dz * Math.sin(heading);
    const to = left + 0.12 * wrap(this.#then.heading - heading);
    return to > 0 ? "Left" : "Right";
  }

  /** How far a foot is from where it would land now, metres. */
  #off(side: Side): number {
    const { x, z } = this.#landingOf(side, SWING.short);
    return norm(x - this.#feet[side].x, z - this.#feet[side].z);
  }

  /** Move the feet; afterwards {@link now} tells where the body is. */
  step(dt: number): void {
    this.#time += dt;
    this.#along += dt * this.#ease();
    this.#path.at(this.#along, this.#now);
    const { Left, Right } = this.#feet;
    if (Left.isPlanted && Right.isPlanted && this.#time >= this.#liftAt && !this.#isSettled) {
      const other: Side = this.#next === "Left" ? "Right" : "Left";
      if (!this.#takeStep(this.#next) && !this.#takeStep(other) && this.hasArrived) {
        this.#isSettled = true;
      }
    }
    this.#peel();
    const weight = !Left.isPlanted ? -1 : !Right.isPlanted ? 1 : 0;
    this.#shift.step(weight, 11, dt);
    const swinging = Left.isPlanted ? Right : Left;
    const isLanding = !swinging.isPlanted && swinging.remaining < DROP_BEFORE;
    this.#drop.step(isLanding ? this.#landingDrop : 0, DROP_RATE, dt);
  }

  /** Where the hips are, for what {@link now} says; legs that are too short pull them down later. */
  hips(out: Vector3): Vector3 {
    const { x, z, heading } = this.#now;
    const shift = SHIFT * this.#shift.value;
    const height = this.#height - this.#drop.value;
    return out.set(x + shift * Math.cos(heading), height, z - shift * Math.sin(heading));
  }

  /** -1 when the body rests on the right foot alone, 1 on the left one. */
  get weight(): number {
    return this.#shift.value;
  }

  /** The body waits for a foot that is left too far behind, or turned too far: 1 goes on. */
  #ease(): number {
    let ease = 1;
    for (const side of SIDES) {
      const foot = this.#feet[side];
      if (!foot.isPlanted) continue;
      const { x, z, heading } = this.#now;
      const far = norm(foot.x - x, foot.z - z);
      const turned = Math.abs(wrap(foot.yaw - heading));
      ease = Math.min(ease, 1 - smooth((far - WAIT.place) / WAIT.over));
      ease = Math.min(ease, 1 - smooth((turned - WAIT.turn) / WAIT.over));
    }
    return Math.max(LEAST_EASE, ease);
  }

  #takeStep(side: Side): boolean {
    const foot = this.#feet[side];
    const { x, z, yaw } = this.#landingOf(side, SWING.long);
    const far = norm(x - foot.x, z - foot.z);
    const turn = Math.abs(wrap(yaw - foot.yaw));
    if (far < OFF.place && turn < OFF.turn) return false;
    const k = smooth(far / LONG);
    const swing: Swing = {
      duration: mix(SWING.short, SWING.long, k),
      lift: mix(LIFT.short, LIFT.long, k),
      landing: TOES * k * this.#isAhead(foot, x, z),
    };
    const to = this.#landingOf(side, swing.duration);
    foot.swingTo(to.x, to.z, to.yaw, swing);
    this.#path.at(this.#along + swing.duration, this.#then);
    const away = norm(to.x - this.#then.x, to.z - this.#then.z);
    const height = Math.sqrt(Math.max(0.1, this.#legLength ** 2 - away ** 2));
    this.#landingDrop = Math.max(0, this.#hipOverAnkle - height);
    this.#liftAt = this.#time + swing.duration + mix(DOUBLE_SUPPORT.short, DOUBLE_SUPPORT.long, k);
    this.#next = side === "Left" ? "Right" : "Left";
    return true;
  }

  /** 1 when a step leads forwards, 0 when it leads aside or back. */
  #isAhead(foot: Foot, x: number, z: number): number {
    const { heading } = this.#now;
    const ahead = (x - foot.x) * Math.sin(heading) + (z - foot.z) * Math.cos(heading);
    return smooth(ahead / 0.4);
  }

  /** Where a foot that lands in `seconds` is to stand. */
  #landingOf(side: Side, seconds: number): Landing {
    const lands = this.#along + seconds;
    const sign = side === "Left" ? 1 : -1;
    const turned = this.#path.at(lands, this.#then).heading;
    const later = this.#path.at(lands + LEAD.turn, this.#then).heading;
    const { x, z } = this.#path.at(lands + LEAD.place, this.#then);
    const heading = turned + clamp(later - turned, -MOST_TURNED, MOST_TURNED);
    const landing = this.#landing;
    landing.x = x + sign * HALF_WIDTH * Math.cos(heading) + this.#ankleAhead * Math.sin(heading);
    landing.z = z - sign * HALF_WIDTH * Math.sin(heading) + this.#ankleAhead * Math.cos(heading);
    landing.yaw = heading;
    this.#keepApart(landing, this.#feet[side === "Left" ? "Right" : "Left"], sign);
    return landing;
  }

  /** Legs do not cross: a foot lands on its own side of the other one, as that one points. */
  #keepApart(landing: Landing, other: Foot, sign: number): void {
    const heading = landing.yaw;
    const [dx, dz] = [landing.x - other.x, landing.z - other.z];
    const apart = sign * (dx * Math.cos(heading) - dz * Math.sin(heading));
    const lacking = clamp(LEAST_APART - apart, 0, MOST_ASIDE);
    landing.x += sign * lacking * Math.cos(heading);
    landing.z -= sign * lacking * Math.sin(heading);
  }

  /** The heel of the foot that swings next comes up as the body leaves it behind. */
  #peel(): void {
    const { heading, speedX, speedZ } = this.#now;
    const foot = this.#feet[this.#next];
    const other = this.#feet[this.#next === "Left" ? "Right" : "Left"];
    other.peel = 0;
    const isDue = !this.#isSettled && this.#liftAt - this.#time < PEEL_BEFORE;
    const ahead = speedX * Math.sin(heading) + speedZ * Math.cos(heading);
    foot.peel = isDue ? -PEEL * smooth(ahead / 1.1) : 0;
  }
}
