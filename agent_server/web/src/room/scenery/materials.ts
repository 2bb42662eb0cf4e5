/** The few materials of the room, shared by everything in it. */

import {
  BackSide,
  DoubleSide,
  MeshBasicMaterial,
  MeshStandardMaterial,
  type DataTexture,
  type Material,
  type Texture,
} from "three";
import { linen, planks, plaster, prints, screenPicture, weave, wood } from "./textures.ts";

export type MaterialName =
  | "plaster"
  | "floor"
  | "wood"
  | "paint"
  | "gloss"
  | "metal"
  | "fabric"
  | "curtain"
  | "print"
  | "screen"
  | "glass";

export type Materials = Readonly<Record<MaterialName, Material>> & {
  /** Those that mirror the room, which darken with it. */
  readonly lit: readonly MeshStandardMaterial[];
  readonly plaster: MeshStandardMaterial;
  readonly floor: MeshStandardMaterial;
  readonly curtain: MeshStandardMaterial;
};

/**
 * @param environment What surfaces mirror, see `surroundings`.
 * @param baked Light and shade of walls and floor, see `bakeShell`.
 */
export function createMaterials(
  environment: Texture,
  baked: { light: DataTexture; shade: DataTexture },
): Materials {
  const grain = wood();
  grain.repeat.set(1 / 1.6, 1 / 0.5);
  const boards = planks();
  boards.repeat.set(1 / 1.92, 1 / 1.92);
  const cloth = weave();
  cloth.repeat.set(1 / 0.06, 1 / 0.06);
  const rough = plaster();
  rough.repeat.set(1 / 0.8, 1 / 0.8);
  const yarn = linen();
  yarn.repeat.set(3, 5);

  const common = { envMap: environment, vertexColors: true };
  const shell = { ...common, lightMap: baked.light, aoMap: baked.shade };
  const plasterWall = new MeshStandardMaterial({
    ...shell,
    bumpMap: rough,
    bumpScale: 0.35,
    roughness: 0.95,
  });
  const floor = new MeshStandardMaterial({ ...shell, map: boards, roughness: 0.5 });
  const plain = {
    wood: new MeshStandardMaterial({ ...common, map: grain, roughness: 0.6 }),
    paint: new MeshStandardMaterial({ ...common, roughness: 0.6 }),
    gloss: new MeshStandardMaterial({ ...common, roughness: 0.22, side: DoubleSide }),
    metal: new MeshStandardMaterial({ ...common, metalness: 1, roughness: 0.35 }),
    fabric: new MeshStandardMaterial({
      ...common,
      map: cloth,
      bumpMap: cloth,
      bumpScale: 0.8,
      roughness: 1,
    }),
    curtain: new MeshStandardMaterial({
      ...common,
      map: yarn,
      color: 0xd3c0a4,
      emissive: 0xffdcae,
      roughness: 1,
      side: DoubleSide,
      // Folds that the sun meets from the front do not shade themselves.
      shadowSide: BackSide,
    }),
    print: new MeshStandardMaterial({ ...common, map: prints(), roughness: 0.8 }),
    glass: new MeshStandardMaterial({
      ...common,
      color: 0xcfe0ec,
      transparent: true,
      opacity: 0.22,
      roughness: 0.04,
      metalness: 0.1,
      depthWrite: false,
    }),
  };
  return {
    plaster: plasterWall,
    floor,
    ...plain,
    screen: new MeshBasicMaterial({ map: screenPicture() }),
    lit: [plasterWall, floor, ...Object.values(plain)],
  };
}
