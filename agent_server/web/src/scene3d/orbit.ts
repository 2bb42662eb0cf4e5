/** The camera's place around the body: dragged, zoomed, or moved with the keyboard. */

import { MathUtils, Spherical, Vector3, type PerspectiveCamera } from "three";
import { share } from "./smooth.ts";

/** Azimuth 0 looks from the sensor. A little to the side shows the depth of a movement. */
const HOME = { azimuth: 0.3, height: 0.12, distance: 2.25 } as const;
const LIMITS = { height: [-0.5, 1.3], distance: [1.1, 5] } as const;
const RADIANS_PER_PIXEL = 0.006;
const TURN_TAU_MS = 70;
const FOLLOW_TAU_MS = 600;
const STILL = 1e-4;

export class Orbit {
  /** What the camera looks at, in metres; it follows slowly. */
  readonly target = new Vector3(0, 0.1, 2.4);

  readonly #camera: PerspectiveCamera;
  readonly #isCalm: boolean;
  readonly #aim = this.target.clone();
  readonly #goal = { ...HOME } as { azimuth: number; height: number; distance: number };
  readonly #now = { ...HOME } as { azimuth: number; height: number; distance: number };
  readonly #offset = new Vector3();
  readonly #spherical = new Spherical();
  #hasTarget = false;
  #isDirty = true;

  /** @param isCalm Whether the camera goes where it is told at once, without gliding. */
  constructor(camera: PerspectiveCamera, element: HTMLElement, isCalm: boolean) {
    this.#camera = camera;
    this.#isCalm = isCalm;
    this.#listen(element);
  }

  reset(): void {
    // The nearest way home, not the way back through every turn made.
    const turns = Math.round((this.#goal.azimuth - HOME.azimuth) / (2 * Math.PI));
    this.#now.azimuth -= turns * 2 * Math.PI;
    Object.assign(this.#goal, HOME);
  }

  /** Look at a point from now on. */
  follow(x: number, y: number, z: number): void {
    this.#aim.set(x, y, z);
    if (!this.#hasTarget) {
      this.target.copy(this.#aim);
      this.#hasTarget = true;
      this.#isDirty = true;
    }
  }

  /** @returns Whether the camera moved. */
  step(dtMs: number): boolean {
    const k = this.#isCalm ? 1 : share(dtMs, TURN_TAU_MS);
    let moved = this.#isDirty;
    for (const key of ["azimuth", "height", "distance"] as const) {
      const rest = this.#goal[key] - this.#now[key];
      if (Math.abs(rest) < STILL) continue;
      this.#now[key] += k * rest;
      moved = true;
    }
    if (this.target.distanceToSquared(this.#aim) > 1e-6) {
      this.target.lerp(this.#aim, share(dtMs, FOLLOW_TAU_MS));
      moved = true;
    }
    this.#isDirty = false;
    if (moved) this.#place();
    return moved;
  }

  #place(): void {
    const { azimuth, height, distance } = this.#now;
    // three.js counts the azimuth from +z; the sensor is on the -z side of the body.
    this.#spherical.set(distance, Math.PI / 2 - height, Math.PI + azimuth);
    this.#camera.position.copy(this.target).add(this.#offset.setFromSpherical(this.#spherical));
    this.#camera.lookAt(this.target);
  }

  #turn(azimuth: number, height: number): void {
    this.#goal.azimuth += azimuth;
    this.#goal.height = MathUtils.clamp(this.#goal.height + height, ...LIMITS.height);
  }

  #zoom(factor: number): void {
    this.#goal.distance = MathUtils.clamp(this.#goal.distance * factor, ...LIMITS.distance);
  }

  #listen(element: HTMLElement): void {
    const pointers = new Map<number, { x: number; y: number }>();
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    const release = (event: PointerEvent) => pointers.delete(event.pointerId);
    element.addEventListener("pointerup", release);
    element.addEventListener("pointercancel", release);
    element.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (before === undefined) return;
      const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other === undefined) {
        this.#turn(-dx * RADIANS_PER_PIXEL, dy * RADIANS_PER_PIXEL);
      } else {
        const was = Math.hypot(before.x - other.x, before.y - other.y);
        const is = Math.hypot(event.clientX - other.x, event.clientY - other.y);
        this.#zoom(was / Math.max(is, 1));
      }
      before.x = event.clientX;
      before.y = event.clientY;
    });
    element.addEventListener(
      "wheel",
      (event) => {
        // Where the page itself scrolls, the wheel stays the page's; a pinch comes with ctrl.
        const root = document.documentElement;
        if (!event.ctrlKey && root.scrollHeight > root.clientHeight) return;
        event.preventDefault();
        this.#zoom(Math.exp(event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)));
      },
      { passive: false },
    );
    element.addEventListener("keydown", (event) => {
      const act = KEYS[event.key];
      if (act === undefined) return;
      event.preventDefault();
      if (act === "home") this.reset();
      else if (typeof act === "number") this.#zoom(act);
      else this.#turn(...act);
    });
  }
}

const KEYS: Readonly<Record<string, readonly [number, number] | number | "home">> = {
  ArrowLeft: [0.15, 0],
  ArrowRight: [-0.15, 0],
  ArrowUp: [0, 0.1],
  ArrowDown: [0, -0.1],
  "+": 0.9,
  "=": 0.9,
  "-": 1.1,
  Home: "home",
};
