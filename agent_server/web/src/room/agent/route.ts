/** The shortest way over the floor between two points, around the furniture. */

import { CHAIR, DESK, HIFI, SPOTS } from "../layout.ts";
import { norm } from "./maths.ts";

export type Point = readonly [x: number, z: number];

/** What nobody may walk through: x from, x to, z from, z to. */
type Box = readonly [left: number, right: number, back: number, front: number];

/** Half a body, and a little air. */
const CLEARANCE = 0.2;
/** Ends of a way may lie nearer: whoever gets up stands close to the chair. */
const LEAST_CLEARANCE = 0.02;
const SEAT_HALF = 0.24;
const CABINET = { width: 1.42, depth: 0.4 } as const;

const around = ([x, z]: Point, width: number, depth: number): Box => [
  x - width / 2,
  x + width / 2,
  z - depth / 2,
  z + depth / 2,
];

export const BOXES = {
  desk: around(DESK.centre, DESK.width, DESK.depth),
  chair: around(CHAIR.at, 2 * SEAT_HALF, 2 * SEAT_HALF),
  cabinet: around(HIFI.cabinet, CABINET.width, CABINET.depth),
} as const;

/** The same on the other side of the chair. */
const mirrored = ([x, z]: Point): Point => [2 * CHAIR.at[0] - x, z];

/** Corners at which ways turn: beside the chair, and behind it. */
const CORNERS: readonly Point[] = [SPOTS.beside.at, mirrored(SPOTS.beside.at), [0.42, -0.92], [-0.42, -0.92]];

/** @returns The corners of the way, both ends included; the straight line where no way is free. */
export function route(from: Point, to: Point): Point[] {
  const points: readonly Point[] = [from, to, ...CORNERS];
  const costs = points.map(() => Number.POSITIVE_INFINITY);
  const before = points.map(() => -1);
  const open = new Set(points.keys());
  costs[0] = 0;
  while (open.size > 0) {
    let here = -1;
    for (const i of open) if (here < 0 || (costs[i] ?? 0) < (costs[here] ?? 0)) here = i;
    open.delete(here);
    if (here === 1) break;
    for (const next of open) {
      const [a, b] = [points[here], points[next]];
      if (a === undefined || b === undefined || !isFree(a, b, from, to)) continue;
      const cost = (costs[here] ?? 0) + apart(a, b);
      if (cost >= (costs[next] ?? 0)) continue;
      costs[next] = cost;
      before[next] = here;
    }
  }
  const way: Point[] = [];
  for (let i = 1; i >= 0; i = before[i] ?? -1) {
    const point = points[i];
    if (point !== undefined) way.unshift(point);
  }
  return way[0] === from ? way : [from, to];
}

function isFree(a: Point, b: Point, from: Point, to: Point): boolean {
  const samples = Math.max(2, Math.ceil(apart(a, b) / 0.05));
  for (let i = 0; i <= samples; i += 1) {
    const k = i / samples;
    const point: Point = [a[0] + (b[0] - a[0]) * k, a[1] + (b[1] - a[1]) * k];
    const end = Math.min(apart(point, from), apart(point, to));
    const needed = Math.min(CLEARANCE, Math.max(LEAST_CLEARANCE, end));
    if (clearanceAt(point) < needed) return false;
  }
  return true;
}

const apart = (a: Point, b: Point): number => norm(a[0] - b[0], a[1] - b[1]);

/** Distance to the nearest piece of furniture, in metres; below 0 inside. */
export function clearanceAt(point: Point): number {
  return Math.min(
    outside(point, BOXES.desk),
    outside(point, BOXES.chair),
    outside(point, BOXES.cabinet),
  );
}

export function outside([x, z]: Point, [left, right, back, front]: Box): number {
  const [dx, dz] = [Math.max(left - x, x - right), Math.max(back - z, z - front)];
  return dx > 0 && dz > 0 ? norm(dx, dz) : Math.max(dx, dz);
}
