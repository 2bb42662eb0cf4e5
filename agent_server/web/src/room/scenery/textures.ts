/** Surfaces painted pixel by pixel: no image is ever loaded. */

import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  NoColorSpace,
  RGBAFormat,
  RepeatWrapping,
  SRGBColorSpace,
} from "three";
import { fractal, hash, mix, noise, smooth } from "./noise.ts";

export type Pixel = [number, number, number];

export interface Canvas {
  readonly width: number;
  readonly height: number;
  /** Whether the values are colours as a screen shows them, rather than heights. */
  readonly isColor: boolean;
}

/**
 * A texture that repeats.
 *
 * @param at What to paint at u, v in [0, 1), v upwards: red, green and blue in 0..1 into `out`.
 */
export function painted(
  { width, height, isColor }: Canvas,
  at: (u: number, v: number, out: Pixel) => void,
): DataTexture {
  const data = new Uint8ClampedArray(width * height * 4);
  const pixel: Pixel = [0, 0, 0];
  for (let row = 0, i = 0; row < height; row += 1) {
    for (let column = 0; column < width; column += 1, i += 4) {
      at((column + 0.5) / width, (row + 0.5) / height, pixel);
      data[i] = 255 * pixel[0];
      data[i + 1] = 255 * pixel[1];
      data[i + 2] = 255 * pixel[2];
      data[i + 3] = 255;
    }
  }
  const texture = new DataTexture(data, width, height, RGBAFormat);
  texture.colorSpace = isColor ? SRGBColorSpace : NoColorSpace;
  texture.wrapS = RepeatWrapping;
  texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}

function gray(out: Pixel, value: number): void {
  out[0] = value;
  out[1] = value;
  out[2] = value;
}

/** How bright wood is: growth rings across v, fibres along u; 1.6 m by 0.5 m. */
function grain(u: number, v: number): number {
  const bend = 1.7 * noise(u * 2, v * 4, 2, 4, 3) + 0.5 * noise(u * 5, v * 9, 5, 9, 4);
  const ring = (v * 11 + bend) % 1;
  const late = smooth(0.35, 0.95, ring) * (1 - smooth(0.95, 1, ring));
  const fibre = noise(u * 14, v * 150, 14, 150, 5);
  return 0.96 - 0.09 * late - 0.08 * fibre;
}

/** Wood in neutral tones, to be tinted; u runs along the grain. One tile is 1.6 m by 0.5 m. */
export function wood(): DataTexture {
  return painted({ width: 256, height: 256, isColor: true }, (u, v, out) => {
    const tone = grain(u, v);
    out[0] = tone;
    out[1] = tone * mix(0.95, 1, tone);
    out[2] = tone * mix(0.86, 1, tone);
  });
}

const PLANKS = 12;

/** Oak planks along u, 12 side by side. One tile is 1.92 m by 1.92 m. */
export function planks(): DataTexture {
  return painted({ width: 512, height: 512, isColor: true }, (u, v, out) => {
    const row = Math.floor(v * PLANKS);
    const along = (u + hash(row, 0, 11)) % 1;
    const half = along < 0.5 ? 0 : 1;
    const across = v * PLANKS - row;
    const own = hash(row, half, 12);
    const joint = Math.min(along - half * 0.5, half * 0.5 + 0.5 - along) * 1.92;
    const seam = Math.min(across, 1 - across) * 0.16;
    const groove = smooth(0, 0.003, seam) * smooth(0, 0.003, joint);
    const tone =
      (0.86 + 0.16 * own) * grain((u * 1.2 + own) % 1, (across * 0.3 + own) % 1) * mix(0.55, 1, groove);
    out[0] = 0.87 * tone;
    out[1] = (0.72 - 0.02 * own) * tone;
    out[2] = (0.55 - 0.03 * own) * tone;
  });
}

/** Heights of a wall that was plastered by hand. One tile is 0.8 m. */
export function plaster(): DataTexture {
  return painted({ width: 256, height: 256, isColor: false }, (u, v, out) => {
    gray(out, 0.6 * fractal(u * 6, v * 6, 6, 3, 21) + 0.4 * noise(u * 70, v * 70, 70, 70, 22));
  });
}

/** A plain weave in neutral tones, to be tinted. One tile is 6 cm, 16 threads each way. */
export function weave(): DataTexture {
  const threads = 16;
  return painted({ width: 128, height: 128, isColor: true }, (u, v, out) => {
    const column = Math.floor(u * threads);
    const row = Math.floor(v * threads);
    const isOver = (column + row) % 2 === 0;
    const across = isOver ? u * threads - column : v * threads - row;
    const round = Math.sqrt(Math.max(0, 1 - (2 * across - 1) ** 2));
    const thread = isOver ? hash(column, 0, 31) : hash(0, row, 32);
    gray(out, 0.8 + 0.12 * round + 0.08 * thread);
  });
}

/** Cloth of uneven yarn in neutral tones, to be tinted: too fine to show its threads. */
export function linen(): DataTexture {
  return painted({ width: 256, height: 256, isColor: true }, (u, v, out) => {
    const warp = noise(u * 120, v * 6, 120, 6, 33);
    const weft = noise(u * 5, v * 110, 5, 110, 34);
    gray(out, 0.9 + 0.05 * warp + 0.05 * weft);
  });
}

/** What is on the computer's screen: an editor with lines of many words, and a bar of files. */
export function screenPicture(): DataTexture {
  const hues: readonly Pixel[] = [
    [0.55, 0.75, 0.95],
    [0.85, 0.85, 0.85],
    [0.95, 0.7, 0.45],
    [0.6, 0.85, 0.6],
  ];
  return painted({ width: 256, height: 144, isColor: true }, (u, v, out) => {
    const line = Math.floor((1 - v) * 26);
    const isText = (1 - v) * 26 - line > 0.4 && line > 1;
    const isSide = u < 0.18;
    const start = isSide ? 0.03 : 0.23 + 0.03 * Math.floor(4 * hash(line >> 2, 1, 41));
    const end = start + (isSide ? 0.1 : 0.65) * hash(line, 2, 42);
    const word = Math.floor(u * 22);
    const isWord = isText && u > start && u < end && hash(word, line, 43) > 0.2;
    const hue = isWord ? hues[Math.floor(4 * hash(word >> 1, line, 44))] : undefined;
    const ground = line < 1 ? 0.2 : isSide ? 0.13 : 0.09;
    out[0] = hue?.[0] ?? ground;
    out[1] = hue?.[1] ?? ground * 1.1;
    out[2] = hue?.[2] ?? ground * 1.3;
  });
}

/**
 * What is printed in the room, side by side: a lined page (u below a third), a landscape in flat
 * colours (to two thirds), and an abstract of arcs.
 */
export function prints(): DataTexture {
  return painted({ width: 384, height: 192, isColor: true }, (u, v, out) => {
    const x = (u * 3) % 1;
    if (u < 1 / 3) page(x, v, out);
    else if (u < 2 / 3) landscape(x, v, out);
    else arcs(x, v, out);
  });
}

function page(x: number, y: number, out: Pixel): void {
  const line = y * 18;
  const row = Math.floor(line);
  const isRule = line - row < 0.12;
  const isInk =
    row > 6 &&
    row < 17 &&
    line - row > 0.2 &&
    line - row < 0.55 &&
    x > 0.1 &&
    x < 0.45 + 0.45 * hash(row, 0, 51) &&
    noise(x * 60, row * 7, 60, 200, 52) > 0.42;
  const tone = isInk ? 0.3 : isRule ? 0.8 : 0.95;
  out[0] = tone;
  out[1] = tone * (isInk ? 1.05 : 0.985);
  out[2] = isInk ? 0.5 : tone * (isRule ? 1.02 : 0.93);
}

function landscape(x: number, y: number, out: Pixel): void {
  const layers: readonly [number, number, Pixel][] = [
    [0.62, 0.1, [0.93, 0.8, 0.66]],
    [0.5, 0.14, [0.82, 0.58, 0.45]],
    [0.36, 0.12, [0.45, 0.5, 0.46]],
    [0.2, 0.1, [0.2, 0.3, 0.32]],
  ];
  let color: Pixel = [0.95, 0.91, 0.83];
  if (Math.hypot(x - 0.66, y - 0.72) < 0.1) color = [0.88, 0.45, 0.3];
  for (const [i, [height, swell, hue]] of layers.entries()) {
    if (y < height + swell * (noise(x * 3 + i, i, 8, 8, 61) - 0.5) * 2) color = hue;
  }
  [out[0], out[1], out[2]] = color;
}

function arcs(x: number, y: number, out: Pixel): void {
  const hues: readonly Pixel[] = [
    [0.24, 0.36, 0.42],
    [0.8, 0.55, 0.32],
    [0.93, 0.9, 0.83],
    [0.55, 0.63, 0.56],
  ];
  const ring = Math.floor(Math.hypot(x - 0.5, y - 0.12) * 9);
  const isInside = x > 0.1 && x < 0.9 && y > 0.12 && ring < 4 && ring > 0;
  [out[0], out[1], out[2]] = (isInside ? hues[ring] : undefined) ?? [0.95, 0.93, 0.88];
}
