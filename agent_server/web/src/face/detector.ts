/** Faces from what the detector network says of each of its 896 anchors. */

import type { Affine } from "./picture.ts";

export type Place = readonly [x: number, y: number];

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** One face, in pixels of the picture. */
export interface Detection {
  readonly box: Box;
  /** The person's right eye, left eye, nose, mouth, right ear, left ear. */
  readonly keyPoints: readonly Place[];
  /** In [0, 1]. */
  readonly score: number;
}

/** Numbers that the network gives for each anchor: a box and six key points. */
export const PER_ANCHOR = 16;
const KEY_POINTS = 6;
const MIN_SCORE = 0.5;
/** Boxes that share more than this (intersection over union) are of one face. */
const SAME_FACE = 0.3;
/** Side of each grid of anchors, and how many sit at each of its places. */
const GRIDS: readonly (readonly [number, number])[] = [
  [16, 2],
  [8, 6],
];

/** Centre of each anchor, in units of the detector's square. */
export const ANCHORS: readonly Place[] = GRIDS.flatMap(([side, count]) =>
  Array.from({ length: side * side * count }, (_, i): Place => {
    const place = Math.floor(i / count);
    return [((place % side) + 0.5) / side, (Math.floor(place / side) + 0.5) / side];
  }),
);

/**
 * @param regressors Box and key points of each anchor relative to it, in pixels of the square.
 * @param logits How sure the network is of each.
 * @param side Side of the square.
 * @param toPicture From pixels of the square to those of the picture.
 * @returns Faces, the largest first.
 */
export function detectionsOf(
  regressors: Float32Array,
  logits: Float32Array,
  side: number,
  toPicture: Affine,
): Detection[] {
  const found: Detection[] = [];
  for (const [i, anchor] of ANCHORS.entries()) {
    const score = sigmoid(logits[i] ?? 0);
    if (score > MIN_SCORE) found.push(decode(regressors, i, anchor, score, side, toPicture));
  }
  return merged(found).sort((a, b) => area(b.box) - area(a.box));
}

export function sigmoid(logit: number): number {
  return 1 / (1 + Math.exp(-logit));
}

function decode(
  regressors: Float32Array,
  index: number,
  [anchorX, anchorY]: Place,
  score: number,
  side: number,
  { a, c, e, f }: Affine,
): Detection {
  const value = (i: number): number => regressors[index * PER_ANCHOR + i] ?? 0;
  const x = (offset: number): number => a * (offset + anchorX * side) + c;
  const y = (offset: number): number => e * (offset + anchorY * side) + f;
  return {
    box: {
      left: x(value(0) - value(2) / 2),
      top: y(value(1) - value(3) / 2),
      right: x(value(0) + value(2) / 2),
      bottom: y(value(1) + value(3) / 2),
    },
    keyPoints: Array.from({ length: KEY_POINTS }, (_, k): Place => [
      x(value(4 + 2 * k)),
      y(value(5 + 2 * k)),
    ]),
    score,
  };
}

/** Make one face of all detections that overlap the surest one, each counted by its score. */
function merged(found: readonly Detection[]): Detection[] {
  const faces: Detection[] = [];
  let rest = [...found].sort((a, b) => b.score - a.score);
  for (;;) {
    const [best] = rest;
    if (best === undefined) return faces;
    const same = rest.filter((other) => overlap(best.box, other.box) > SAME_FACE);
    // A box without area shares nothing, not even with itself.
    rest = rest.filter((other) => other !== best && !same.includes(other));
    faces.push(same.length > 0 ? mean(same, best.score) : best);
  }
}

function mean(detections: readonly Detection[], score: number): Detection {
  const total = detections.reduce((sum, detection) => sum + detection.score, 0);
  const of = (value: (detection: Detection) => number): number =>
    detections.reduce((sum, detection) => sum + detection.score * value(detection), 0) / total;
  return {
    box: {
      left: of(({ box }) => box.left),
      top: of(({ box }) => box.top),
      right: of(({ box }) => box.right),
      bottom: of(({ box }) => box.bottom),
    },
    keyPoints: Array.from({ length: KEY_POINTS }, (_, k): Place => [
      of(({ keyPoints }) => keyPoints[k]?.[0] ?? 0),
      of(({ keyPoints }) => keyPoints[k]?.[1] ?? 0),
    ]),
    score,
  };
}

function area({ left, top, right, bottom }: Box): number {
  return Math.max(0, right - left) * Math.max(0, bottom - top);
}

/** Intersection over union. */
export function overlap(a: Box, b: Box): number {
  const shared = area({
    left: Math.max(a.left, b.left),
    top: Math.max(a.top, b.top),
    right: Math.min(a.right, b.right),
    bottom: Math.min(a.bottom, b.bottom),
  });
  const all = area(a) + area(b) - shared;
  return all > 0 ? shared / all : 0;
}
