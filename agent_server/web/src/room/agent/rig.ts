/**
 * Named access to the bones of a humanoid and what its rest pose tells: lengths, directions, soles.
 *
 * Poses are written as deltas: the turn of a bone, in the world, against its rest pose, in which
 * the body faces +z on the floor y = 0. How the bones' own axes lie is of no concern to the rest.
 */

import { Matrix4, Quaternion, Vector3, type Bone, type Mesh, type Object3D } from "three";
import { closeHand } from "./fingers.ts";

const BODY = ["Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"] as const;
const LIMBS = ["Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase"] as const;
const FINGERS = ["Thumb", "Index", "Middle", "Ring", "Pinky"] as const;

type Body = (typeof BODY)[number];
type Limb = (typeof LIMBS)[number];
export type Side = "Left" | "Right";
export type BoneName = Body | `${Side}${Limb}`;

export const SIDES: readonly Side[] = ["Left", "Right"];
/** +1 where x is positive at rest: the body faces +z, so its left is at +x. */
export const SIGN: Readonly<Record<Side, 1 | -1>> = { Left: 1, Right: -1 };

/** How far thumb and forefinger are closed when they meet. */
const PINCHED = 0.5;
/** Share of the foot's length, ankle to ball, that the heel lies behind the ankle. */
const HEEL_SHARE = 0.35;

const m = new Matrix4();
const q = new Quaternion();

/** One bone: its turn against rest and its place, both in the world. */
export class Joint {
  readonly object: Object3D;
  readonly parent: Joint | null;
  readonly rest = { place: new Vector3(), turn: new Quaternion(), parentTurn: new Quaternion() };
  /** From the parent's place, at rest. */
  readonly offset = new Vector3();
  readonly delta = new Quaternion();
  readonly place = new Vector3();

  constructor(object: Object3D, parent: Joint | null, floor: number) {
    this.object = object;
    this.parent = parent;
    object.getWorldPosition(this.rest.place);
    this.rest.place.y -= floor;
    object.getWorldQuaternion(this.rest.turn);
    object.parent?.getWorldQuaternion(this.rest.parentTurn);
    this.place.copy(this.rest.place);
    if (parent !== null) this.offset.subVectors(this.rest.place, parent.rest.place);
  }

  /** Be where the parent carries it. */
  follow(): void {
    const { parent } = this;
    if (parent === null) return;
    this.place.copy(this.offset).applyQuaternion(parent.delta).add(parent.place);
  }

  /** Hand the turn to the bone. */
  write(): void {
    const { object, rest, parent } = this;
    q.copy(rest.parentTurn);
    if (parent !== null) q.premultiply(parent.delta);
    object.quaternion.copy(q.conjugate()).multiply(this.delta).multiply(rest.turn);
  }
}

/** A bone that only turns against its parent about axes known at rest: fingers, eyes. */
export class SmallJoint {
  readonly object: Object3D;
  readonly place = new Vector3();
  readonly #rest = new Quaternion();
  readonly #toParent = new Quaternion();
  readonly #axis = new Vector3();

  constructor(object: Object3D) {
    this.object = object;
    object.getWorldPosition(this.place);
    this.#rest.copy(object.quaternion);
    object.parent?.getWorldQuaternion(this.#toParent).invert();
  }

  reset(): void {
    this.object.quaternion.copy(this.#rest);
  }

  /** Turn further about an axis given in the world at rest. */
  turn(axis: Vector3, angle: number): void {
    this.#axis.copy(axis).applyQuaternion(this.#toParent);
    this.object.quaternion.premultiply(q.setFromAxisAngle(this.#axis, angle));
  }
}

export interface Arm {
  readonly sign: 1 | -1;
  readonly clavicle: Joint;
  readonly upper: Joint;
  readonly fore: Joint;
  readonly hand: Joint;
  readonly upperLength: number;
  readonly foreLength: number;
  /** At rest, from the wrist: where the fingers point and which way the palm faces. */
  readonly fingers: Vector3;
  readonly palm: Vector3;
  /** At rest, from the wrist: middle of the closed fist, and where thumb and forefinger meet. */
  readonly fist: Vector3;
  readonly pinch: Vector3;
  /** Five fingers of up to three bones, thumb first; none where the rig has none. */
  readonly digits: readonly (readonly SmallJoint[])[];
}

export interface Leg {
  readonly sign: 1 | -1;
  readonly thigh: Joint;
  readonly shank: Joint;
  readonly foot: Joint;
  readonly toes: Joint;
  readonly thighLength: number;
  readonly shankLength: number;
  /** Of the ankle over the sole. */
  readonly ankleHeight: number;
  /** From the ankle forwards, along the floor. */
  readonly ball: number;
  /** Of the joint there, over the sole. */
  readonly ballHeight: number;
  /** From the ankle backwards. */
  readonly heel: number;
}

/** A mesh with named morph targets. */
interface Morphing {
  readonly names: Readonly<Record<string, number>>;
  readonly weights: number[];
}

export class Rig {
  readonly root: Object3D;
  readonly joints: Readonly<Record<BoneName, Joint>>;
  readonly all: readonly Joint[];
  readonly arms: Readonly<Record<Side, Arm>>;
  readonly legs: Readonly<Record<Side, Leg>>;
  readonly eyes: readonly SmallJoint[];
  /** Between the eyes, from the head's joint, at rest. */
  readonly gaze = new Vector3();
  readonly #morphing: Morphing[] = [];

  /**
   * @param root Holds the skeleton in its rest pose, T or A, facing +z.
   * @param floor Height of the soles in that pose.
   * @throws Error that names the bones that are missing.
   */
  constructor(root: Object3D, floor = 0) {
    this.root = root;
    root.updateWorldMatrix(true, true);
    const found = new Map<string, Object3D>();
    root.traverse((object) => {
      // Meshes may be called as bones are.
      if ((object as Bone).isBone) found.set(plainName(object.name), object);
      const { morphTargetDictionary: names, morphTargetInfluences: weights } = object as Mesh;
      if (names !== undefined && weights !== undefined) this.#morphing.push({ names, weights });
    });
    const names: readonly BoneName[] = [
      ...BODY,
      ...SIDES.flatMap((side) => LIMBS.map((limb) => `${side}${limb}` as const)),
    ];
    const missing = names.filter((name) => !found.has(name));
    if (missing.length > 0) throw new Error(`the skeleton lacks ${missing.join(", ")}`);
    const byObject = new Map<Object3D, Joint>();
    const joints: Partial<Record<BoneName, Joint>> = {};
    for (const name of names) {
      const object = found.get(name);
      if (object === undefined) continue;
      const joint = new Joint(object, nearest(object, byObject), floor);
      byObject.set(object, joint);
      joints[name] = joint;
    }
    this.joints = joints as Record<BoneName, Joint>;
    this.all = [...byObject.values()];
    this.arms = { Left: armOf(this.joints, "Left", found), Right: armOf(this.joints, "Right", found) };
    this.legs = { Left: legOf(this.joints, "Left"), Right: legOf(this.joints, "Right") };
    this.eyes = SIDES.flatMap((side) => {
      const eye = found.get(`${side}Eye`);
      return eye === undefined ? [] : [new SmallJoint(eye)];
    });
    const [left, right] = this.eyes;
    const { place } = this.joints.Head.rest;
    if (left === undefined || right === undefined) this.gaze.set(0, 0.09, 0.09);
    else this.gaze.addVectors(left.place, right.place).multiplyScalar(0.5).sub(place).y -= floor;
  }

  /** Height of the hips over the floor at rest. */
  get hipHeight(): number {
    return this.joints.Hips.rest.place.y;
  }

  /** Hand the pose to the bones. */
  write(): void {
    const { Hips } = this.joints;
    const { parent } = Hips.object;
    Hips.object.position.copy(Hips.place);
    if (parent !== null) Hips.object.position.applyMatrix4(m.copy(parent.matrixWorld).invert());
    for (const joint of this.all) joint.write();
  }

  /** Set every morph of this name; a rig without it is left as it is. */
  morph(name: string, weight: number): void {
    for (const { names, weights } of this.#morphing) {
      const index = names[name];
      if (index !== undefined) weights[index] = weight;
    }
  }

  /** Names of its morphs. */
  get morphs(): string[] {
    return [...new Set(this.#morphing.flatMap(({ names }) => Object.keys(names)))];
  }
}

/** `mixamorig:LeftArm`, `mixamorigLeftArm` and `LeftArm` are one bone. */
function plainName(name: string): string {
  return name.replace(/^mixamorig\d*[:_]?/, "");
}

function nearest(object: Object3D, joints: ReadonlyMap<Object3D, Joint>): Joint | null {
  for (let above = object.parent; above !== null; above = above.parent) {
    const joint = joints.get(above);
    if (joint !== undefined) return joint;
  }
  return null;
}

type Joints = Readonly<Record<BoneName, Joint>>;

function armOf(joints: Joints, side: Side, found: ReadonlyMap<string, Object3D>): Arm {
  const [upper, fore, hand] = [joints[`${side}Arm`], joints[`${side}ForeArm`], joints[`${side}Hand`]];
  const digits = FINGERS.map((finger) =>
    [1, 2, 3].flatMap((i) => {
      const bone = found.get(`${side}Hand${finger}${i}`);
      return bone === undefined ? [] : [new SmallJoint(bone)];
    }),
  );
  const wrist = new Vector3();
  hand.object.getWorldPosition(wrist);
  const knuckle = (i: number): Vector3 | undefined => digits[i]?.[0]?.place.clone().sub(wrist);
  const [index, middle, last] = [knuckle(1), knuckle(2), knuckle(4) ?? knuckle(3)];
  const fingers = (middle ?? hand.rest.place.clone().sub(fore.rest.place)).clone().normalize();
  const palm = new Vector3(0, -1, 0);
  if (index !== undefined && last !== undefined) {
    palm.crossVectors(fingers, index.sub(last)).multiplyScalar(SIGN[side]);
  }
  palm.addScaledVector(fingers, -palm.dot(fingers)).normalize();
  // Of a hand of usual proportions, whose knuckles lie half a hand from the wrist.
  const half = middle?.length() ?? 0.09;
  const at = (along: number, below: number): Vector3 =>
    fingers.clone().multiplyScalar(half * along).addScaledVector(palm, half * below);
  const arm: Arm = {
    sign: SIGN[side],
    clavicle: joints[`${side}Shoulder`],
    upper,
    fore,
    hand,
    upperLength: fore.rest.place.distanceTo(upper.rest.place),
    foreLength: hand.rest.place.distanceTo(fore.rest.place),
    fingers,
    palm,
    fist: at(0.95, 0.4),
    pinch: at(1.6, 0.55),
    digits,
  };
  const [thumb, forefinger] = digits;
  if (thumb?.length === 3 && forefinger?.length === 3) {
    closeHand(arm, PINCHED, 1);
    hand.object.updateWorldMatrix(false, true);
    arm.pinch.addVectors(tipOf(thumb), tipOf(forefinger)).multiplyScalar(0.5).sub(wrist);
    closeHand(arm, 0, 0);
    hand.object.updateWorldMatrix(false, true);
  }
  return arm;
}

/** A fingertip lies about as far beyond the last joint as that lies beyond the one before. */
function tipOf(digit: readonly SmallJoint[]): Vector3 {
  const [before, last] = [new Vector3(), new Vector3()];
  digit[1]?.object.getWorldPosition(before);
  digit[2]?.object.getWorldPosition(last);
  return last.add(last.clone().sub(before).multiplyScalar(0.75));
}

function legOf(joints: Joints, side: Side): Leg {
  const [thigh, shank] = [joints[`${side}UpLeg`], joints[`${side}Leg`]];
  const [foot, toes] = [joints[`${side}Foot`], joints[`${side}ToeBase`]];
  const ball = toes.rest.place.z - foot.rest.place.z;
  return {
    sign: SIGN[side],
    thigh,
    shank,
    foot,
    toes,
    thighLength: shank.rest.place.distanceTo(thigh.rest.place),
    shankLength: foot.rest.place.distanceTo(shank.rest.place),
    ankleHeight: foot.rest.place.y,
    ball,
    ballHeight: toes.rest.place.y,
    heel: ball * HEEL_SHARE,
  };
}
