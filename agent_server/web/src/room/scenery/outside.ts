/** What the window looks out on: sky, hills, a few houses, trees and a meadow, softly out of focus. */

import { ClampToEdgeWrapping, Mesh, MeshBasicMaterial, PlaneGeometry } from "three";
import { fractal, mix, noise, smooth } from "./noise.ts";
import { painted, type Pixel } from "./textures.ts";

/** Where the picture stands and how large it is, in metres; the horizon is at the eyes' height. */
const PLACE = { x: 4, y: 2.4, z: -14, width: 26, height: 13 } as const;
const HORIZON = 1.5;
/** The day outside is brighter than what a screen calls white. */
const BRIGHTNESS = 1.5;

interface House {
  readonly x: number;
  readonly half: number;
  readonly foot: number;
  readonly eaves: number;
  readonly ridge: number;
  readonly wall: Pixel;
  readonly roof: Pixel;
}

const HOUSES: readonly House[] = [
  {
    x: 2.55,
    half: 0.62,
    foot: -0.75,
    eaves: 0.05,
    ridge: 0.62,
    wall: [0.93, 0.88, 0.79],
    roof: [0.68, 0.4, 0.3],
  },
  {
    x: 4.2,
    half: 0.8,
    foot: -0.7,
    eaves: -0.12,
    ridge: 0.3,
    wall: [0.86, 0.8, 0.72],
    roof: [0.55, 0.36, 0.31],
  },
  {
    x: -1.8,
    half: 0.7,
    foot: -0.7,
    eaves: -0.05,
    ridge: 0.45,
    wall: [0.9, 0.86, 0.8],
    roof: [0.6, 0.38, 0.3],
  },
  {
    x: 9.2,
    half: 0.7,
    foot: -0.7,
    eaves: 0,
    ridge: 0.5,
    wall: [0.92, 0.87, 0.78],
    roof: [0.63, 0.39, 0.3],
  },
];

/** The crown of a tree: x, height over the horizon, radius. */
type Crown = readonly [number, number, number];

const CROWNS: readonly Crown[] = [
  [5.5, 0.55, 0.85],
  [5.0, 0.05, 0.6],
  [6.1, 0.1, 0.7],
  [1.35, 0.1, 0.5],
  [1.65, -0.3, 0.42],
  [3.4, -0.5, 0.28],
  [-3.6, 0.4, 0.9],
  [-0.4, -0.1, 0.5],
  [8.1, 0.2, 0.6],
  [11.4, 0.5, 0.95],
];

/** One plane far behind the window. */
export function outside(): Mesh {
  const width = 768;
  const height = 384;
  const texture = painted({ width, height, isColor: true }, (u, v, out) => {
    view(PLACE.x + (u - 0.5) * PLACE.width, PLACE.y + (v - 0.5) * PLACE.height - HORIZON, out);
  });
  texture.wrapS = ClampToEdgeWrapping;
  texture.wrapT = ClampToEdgeWrapping;
  const material = new MeshBasicMaterial({ map: texture, fog: false });
  material.color.setScalar(BRIGHTNESS);
  const mesh = new Mesh(new PlaneGeometry(PLACE.width, PLACE.height), material);
  mesh.position.set(PLACE.x, PLACE.y, PLACE.z);
  return mesh;
}

function blend(out: Pixel, color: Pixel, share: number): void {
  if (share === 0) return;
  out[0] = mix(out[0], color[0], share);
  out[1] = mix(out[1], color[1], share);
  out[2] = mix(out[2], color[2], share);
}

const shade: Pixel = [0, 0, 0];

function tinted(color: Pixel, tone: number): Pixel {
  shade[0] = color[0] * tone;
  shade[1] = color[1] * tone;
  shade[2] = color[2] * tone;
  return shade;
}

const SKY_LOW: Pixel = [0.9, 0.94, 0.97];
const SKY_HIGH: Pixel = [0.42, 0.64, 0.92];
const CLOUD: Pixel = [1, 0.995, 0.98];
const HILLS: Pixel = [0.66, 0.75, 0.8];
const WOODS: Pixel = [0.52, 0.62, 0.5];
const GRASS: Pixel = [0.62, 0.7, 0.42];
const HEDGE: Pixel = [0.38, 0.48, 0.28];
const LEAVES: Pixel = [0.47, 0.58, 0.3];
const GLASS: Pixel = [0.4, 0.46, 0.52];

/** @param x Metres in the picture's plane. @param h Metres over the horizon. */
function view(x: number, h: number, out: Pixel): void {
  if (h > -0.7) far(x + 20, h, out);
  if (h < -0.5) {
    const blades = noise((x + 20) * 3, (h + 8) * 14, 256, 512, 75);
    blend(out, tinted(GRASS, 0.9 + 0.2 * blades), edge(-0.62 - h, 0.05));
  }
  for (const house of HOUSES) build(house, x, h, out);
  for (const crown of CROWNS) grow(crown, x, h, out);
  if (h < -0.75 && h > -1.75) hedge(x + 20, h, out);
}

/** Sky, clouds, hills and the edge of a wood. */
function far(x: number, h: number, out: Pixel): void {
  [out[0], out[1], out[2]] = SKY_LOW;
  blend(out, SKY_HIGH, smooth(-0.3, 6, h));
  if (h > 0.2) {
    const cloud = fractal(x * 0.35, (h + 4) * 0.8, 64, 4, 71);
    blend(out, CLOUD, 0.9 * smooth(0.5, 0.7, cloud) * smooth(0.2, 1.2, h));
  }
  if (h > 1.2) return;
  blend(out, HILLS, edge(0.35 + 0.7 * noise(x * 0.3, 1, 64, 8, 72) - h, 0.05));
  const woods = 0.1 + 0.35 * noise(x * 0.9, 2, 64, 8, 73) + 0.14 * noise(x * 4, 3, 256, 8, 74);
  blend(out, WOODS, edge(woods - h, 0.06));
}

function hedge(x: number, h: number, out: Pixel): void {
  const top = -1.05 + 0.16 * noise(x * 2.2, 4, 256, 8, 76) + 0.07 * noise(x * 9, 5, 512, 8, 77);
  const light = 0.75 + 0.5 * noise(x * 12, (h + 8) * 12, 512, 512, 78) * smooth(-1.7, -0.9, h);
  blend(out, tinted(HEDGE, light), edge(top - h, 0.04) * edge(h + 1.65, 0.05));
}

/** 1 well inside, 0 outside, soft over the width of the edge. */
function edge(inside: number, width: number): number {
  return smooth(-width, width, inside);
}

function build(house: House, x: number, h: number, out: Pixel): void {
  const across = x - house.x;
  if (Math.abs(across) > house.half * 1.25 || h > house.ridge + 0.1 || h < house.foot - 0.1) return;
  const side = house.half - Math.abs(across);
  const wall = Math.min(side, house.eaves - h, h - house.foot);
  blend(out, tinted(house.wall, across > 0 ? 1 : 0.93), edge(wall, 0.025));
  const rise = (house.ridge - h) / (house.ridge - house.eaves);
  const roof = Math.min(
    house.half * mix(0.55, 1.12, rise) - Math.abs(across),
    h - house.eaves,
    house.ridge - h,
  );
  blend(out, house.roof, edge(roof, 0.025));
  for (const column of [-0.5, 0, 0.5]) {
    const pane = Math.min(
      0.075 - Math.abs(across - column * house.half),
      0.12 - Math.abs(h - mix(house.foot, house.eaves, 0.62)),
    );
    blend(out, GLASS, edge(pane, 0.02));
  }
}

function grow([at, height, radius]: Crown, x: number, h: number, out: Pixel): void {
  const dx = x - at;
  const dy = (h - height) * 0.85;
  if (Math.abs(dx) > radius * 1.3 || dy > radius * 1.3 || h < -1) return;
  const trunk = Math.min(0.05 * radius + 0.02 - Math.abs(dx), height - h, h + 0.95);
  blend(out, tinted(HEDGE, 0.6), edge(trunk, 0.02));
  const distance = Math.hypot(dx, dy);
  if (distance > radius * 1.3) return;
  const ragged = noise((x + 20) * 5, (h + 8) * 5, 512, 512, 79) - 0.5;
  const fine = noise((x + 20) * 14, (h + 8) * 14, 1024, 1024, 80);
  // The sun stands behind, to the right: light comes from there and through the edges.
  const light = 0.72 + (0.21 * (dx + dy)) / radius + 0.3 * (fine - 0.4);
  blend(out, tinted(LEAVES, Math.max(0.55, light)), edge(radius * (1 + 0.35 * ragged) - distance, 0.06));
}
