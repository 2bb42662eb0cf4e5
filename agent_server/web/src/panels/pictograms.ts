/** Small pictures of the room's objects, one a state; 40 x 40, drawn with lines. */

import { svg } from "../ui/dom.ts";

interface Drawing {
  /** Drawn with the full colour. */
  readonly strong: string;
  /** Drawn faintly. */
  readonly faint?: string;
}

const WINDOW_FRAME = "M7 6h26v28H7zM5 36h30";

const DRAWINGS: Readonly<Record<string, Readonly<Record<string, Drawing>>>> = {
  window: {
    open: {
      strong: "M7 6 15 10V38L7 34ZM33 6 25 10V38L33 34Z",
      faint: "M7 6h26M15 34h10M18 16q2-2 4 0M17.500 21q2.500-2 5 0M18 26q2-2 4 0",
    },
    closed: { strong: `${WINDOW_FRAME}M20 6v28`, faint: "M7 20h26" },
  },
  hifi: {
    high: {
      strong: "M6 8h14v24H6zM25 15q3 5 0 10M29.500 11.500q5.500 8.500 0 17M34 8q8 12 0 24",
      faint: "M13 26.500a4 4 0 1 0 0-8 4 4 0 0 0 0 8ZM13 14.500a1.700 1.700 0 1 0 0-3.400 1.700 1.700 0 0 0 0 3.400Z",
    },
    low: {
      strong: "M6 8h14v24H6zM25 16.500q2 3.500 0 7",
      faint: "M13 26.500a4 4 0 1 0 0-8 4 4 0 0 0 0 8ZM13 14.500a1.700 1.700 0 1 0 0-3.400 1.700 1.700 0 0 0 0 3.400Z",
    },
  },
  cigarette: {
    lit: {
      strong: "M4 27h25v5H4zM32 27v5M36 27v5M12 27v5",
      faint: "M34 22c0-4-4-4-4-8s4-4 4-8M28 22c0-3-3-3-3-6s3-3 3-6",
    },
    out: { strong: "M5 30c0 4 6 6 15 6s15-2 15-6M13 28 27 20l2 3.500-11 6.200", faint: "M5 30c0-4 6-6 15-6s15 2 15 6" },
  },
  curtain: {
    open: {
      strong: "M4 6h32M8 6v28h6q1-8-2-14 3-6 2-14M32 6v28h-6q-1-8 2-14-3-6-2-14",
      faint: "M20 16.500a3.500 3.500 0 1 0 0 7 3.500 3.500 0 0 0 0-7M20 11v2M20 27v2M15.500 20h-.5M25 20h-.5",
    },
    closed: { strong: "M4 6h32M8 6v28h12V6M32 6v28H20", faint: "M12 10v20M16 10v20M24 10v20M28 10v20" },
  },
};

/** Other names under which a rule file may know the same thing. */
const ALIASES: Readonly<Record<string, string>> = {
  "hi-fi": "hifi",
  hi_fi: "hifi",
  stereo: "hifi",
  volume: "hifi",
  curtains: "curtain",
};

const UNKNOWN: Drawing = { strong: "M20 5 34 12.500V27.500L20 35 6 27.500V12.500Z", faint: "M6 12.500 20 20 34 12.500M20 20V35" };

/** A picture of an object in a state; a plain box for what this page has no picture of. */
export function pictogram(object: string, state: string): SVGSVGElement {
  const drawing = DRAWINGS[ALIASES[object] ?? object]?.[state] ?? UNKNOWN;
  const picture = svg("svg", { class: "pictogram", viewBox: "0 0 40 40", "aria-hidden": "true" });
  if (drawing.faint !== undefined) picture.append(svg("path", { class: "faint", d: drawing.faint }));
  picture.append(svg("path", { class: "strong", d: drawing.strong }));
  return picture;
}
