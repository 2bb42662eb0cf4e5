/** The nine core joints, in which telemetry shows a body. */

/** Index of each core joint in every array of nine. */
export const JOINT = {
  head: 0,
  neck: 1,
  navel: 2,
  leftShoulder: 3,
  leftElbow: 4,
  leftWrist: 5,
  rightShoulder: 6,
  rightElbow: 7,
  rightWrist: 8,
} as const;

export const JOINTS = 9;

/** (parent, child) of the eight bones, outwards from the navel. */
export const BONES: readonly (readonly [number, number])[] = [
  [JOINT.navel, JOINT.neck],
  [JOINT.neck, JOINT.head],
  [JOINT.neck, JOINT.leftShoulder],
  [JOINT.leftShoulder, JOINT.leftElbow],
  [JOINT.leftElbow, JOINT.leftWrist],
  [JOINT.neck, JOINT.rightShoulder],
  [JOINT.rightShoulder, JOINT.rightElbow],
  [JOINT.rightElbow, JOINT.rightWrist],
];
