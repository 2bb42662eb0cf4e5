/** What the camera sends: landmarks, or pictures where the page cannot read them. */

import type { FacePoints } from "../protocol.ts";
import type { Looked } from "./exchange.ts";

const STEPS_PER_PIXEL = 16;
const MAGIC = [0x41, 0x46, 0x4a, 0x31];
const HEADER_BYTES = 16;

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

/** A binary frame: `AFJ1`, flags, the stamp in 64 bits, all little-endian, and the JPEG. */
export function imageFrame(jpeg: Uint8Array, capturedAt: number): Uint8Array<ArrayBuffer> {
  const frame = new Uint8Array(HEADER_BYTES + jpeg.length);
  frame.set(MAGIC);
  new DataView(frame.buffer).setBigInt64(8, BigInt(stampOf(capturedAt)), true);
  frame.set(jpeg, HEADER_BYTES);
  return frame;
}
