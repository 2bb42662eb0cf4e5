/** The hi-fi's furniture: a cabinet with records, the amplifier's case, and two speakers. */

import { Box3, Vector3 } from "three";
import { HIFI } from "../layout.ts";
import type { Batch } from "./batch.ts";
import { BLACK, OAK, STEEL, WALNUT } from "./colors.ts";
import { sequence } from "./noise.ts";
import { bar, block, box, turned } from "./shapes.ts";

const [X, Z] = HIFI.cabinet;
const [KNOB_X, KNOB_Y, FACE_Z] = HIFI.knob;
export const CABINET = { width: 1.42, depth: 0.4, legs: 0.15 } as const;
const AMPLIFIER = { width: 0.44, height: 0.13, depth: 0.32 } as const;
/** Where the speakers stand along x. */
export const SPEAKERS = [X - 0.5, X + 0.5] as const;
export const SPEAKER = { width: 0.2, height: 0.34, depth: 0.25 } as const;
/** Their fronts' z. */
export const SPEAKER_FACE = Z - 0.02 + SPEAKER.depth / 2;

export function hifiCabinet(batch: Batch): void {
  const { width, depth, legs } = CABINET;
  const height = HIFI.top - legs;
  batch.within([X, 0, Z]);
  const y = legs + height / 2;
  const round = { radius: 0.006, segments: 2 };
  const wide = (board: number) => box(width, board, depth, round);
  batch.add("wood", wide(0.024), { at: [0, HIFI.top - 0.012, 0], color: WALNUT, isBulky: true });
  batch.add("wood", wide(0.024), { at: [0, legs + 0.012, 0], color: WALNUT, shift: 0.3, isBulky: true });
  for (const side of [-1, 1]) {
    batch.add("wood", box(0.024, height - 0.04, depth), {
      at: [side * (width / 2 - 0.012), y, 0],
      color: WALNUT,
      shift: side,
      isBulky: true,
    });
    for (const end of [-1, 1]) {
      batch.add("wood", bar(0.02, 0.012, legs + 0.01, 12), {
        at: [side * (width / 2 - 0.1), legs / 2, end * (depth / 2 - 0.07)],
        turn: [end * 0.12, 0, -side * 0.12],
        color: WALNUT,
      });
    }
  }
  batch.add("wood", block(width - 0.04, height - 0.04, 0.01), {
    at: [0, y, -depth / 2 + 0.01],
    color: 0x6f472c,
    isBulky: true,
  });
  batch.add("wood", box(0.02, height - 0.04, depth - 0.03), {
    at: [0.16, y, 0],
    color: WALNUT,
    isBulky: true,
  });
  // Left a sliding door in two leaves, right an open compartment with records.
  for (const [i, at] of [-0.485, -0.06].entries()) {
    batch.add("wood", box(0.436, height - 0.056, 0.016), {
      at: [at, y, depth / 2 - 0.016 - i * 0.018],
      color: 0x95633f,
      shift: 0.55 + i,
      isBulky: true,
    });
    batch.add("paint", bar(0.018, 0.018, 0.004, 18), {
      at: [at + (i === 0 ? 0.17 : -0.12), y, depth / 2 - 0.007 - i * 0.018],
      turn: [Math.PI / 2, 0, 0],
      color: 0x4a2f1e,
    });
  }
  records(batch, legs + 0.024);
  batch.within([0, 0, 0]);
  amplifier(batch);
  for (const x of SPEAKERS) speaker(batch, x);
}

const SLEEVES = [
  0x2f3e4d, 0xb5563c, 0xe3d9c4, 0x5d7264, 0x23262b, 0xc99a45, 0x7d3b42, 0x8ba3ad,
] as const;

function records(batch: Batch, floor: number): void {
  const next = sequence(12);
  let x = 0.185;
  while (x < 0.56) {
    const thick = 0.004 + 0.006 * next();
    const color = SLEEVES[Math.floor(next() * SLEEVES.length)] ?? 0xffffff;
    batch.add("paint", block(thick, 0.315, 0.315), {
      at: [x + thick / 2, floor + 0.158, -0.01 + 0.02 * next()],
      turn: [0, 0, -0.02],
      color,
    });
    x += thick + 0.002;
  }
  batch.blocks.push(
    new Box3(new Vector3(X + 0.19, floor, Z - 0.17), new Vector3(X + 0.57, floor + 0.31, Z + 0.14)),
  );
}

function amplifier(batch: Batch): void {
  const { width, height, depth } = AMPLIFIER;
  const x = KNOB_X - 0.15;
  const y = HIFI.top + 0.012 + height / 2;
  const z = FACE_Z - 0.022 - depth / 2;
  batch.add("paint", box(width, height, depth, { radius: 0.006, segments: 2 }), {
    at: [x, y, z],
    color: BLACK,
    isBulky: true,
  });
  batch.add("metal", box(width + 0.004, height, 0.012, { radius: 0.004, segments: 2 }), {
    at: [x, y, FACE_Z - 0.02],
    color: 0xc9cbcc,
  });
  batch.add("paint", box(0.25, 0.05, 0.004, { radius: 0.002, segments: 1 }), {
    at: [x - 0.065, KNOB_Y + 0.012, FACE_Z - 0.0145],
    color: 0x101318,
  });
  for (let button = 0; button < 5; button += 1) {
    batch.add("metal", box(0.026, 0.012, 0.008, { radius: 0.003, segments: 1 }), {
      at: [x - 0.165 + button * 0.045, y - 0.042, FACE_Z - 0.012],
      color: STEEL,
    });
  }
  batch.add(
    "metal",
    turned(
      [
        [0.039, 0],
        [0.036, 0.004],
        [0.001, 0.004],
      ],
      32,
    ),
    { at: [KNOB_X, KNOB_Y, FACE_Z - 0.0145], turn: [Math.PI / 2, 0, 0], color: 0x8d9094 },
  );
  for (const side of [-1, 1]) {
    for (const end of [-1, 1]) {
      batch.add("paint", bar(0.018, 0.018, 0.014, 12), {
        at: [x + side * 0.18, HIFI.top + 0.007, z + end * 0.12],
        color: BLACK,
      });
    }
  }
}

function speaker(batch: Batch, x: number): void {
  const { width, height, depth } = SPEAKER;
  const y = HIFI.top + height / 2;
  batch.add("wood", box(width, height, depth, { radius: 0.008, segments: 2 }), {
    at: [x, y, Z - 0.02],
    color: OAK,
    shift: x,
    isBulky: true,
  });
  batch.add("paint", box(width - 0.02, height - 0.02, 0.008, { radius: 0.003, segments: 1 }), {
    at: [x, y, SPEAKER_FACE],
    color: 0x26282b,
  });
  const face = SPEAKER_FACE + 0.003;
  batch.add(
    "metal",
    turned(
      [
        [0.084, 0],
        [0.078, 0.006],
        [0.072, 0],
      ],
      32,
    ),
    { at: [x, y - 0.05, face], turn: [Math.PI / 2, 0, 0], color: 0x5b5f65 },
  );
  batch.add(
    "metal",
    turned(
      [
        [0.034, 0],
        [0.031, 0.003],
        [0.018, 0.003],
        [0.014, 0.007],
        [0.001, 0.01],
      ],
      24,
    ),
    { at: [x, y + 0.1, face], turn: [Math.PI / 2, 0, 0], color: 0x5b5f65 },
  );
}
