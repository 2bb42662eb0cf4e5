/** Which object a click meets: by boxes around them. */

import { Box3, Vector3, type Ray } from "three";
import { CHAIR, DESK, ON_DESK } from "../layout.ts";

export type Bounds = readonly [name: string, box: Box3];

/** A box over a point: its middle in x and z, from one height up to another. */
function over(
  [x, z]: readonly [number, number],
  width: number,
  depth: number,
  low: number,
  high: number,
): Box3 {
  return new Box3(
    new Vector3(x - width / 2, low, z - depth / 2),
    new Vector3(x + width / 2, high, z + depth / 2),
  );
}

/** Of what the rule file names and that never moves. */
export const STILL_BOUNDS: readonly Bounds[] = [
  ["screen", over(ON_DESK.screen.at, 0.5, 0.26, DESK.top + 0.01, DESK.top + 0.36)],
  ["keyboard", over(ON_DESK.keyboard.at, 0.38, 0.14, DESK.top, DESK.top + 0.025)],
  ["notebook", over(ON_DESK.notebook.at, 0.31, 0.23, DESK.top, DESK.top + 0.025)],
  ["desk", over(DESK.centre, DESK.width, DESK.depth, 0, DESK.top)],
  ["chair", over(CHAIR.at, 0.5, 0.6, 0, CHAIR.seat + 0.68)],
];

const hit = new Vector3();

export function nearest(bounds: readonly Bounds[], ray: Ray): string | null {
  let best = Infinity;
  let found: string | null = null;
  for (const [name, box] of bounds) {
    if (ray.intersectBox(box, hit) === null) continue;
    const distance = hit.distanceToSquared(ray.origin);
    if (distance >= best) continue;
    best = distance;
    found = name;
  }
  return found;
}
