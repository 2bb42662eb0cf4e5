/** What else may follow: of each further future the paths of both wrists and the last pose, faint. */

import {
  AdditiveBlending,
  BufferAttribute,
  BufferGeometry,
  type Color,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
} from "three";
import type { FutureBody, Point } from "../protocol/messages.ts";
import { BONES, JOINT } from "../protocol/skeleton.ts";

const MOST = 16;
/** Of a future, at 5 Hz. */
const FRAMES = 10;
const WRISTS = [JOINT.leftWrist, JOINT.rightWrist] as const;
const OPACITY = 0.3;
const SEGMENTS = MOST * (WRISTS.length * (FRAMES - 1) + BONES.length);

export class Others {
  readonly group = new Group();
  readonly #places = new BufferAttribute(new Float32Array(SEGMENTS * 6), 3).setUsage(DynamicDrawUsage);
  readonly #geometry = new BufferGeometry();
  #used = 0;

  constructor(color: Color) {
    this.#geometry.setAttribute("position", this.#places);
    const material = new LineBasicMaterial({
      color,
      transparent: true,
      opacity: OPACITY,
      blending: AdditiveBlending,
      depthWrite: false,
    });
    const lines = new LineSegments(this.#geometry, material);
    lines.frustumCulled = false;
    this.group.add(lines);
    this.group.visible = false;
  }

  set(futures: readonly FutureBody[]): void {
    this.#used = 0;
    for (const { positions } of futures.slice(0, MOST)) {
      const frames = positions.slice(0, FRAMES);
      for (const wrist of WRISTS) {
        for (const [i, frame] of frames.entries()) {
          const before = frames[i - 1];
          if (before !== undefined) this.#add(before[wrist], frame[wrist]);
        }
      }
      const last = frames.at(-1);
      if (last === undefined) continue;
      for (const [parent, child] of BONES) this.#add(last[parent], last[child]);
    }
    this.#geometry.setDrawRange(0, this.#used);
    this.#places.needsUpdate = true;
    this.group.visible = this.#used > 0;
  }

  #add(from: Point | undefined, to: Point | undefined): void {
    if (from === undefined || to === undefined) return;
    this.#places.setXYZ(this.#used++, ...from);
    this.#places.setXYZ(this.#used++, ...to);
  }
}
