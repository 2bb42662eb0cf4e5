/** What makes it somebody's room: books, a plant, pictures. */

import { PlaneGeometry, type BufferGeometry } from "three";
import { ROOM } from "../layout.ts";
import type { Batch } from "./batch.ts";
import { OAK, WALNUT } from "./colors.ts";
import { sequence } from "./noise.ts";
import { block, box, hose, sheet, turned } from "./shapes.ts";

/** A bookcase on the left wall. */
export function shelf(batch: Batch): void {
  const [width, height, depth] = [0.95, 1.82, 0.27];
  const boards = 5;
  batch.within([ROOM.left + depth / 2 + 0.005, 0, -0.72], Math.PI / 2);
  for (const side of [-1, 1]) {
    batch.add("wood", box(0.024, height, depth), {
      at: [side * (width / 2 - 0.012), height / 2, 0],
      color: OAK,
      shift: side,
      isBulky: true,
    });
  }
  batch.add("wood", box(width, height - 0.06, 0.008), {
    at: [0, height / 2 + 0.02, -depth / 2 + 0.006],
    color: 0xbd925f,
    isBulky: true,
  });
  const next = sequence(5);
  for (let board = 0; board < boards; board += 1) {
    const y = 0.07 + (board * (height - 0.082)) / (boards - 1);
    batch.add("wood", box(width - 0.05, 0.022, depth - 0.01), {
      at: [0, y, 0],
      color: OAK,
      shift: board * 0.7,
      isBulky: true,
    });
    if (board < boards - 1) books(batch, next, y + 0.011, width - 0.1, depth, board);
  }
  batch.add(
    "gloss",
    turned([
      [0.001, 0],
      [0.05, 0],
      [0.085, 0.07],
      [0.08, 0.14],
      [0.035, 0.2],
      [0.03, 0.23],
      [0.04, 0.25],
    ]),
    {
      at: [0.2, height - 0.001, 0],
      color: 0xb5674a,
    },
  );
  batch.within([0, 0, 0]);
}

const SPINES = [
  0x7a3b35, 0x2f4a5a, 0xc8b48a, 0x4c5d48, 0xd8d2c4, 0x9a6b3f, 0x3c3a44, 0xb98a72, 0x5f7782, 0xe0c48c,
] as const;

function books(
  batch: Batch,
  next: () => number,
  y: number,
  width: number,
  depth: number,
  row: number,
): void {
  let x = -width / 2;
  const end = width / 2 - (row === 1 ? 0.3 : 0.12);
  while (x < end) {
    const thick = 0.018 + 0.03 * next();
    const tall = 0.2 + 0.12 * next();
    const deep = 0.14 + 0.05 * next();
    const color = SPINES[Math.floor(next() * SPINES.length)] ?? 0xffffff;
    batch.add("paint", block(thick, tall, deep), {
      at: [x + thick / 2, y + tall / 2, depth / 2 - deep / 2 - 0.02 - 0.02 * next()],
      color,
    });
    x += thick + 0.0015;
  }
  if (row === 1) {
    batch.add("paint", box(0.14, 0.14, 0.12, { radius: 0.01, segments: 1 }), {
      at: [width / 2 - 0.1, y + 0.07, 0.02],
      color: 0xd9d4c8,
    });
  }
}

/** A rubber plant in the corner beside the window. */
export function plant(batch: Batch): void {
  batch.within([ROOM.right - 0.34, 0, ROOM.back + 0.42]);
  batch.add(
    "paint",
    turned([
      [0.001, 0.002],
      [0.12, 0.002],
      [0.165, 0.3],
      [0.17, 0.32],
      [0.15, 0.32],
      [0.145, 0.28],
      [0.001, 0.28],
    ]),
    {
      color: 0xd8d0c2,
      isBulky: true,
    },
  );
  const next = sequence(8);
  const stems = [
    [0.02, 1.28, -0.02],
    [-0.09, 1.02, 0.05],
    [0.1, 0.86, 0.08],
  ] as const;
  for (const [dx, top, dz] of stems) {
    const points: readonly [number, number, number][] = [
      [dx * 0.2, 0.27, dz * 0.2],
      [dx * 0.5, 0.6, dz * 0.7],
      [dx, top, dz],
    ];
    batch.add("paint", hose(points, 0.008), { color: 0x6b5a3e });
    const leaves = 12;
    for (let leaf = 0; leaf < leaves; leaf += 1) {
      const share = 0.42 + (0.58 * leaf) / (leaves - 1);
      const around = leaf * 2.4 + top * 7;
      const size = 0.24 + 0.07 * next() - 0.07 * share;
      batch.add("gloss", leafShape(size), {
        at: [dx * share, 0.3 + (top - 0.3) * share, dz * share],
        turn: [-0.25 - 0.75 * share - 0.3 * next(), around, 0],
        color: leaf % 3 === 0 ? 0x3f6b3c : leaf % 3 === 1 ? 0x2f5a34 : 0x4b7a42,
      });
    }
  }
  batch.within([0, 0, 0]);
}

/** A leaf from the origin towards +z, folded along its middle and hanging at its tip. */
function leafShape(length: number): BufferGeometry {
  const geometry = new PlaneGeometry(1, 1, 4, 6).rotateX(Math.PI / 2).translate(0, 0, 0.5);
  const position = geometry.getAttribute("position");
  for (let i = 0; i < position.count; i += 1) {
    const along = position.getZ(i);
    const across =
      position.getX(i) * Math.sin(Math.PI * Math.min(1, along * 0.92 + 0.06)) ** 0.8 * 0.55 * length;
    position.setXYZ(i, across, 0.35 * Math.abs(across) - 0.28 * length * along * along, along * length);
  }
  geometry.computeVertexNormals();
  return geometry;
}

/** Two framed prints: over the hi-fi and on the right wall. */
export function pictures(batch: Batch): void {
  const framed = (width: number, height: number, print: number) => {
    batch.add("wood", box(width + 0.05, height + 0.05, 0.022), { color: WALNUT });
    batch.add("paint", sheet(width, height), { at: [0, 0, 0.012], color: 0xf3f0ea });
    batch.add("print", sheet(width * 0.76, height * 0.78, print / 3 + 0.004, (print + 1) / 3 - 0.004), {
      at: [0, 0, 0.0135],
    });
  };
  batch.within([-1.35, 1.66, ROOM.back + 0.013]);
  framed(0.66, 0.5, 1);
  batch.within([ROOM.right - 0.013, 1.58, -0.95], -Math.PI / 2);
  framed(0.46, 0.62, 2);
  batch.within([0, 0, 0]);
}
