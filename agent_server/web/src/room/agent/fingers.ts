/** How the fingers close. */

import { Vector3 } from "three";
import { mix } from "./maths.ts";
import type { Arm } from "./rig.ts";

const DEGREE = Math.PI / 180;
/** Of knuckle, middle and last joint, when the fist is closed. */
const CURL = [62, 78, 50] as const;
/** The same for thumb and forefinger that hold something small. */
const PINCH = [48, 42, 18] as const;
const THUMB = [22, 28, 30] as const;

const axis = new Vector3();
const thumbAxis = new Vector3();

/**
 * @param closed From 0, flat, to 1, a fist.
 * @param pinch From 0 to 1: forefinger and thumb meet instead.
 */
export function closeHand(arm: Arm, closed: number, pinch: number): void {
  // Fingers bend towards the palm; the thumb bends across it.
  axis.crossVectors(arm.fingers, arm.palm);
  thumbAxis.copy(arm.palm).multiplyScalar(-arm.sign).addScaledVector(axis, 0.45).normalize();
  for (let f = 0; f < arm.digits.length; f += 1) {
    const digit = arm.digits[f];
    if (digit === undefined) continue;
    for (let i = 0; i < digit.length; i += 1) {
      const fist = f === 0 ? (THUMB[i] ?? 0) : (CURL[i] ?? 0);
      const angle = f === 1 ? mix(fist, PINCH[i] ?? 0, pinch) : fist;
      digit[i]?.reset();
      digit[i]?.turn(f === 0 ? thumbAxis : axis, angle * closed * DEGREE);
    }
  }
}
