/** A thin skin between shoulders and navel, so that a turn of the body can be read. */

import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial, type Color, type Vector3 } from "three";
import { JOINT } from "../protocol/skeleton.ts";

const CORNERS = [JOINT.leftShoulder, JOINT.neck, JOINT.rightShoulder, JOINT.navel];

export class Torso {
  readonly mesh: Mesh;
  readonly #positions = new BufferAttribute(new Float32Array(CORNERS.length * 3), 3);

  constructor(color: Color) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.#positions);
    geometry.setIndex([0, 1, 3, 1, 2, 3]);
    const material = new MeshBasicMaterial({
      color,
      transparent: true,
      opacity: 0.1,
      depthWrite: false,
      side: DoubleSide,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
  }

  /** @param points The nine core joints. */
  place(points: readonly Vector3[]): void {
    for (const [i, joint] of CORNERS.entries()) {
      const point = points[joint];
      if (point !== undefined) this.#positions.setXYZ(i, point.x, point.y, point.z);
    }
    this.#positions.needsUpdate = true;
  }
}
