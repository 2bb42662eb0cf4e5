/** The window: a fixed frame and pane, and a sash that swings outwards about its left side. */

import { Box3, Group, Object3D, Vector3 } from "three";
import { WINDOW } from "../layout.ts";
import { Batch } from "./batch.ts";
import { STEEL, WHITE } from "./colors.ts";
import type { Materials } from "./materials.ts";
import type { Movable } from "./movable.ts";
import { HOLE } from "./shell.ts";
import { block, box, rod, type Bevel } from "./shapes.ts";

const FRAME = 0.045;
const RAIL = 0.05;
const MULLION = 0.05;
const MOULDED: Bevel = { radius: 0.006, segments: 2 };
/** The frame's plane behind the wall's face. */
const Z = WINDOW.centre[2] - 0.05;
const SASH = {
  width: WINDOW.width / 2 - FRAME - MULLION / 2,
  height: WINDOW.height - 2 * FRAME,
} as const;
/** Of the handle over the floor, and from the sash's free edge. */
const HANDLE = { height: 1.33, inset: 0.026 } as const;

/** What does not move: frame, mullion, and the right half with its pane. */
export function windowFrame(batch: Batch): void {
  const [x, y] = WINDOW.centre;
  for (const side of [-1, 1]) {
    batch.add("paint", box(FRAME, WINDOW.height, 0.07, MOULDED), {
      at: [x + side * (WINDOW.width / 2 - FRAME / 2), y, Z],
      color: WHITE,
    });
    batch.add("paint", box(WINDOW.width, FRAME, 0.07, MOULDED), {
      at: [x, y + side * (WINDOW.height / 2 - FRAME / 2), Z],
      color: WHITE,
    });
  }
  batch.add("paint", box(MULLION, WINDOW.height, 0.07, MOULDED), { at: [x, y, Z], color: WHITE });
  leaf(batch, [x + MULLION / 2 + SASH.width / 2, y, Z]);
}

/** A pane in its four rails, about a point. */
function leaf(batch: Batch, [x, y, z]: readonly [number, number, number]): void {
  const { width, height } = SASH;
  for (const side of [-1, 1]) {
    batch.add("paint", box(RAIL, height, 0.045, MOULDED), {
      at: [x + side * (width / 2 - RAIL / 2), y, z],
      color: WHITE,
    });
    batch.add("paint", box(width - RAIL, RAIL, 0.043, MOULDED), {
      at: [x, y + side * (height / 2 - RAIL / 2), z],
      color: WHITE,
    });
  }
  batch.add("glass", block(width - 2 * RAIL + 0.01, height - 2 * RAIL + 0.01, 0.006), { at: [x, y, z] });
}

export class Sash implements Movable {
  readonly root = new Group();
  readonly place = new Object3D();
  readonly bounds = [
    new Box3(
      new Vector3(HOLE.left, HOLE.bottom, Z - 0.12),
      new Vector3(HOLE.right, HOLE.top, WINDOW.centre[2]),
    ),
  ];

  constructor(materials: Materials) {
    const batch = new Batch();
    leaf(batch, [SASH.width / 2, 0, 0]);
    const at = SASH.width - HANDLE.inset;
    const y = HANDLE.height - WINDOW.centre[1];
    batch.add("metal", box(0.026, 0.12, 0.01), { at: [at, y, 0.027], color: STEEL });
    batch.add("metal", rod([at, y + 0.02, 0.025], [at, y + 0.02, 0.055], 0.009), { color: STEEL });
    batch.add("metal", box(0.02, 0.12, 0.014, { radius: 0.006, segments: 2 }), {
      at: [at, y - 0.03, 0.058],
      color: STEEL,
    });
    this.place.position.set(at, y - 0.02, 0.06);
    this.root.add(...batch.meshes(materials), this.place);
    this.root.position.set(HOLE.left + FRAME, WINDOW.centre[1], Z);
    this.show(0);
  }

  /** 0 open, 1 closed. */
  show(share: number): void {
    this.root.rotation.y = WINDOW.openAngle * (1 - share);
  }
}
