/** Where the agent works: the desk, the chair, and the rug they stand on. */

import type { BufferGeometry } from "three";
import { CHAIR, DESK } from "../layout.ts";
import type { Batch } from "./batch.ts";
import { BLACK, IRON, OAK, SAGE, STEEL } from "./colors.ts";
import { bar, block, box, hose, rod } from "./shapes.ts";

export function desk(batch: Batch): void {
  const [x, z] = DESK.centre;
  const thickness = 0.032;
  batch.add("wood", box(DESK.width, thickness, DESK.depth, { radius: 0.009, segments: 2 }), {
    at: [x, DESK.top - thickness / 2, z],
    color: OAK,
    isBulky: true,
  });
  const inset = { x: DESK.width / 2 - 0.09, z: DESK.depth / 2 - 0.08 };
  const legTop = DESK.top - thickness;
  for (const side of [-1, 1]) {
    for (const end of [-1, 1]) {
      batch.add("wood", bar(0.026, 0.016, legTop + 0.006, 16), {
        at: [x + side * (inset.x + 0.025), legTop / 2, z + end * (inset.z + 0.02)],
        turn: [end * 0.055, 0, -side * 0.07],
        color: OAK,
        shift: side + end * 0.3,
        isBulky: true,
      });
    }
    batch.add("wood", box(0.022, 0.075, 2 * inset.z), {
      at: [x + side * inset.x, legTop - 0.038, z],
      color: OAK,
      shift: side * 0.4,
    });
  }
  for (const end of [-1, 1]) {
    batch.add("wood", box(2 * inset.x, 0.075, 0.022), {
      at: [x, legTop - 0.038, z + end * inset.z],
      color: OAK,
      shift: end * 0.7,
    });
  }
}

export function chair(batch: Batch): void {
  const [x, z] = CHAIR.at;
  batch.within([x, 0, z]);
  const cushion = { radius: 0.032, segments: 3 };
  batch.add("fabric", box(0.48, 0.075, 0.46, cushion), {
    at: [0, CHAIR.seat - 0.037, 0],
    color: SAGE,
    isBulky: true,
  });
  batch.add("paint", box(0.4, 0.02, 0.36), { at: [0, CHAIR.seat - 0.08, 0], color: BLACK });
  const back = box(0.44, 0.5, 0.07, cushion);
  curve(back, 0.35);
  batch.add("fabric", back, {
    at: [0, CHAIR.seat + 0.42, -0.27],
    turn: [-0.13, 0, 0],
    color: SAGE,
    isBulky: true,
  });
  const spine: readonly [number, number, number][] = [
    [0, CHAIR.seat - 0.09, -0.05],
    [0, CHAIR.seat - 0.09, -0.28],
    [0, CHAIR.seat + 0.12, -0.31],
    [0, CHAIR.seat + 0.45, -0.32],
  ];
  batch.add("metal", hose(spine, 0.016), { color: IRON });
  batch.add("metal", bar(0.024, 0.024, 0.28), { at: [0, 0.23, 0], color: STEEL });
  batch.add("metal", bar(0.034, 0.04, 0.12), { at: [0, 0.14, 0], color: IRON });
  for (let leg = 0; leg < 5; leg += 1) {
    const angle = 0.3 + (leg * 2 * Math.PI) / 5;
    const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
    batch.add("metal", rod([0, 0.1, 0], [0.29 * sin, 0.075, 0.29 * cos], 0.017), { color: IRON });
    batch.add("paint", bar(0.028, 0.028, 0.035, 12), {
      at: [0.29 * sin, 0.028, 0.29 * cos],
      turn: [0, angle, Math.PI / 2],
      color: BLACK,
    });
  }
  batch.within([0, 0, 0]);
}

/** Bend a box's wide face about y, its sides towards +z. */
function curve(geometry: BufferGeometry, strength: number): void {
  const position = geometry.getAttribute("position");
  for (let i = 0; i < position.count; i += 1) {
    position.setZ(i, position.getZ(i) + strength * position.getX(i) ** 2);
  }
}

export function rug(batch: Batch): void {
  const [x, z] = [0.05, 0.15];
  batch.add("fabric", box(3.0, 0.012, 2.3, { radius: 0.005, segments: 1 }), {
    at: [x, 0.006, z],
    color: 0xb9ab96,
  });
  for (const side of [-1, 1]) {
    batch.add("fabric", block(2.76, 0.002, 0.035), { at: [x, 0.013, z + side * 1.03], color: 0x7c6a58 });
    batch.add("fabric", block(0.035, 0.002, 2.06), { at: [x + side * 1.37, 0.013, z], color: 0x7c6a58 });
  }
}
