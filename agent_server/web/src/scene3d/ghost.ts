/** The expected motion: a few poses to come that fade with their distance in time, and the path
 * of both wrists as one dot a frame, so that the gap between dots shows the speed. */

import {
  Color,
  CustomBlending,
  Group,
  InstancedMesh,
  MathUtils,
  Matrix4,
  MaxEquation,
  ShaderMaterial,
  SphereGeometry,
  type Vector3,
} from "three";
import type { Point } from "../protocol/messages.ts";
import { BONES, JOINT, JOINTS } from "../protocol/skeleton.ts";
import { Follower } from "./smooth.ts";
import { BONE_RADIUS, boneGeometry, jointGeometry, placeBone, placeJoint } from "./shapes.ts";

/** Poses shown of a forecast: evenly spread, the last one being the forecast's last frame. */
const POSES = 5;
const FRAMES = 50;
const WRISTS = [JOINT.leftWrist, JOINT.rightWrist] as const;
const GHOST_TAU_MS = 90;
const DOT_RADIUS_M = 0.0105;
const SLIM = 0.8;

export class Ghost {
  readonly group = new Group();
  readonly #poses = Array.from({ length: POSES }, () => new Follower(JOINTS, GHOST_TAU_MS));
  readonly #trails = WRISTS.map(() => new Follower(FRAMES, GHOST_TAU_MS));
  readonly #bones: InstancedMesh;
  readonly #joints: InstancedMesh;
  readonly #dots: InstancedMesh;
  readonly #matrix = new Matrix4();
  readonly #color: Color;
  readonly #tint = new Color();
  #frames = 0;

  constructor(color: Color) {
    const rim = rimMaterial(1.5);
    this.#bones = new InstancedMesh(boneGeometry(), rim, POSES * BONES.length);
    this.#joints = new InstancedMesh(jointGeometry(), rim, POSES * JOINTS);
    this.#dots = new InstancedMesh(new SphereGeometry(1, 8, 6), rimMaterial(0), WRISTS.length * FRAMES);
    this.#color = color;
    for (let i = 0; i < WRISTS.length * FRAMES; i++) {
      const age = (i % FRAMES) / FRAMES;
      this.#dots.setColorAt(i, this.#lit(0.95 * (1 - age) ** 1.3 + 0.06));
    }
    for (const mesh of [this.#bones, this.#joints, this.#dots]) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
    this.group.visible = false;
  }

  /** Show a forecast of any length from one frame on, or none. */
  set(positions: readonly (readonly Point[])[] | null): void {
    const length = positions?.length ?? 0;
    this.group.visible = length > 0;
    if (positions === null || length === 0) {
      for (const follower of [...this.#poses, ...this.#trails]) follower.forget();
      return;
    }
    this.#frames = Math.min(FRAMES, length);
    for (const [i, follower] of this.#poses.entries()) {
      const frame = positions[Math.ceil(((i + 1) * length) / POSES) - 1];
      if (frame !== undefined) follower.aim(frame);
    }
    for (const [i, follower] of this.#trails.entries()) {
      const wrist = WRISTS[i] ?? JOINT.leftWrist;
      follower.aim(positions.slice(0, FRAMES).map((frame) => frame[wrist] ?? [0, 0, 0]));
    }
  }

  /**
   * @param body The body as shown now, nine points: what is not expected to move stays dark.
   * @returns Whether the picture changed.
   */
  step(dtMs: number, body: readonly Vector3[]): boolean {
    if (!this.group.visible) return false;
    let moved = false;
    for (const follower of [...this.#poses, ...this.#trails]) moved = follower.step(dtMs) || moved;
    if (moved) this.place(body);
    return moved;
  }

  /** Put every part where the followers are. */
  place(body: readonly Vector3[]): void {
    for (const [pose, { points }] of this.#poses.entries()) {
      const light = 0.68 ** pose;
      const apart = points.map((point, i) => departure(point, body[i]));
      for (const [i, [parent, child]] of BONES.entries()) {
        const [a, b] = [points[parent], points[child]];
        if (a === undefined || b === undefined) continue;
        const at = pose * BONES.length + i;
        const radius = (BONE_RADIUS[i] ?? 0.02) * SLIM;
        const farthest = Math.max(apart[parent] ?? 0, apart[child] ?? 0);
        this.#bones.setMatrixAt(at, placeBone(this.#matrix, a, b, radius));
        this.#bones.setColorAt(at, this.#lit(light * farthest));
      }
      for (const [i, point] of points.entries()) {
        const at = pose * JOINTS + i;
        this.#joints.setMatrixAt(at, placeJoint(this.#matrix, point, i, SLIM));
        this.#joints.setColorAt(at, this.#lit(light * (apart[i] ?? 0)));
      }
    }
    for (const [trail, { points }] of this.#trails.entries()) {
      for (const [i, { x, y, z }] of points.entries()) {
        const size = i < this.#frames ? DOT_RADIUS_M * (1 - (0.6 * i) / FRAMES) : 0;
        this.#matrix.makeScale(size, size, size).setPosition(x, y, z);
        this.#dots.setMatrixAt(trail * FRAMES + i, this.#matrix);
      }
    }
    for (const mesh of [this.#bones, this.#joints, this.#dots]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor !== null) mesh.instanceColor.needsUpdate = true;
    }
  }

  #lit(light: number): Color {
    return this.#tint.copy(this.#color).multiplyScalar(light);
  }
}

/** How clearly a joint is expected to leave its place: 0 up to 2 cm away, 1 from 10 cm on. */
function departure(then: Vector3, now: Vector3 | undefined): number {
  return now === undefined ? 1 : MathUtils.smoothstep(then.distanceTo(now), 0.02, 0.1);
}

/**
 * Light where a surface turns away from the eye: a shape of glass. The brighter of two lights wins,
 * so bodies that overlap neither wash out nor have to be sorted, and no light leaves the canvas
 * transparent.
 *
 * @param power How narrow the rim is; 0 lights the whole shape.
 */
function rimMaterial(power: number): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: MaxEquation,
    uniforms: { power: { value: power } },
    vertexShader: /* glsl */ `
      varying vec3 vTint;
      varying float vFacing;
      void main() {
        mat4 place = modelViewMatrix * instanceMatrix;
        vec4 seen = place * vec4(position, 1.0);
        // The parts are scaled unevenly; dividing by the squared scale keeps normals upright.
        vec3 squared = vec3(dot(place[0], place[0]), dot(place[1], place[1]), dot(place[2], place[2]));
        vec3 outward = normalize(mat3(place) * (normal / max(squared, vec3(1e-12))));
        vFacing = abs(dot(outward, normalize(-seen.xyz)));
        vTint = instanceColor;
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: /* glsl */ `
      uniform float power;
      varying vec3 vTint;
      varying float vFacing;
      void main() {
        float light = power > 0.0 ? 0.2 + 0.8 * pow(1.0 - vFacing, power) : 1.0;
        gl_FragColor = vec4(vTint * light, 0.0);
        #include <colorspace_fragment>
      }`,
  });
}
