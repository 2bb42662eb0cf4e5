/** The turned square of a picture in which the mesh network looks for a face. */

import type { Detection } from "./detector.ts";
import type { Affine } from "./picture.ts";

export interface Region {
  /** Centre, in pixels of the picture. */
  readonly x: number;
  readonly y: number;
  /** Side, in pixels of the picture. */
  readonly size: number;
  /** How far the face is turned in the picture's plane, clockwise, in radians. */
  readonly angle: number;
}

/** How much larger the square is than the face. */
const MARGIN = 1.5;
/** Outer corners of the eyes in the mesh: of the person's right one and of the left one. */
const RIGHT_EYE = 33;
const LEFT_EYE = 263;

/** Where to look after the detector has found a face: eyes level, the box and half of it more. */
export function regionOfDetection({ box, keyPoints }: Detection): Region {
  const [right, left] = keyPoints;
  if (right === undefined || left === undefined) throw new Error("a detection has two eyes");
  return {
    x: (box.left + box.right) / 2,
    y: (box.top + box.bottom) / 2,
    size: MARGIN * Math.max(box.right - box.left, box.bottom - box.top),
    angle: Math.atan2(left[1] - right[1], left[0] - right[0]),
  };
}

/**
 * Where to look in the next picture: around the landmarks of this one.
 *
 * @param points x, y, z of each landmark in turn, in pixels.
 */
export function regionOfPoints(points: Float32Array): Region {
  const at = (i: number): readonly [number, number] => [points[3 * i] ?? 0, points[3 * i + 1] ?? 0];
  const [rightX, rightY] = at(RIGHT_EYE);
  const [leftX, leftY] = at(LEFT_EYE);
  let west = Number.POSITIVE_INFINITY;
  let north = Number.POSITIVE_INFINITY;
  let east = Number.NEGATIVE_INFINITY;
  let south = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < points.length / 3; i++) {
    const [x, y] = at(i);
    west = Math.min(west, x);
    east = Math.max(east, x);
    north = Math.min(north, y);
    south = Math.max(south, y);
  }
  return {
    x: (west + east) / 2,
    y: (north + south) / 2,
    size: MARGIN * Math.max(east - west, south - north),
    angle: Math.atan2(leftY - rightY, leftX - rightX),
  };
}

/** From pixels of an upright crop of `side` to those of the picture. */
export function cropMap({ x, y, size, angle }: Region, side: number): Affine {
  const cos = (size / side) * Math.cos(angle);
  const sin = (size / side) * Math.sin(angle);
  const half = side / 2;
  return { a: cos, b: -sin, c: x - half * (cos - sin), d: sin, e: cos, f: y - half * (sin + cos) };
}

/**
 * Landmarks of a crop in pixels of the picture.
 *
 * @param landmarks x, y, z of each landmark in turn, in pixels of the crop.
 * @param side Side of the crop.
 */
export function toPicture(landmarks: Float32Array, region: Region, side: number): Float32Array {
  const { a, b, c, d, e, f } = cropMap(region, side);
  const points = new Float32Array(landmarks.length);
  for (let i = 0; i < landmarks.length; i += 3) {
    const x = landmarks[i] ?? 0;
    const y = landmarks[i + 1] ?? 0;
    points[i] = a * x + b * y + c;
    points[i + 1] = d * x + e * y + f;
    points[i + 2] = (landmarks[i + 2] ?? 0) * (region.size / side);
  }
  return points;
}
