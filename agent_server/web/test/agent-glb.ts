/** The skeleton of a GLB file, without its meshes and pictures, for Node. */

import { readFileSync } from "node:fs";
import { Bone, Group } from "three";
import { Rig } from "../src/room/agent/rig.ts";

/** As much of glTF's JSON as is read. */
interface Gltf {
  readonly scene?: number;
  readonly scenes: readonly { readonly nodes: readonly number[] }[];
  readonly nodes: readonly {
    readonly name?: string;
    readonly children?: readonly number[];
    readonly translation?: readonly [number, number, number];
    readonly rotation?: readonly [number, number, number, number];
    readonly scale?: readonly [number, number, number];
  }[];
  readonly meshes: readonly {
    readonly primitives: readonly { readonly attributes: { readonly POSITION: number } }[];
  }[];
  readonly skins: readonly { readonly joints: readonly number[] }[];
  readonly accessors: readonly { readonly min?: readonly number[] }[];
}

const JSON_STARTS = 20;

export function readRig(path: string | URL): Rig {
  const bytes = readFileSync(path);
  const length = bytes.readUInt32LE(12);
  const gltf = JSON.parse(bytes.toString("utf8", JSON_STARTS, JSON_STARTS + length)) as Gltf;
  const joints = new Set(gltf.skins.flatMap((skin) => skin.joints));
  const bones = gltf.nodes.map(({ name = "", translation, rotation, scale }, i) => {
    const bone = joints.has(i) ? new Bone() : new Group();
    bone.name = name;
    if (translation !== undefined) bone.position.set(...translation);
    if (rotation !== undefined) bone.quaternion.set(...rotation);
    if (scale !== undefined) bone.scale.set(...scale);
    return bone;
  });
  for (const [i, { children = [] }] of gltf.nodes.entries()) {
    for (const child of children) bones[i]?.add(bones[child] ?? new Group());
  }
  const root = new Group();
  for (const node of gltf.scenes[gltf.scene ?? 0]?.nodes ?? []) root.add(bones[node] ?? new Group());
  const lows = gltf.meshes.flatMap(({ primitives }) =>
    primitives.map(({ attributes }) => gltf.accessors[attributes.POSITION]?.min?.[1] ?? 0),
  );
  return new Rig(root, Math.min(...lows));
}
