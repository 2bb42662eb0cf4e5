/** Soft shadows where things stand on each other, which no light that is drawn would give. */

import {
  BufferAttribute,
  DataTexture,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  RGBAFormat,
  type BufferGeometry,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { CHAIR, DESK, HIFI, ON_DESK } from "../layout.ts";
import { sheet } from "./shapes.ts";

interface Stain {
  readonly at: readonly [number, number, number];
  /** Along x and z, with the soft rim. */
  readonly size: readonly [number, number];
  readonly heading?: number;
  /** How dark, 0..1. */
  readonly strength: number;
}

const DESKTOP = DESK.top + 0.001;
const CABINET = HIFI.top + 0.001;
const RUG = 0.0145;

const STAINS: readonly Stain[] = [
  on(ON_DESK.keyboard.at, [0.43, 0.19], 0.55, ON_DESK.keyboard.heading),
  on(ON_DESK.notebook.at, [0.36, 0.265], 0.5, ON_DESK.notebook.heading),
  on(ON_DESK.screen.at, [0.3, 0.26], 0.6, ON_DESK.screen.heading),
  on(ON_DESK.screen.at, [0.75, 0.34], 0.35, ON_DESK.screen.heading),
  on(ON_DESK.ashtray.at, [0.2, 0.2], 0.7),
  on([0.66, 0.36], [0.15, 0.15], 0.7),
  on([ON_DESK.keyboard.at[0] - 0.29, ON_DESK.keyboard.at[1]], [0.1, 0.14], 0.55),
  { at: [HIFI.knob[0] - 0.15, CABINET, HIFI.cabinet[1] + 0.05], size: [0.56, 0.46], strength: 0.75 },
  { at: [HIFI.cabinet[0] - 0.5, CABINET, HIFI.cabinet[1] - 0.01], size: [0.32, 0.36], strength: 0.7 },
  { at: [HIFI.cabinet[0] + 0.5, CABINET, HIFI.cabinet[1] - 0.01], size: [0.32, 0.36], strength: 0.7 },
  { at: [CHAIR.at[0], RUG, CHAIR.at[1]], size: [1.0, 1.0], strength: 0.4 },
  { at: [DESK.centre[0] - 0.8, RUG, DESK.centre[1] + 0.3], size: [0.16, 0.16], strength: 0.6 },
  { at: [DESK.centre[0] + 0.8, RUG, DESK.centre[1] + 0.3], size: [0.16, 0.16], strength: 0.6 },
  { at: [DESK.centre[0], RUG - 0.0005, DESK.centre[1]], size: [2.3, 1.3], strength: 0.28 },
];

function on(
  at: readonly [number, number],
  size: readonly [number, number],
  strength: number,
  heading = 0,
): Stain {
  return { at: [at[0], DESKTOP, at[1]], size, strength, heading };
}

export function contactShadows(): Mesh {
  const pieces: BufferGeometry[] = STAINS.map(({ at, size, heading = 0, strength }) => {
    const piece = sheet(...size)
      .rotateX(-Math.PI / 2)
      .rotateY(heading)
      .translate(...at);
    const color = new Float32Array(16);
    for (let corner = 0; corner < 4; corner += 1) color[corner * 4 + 3] = strength;
    return piece.setAttribute("color", new BufferAttribute(color, 4));
  });
  const material = new MeshBasicMaterial({
    map: softSpot(),
    vertexColors: true,
    transparent: true,
    depthWrite: false,
  });
  const mesh = new Mesh(mergeGeometries(pieces), material);
  mesh.renderOrder = 1;
  return mesh;
}

/** Opaque in the middle of a rounded square, clear at its edge. */
function softSpot(): DataTexture {
  const size = 64;
  const data = new Uint8Array(size * size * 4).fill(255);
  for (let row = 0; row < size; row += 1) {
    for (let column = 0; column < size; column += 1) {
      const [x, y] = [(2 * column + 1) / size - 1, (2 * row + 1) / size - 1];
      const out = (Math.abs(x) ** 3.2 + Math.abs(y) ** 3.2) ** (1 / 3.2);
      const near = Math.max(0, 1 - out);
      data[(row * size + column) * 4 + 3] = Math.round(255 * Math.min(1, near * 1.7) ** 1.6);
    }
  }
  const texture = new DataTexture(data, size, size, RGBAFormat);
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
