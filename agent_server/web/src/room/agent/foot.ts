/**
 * A foot that either stands, and then does not move but to roll over heel and ball, or swings to
 * where it will stand. A swing that is under way may be given another end.
 */

import { Spring, coasts, remains, smooth, wrap } from "./maths.ts";
import type { Footing } from "./posture.ts";

/** How fast a standing foot rolls, radians a second. */
const ROLL_RATE = 26;
/** Toes come up in this part of the swing. */
const TOES_UP_FROM = 0.35;

/** Where a foot is to stand, flat. */
export interface Landing {
  x: number;
  z: number;
  yaw: number;
}

export interface Swing {
  /** In seconds. */
  readonly duration: number;
  /** Highest point of the sole, in metres. */
  readonly lift: number;
  /** Pitch with which it lands, in radians: on the heel when above 0. */
  readonly landing: number;
}

/** One coordinate on its way: what is left of the distance and of the speed it had. */
class Way {
  #from = 0;
  #speed = 0;
  #start = 0;
  end = 0;

  set(from: number, speed: number, end: number, start: number): void {
    this.#from = from - end;
    this.#speed = speed;
    this.#start = start;
    this.end = end;
  }

  at(time: number, duration: number): number {
    const left = Math.max(1e-3, duration - this.#start);
    const u = (time - this.#start) / left;
    return this.end + this.#from * remains(u) + this.#speed * left * coasts(u);
  }
}

export class Foot implements Footing {
  x = 0;
  z = 0;
  yaw = 0;
  lift = 0;
  pitch = 0;
  isPlanted = true;
  /** As it was shown last: a leg that is too short brings the heel up further. */
  shown = 0;
  /** Pitch that a standing foot rolls to: below 0 the heel comes up. */
  peel = 0;
  readonly #roll = new Spring();
  readonly #ways = { x: new Way(), z: new Way(), yaw: new Way() };
  #swing: Swing = { duration: 1, lift: 0, landing: 0 };
  #time = 0;
  #pitchFrom = 0;
  #speed = { x: 0, z: 0, yaw: 0 };

  set(x: number, z: number, yaw: number): void {
    this.x = x;
    this.z = z;
    this.yaw = yaw;
    this.lift = 0;
    this.pitch = 0;
    this.shown = 0;
    this.peel = 0;
    this.#roll.value = 0;
    this.#roll.speed = 0;
    this.isPlanted = true;
  }

  /** Seconds until it lands; 0 when it stands. */
  get remaining(): number {
    return this.isPlanted ? 0 : this.#swing.duration - this.#time;
  }

  swingTo(x: number, z: number, yaw: number, swing: Swing): void {
    this.isPlanted = false;
    this.#swing = swing;
    this.#time = 0;
    this.#pitchFrom = this.shown;
    this.#ways.x.set(this.x, 0, x, 0);
    this.#ways.z.set(this.z, 0, z, 0);
    const end = this.yaw + wrap(yaw - this.yaw);
    this.#ways.yaw.set(this.yaw, 0, end, 0);
  }

  /** Land elsewhere, as soon as before. */
  divert(x: number, z: number, yaw: number): void {
    const time = this.#time;
    this.#ways.x.set(this.x, this.#speed.x, x, time);
    this.#ways.z.set(this.z, this.#speed.z, z, time);
    this.#ways.yaw.set(this.yaw, this.#speed.yaw, this.yaw + wrap(yaw - this.yaw), time);
  }

  step(dt: number): void {
    if (this.isPlanted) {
      this.pitch = this.#roll.step(this.peel, ROLL_RATE, dt);
      return;
    }
    this.#time += dt;
    const { duration, lift, landing } = this.#swing;
    const u = this.#time / duration;
    const { x, z, yaw } = this.#ways;
    const [oldX, oldZ, oldYaw] = [this.x, this.z, this.yaw];
    this.x = x.at(this.#time, duration);
    this.z = z.at(this.#time, duration);
    this.yaw = yaw.at(this.#time, duration);
    this.#speed.x = (this.x - oldX) / dt;
    this.#speed.z = (this.z - oldZ) / dt;
    this.#speed.yaw = (this.yaw - oldYaw) / dt;
    this.lift = u < 1 ? lift * 16 * u * u * (1 - u) * (1 - u) : 0;
    const toes = smooth((u - TOES_UP_FROM) / (1 - TOES_UP_FROM));
    this.pitch = this.#pitchFrom * (1 - smooth((u - 0.12) / 0.68)) + landing * toes;
    if (u < 1) return;
    this.isPlanted = true;
    this.peel = 0;
    this.#roll.value = this.pitch;
    this.#roll.speed = 0;
  }
}
