/** Where the agent stands, with which hand and how it takes hold of things, and where they are. */

import { Vector3 } from "three";
import { CHAIR, DESK, HIFI, ON_DESK, SPOTS, WINDOW, type Spot } from "../layout.ts";
import type { Side } from "./rig.ts";

export type PlaceName = "chair" | "window" | "curtain" | "hifi";

/** How far one turns on the chair before one gets up, to either side. */
export const TURNED_OUT = 1.25;
/** From where one sits to where one stands in front of it. */
const GET_UP = 0.38;

/** Where one gets up from the chair and sits down again, on either side of it. */
export const BY_CHAIR: Readonly<Record<Side, Spot>> = { Left: byChair(1), Right: byChair(-1) };

function byChair(sign: 1 | -1): Spot {
  const [x, z] = CHAIR.at;
  return {
    at: [x + sign * GET_UP * Math.sin(TURNED_OUT), z + GET_UP * Math.cos(TURNED_OUT)],
    heading: sign * TURNED_OUT,
  };
}

/** The side of the chair on which a point over the floor lies, as seen by who sits on it. */
export const sideOf = (x: number): Side => (x >= CHAIR.at[0] ? "Left" : "Right");

/** Where one stands for something. */
export const spotOf = (place: PlaceName, side: Side): Spot =>
  place === "chair" ? BY_CHAIR[side] : SPOTS[place];

/** How a hand takes hold of something. */
export interface Grip {
  readonly side: Side;
  /** 0 with the fist, 1 with thumb and forefinger. */
  readonly pinch: number;
  readonly closed: number;
  /** Of the fingers below the line from shoulder to handle, in radians. */
  readonly droop: number;
  /** Of the palm: 0 it faces down, pi/2 it faces the body's middle. */
  readonly roll: number;
  /** How far the hand turns about the fingers while it acts. */
  readonly turn: number;
}

/** Things that are acted on. The cigarette lies in the ashtray, on the agent's left. */
export const GRIPS: Readonly<Record<string, Grip>> = {
  window: { side: "Left", pinch: 0, closed: 0.8, droop: 0, roll: 1.2, turn: 0 },
  curtain: { side: "Right", pinch: 0, closed: 0.85, droop: 0, roll: 1.2, turn: 0 },
  hifi: { side: "Right", pinch: 1, closed: 0.5, droop: -0.3, roll: 0.9, turn: -0.8 },
  cigarette: { side: "Left", pinch: 1, closed: 0.55, droop: 0.1, roll: 0.4, turn: 0.5 },
};

const onDesk = ([x, z]: readonly [number, number], above: number): Vector3 =>
  new Vector3(x, DESK.top + above, z);

/** What there is to look at. */
export const SIGHTS: Readonly<Record<string, Vector3>> = {
  window: new Vector3(...WINDOW.centre),
  curtain: new Vector3(...WINDOW.centre),
  hifi: new Vector3(...HIFI.knob),
  cigarette: onDesk(ON_DESK.ashtray.at, 0.03),
  chair: new Vector3(CHAIR.at[0], CHAIR.seat, CHAIR.at[1]),
  desk: onDesk(DESK.centre, 0),
  keyboard: onDesk(ON_DESK.keyboard.at, 0.02),
  screen: onDesk(ON_DESK.screen.at, 0.24),
  notebook: onDesk(ON_DESK.notebook.at, 0.01),
};

export const isPlace = (name: string): name is PlaceName => name in SPOTS && name !== "beside";
