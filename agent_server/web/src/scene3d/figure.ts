/** The body as measured: solid where the sensor is sure, faint and hollow where it is not. */

import {
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  type BufferGeometry,
  type Color,
  type Material,
} from "three";
import type { JointSample } from "../protocol/messages.ts";
import { BONES, JOINTS } from "../protocol/skeleton.ts";
import { Follower } from "./smooth.ts";
import {
  BONE_RADIUS,
  boneGeometry,
  hollowGeometry,
  jointGeometry,
  placeBone,
  placeJoint,
} from "./shapes.ts";
import { Torso } from "./torso.ts";

/** Kinect says 1 for tracked, 0.5 for inferred and 0 for lost. */
const SURE = 0.75;
const GUESSED = 0.25;
const POSE_TAU_MS = 35;

type Look = "sure" | "guessed" | "lost";

export class Figure {
  readonly group = new Group();
  readonly follower = new Follower(JOINTS, POSE_TAU_MS);

  readonly #joints: readonly Mesh[];
  readonly #bones: readonly Mesh[];
  readonly #torso: Torso;
  readonly #ball: BufferGeometry;
  readonly #cage: BufferGeometry;
  readonly #solid: Readonly<Record<Look, Material>>;
  readonly #hollow: Readonly<Record<Look, Material>>;
  #looks: readonly Look[] = Array.from({ length: JOINTS }, () => "sure");

  constructor(measured: Color, uncertain: Color) {
    const sure = new MeshStandardMaterial({ color: measured, roughness: 0.42, metalness: 0.05 });
    const faint = (opacity: number) =>
      new MeshStandardMaterial({ color: uncertain, roughness: 0.8, transparent: true, opacity });
    const wire = (opacity: number) =>
      new MeshBasicMaterial({ color: uncertain, wireframe: true, transparent: true, opacity });
    this.#solid = { sure, guessed: faint(0.55), lost: faint(0.22) };
    this.#hollow = { sure, guessed: wire(0.9), lost: wire(0.4) };
    const bone = boneGeometry();
    this.#ball = jointGeometry();
    this.#cage = hollowGeometry();
    const mesh = (geometry: BufferGeometry) => {
      const part = new Mesh(geometry, sure);
      part.matrixAutoUpdate = false;
      part.frustumCulled = false;
      this.group.add(part);
      return part;
    };
    this.#joints = Array.from({ length: JOINTS }, () => mesh(this.#ball));
    this.#bones = BONES.map(() => mesh(bone));
    this.#torso = new Torso(measured);
    this.group.add(this.#torso.mesh);
    this.group.visible = false;
  }

  /** Show a pose, or nobody. */
  set(joints: readonly JointSample[] | null): void {
    this.group.visible = joints !== null;
    if (joints === null) {
      this.follower.forget();
      return;
    }
    this.follower.aim(joints);
    this.#looks = joints.map(([, , , confidence]) => lookOf(confidence));
    for (const [i, part] of this.#joints.entries()) {
      const look = this.#looks[i] ?? "lost";
      part.material = this.#hollow[look];
      part.geometry = look === "sure" ? this.#ball : this.#cage;
    }
    for (const [i, [parent, child]] of BONES.entries()) {
      const part = this.#bones[i];
      const [a, b] = [this.#looks[parent] ?? "lost", this.#looks[child] ?? "lost"];
      if (part !== undefined) part.material = this.#solid[worse(a, b)];
    }
  }

  /** @returns Whether the picture changed. */
  step(dtMs: number): boolean {
    if (!this.group.visible || !this.follower.step(dtMs)) return false;
    this.place();
    return true;
  }

  /** Put every part where the follower is. */
  place(): void {
    const { points } = this.follower;
    this.#torso.place(points);
    for (const [i, part] of this.#joints.entries()) {
      const point = points[i];
      if (point === undefined) continue;
      placeJoint(part.matrix, point, i);
      part.matrixWorldNeedsUpdate = true;
    }
    for (const [i, [parent, child]] of BONES.entries()) {
      const part = this.#bones[i];
      const [a, b] = [points[parent], points[child]];
      if (part === undefined || a === undefined || b === undefined) continue;
      const thin = part.material === this.#solid.sure ? 1 : 0.7;
      placeBone(part.matrix, a, b, (BONE_RADIUS[i] ?? 0.02) * thin);
      part.matrixWorldNeedsUpdate = true;
    }
  }
}

function lookOf(confidence: number): Look {
  return confidence >= SURE ? "sure" : confidence >= GUESSED ? "guessed" : "lost";
}

function worse(a: Look, b: Look): Look {
  return a === "lost" || b === "lost" ? "lost" : a === "guessed" || b === "guessed" ? "guessed" : "sure";
}
