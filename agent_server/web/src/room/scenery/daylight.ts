/** The light of the day: the sun through the window, the sky, and what walls throw back. */

import {
  DataTexture,
  DataUtils,
  DirectionalLight,
  EquirectangularReflectionMapping,
  Group,
  HalfFloatType,
  HemisphereLight,
  LinearFilter,
  RGBAFormat,
  SpotLight,
  Vector3,
} from "three";
import { ROOM, WINDOW } from "../layout.ts";
import type { Materials } from "./materials.ts";
import { mix, smooth } from "./noise.ts";

/** Which way the sun shines: from behind the right side of the window, down into the room. */
const SUN = { azimuth: 0.27, elevation: 0.41, intensity: 8.5, color: 0xffeccf } as const;
const SHADOW_MAP = 2048;
const SKY = { intensity: 0.7, above: 0xf6f4ee, below: 0xc4aa88 } as const;
const FRONT = { intensity: 0.5, color: 0xfff4e6 } as const;
const SPILL = { intensity: 7, color: 0xeaf2ff } as const;
const MIRRORED = 0.5;
const BAKED = 1;
/** What closed curtains leave of the sky's light, and glass of all of it. */
const CURTAINED = 0.27;
const GLAZED = 0.86;

export class Daylight {
  readonly root = new Group();
  /** How bright the room is, 1 by an open window. */
  brightness = 1;
  /** Of what surfaces mirror. */
  environmentIntensity = MIRRORED;
  readonly #materials: Materials;
  readonly #sun = new DirectionalLight(SUN.color, SUN.intensity);
  readonly #sky = new HemisphereLight(SKY.above, SKY.below, SKY.intensity);
  readonly #front = new DirectionalLight(FRONT.color, FRONT.intensity);
  readonly #spill = new SpotLight(SPILL.color, SPILL.intensity, 0, 1.25, 1, 2);

  constructor(materials: Materials) {
    this.#materials = materials;
    const way = new Vector3(
      -Math.sin(SUN.azimuth) * Math.cos(SUN.elevation),
      -Math.sin(SUN.elevation),
      Math.cos(SUN.azimuth) * Math.cos(SUN.elevation),
    );
    this.#sun.target.position.set(0, ROOM.height / 2, (ROOM.back + ROOM.front) / 2);
    this.#sun.position.copy(this.#sun.target.position).addScaledVector(way, -6);
    this.#frameShadow(way);
    this.#front.position.set(-1.2, 2.4, 4);
    this.#front.target.position.set(0.1, 0.9, -0.6);
    this.#spill.position.set(WINDOW.centre[0], WINDOW.centre[1] + 0.25, ROOM.back - 0.25);
    this.#spill.target.position.set(0.1, 0.7, 0.6);
    this.root.add(
      this.#sun,
      this.#sun.target,
      this.#sky,
      this.#front,
      this.#front.target,
      this.#spill,
      this.#spill.target,
    );
    this.set(0, 0);
  }

  /** @param closed How far window and curtain are closed, 0..1 each. */
  set(closedWindow: number, closedCurtain: number): void {
    const glass = mix(1, GLAZED, closedWindow);
    const sky = mix(1, CURTAINED, smooth(0, 1, closedCurtain)) * glass;
    this.brightness = sky;
    this.#sun.intensity = SUN.intensity * glass;
    this.#sky.intensity = SKY.intensity * mix(0.12, 1, sky);
    this.#front.intensity = FRONT.intensity * mix(0.15, 1, sky);
    this.#spill.intensity = SPILL.intensity * sky;
    this.environmentIntensity = MIRRORED * mix(0.1, 1, sky);
    for (const material of this.#materials.lit) material.envMapIntensity = this.environmentIntensity;
    this.#materials.plaster.lightMapIntensity = BAKED * sky;
    this.#materials.floor.lightMapIntensity = BAKED * sky;
  }

  /** Draw the sun's shadows anew with the next picture. */
  moveShadows(): void {
    this.#sun.shadow.needsUpdate = true;
  }

  /** Fit the shadow's box about the room: what lies outside of it would be lit through walls. */
  #frameShadow(way: Vector3): void {
    const { shadow } = this.#sun;
    this.#sun.castShadow = true;
    shadow.mapSize.set(SHADOW_MAP, SHADOW_MAP);
    shadow.bias = -0.0004;
    shadow.normalBias = 0.012;
    shadow.radius = 3;
    shadow.autoUpdate = false;
    shadow.needsUpdate = true;
    const right = new Vector3(0, 1, 0).cross(way).normalize();
    const up = way.clone().cross(right);
    const { camera } = shadow;
    camera.left = camera.bottom = camera.near = Infinity;
    camera.right = camera.top = camera.far = -Infinity;
    const corner = new Vector3();
    for (let i = 0; i < 8; i += 1) {
      corner.set(
        i & 1 ? ROOM.left : ROOM.right,
        i & 2 ? 0 : ROOM.height,
        i & 4 ? ROOM.back - 0.6 : ROOM.front,
      );
      corner.sub(this.#sun.position);
      const across = Math.abs(corner.dot(right));
      camera.right = Math.max(camera.right, across + 0.05);
      camera.top = Math.max(camera.top, Math.abs(corner.dot(up)) + 0.05);
      camera.near = Math.min(camera.near, corner.dot(way) - 0.2);
      camera.far = Math.max(camera.far, corner.dot(way) + 0.2);
    }
    camera.left = -camera.right;
    camera.bottom = -camera.top;
    camera.updateProjectionMatrix();
  }
}

/** What surfaces mirror: pale walls, a bright window at the back right, a wooden floor. */
export function surroundings(): DataTexture {
  const [width, height] = [64, 32];
  const data = new Uint16Array(width * height * 4);
  const window = new Vector3(
    WINDOW.centre[0],
    WINDOW.centre[1] - 1.1,
    WINDOW.centre[2] + 0.4,
  ).normalize();
  const way = new Vector3();
  for (let row = 0, i = 0; row < height; row += 1) {
    const up = ((row + 0.5) / height - 0.5) * Math.PI;
    for (let column = 0; column < width; column += 1, i += 4) {
      const around = ((column + 0.5) / width - 0.5) * 2 * Math.PI;
      way.set(Math.cos(up) * Math.cos(around), Math.sin(up), Math.cos(up) * Math.sin(around));
      const sky = 9 * smooth(0.9, 0.97, way.dot(window));
      const wall = 0.75 + 0.45 * smooth(-0.2, 1, way.dot(window));
      const floor = 1 - smooth(-0.5, 0.1, way.y);
      const color = [
        mix(wall, 0.5, floor) + sky * 0.95,
        mix(wall * 0.98, 0.4, floor) + sky,
        mix(wall * 0.94, 0.29, floor) + sky * 1.08,
        1,
      ];
      for (const [channel, value] of color.entries()) data[i + channel] = DataUtils.toHalfFloat(value);
    }
  }
  const texture = new DataTexture(data, width, height, RGBAFormat, HalfFloatType);
  texture.mapping = EquirectangularReflectionMapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
