/** Two curtains on a rail. They are drawn together; their folds flatten as they spread. */

import {
  Box3,
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  LinearFilter,
  Mesh,
  Object3D,
} from "three";
import { CURTAIN, ROOM, WINDOW } from "../layout.ts";
import type { Batch } from "./batch.ts";
import { BLACK } from "./colors.ts";
import type { Materials } from "./materials.ts";
import type { Movable } from "./movable.ts";
import { mix, sequence, smooth } from "./noise.ts";
import { ball, rod } from "./shapes.ts";
import { painted } from "./textures.ts";

const Z = ROOM.back + CURTAIN.depth;
/** From the window's edge outwards to where a curtain ends. */
const OVERLAP = 0.2;
const HALF = WINDOW.width / 2 + OVERLAP;
/** Share of its half that a gathered curtain takes. */
const GATHERED = 0.27;
const FOLDS = 7;
const COLUMNS = 88;
const ROWS = 6;
const HEM = 0.04;
const TOP = CURTAIN.rail - 0.03;

export function curtainRail(batch: Batch): void {
  const x = WINDOW.centre[0];
  const half = HALF + 0.09;
  batch.add("metal", rod([x - half, CURTAIN.rail, Z], [x + half, CURTAIN.rail, Z], 0.011, 12), {
    color: BLACK,
  });
  for (const side of [-1, 1]) {
    batch.add("metal", ball(0.022), { at: [x + side * half, CURTAIN.rail, Z], color: BLACK });
    batch.add(
      "metal",
      rod(
        [x + side * (half - 0.06), CURTAIN.rail, Z],
        [x + side * (half - 0.06), CURTAIN.rail, ROOM.back],
        0.008,
      ),
      { color: BLACK },
    );
  }
}

export class Curtains implements Movable {
  readonly root = new Group();
  readonly place = new Object3D();
  readonly bounds = [new Box3(), new Box3()] as const;
  readonly #panels: readonly [Mesh, Mesh];
  readonly #materials: Materials;

  constructor(materials: Materials) {
    this.#materials = materials;
    materials.curtain.emissiveMap = glow();
    const left = new Mesh(cloth(1), materials.curtain);
    const right = new Mesh(cloth(-1), materials.curtain);
    left.position.set(WINDOW.centre[0] - HALF, TOP, Z);
    right.position.set(WINDOW.centre[0] + HALF, TOP, Z);
    this.#panels = [left, right];
    for (const panel of this.#panels) {
      panel.castShadow = true;
      panel.receiveShadow = true;
    }
    this.place.position.set(0, CURTAIN.pullHeight, Z + 0.03);
    this.root.add(left, right, this.place);
    this.show(0);
  }

  /** 0 open, 1 closed. */
  show(share: number): void {
    const [left, right] = this.#panels;
    const width = HALF * mix(GATHERED, 1, share) - 0.002;
    const depth = mix(1, 0.62, share);
    left.scale.set(width, 1, depth);
    right.scale.set(width, 1, depth);
    const [x] = WINDOW.centre;
    this.place.position.x = x + HALF - width + 0.01;
    const before = Z + 0.05;
    const behind = Z - 0.05;
    this.bounds[0].min.set(x - HALF, HEM, behind);
    this.bounds[0].max.set(x - HALF + width, TOP, before);
    this.bounds[1].min.set(x + HALF - width, HEM, behind);
    this.bounds[1].max.set(x + HALF, TOP, before);
    // Cloth before the window lets the day through; gathered it is too thick.
    this.#materials.curtain.emissiveIntensity = mix(0.06, 0.7, smooth(0.1, 1, share));
  }

  /**
   * Let the air that comes in move the hems.
   *
   * @param openness Of the window, 0..1.
   */
  sway(seconds: number, openness: number): void {
    const [left, right] = this.#panels;
    left.rotation.x = -openness * 0.012 * (1 + Math.sin(0.9 * seconds) * Math.sin(0.37 * seconds));
    right.rotation.x = -openness * 0.007 * (1 + Math.sin(0.8 * seconds + 1) * Math.sin(0.31 * seconds));
  }
}

/** One curtain below its rail, from its outer edge at x = 0 to 1 (or -1), in folds that are not all alike. */
function cloth(side: 1 | -1): BufferGeometry {
  const next = sequence(side === 1 ? 101 : 102);
  const depths = Array.from({ length: FOLDS + 4 }, () => 0.024 + 0.034 * next());
  const drift = next();
  const positions: number[] = [];
  const colors: number[] = [];
  const uv: number[] = [];
  const index: number[] = [];
  for (let row = 0; row <= ROWS; row += 1) {
    const down = row / ROWS;
    const y = mix(0, HEM - TOP, down);
    for (let column = 0; column <= COLUMNS; column += 1) {
      const u = column / COLUMNS;
      // Pleats are not of one width: they drift along the rail.
      const phase =
        u * FOLDS +
        0.16 * Math.sin(2 * Math.PI * (2.3 * u + drift)) +
        0.08 * Math.sin(2 * Math.PI * (5.1 * u + 2 * drift));
      const depth =
        mix(0.7, 1, smooth(0, 0.6, down)) *
        mix(depths[Math.floor(phase + 1)] ?? 0, depths[Math.floor(phase + 2)] ?? 0, (phase + 1) % 1);
      const wander = 0.012 * Math.sin(3 * down + u * 9) * down;
      const fold = Math.sin(2 * Math.PI * phase + 0.5 * Math.sin(2 * down + u * 5));
      positions.push(side * u, y, depth * fold + wander);
      // Little light comes into the folds that lie back.
      const tone = mix(0.5, 1, smooth(-1, 0.6, fold));
      colors.push(tone, tone, tone);
      uv.push(u, 1 - down);
      if (row === ROWS || column === COLUMNS) continue;
      const a = row * (COLUMNS + 1) + column;
      const b = a + COLUMNS + 1;
      if (side === 1) index.push(a, b, a + 1, a + 1, b, b + 1);
      else index.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
  geometry.setAttribute("uv", new Float32BufferAttribute(uv, 2));
  geometry.setAttribute("uv1", new Float32BufferAttribute(uv, 2));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

/** The window as it shines through a closed curtain, from the outer edge in. */
function glow(): ReturnType<typeof painted> {
  const edge = OVERLAP / HALF;
  const bottom = (WINDOW.centre[1] - WINDOW.height / 2 - HEM) / (TOP - HEM);
  const top = (WINDOW.centre[1] + WINDOW.height / 2 - HEM) / (TOP - HEM);
  const texture = painted({ width: 128, height: 128, isColor: true }, (u, v, out) => {
    const across = smooth(edge - 0.05, edge + 0.12, u) * (1 - 0.45 * smooth(0.93, 0.97, u));
    const along = smooth(bottom - 0.02, bottom + 0.05, v) * (1 - smooth(top - 0.05, top + 0.02, v));
    const fold = 0.78 + 0.22 * Math.cos(4 * Math.PI * (u * FOLDS) + 0.6);
    const light = (0.1 + 0.9 * across * along * mix(0.75, 1, v)) * fold;
    out[0] = light;
    out[1] = light * 0.93;
    out[2] = light * 0.8;
  });
  texture.channel = 1;
  texture.minFilter = LinearFilter;
  return texture;
}
