/**
 * Where things are in the agent's room, for the furniture and for whoever walks and reaches in it.
 *
 * Metres; right-handed, x to the right as seen by the user, y up, z towards the user. The floor is
 * y = 0. The agent sits behind the desk and faces the user (+z), who looks in from +z. A heading is
 * the angle about y of what faces +z at 0, positive to +x.
 */

export type Vec3 = readonly [number, number, number];

export interface Spot {
  /** Where the hips are over the floor: x, z. */
  readonly at: readonly [number, number];
  readonly heading: number;
}

export const ROOM = { left: -2.3, right: 2.3, back: -2.1, front: 2.0, height: 2.6 } as const;

export const DESK = { centre: [0, 0.28], width: 1.7, depth: 0.72, top: 0.74 } as const;
export const CHAIR = { at: [0, -0.42], seat: 0.46 } as const;

/** On the desk; y is its top. */
export const ON_DESK = {
  screen: { at: [-0.52, 0.3], heading: Math.PI - 0.45 },
  keyboard: { at: [-0.12, 0.1], heading: Math.PI },
  notebook: { at: [0.24, 0.1], heading: Math.PI + 0.12 },
  /** Within reach of somebody who sits on the chair. */
  ashtray: { at: [0.47, 0.08] },
} as const;

/** In the back wall; its left half is a sash, hinged at the left side, that opens outwards: inwards it
 * would swing through curtains and whoever stands there. */
export const WINDOW = {
  centre: [1.15, 1.5, ROOM.back],
  width: 1.1,
  height: 1.25,
  /** Of the sash when it is open, radians about its hinge. */
  openAngle: 0.8,
} as const;

/** Two curtains before the window, which meet in its middle. The right one is pulled by its edge, and
 * the left one comes along. */
export const CURTAIN = { rail: 2.25, depth: 0.17, pullHeight: 1.25 } as const;

/** A hi-fi on a cabinet at the back wall, its volume knob in front. */
export const HIFI = { cabinet: [-1.35, -1.86], top: 0.8, knob: [-1.18, 0.9, -1.62] } as const;

/** Where the agent stands or sits to do something, and which way it faces. */
export const SPOTS: Readonly<Record<"chair" | "window" | "curtain" | "hifi" | "beside", Spot>> = {
  chair: { at: [0, -0.42], heading: 0 },
  /** Beside the chair: every way from and to it leads through here. */
  beside: { at: [0.62, -0.62], heading: 0.4 },
  window: { at: [1.02, -1.74], heading: Math.PI },
  curtain: { at: [1.4, -1.6], heading: Math.PI },
  hifi: { at: [-1.2, -1.22], heading: Math.PI },
};

/** What the user's eyes see it from, and what they look at. */
export const VIEW = { from: [0.1, 1.55, 2.6], to: [0.15, 1.05, -0.6], fov: 46 } as const;
