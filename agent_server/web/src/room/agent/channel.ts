/**
 * A quantity that may change whom it follows at any moment without a jump: what separates it from
 * the new source fades out, with the speed that it had (inertialization).
 *
 * Each frame `follow` is given where the source is now. Offsets turn with the body: they are kept
 * in the frame of its heading.
 */

import { Quaternion, Vector3 } from "three";
import { coasts, norm, remains, wrap } from "./maths.ts";

/**
 * Speed that is carried on, in distances to go a change: a hand that is thrown about does not
 * overshoot far.
 */
const FASTEST = 2;

const UP = new Vector3(0, 1, 0);
const v = new Vector3();
const q = new Quaternion();

/** How far a change of source has come: the first frame goes on as before, to see both speeds. */
class Fading {
  seconds = 0;
  #elapsed = 0;
  stage: "over" | "asked" | "begun" | "under way" = "over";

  ask(seconds: number): void {
    this.seconds = seconds;
    this.stage = seconds > 0 ? "asked" : "over";
  }

  begin(): void {
    this.#elapsed = 0;
    this.stage = "begun";
  }

  advance(dt: number): void {
    this.#elapsed += dt;
    this.stage = this.#elapsed >= this.seconds ? "over" : "under way";
  }

  /** Weight of the offset at the change. */
  get offset(): number {
    return this.stage === "over" ? 0 : remains(this.#elapsed / this.seconds);
  }

  /** Weight of the difference of speeds at the change, in seconds. */
  get drift(): number {
    return this.stage === "over" ? 0 : coasts(this.#elapsed / this.seconds) * this.seconds;
  }
}

export class AngleChannel {
  value = 0;
  speed = 0;
  readonly #fading = new Fading();
  #offset = 0;
  #drift = 0;
  #source = 0;

  set(value: number): void {
    this.value = value;
    this.speed = 0;
    this.#fading.ask(0);
  }

  /** Take the next source as a new one, to be reached in this time. */
  change(seconds: number): void {
    this.#fading.ask(seconds);
  }

  follow(source: number, dt: number): number {
    const before = this.value;
    const fading = this.#fading;
    if (fading.stage === "asked") {
      this.value += this.speed * dt;
      this.#offset = wrap(this.value - source);
      fading.begin();
    } else {
      if (fading.stage === "begun") this.#drift = this.speed - wrap(source - this.#source) / dt;
      if (fading.stage !== "over") fading.advance(dt);
      this.value = source + this.#offset * fading.offset + this.#drift * fading.drift;
    }
    this.#source = source;
    this.speed = wrap(this.value - before) / dt;
    return this.value;
  }
}

export class PlaceChannel {
  readonly value = new Vector3();
  readonly speed = new Vector3();
  readonly #fading = new Fading();
  readonly #offset = new Vector3();
  readonly #drift = new Vector3();
  readonly #source = new Vector3();

  set(value: Vector3): void {
    this.value.copy(value);
    this.speed.set(0, 0, 0);
    this.#fading.ask(0);
  }

  change(seconds: number): void {
    this.#fading.ask(seconds);
  }

  get isThere(): boolean {
    return this.#fading.stage === "over";
  }

  follow(source: Vector3, heading: number, dt: number): Vector3 {
    const { value, speed } = this;
    const fading = this.#fading;
    v.copy(value);
    if (fading.stage === "asked") {
      value.addScaledVector(speed, dt);
      this.#offset.subVectors(value, source).applyAxisAngle(UP, -heading);
      fading.begin();
    } else {
      if (fading.stage === "begun") {
        this.#drift.subVectors(source, this.#source).divideScalar(-dt).add(speed);
        this.#drift.applyAxisAngle(UP, -heading);
        this.#drift.clampLength(0, (this.#offset.length() * FASTEST) / fading.seconds);
      }
      if (fading.stage !== "over") fading.advance(dt);
      value.copy(this.#offset).multiplyScalar(fading.offset);
      value.addScaledVector(this.#drift, fading.drift).applyAxisAngle(UP, heading).add(source);
    }
    this.#source.copy(source);
    speed.subVectors(value, v).divideScalar(dt);
    return value;
  }
}

export class TurnChannel {
  readonly value = new Quaternion();
  readonly #fading = new Fading();
  readonly #speed = new Vector3();
  readonly #offset = new Vector3();
  readonly #drift = new Vector3();
  readonly #source = new Quaternion();
  readonly #before = new Quaternion();

  set(value: Quaternion): void {
    this.value.copy(value);
    this.#speed.set(0, 0, 0);
    this.#fading.ask(0);
  }

  change(seconds: number): void {
    this.#fading.ask(seconds);
  }

  follow(source: Quaternion, heading: number, dt: number): Quaternion {
    const { value } = this;
    const fading = this.#fading;
    this.#before.copy(value);
    if (fading.stage === "asked") {
      value.premultiply(turnOf(v.copy(this.#speed).multiplyScalar(dt)));
      axisOf(value, source, this.#offset).applyAxisAngle(UP, -heading);
      fading.begin();
    } else {
      if (fading.stage === "begun") {
        axisOf(this.#source, source, this.#drift).divideScalar(dt).add(this.#speed);
        this.#drift.applyAxisAngle(UP, -heading);
      }
      if (fading.stage !== "over") fading.advance(dt);
      v.copy(this.#offset).multiplyScalar(fading.offset);
      v.addScaledVector(this.#drift, fading.drift).applyAxisAngle(UP, heading);
      value.copy(source).premultiply(turnOf(v));
    }
    this.#source.copy(source);
    axisOf(value, this.#before, this.#speed).divideScalar(dt);
    return value;
  }
}

/** The turn that leads from `from` to `to`, as axis times angle: at most half a turn. */
function axisOf(to: Quaternion, from: Quaternion, out: Vector3): Vector3 {
  q.copy(from).conjugate().premultiply(to);
  const sign = q.w < 0 ? -1 : 1;
  const sine = norm(q.x, q.y, q.z);
  const angle = 2 * Math.atan2(sine, q.w * sign);
  return out.set(q.x, q.y, q.z).multiplyScalar(sine < 1e-9 ? 0 : (sign * angle) / sine);
}

function turnOf(axis: Vector3): Quaternion {
  const angle = axis.length();
  return angle < 1e-9 ? q.identity() : q.setFromAxisAngle(axis.divideScalar(angle), angle);
}
