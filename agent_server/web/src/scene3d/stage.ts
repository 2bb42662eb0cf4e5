/** The 3D view: the body, its expected motion and the grid, drawn only when something moved. */

import {
  Color,
  DirectionalLight,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  WebGLRenderer,
} from "three";
import type { ForecastMessage, JointSample } from "../protocol/messages.ts";
import { JOINT } from "../protocol/skeleton.ts";
import { Figure } from "./figure.ts";
import { Floor } from "./floor.ts";
import { Ghost } from "./ghost.ts";
import { Others } from "./others.ts";
import { Orbit } from "./orbit.ts";

const FIELD_OF_VIEW = 32;
/** From the navel up to the middle of what is shown, and down to the grid, in metres: between
 * them there is room for hands that hang and hands that wave. */
const CENTRE_ABOVE_NAVEL_M = 0.1;
const GRID_BELOW_NAVEL_M = 0.58;
/** A picture narrower than this, width to height, steps back to keep the arms in view. */
const FULL_ASPECT = 1.05;

export interface StageOptions {
  readonly isCalm: boolean;
  readonly pixelRatio: number;
}

export class Stage {
  /** Pictures drawn so far. */
  pictures = 0;

  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 30);
  readonly #orbit: Orbit;
  readonly #figure: Figure;
  readonly #ghost: Ghost;
  readonly #others: Others;
  readonly #floor: Floor;
  readonly #element: HTMLElement;
  #isDirty = true;
  #hasFloor = false;

  /**
   * @param element The box that the canvas fills.
   * @throws Error where the browser has no WebGL.
   */
  constructor(element: HTMLElement, options: StageOptions) {
    this.#element = element;
    this.#renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: "low-power" });
    this.#renderer.setPixelRatio(options.pixelRatio);
    const canvas = this.#renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
      "aria-label",
      "The body in three dimensions with its expected motion. Arrow keys turn the view, plus and minus zoom, Home resets.",
    );
    element.append(canvas);

    const css = getComputedStyle(document.documentElement);
    const color = (name: string): Color => new Color(css.getPropertyValue(name).trim());
    this.#figure = new Figure(color("--measured"), color("--uncertain"));
    this.#ghost = new Ghost(color("--forecast"));
    this.#others = new Others(color("--forecast"));
    this.#floor = new Floor(color("--grid"));
    this.#floor.group.position.set(0, -GRID_BELOW_NAVEL_M, 2.4);

    // Lights stand on the sensor's side (-z): a key from above, a cool rim from behind.
    const key = new DirectionalLight(0xffffff, 2.6);
    key.position.set(1.5, 2.5, -2);
    const rim = new DirectionalLight(color("--forecast"), 0.9);
    rim.position.set(-2, 1.5, 2.5);
    const sky = new HemisphereLight(0xdfe8ff, 0x1a2233, 1.0);
    this.#scene.add(key, rim, sky, this.#floor.group, this.#figure.group);
    this.#scene.add(this.#ghost.group, this.#others.group);
    this.#orbit = new Orbit(this.#camera, canvas, options.isCalm);
    new ResizeObserver(() => this.#resize()).observe(element);
    this.#resize();
  }

  /** Show a pose in the camera frame, or nobody. */
  setPose(joints: readonly JointSample[] | null): void {
    this.#isDirty = true;
    this.#figure.set(joints);
    this.#figure.place();
    const navel = joints?.[JOINT.navel];
    if (navel === undefined) return;
    const [x, y, z] = navel;
    this.#orbit.follow(x, y + CENTRE_ABOVE_NAVEL_M, z);
    if (!this.#hasFloor) this.#floor.group.position.set(x, y - GRID_BELOW_NAVEL_M, z);
    this.#hasFloor = true;
  }

  /** Show a forecast in the camera frame and what else may follow, or none. */
  setForecast(forecast: Pick<ForecastMessage, "positions" | "futures"> | null): void {
    this.#isDirty = true;
    this.#others.set(forecast?.futures ?? []);
    this.#ghost.set(forecast?.positions ?? null);
    this.#ghost.place(this.#figure.follower.points);
  }

  resetView(): void {
    this.#orbit.reset();
  }

  /** Let time pass. */
  step(dtMs: number): void {
    const { points } = this.#figure.follower;
    const moved = [
      this.#figure.step(dtMs),
      this.#ghost.step(dtMs, points),
      this.#orbit.step(dtMs),
    ];
    this.#isDirty ||= moved.includes(true);
  }

  /** Draw if anything has changed. */
  draw(): void {
    if (!this.#isDirty) return;
    this.#isDirty = false;
    this.pictures += 1;
    this.#renderer.render(this.#scene, this.#camera);
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#element;
    if (width === 0 || height === 0) return;
    const aspect = width / height;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = aspect;
    this.#camera.zoom = Math.min(1, aspect / FULL_ASPECT);
    this.#camera.updateProjectionMatrix();
    this.#isDirty = true;
  }
}
