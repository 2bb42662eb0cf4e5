/** Many parts, one mesh for each material: parts are coloured by their vertices. */

import {
  Box3,
  BufferAttribute,
  Color,
  Euler,
  Float32BufferAttribute,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
  type BufferGeometry,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { MaterialName, Materials } from "./materials.ts";

export type Place = readonly [number, number, number];

export interface Part {
  readonly at?: Place;
  /** Radians about x, y and z; y is turned last. */
  readonly turn?: Place;
  readonly color?: number;
  /** Whether it is large enough to take light from what is beside it. */
  readonly isBulky?: boolean;
  /** Metres that its texture is shifted by, so that two boards are not alike. */
  readonly shift?: number;
}

const matrix = new Matrix4();
const euler = new Euler();
const quaternion = new Quaternion();
const position = new Vector3();
const ONE = new Vector3(1, 1, 1);

export class Batch {
  /** Bounding boxes of the bulky parts, in the batch's frame. */
  readonly blocks: Box3[] = [];
  readonly #parts = new Map<MaterialName, BufferGeometry[]>();
  /** What every later part is placed in. */
  readonly #frame = new Matrix4();

  /** Place what follows at a point and heading, instead of in the batch's own frame. */
  within(at: Place, heading = 0): this {
    this.#frame.makeRotationY(heading).setPosition(...at);
    return this;
  }

  add(material: MaterialName, geometry: BufferGeometry, part: Part = {}): this {
    const [x = 0, y = 0, z = 0] = part.turn ?? [];
    quaternion.setFromEuler(euler.set(x, y, z, "YXZ"));
    matrix.compose(position.set(...(part.at ?? [0, 0, 0])), quaternion, ONE).premultiply(this.#frame);
    geometry.applyMatrix4(matrix);
    const color = new Color(part.color ?? 0xffffff);
    const count = geometry.getAttribute("position").count;
    const colors = new Float32Array(count * 3);
    for (let i = 0; i < count; i += 1) color.toArray(colors, i * 3);
    geometry.setAttribute("color", new BufferAttribute(colors, 3));
    if (part.shift !== undefined) shift(geometry, part.shift);
    if (part.isBulky === true) {
      geometry.computeBoundingBox();
      if (geometry.boundingBox !== null) this.blocks.push(geometry.boundingBox);
    }
    const parts = this.#parts.get(material) ?? [];
    parts.push(geometry);
    this.#parts.set(material, parts);
    return this;
  }

  /**
   * @param shade Darkens the vertices of what was merged, in place.
   * @returns A mesh for each material that was used.
   */
  meshes(materials: Materials, shade?: (geometry: BufferGeometry) => void): Mesh[] {
    return [...this.#parts].map(([name, parts]) => {
      const merged = mergeGeometries(parts);
      shade?.(merged);
      const mesh = new Mesh(merged, materials[name]);
      mesh.name = name;
      mesh.castShadow = name !== "glass";
      mesh.receiveShadow = true;
      return mesh;
    });
  }
}

function shift(geometry: BufferGeometry, metres: number): void {
  const uv = geometry.getAttribute("uv");
  const moved = new Float32BufferAttribute(uv.count * 2, 2);
  for (let i = 0; i < uv.count; i += 1) moved.setXY(i, uv.getX(i) + metres, uv.getY(i) + metres * 0.37);
  geometry.setAttribute("uv", moved);
}
