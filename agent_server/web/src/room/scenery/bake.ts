/** Light that is worked out once: how much of the sky and of the room every part of it sees. */

import {
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  RGBAFormat,
  Vector3,
  type Box3,
  type BufferGeometry,
} from "three";
import { WINDOW } from "../layout.ts";
import { hash } from "./noise.ts";

/** A flat piece of the shell and its place in the baked pictures. */
export interface Surface {
  readonly origin: Vector3;
  /** Its sides: from the origin to the corners beside it, in metres. */
  readonly u: Vector3;
  readonly v: Vector3;
  readonly normal: Vector3;
  /** In the atlas, in texels. */
  readonly tile: {
    readonly x: number;
    readonly y: number;
    readonly width: number;
    readonly height: number;
  };
}

export const ATLAS = { width: 192, height: 96 } as const;

const SHADE_RAYS = { surface: 20, vertex: 12 } as const;
/** How far things darken each other, in metres. */
const SHADE_REACH = 0.85;
const LIGHT_RAYS = 6;
/** Brings the window's share of the sky to what materials take as light. */
const LIGHT_SCALE = 9;

const start = new Vector3();
const way = new Vector3();
const tangent = new Vector3();
const bitangent = new Vector3();
const lift = new Vector3();

/**
 * @param blocks What stands in the way.
 * @returns Light from the window, and how open each point is to the room around (red).
 */
export function bakeShell(
  surfaces: readonly Surface[],
  blocks: readonly Box3[],
): { light: DataTexture; shade: DataTexture } {
  const size = ATLAS.width * ATLAS.height;
  const light = new Float32Array(size);
  const shade = new Float32Array(size).fill(1);
  for (const { origin, u, v, normal, tile } of surfaces) {
    for (let row = 0; row < tile.height; row += 1) {
      for (let column = 0; column < tile.width; column += 1) {
        // The outermost texels lie on the edges, so that neighbours in the atlas do not bleed in.
        start
          .copy(origin)
          .addScaledVector(u, column / (tile.width - 1))
          .addScaledVector(v, row / (tile.height - 1));
        start.addScaledVector(normal, 0.012);
        const i = (tile.y + row) * ATLAS.width + tile.x + column;
        shade[i] =
          openness(start, normal, blocks, i, SHADE_RAYS.surface) * cornerShade(surfaces, start, normal);
        light[i] = LIGHT_SCALE * windowShare(start, normal, blocks, i);
      }
    }
    soften(light, tile);
    soften(shade, tile);
  }
  return { light: texture(light, [0.93, 0.98, 1.06]), shade: texture(shade, [1, 1, 1]) };
}

/** Darken the vertices of merged furniture where others stand close. */
export function shadeVertices(geometry: BufferGeometry, blocks: readonly Box3[]): void {
  const position = geometry.getAttribute("position");
  const normal = geometry.getAttribute("normal");
  const color = geometry.getAttribute("color");
  for (let i = 0; i < position.count; i += 1) {
    lift.fromBufferAttribute(normal, i);
    start.fromBufferAttribute(position, i).addScaledVector(lift, 0.015);
    const open =
      openness(start, lift, blocks, i, SHADE_RAYS.vertex) *
      Math.min(1, 0.72 + 0.28 * smoothHeight(start.y, lift.y));
    const tone = 0.25 + 0.75 * open;
    color.setXYZ(i, color.getX(i) * tone, color.getY(i) * tone, color.getZ(i) * tone);
  }
}

/** What is low sees less light, what looks down least. */
function smoothHeight(height: number, up: number): number {
  return Math.min(1, height / 0.5) * (0.5 + 0.5 * Math.max(-1, up) * 0.5 + 0.25);
}

/** Share of the hemisphere about the normal that nothing near stands in, weighted by cosine. */
function openness(
  from: Vector3,
  normal: Vector3,
  blocks: readonly Box3[],
  seed: number,
  rays: number,
): number {
  tangent.set(normal.y, normal.z, normal.x).cross(normal).normalize();
  bitangent.crossVectors(normal, tangent);
  const near = blocks.filter((block) => block.distanceToPoint(from) < SHADE_REACH);
  let blocked = 0;
  for (let ray = 0; ray < rays; ray += 1) {
    const spread = (ray + hash(seed, ray, 91)) / rays;
    const around = 2 * Math.PI * ((ray * 0.618034 + hash(seed, 0, 92)) % 1);
    const radius = Math.sqrt(spread);
    way.copy(normal).multiplyScalar(Math.sqrt(1 - spread));
    way
      .addScaledVector(tangent, radius * Math.cos(around))
      .addScaledVector(bitangent, radius * Math.sin(around));
    let nearest = SHADE_REACH;
    for (const block of near) nearest = Math.min(nearest, distanceTo(block, from, way));
    blocked += 1 - nearest / SHADE_REACH;
  }
  return 1 - blocked / rays;
}

/** Walls darken each other towards the edge where they meet. */
function cornerShade(surfaces: readonly Surface[], at: Vector3, normal: Vector3): number {
  let open = 1;
  for (const other of surfaces) {
    if (other.normal.dot(normal) > 0.9) continue;
    const distance = lift.subVectors(at, other.origin).dot(other.normal);
    open *= 1 - 0.3 * Math.exp(-Math.max(0, distance) / 0.28);
  }
  return open;
}

/** Share of the cosine-weighted hemisphere that the window fills. */
function windowShare(from: Vector3, normal: Vector3, blocks: readonly Box3[], seed: number): number {
  const [x, y, z] = WINDOW.centre;
  const area = (WINDOW.width * WINDOW.height) / LIGHT_RAYS;
  let sum = 0;
  for (let ray = 0; ray < LIGHT_RAYS; ray += 1) {
    const column = (ray % 3) + hash(seed, ray, 93);
    const row = Math.floor(ray / 3) + hash(seed, ray, 94);
    way
      .set(x + WINDOW.width * (column / 3 - 0.5), y + WINDOW.height * (row / 2 - 0.5), z - 0.08)
      .sub(from);
    const distance = way.length();
    way.divideScalar(distance);
    const cosines = Math.max(0, way.dot(normal)) * Math.max(0, -way.z);
    if (cosines === 0) continue;
    let isSeen = true;
    for (const block of blocks) {
      if (distanceTo(block, from, way) < distance) {
        isSeen = false;
        break;
      }
    }
    if (isSeen) sum += (cosines * area) / (Math.PI * Math.max(0.09, distance * distance));
  }
  return sum;
}

/** @returns How far along the way the box begins, in metres, or infinity. */
function distanceTo({ min, max }: Box3, from: Vector3, direction: Vector3): number {
  const ax = (min.x - from.x) / direction.x;
  const bx = (max.x - from.x) / direction.x;
  const ay = (min.y - from.y) / direction.y;
  const by = (max.y - from.y) / direction.y;
  const az = (min.z - from.z) / direction.z;
  const bz = (max.z - from.z) / direction.z;
  const near = Math.max(0, Math.min(ax, bx), Math.min(ay, by), Math.min(az, bz));
  const far = Math.min(Math.max(ax, bx), Math.max(ay, by), Math.max(az, bz));
  return near > far ? Infinity : near;
}

/** Average each texel with its neighbours in the tile, twice, which takes out the rays' noise. */
function soften(values: Float32Array, { x, y, width, height }: Surface["tile"]): void {
  const before = new Float32Array(width * height);
  for (let pass = 0; pass < 2; pass += 1) {
    for (let row = 0; row < height; row += 1) {
      for (let column = 0; column < width; column += 1) {
        before[row * width + column] = values[(y + row) * ATLAS.width + x + column] ?? 0;
      }
    }
    for (let row = 0; row < height; row += 1) {
      for (let column = 0; column < width; column += 1) {
        let sum = 0;
        for (let dy = -1; dy <= 1; dy += 1) {
          for (let dx = -1; dx <= 1; dx += 1) {
            const near = Math.min(height - 1, Math.max(0, row + dy)) * width;
            sum += before[near + Math.min(width - 1, Math.max(0, column + dx))] ?? 0;
          }
        }
        values[(y + row) * ATLAS.width + x + column] = sum / 9;
      }
    }
  }
}

function texture(values: Float32Array, hue: readonly [number, number, number]): DataTexture {
  const data = new Uint16Array(values.length * 4);
  for (const [i, value] of values.entries()) {
    for (let channel = 0; channel < 3; channel += 1) {
      data[i * 4 + channel] = DataUtils.toHalfFloat(value * (hue[channel] ?? 1));
    }
    data[i * 4 + 3] = DataUtils.toHalfFloat(1);
  }
  const baked = new DataTexture(data, ATLAS.width, ATLAS.height, RGBAFormat, HalfFloatType);
  baked.magFilter = LinearFilter;
  baked.minFilter = LinearFilter;
  baked.channel = 1;
  baked.needsUpdate = true;
  return baked;
}
