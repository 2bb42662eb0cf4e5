/** A skeleton of 1.75 m with Mixamo's names, in T or A pose, whose bones' own axes lie anyhow. */

import { Bone, Group, Quaternion, Vector3, type Object3D } from "three";
import { Chance } from "../src/room/agent/maths.ts";
import { Rig } from "../src/room/agent/rig.ts";

export interface MannequinOptions {
  readonly prefix?: string;
  /** Of the arms below the horizontal, radians. */
  readonly armsDown?: number;
  /** Of the bones' own axes; none are turned at 0. */
  readonly seed?: number;
}

type Place = readonly [x: number, y: number, z: number];

/** Of the middle, and of the left side: [parent, place]. */
const MIDDLE: Readonly<Record<string, readonly [string, Place]>> = {
  Hips: ["", [0, 0.98, 0]],
  Spine: ["Hips", [0, 1.08, -0.01]],
  Spine1: ["Spine", [0, 1.2, -0.015]],
  Spine2: ["Spine1", [0, 1.32, -0.015]],
  Neck: ["Spine2", [0, 1.48, -0.02]],
  Head: ["Neck", [0, 1.57, 0]],
};
const SIDE: Readonly<Record<string, readonly [string, Place]>> = {
  Shoulder: ["Spine2", [0.04, 1.44, -0.01]],
  Arm: ["*Shoulder", [0.175, 1.44, -0.02]],
  ForeArm: ["*Arm", [0.455, 1.44, -0.025]],
  Hand: ["*ForeArm", [0.71, 1.44, -0.01]],
  UpLeg: ["Hips", [0.09, 0.92, 0]],
  Leg: ["*UpLeg", [0.09, 0.5, 0.005]],
  Foot: ["*Leg", [0.09, 0.085, -0.02]],
  ToeBase: ["*Foot", [0.09, 0.02, 0.11]],
  Eye: ["Head", [0.032, 1.64, 0.08]],
};
const FINGERS: Readonly<Record<string, Place>> = {
  Thumb: [0.75, 1.425, 0.03],
  Index: [0.8, 1.44, 0.02],
  Middle: [0.8, 1.44, -0.002],
  Ring: [0.795, 1.44, -0.022],
  Pinky: [0.785, 1.44, -0.042],
};

export function mannequin({ prefix = "mixamorig:", armsDown = 0, seed = 0 }: MannequinOptions = {}): {
  readonly root: Object3D;
  readonly rig: Rig;
} {
  const chance = new Chance(seed);
  const bones = new Map<string, Bone>();
  const root = new Group();
  const add = (name: string, parentName: string, place: Vector3): void => {
    const bone = new Bone();
    bone.name = prefix + name;
    const parent: Object3D = bones.get(parentName) ?? root;
    parent.add(bone);
    root.updateWorldMatrix(true, true);
    bone.position.copy(parent.worldToLocal(place.clone()));
    if (seed > 0) {
      const axis = new Vector3(chance.between(-1, 1), chance.between(-1, 1), chance.between(-1, 1));
      bone.quaternion.copy(new Quaternion().setFromAxisAngle(axis.normalize(), chance.between(0, 3)));
    }
    bones.set(name, bone);
  };
  for (const [name, [parent, place]] of Object.entries(MIDDLE)) add(name, parent, new Vector3(...place));
  for (const [side, sign] of [["Left", 1], ["Right", -1]] as const) {
    const shoulder = new Vector3(...(SIDE["Arm"]?.[1] ?? [0, 0, 0]));
    const place = (at: Place, isArm: boolean): Vector3 => {
      const point = new Vector3(...at);
      if (isArm) point.sub(shoulder).applyAxisAngle(new Vector3(0, 0, 1), -armsDown).add(shoulder);
      return point.multiply(new Vector3(sign, 1, 1));
    };
    for (const [name, [parent, at]] of Object.entries(SIDE)) {
      const isArm = name === "ForeArm" || name === "Hand";
      add(side + name, parent.replace("*", side), place(at, isArm));
    }
    for (const [finger, [x, y, z]] of Object.entries(FINGERS)) {
      for (const i of [1, 2, 3]) {
        const parent = i === 1 ? `${side}Hand` : `${side}Hand${finger}${i - 1}`;
        add(`${side}Hand${finger}${i}`, parent, place([x + 0.03 * (i - 1), y, z], true));
      }
    }
  }
  return { root, rig: new Rig(root) };
}
