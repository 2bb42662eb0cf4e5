/** The agent's body from a GLB file. */

import { Box3, type Object3D } from "three";
import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";
import { Rig } from "./rig.ts";

export interface AgentBody {
  /** To be put into the scene, at its origin. */
  readonly root: Object3D;
  readonly rig: Rig;
}

/** @throws Error when the file cannot be fetched, is not a GLB, or lacks bones. */
export async function loadBody(url: string): Promise<AgentBody> {
  return bodyOf(await new GLTFLoader().loadAsync(url));
}

function bodyOf({ scene: root }: GLTF): AgentBody {
  root.updateWorldMatrix(true, true);
  root.traverse((object) => {
    // It moves far from where its bounds were measured.
    object.frustumCulled = false;
  });
  const floor = new Box3().setFromObject(root, true).min.y;
  return { root, rig: new Rig(root, floor) };
}
