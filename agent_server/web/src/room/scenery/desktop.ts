/** What lies and stands on the desk, but for the cigarette. */

import { DESK, ON_DESK } from "../layout.ts";
import type { Batch } from "./batch.ts";
import { BLACK, WHITE } from "./colors.ts";
import { ball, bar, block, box, hose, ring, sheet, turned } from "./shapes.ts";

/** The screen's glass, in metres. */
const GLASS = { width: 0.48, height: 0.27, above: 0.075 } as const;

export function desktop(batch: Batch): void {
  screen(batch);
  keyboard(batch);
  mouse(batch);
  notebook(batch);
  mug(batch);
  batch.within([0, 0, 0]);
}

function screen(batch: Batch): void {
  const { at, heading } = ON_DESK.screen;
  batch.within([at[0], DESK.top, at[1]], heading);
  const y = GLASS.above + GLASS.height / 2;
  const lean = -0.07;
  batch.add(
    "paint",
    box(GLASS.width + 0.018, GLASS.height + 0.022, 0.014, { radius: 0.006, segments: 2 }),
    {
      at: [0, y, 0],
      turn: [lean, 0, 0],
      color: BLACK,
      isBulky: true,
    },
  );
  batch.add("paint", box(0.34, 0.16, 0.036, { radius: 0.016, segments: 2 }), {
    at: [0, y - 0.01, -0.015],
    turn: [lean, 0, 0],
    color: 0x2b2e33,
  });
  batch.add("screen", sheet(GLASS.width, GLASS.height), { at: [0, y, 0.0078], turn: [lean, 0, 0] });
  batch.add("metal", box(0.06, 0.2, 0.012, { radius: 0.004, segments: 1 }), {
    at: [0, 0.1, -0.042],
    turn: [0.05, 0, 0],
    color: 0x9a9da2,
  });
  batch.add("metal", box(0.22, 0.009, 0.17, { radius: 0.004, segments: 2 }), {
    at: [0, 0.0045, -0.03],
    color: 0x9a9da2,
  });
  batch.add(
    "paint",
    hose(
      [
        [0.02, 0.18, -0.04],
        [0.05, 0.06, -0.08],
        [0.03, 0.004, -0.11],
        [-0.1, 0.004, -0.16],
      ],
      0.0035,
    ),
    { color: BLACK },
  );
}

function keyboard(batch: Batch): void {
  const { at, heading } = ON_DESK.keyboard;
  batch.within([at[0], DESK.top, at[1]], heading);
  batch.add("paint", box(0.37, 0.013, 0.13, { radius: 0.006, segments: 1 }), {
    at: [0, 0.0075, 0],
    turn: [0.05, 0, 0],
    color: 0xd8d8d4,
  });
  const pitch = 0.0232;
  for (let row = 0; row < 5; row += 1) {
    const z = (row - 2) * pitch;
    for (let column = 0; column < 15; column += 1) {
      const isSpace = row === 4 && column > 3 && column < 10;
      if (isSpace && column !== 7) continue;
      batch.add("paint", block(isSpace ? pitch * 5.8 : 0.0195, 0.007, 0.0195), {
        at: [(column - 7) * pitch + (isSpace ? -0.5 * pitch : 0), 0.0165 - z * 0.05, z],
        turn: [0.05, 0, 0],
        color: column === 0 || column > 12 || row === 4 ? 0x9ba3a6 : WHITE,
      });
    }
  }
}

function mouse(batch: Batch): void {
  batch.within([ON_DESK.keyboard.at[0] - 0.29, DESK.top, ON_DESK.keyboard.at[1]]);
  batch.add("gloss", ball(0.034).scale(0.9, 0.95, 1.5).translate(0, 0.001, 0), { color: WHITE });
}

/** Open, with a pen across. */
function notebook(batch: Batch): void {
  const { at, heading } = ON_DESK.notebook;
  batch.within([at[0], DESK.top, at[1]], heading);
  batch.add("paint", box(0.3, 0.006, 0.206, { radius: 0.003, segments: 1 }), {
    at: [0, 0.003, 0],
    color: 0x31505a,
  });
  for (const side of [-1, 1]) {
    batch.add("paint", box(0.143, 0.007, 0.198, { radius: 0.003, segments: 1 }), {
      at: [side * 0.0725, 0.009, 0],
      color: 0xf3ecdc,
    });
    batch.add("print", sheet(0.138, 0.193, 0.004, 0.329), {
      at: [side * 0.0725, 0.0128, 0],
      turn: [-Math.PI / 2, 0, 0],
    });
  }
  batch.add("metal", bar(0.0042, 0.0042, 0.13, 10), {
    at: [0.07, 0.0172, 0.03],
    turn: [0, 0.5, Math.PI / 2],
    color: 0x2b3f66,
  });
}

function mug(batch: Batch): void {
  batch.within([0.66, DESK.top, 0.36], 2.4);
  const color = 0xe7e2d6;
  batch.add(
    "gloss",
    turned(
      [
        [0.001, 0.002],
        [0.03, 0.002],
        [0.037, 0.01],
        [0.04, 0.088],
        [0.0385, 0.09],
        [0.037, 0.088],
        [0.034, 0.012],
        [0.001, 0.01],
      ],
      32,
    ),
    { color },
  );
  batch.add("gloss", ring(0.022, 0.005).scale(1, 1.2, 1), { at: [0.059, 0.048, 0], color });
  batch.add("gloss", bar(0.0362, 0.0362, 0.002, 28), { at: [0, 0.07, 0], color: 0x3a2217 });
}
