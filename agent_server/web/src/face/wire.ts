/** What the camera sends: landmarks, or pictures where the page cannot read them. */

import type { FacePoints, Image } from "../protocol/messages.ts";
import type { Looked } from "./exchange.ts";

const STEPS_PER_PIXEL = 16;

/** Milliseconds of the page's clock as the whole nanoseconds of a stamp. */
export function stampOf(ms: number): number {
  return Math.round(ms * 1e6);
}

/** @returns The message, or null without a face. */
export function faceMessage({ points, width, height, capturedAt }: Looked): FacePoints | null {
  if (points === null) return null;
  const rounded = (i: number): number =>
    Math.round((points[i] ?? 0) * STEPS_PER_PIXEL) / STEPS_PER_PIXEL;
  return {
    type: "face",
    format: "mesh478",
    width,
    height,
    originating_ns: stampOf(capturedAt),
    points: Array.from({ length: points.length / 3 }, (_, i) => [
      rounded(3 * i),
      rounded(3 * i + 1),
      rounded(3 * i + 2),
    ]),
  };
}

export function imageMessage(jpeg: Uint8Array, capturedAt: number): Image {
  return { type: "image", originating_ns: stampOf(capturedAt), jpeg };
}
