/** Floor, walls and ceiling, with a hole for the window. They are open towards the user. */

import { BufferGeometry, Float32BufferAttribute, Mesh, Vector3 } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { ROOM, WINDOW } from "../layout.ts";
import { ATLAS, type Surface } from "./bake.ts";
import type { Batch } from "./batch.ts";
import { WHITE } from "./colors.ts";
import type { Materials } from "./materials.ts";
import { bar, block, box } from "./shapes.ts";

const WIDTH = ROOM.right - ROOM.left;
const DEPTH = ROOM.front - ROOM.back;
/** How thick the back wall is, in metres. */
const THICKNESS = 0.24;

/** Walls are not one colour: the far one is a little warmer. */
const COLOR = {
  wall: [0.9, 0.86, 0.79],
  side: [0.89, 0.87, 0.82],
  ceiling: [0.95, 0.94, 0.92],
  oak: [1, 1, 1],
} as const;

export const FLOOR: Surface = {
  origin: new Vector3(ROOM.left, 0, ROOM.front),
  u: new Vector3(WIDTH, 0, 0),
  v: new Vector3(0, 0, -DEPTH),
  normal: new Vector3(0, 1, 0),
  tile: { x: 0, y: 0, width: 80, height: 72 },
};

const BACK: Surface = {
  origin: new Vector3(ROOM.left, 0, ROOM.back),
  u: new Vector3(WIDTH, 0, 0),
  v: new Vector3(0, ROOM.height, 0),
  normal: new Vector3(0, 0, 1),
  tile: { x: 80, y: 0, width: 72, height: 48 },
};

const CEILING: Surface = {
  origin: new Vector3(ROOM.left, ROOM.height, ROOM.back),
  u: new Vector3(WIDTH, 0, 0),
  v: new Vector3(0, 0, DEPTH),
  normal: new Vector3(0, -1, 0),
  tile: { x: 80, y: 48, width: 48, height: 48 },
};

const LEFT: Surface = {
  origin: new Vector3(ROOM.left, 0, ROOM.front),
  u: new Vector3(0, 0, -DEPTH),
  v: new Vector3(0, ROOM.height, 0),
  normal: new Vector3(1, 0, 0),
  tile: { x: 152, y: 0, width: 40, height: 40 },
};

const RIGHT: Surface = {
  origin: new Vector3(ROOM.right, 0, ROOM.back),
  u: new Vector3(0, 0, DEPTH),
  v: new Vector3(0, ROOM.height, 0),
  normal: new Vector3(-1, 0, 0),
  tile: { x: 152, y: 40, width: 40, height: 40 },
};

export const SURFACES: readonly Surface[] = [FLOOR, BACK, CEILING, LEFT, RIGHT];

/** The window's hole: left, right, bottom, top, in the room's x and y. */
export const HOLE = {
  left: WINDOW.centre[0] - WINDOW.width / 2,
  right: WINDOW.centre[0] + WINDOW.width / 2,
  bottom: WINDOW.centre[1] - WINDOW.height / 2,
  top: WINDOW.centre[1] + WINDOW.height / 2,
} as const;

/** The room's bare faces; what is mounted on them comes with `fittings`. */
export function shell(materials: Materials): Mesh[] {
  const a = (HOLE.left - ROOM.left) / WIDTH;
  const b = (HOLE.right - ROOM.left) / WIDTH;
  const low = HOLE.bottom / ROOM.height;
  const high = HOLE.top / ROOM.height;
  const walls = [
    piece(BACK, COLOR.wall, 0, 0, a, 1),
    piece(BACK, COLOR.wall, b, 0, 1, 1),
    piece(BACK, COLOR.wall, a, 0, b, low),
    piece(BACK, COLOR.wall, a, high, b, 1),
    piece(LEFT, COLOR.side),
    piece(RIGHT, COLOR.side),
    piece(CEILING, COLOR.ceiling),
  ];
  const meshes = [
    new Mesh(mergeGeometries(walls), materials.plaster),
    new Mesh(piece(FLOOR, COLOR.oak, 0, 0, 1, 1, true), materials.floor),
  ];
  for (const mesh of meshes) mesh.receiveShadow = true;
  return meshes;
}

/** Skirting boards, the window's reveal and sill, and the radiator below it. */
export function fittings(batch: Batch): void {
  const height = 0.09;
  const skirt = (length: number) => box(length, height, 0.016, { radius: 0.006, segments: 1 });
  batch.add("paint", skirt(WIDTH), { at: [0, height / 2, ROOM.back + 0.008], color: WHITE });
  for (const side of [-1, 1]) {
    const at = [side * (ROOM.right - 0.008), height / 2, (ROOM.back + ROOM.front) / 2] as const;
    batch.add("paint", skirt(DEPTH), { at, turn: [0, Math.PI / 2, 0], color: WHITE });
  }

  const [x, y] = WINDOW.centre;
  const z = ROOM.back - 0.008 - THICKNESS / 2;
  const jamb = () => block(0.02, WINDOW.height + 0.04, THICKNESS);
  batch.add("paint", jamb(), { at: [HOLE.left - 0.01, y, z], color: WHITE });
  batch.add("paint", jamb(), { at: [HOLE.right + 0.01, y, z], color: WHITE });
  batch.add("paint", block(WINDOW.width, 0.02, THICKNESS), {
    at: [x, HOLE.top + 0.01, z],
    color: WHITE,
  });
  batch.add("paint", block(WINDOW.width, 0.02, THICKNESS), {
    at: [x, HOLE.bottom - 0.02, z],
    color: WHITE,
  });
  batch.add("wood", box(WINDOW.width + 0.1, 0.03, 0.17, { radius: 0.008, segments: 2 }), {
    at: [x, HOLE.bottom - 0.012, ROOM.back + 0.02],
    color: 0xc99f6e,
    isBulky: true,
  });

  radiator(batch, x);
  masonry(batch);
}

/** Thick walls behind the faces, which nobody sees: they keep the sun out at every seam. */
function masonry(batch: Batch): void {
  const beyond = 0.3;
  const gap = 0.02;
  const wall = THICKNESS - gap;
  const z = ROOM.back - gap - wall / 2;
  const upright = (from: number, to: number, low: number, high: number) =>
    batch.add("paint", block(to - from, high - low, wall), {
      at: [(from + to) / 2, (low + high) / 2, z],
    });
  upright(ROOM.left - beyond, HOLE.left, -beyond, ROOM.height + beyond);
  upright(HOLE.right, ROOM.right + beyond, -beyond, ROOM.height + beyond);
  upright(HOLE.left, HOLE.right, -beyond, HOLE.bottom - gap);
  upright(HOLE.left, HOLE.right, HOLE.top + gap, ROOM.height + beyond);
  const middle = (ROOM.back + ROOM.front - wall) / 2;
  const length = DEPTH + wall;
  const tall = ROOM.height + 2 * beyond;
  batch.add("paint", block(wall, tall, length), {
    at: [ROOM.right + gap + wall / 2, ROOM.height / 2, middle],
  });
  batch.add("paint", block(WIDTH + 2 * beyond, wall, length), {
    at: [0, ROOM.height + gap + wall / 2, middle],
  });
}

function radiator(batch: Batch, x: number): void {
  const width = 1.0;
  const bottom = 0.16;
  const height = 0.52;
  const z = ROOM.back + 0.06;
  const color = 0xecebe6;
  batch.add("gloss", box(width, height, 0.05, { radius: 0.012, segments: 1 }), {
    at: [x, bottom + height / 2, z],
    color,
    isBulky: true,
  });
  const ribs = 16;
  for (let rib = 0; rib < ribs; rib += 1) {
    batch.add("gloss", bar(0.019, 0.019, height - 0.05, 10), {
      at: [x + (rib - (ribs - 1) / 2) * ((width - 0.03) / ribs), bottom + height / 2, z + 0.018],
      color,
    });
  }
  for (const side of [-1, 1]) {
    batch.add("paint", block(0.02, bottom + 0.05, 0.02), {
      at: [x + side * 0.4, bottom / 2, z - 0.005],
      color,
    });
  }
}

/** Part of a surface, from (u0, v0) to (u1, v1) of its sides. */
function piece(
  surface: Surface,
  color: readonly [number, number, number],
  u0 = 0,
  v0 = 0,
  u1 = 1,
  v1 = 1,
  isAlongV = false,
): BufferGeometry {
  const { origin, u, v, normal, tile } = surface;
  const at = new Vector3();
  const positions: number[] = [];
  const normals: number[] = [];
  const uv: number[] = [];
  const uv1: number[] = [];
  for (const [s, t] of [
    [u0, v0],
    [u1, v0],
    [u1, v1],
    [u0, v1],
  ] as const) {
    at.copy(origin).addScaledVector(u, s).addScaledVector(v, t);
    positions.push(at.x, at.y, at.z);
    normals.push(normal.x, normal.y, normal.z);
    const metres = [s * u.length(), t * v.length()] as const;
    uv.push(...(isAlongV ? [metres[1], metres[0]] : metres));
    uv1.push(
      (tile.x + 0.5 + s * (tile.width - 1)) / ATLAS.width,
      (tile.y + 0.5 + t * (tile.height - 1)) / ATLAS.height,
    );
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new Float32BufferAttribute(normals, 3));
  geometry.setAttribute("uv", new Float32BufferAttribute(uv, 2));
  geometry.setAttribute("uv1", new Float32BufferAttribute(uv1, 2));
  geometry.setAttribute(
    "color",
    new Float32BufferAttribute([...color, ...color, ...color, ...color], 3),
  );
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return geometry;
}
