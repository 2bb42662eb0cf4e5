/**
 * A camera's picture, and how a network gets to see it. Written out rather than left to a canvas,
 * so that every browser and the server's own pipeline see the same pixels.
 */

/** Rows of RGBA from the top left, as `ImageData` has them. */
export interface Picture {
  readonly width: number;
  readonly height: number;
  readonly data: Uint8ClampedArray | Uint8Array;
}

/** Smallest and largest value of a network's pixels, from its manifest. */
export type Range = readonly [number, number];

/** From pixels of a square view to those of the picture: x = a i + b j + c, y = d i + e j + f. */
export interface Affine {
  readonly a: number;
  readonly b: number;
  readonly c: number;
  readonly d: number;
  readonly e: number;
  readonly f: number;
}

/** The whole picture in a square, corner to corner, with bars where it is not square itself. */
export function wholePicture(width: number, height: number, side: number): Affine {
  const step = Math.max(width, height) / side;
  return {
    a: step,
    b: 0,
    c: (width - step * side) / 2,
    d: 0,
    e: step,
    f: (height - step * side) / 2,
  };
}

/**
 * Look at a part of a picture, bilinearly.
 *
 * @param outside What lies beyond the picture: its edge goes on, or nothing but black.
 * @returns RGB, side x side x 3, in the network's range.
 */
export function seen(
  picture: Picture,
  map: Affine,
  side: number,
  [low, high]: Range,
  outside: "edge" | "black",
): Float32Array {
  const { width, height, data } = picture;
  const gain = (high - low) / 255;
  const pixels = new Float32Array(side * side * 3);
  const hasEdge = outside === "edge";
  let to = 0;
  for (let j = 0; j < side; j++) {
    for (let i = 0; i < side; i++) {
      const x = map.a * i + map.b * j + map.c;
      const y = map.d * i + map.e * j + map.f;
      const left = Math.floor(x);
      const top = Math.floor(y);
      const u = x - left;
      const v = y - top;
      let red = 0;
      let green = 0;
      let blue = 0;
      for (let corner = 0; corner < 4; corner++) {
        let cx = left + (corner & 1);
        let cy = top + (corner >> 1);
        if (hasEdge) {
          cx = cx < 0 ? 0 : cx >= width ? width - 1 : cx;
          cy = cy < 0 ? 0 : cy >= height ? height - 1 : cy;
        } else if (cx < 0 || cy < 0 || cx >= width || cy >= height) {
          continue;
        }
        const weight = ((corner & 1) === 1 ? u : 1 - u) * (corner > 1 ? v : 1 - v);
        const from = (cy * width + cx) * 4;
        red += weight * (data[from] ?? 0);
        green += weight * (data[from + 1] ?? 0);
        blue += weight * (data[from + 2] ?? 0);
      }
      // Whole levels, as a picture of that size would have them.
      pixels[to++] = low + gain * Math.round(red);
      pixels[to++] = low + gain * Math.round(green);
      pixels[to++] = low + gain * Math.round(blue);
    }
  }
  return pixels;
}
