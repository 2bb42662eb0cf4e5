/** The ashtray and the cigarette on its rim, which is put out in the bowl. */

import { Box3, Color, Group, Mesh, MeshStandardMaterial, Object3D, Vector3 } from "three";
import { DESK, ON_DESK } from "../layout.ts";
import { Batch } from "./batch.ts";
import type { Materials } from "./materials.ts";
import type { Movable } from "./movable.ts";
import { mix, smooth } from "./noise.ts";
import { ball, bar, turned } from "./shapes.ts";
import { Smoke } from "./smoke.ts";

const [X, Z] = ON_DESK.ashtray.at;
const TRAY = { radius: 0.066, height: 0.03 } as const;
const LENGTH = 0.084;
const RADIUS = 0.0042;
/** What is left of its length when it has been pressed out. */
const STUB = 0.55;
/** How bright its glow is. */
const EMBER = 2.2;

interface Pose {
  readonly at: readonly [number, number, number];
  /** Radians about x: 0 lies along z, its filter towards -z; a half pi stands on its ember. */
  readonly tilt: number;
  readonly heading: number;
}

/** On the rim, over the bowl, pressed into it, and lying there. `at` is where the ember is. */
const POSES: readonly Pose[] = [
  { at: [0.004, 0.022, 0.006], tilt: 0.2, heading: -0.5 },
  { at: [0, 0.06, 0], tilt: 1.25, heading: -0.5 },
  { at: [0, 0.012, 0.004], tilt: 1.3, heading: -0.2 },
  { at: [0.008, 0.012, 0.012], tilt: 0.42, heading: 0.25 },
];

export function ashtray(batch: Batch): void {
  const profile: readonly (readonly [number, number])[] = [
    [0.001, 0.007],
    [0.044, 0.008],
    [0.05, 0.012],
    [0.054, 0.026],
    [0.057, 0.03],
    [0.063, 0.03],
    [0.066, 0.026],
    [0.062, 0.006],
    [0.056, 0.0],
    [0.001, 0.0],
  ];
  batch.within([X, DESK.top, Z]);
  batch.add("gloss", turned(profile.toReversed(), 40), { color: 0x35586a });
  batch.add("paint", ball(0.03, 12).scale(1, 0.09, 0.8), {
    at: [-0.008, 0.0085, 0.004],
    color: 0x5f5b56,
  });
  for (const [x, z, heading] of [
    [-0.022, -0.01, 0.9],
    [-0.012, 0.024, 2.2],
  ] as const) {
    batch.add("paint", bar(RADIUS, RADIUS, 0.03, 10), {
      at: [x, 0.0135, z],
      turn: [0, heading, Math.PI / 2 - 0.1],
      color: 0xc98d4f,
    });
  }
  batch.within([0, 0, 0]);
}

export class Cigarette implements Movable {
  readonly root = new Group();
  readonly place = new Object3D();
  readonly bounds = [
    new Box3(
      new Vector3(X - TRAY.radius - 0.02, DESK.top, Z - TRAY.radius - 0.03),
      new Vector3(X + TRAY.radius + 0.02, DESK.top + 0.07, Z + TRAY.radius + 0.02),
    ),
  ];
  readonly #stick = new Group();
  /** Only its white part is crushed. */
  readonly #paper = new Group();
  readonly #end = new Group();
  readonly #ember: MeshStandardMaterial;
  readonly #smoke = new Smoke();
  readonly #source = new Vector3();
  #brightness = 1;
  #share = 0;

  constructor(materials: Materials) {
    const filter = 0.024;
    const along = [Math.PI / 2, 0, 0] as const;
    const white = new Batch().add("paint", bar(RADIUS, RADIUS, 1, 12), {
      at: [0, 0, -0.5],
      turn: along,
      color: 0xf6f3ec,
    });
    this.#paper.add(...white.meshes(materials));
    const cork = new Batch().add("paint", bar(RADIUS * 1.03, RADIUS * 1.03, filter, 12), {
      at: [0, 0, -filter / 2],
      turn: along,
      color: 0xc98d4f,
    });
    this.#end.add(...cork.meshes(materials), this.place);
    this.place.position.set(0, 0, -filter * 0.8);
    this.#ember = new MeshStandardMaterial({
      color: 0x5c544d,
      emissive: new Color(0xff3408),
      roughness: 1,
    });
    const ember = new Mesh(ball(RADIUS * 1.04, 10).scale(1, 1, 1.9), this.#ember);
    this.#stick.add(this.#paper, this.#end, ember);
    this.root.add(this.#stick, this.#smoke.mesh);
    this.show(0);
  }

  /** 0 lit, 1 out. */
  show(share: number): void {
    this.#share = share;
    const on = share * (POSES.length - 1);
    const leg = Math.min(POSES.length - 2, Math.floor(on));
    const [from, to] = [POSES[leg], POSES[leg + 1]];
    if (from === undefined || to === undefined) return;
    const k = smooth(0, 1, on - leg);
    this.#stick.position.set(
      X + mix(from.at[0], to.at[0], k),
      DESK.top + mix(from.at[1], to.at[1], k),
      Z + mix(from.at[2], to.at[2], k),
    );
    this.#stick.rotation.set(mix(from.tilt, to.tilt, k), mix(from.heading, to.heading, k), 0, "YXZ");
    const length = (LENGTH - 0.024) * mix(1, STUB, smooth(0.5, 0.72, share));
    this.#paper.scale.z = length;
    this.#end.position.z = -length;
    this.#ember.emissiveIntensity = EMBER * (1 - smooth(0.5, 0.7, share));
    this.#puff();
  }

  /** @param light How bright the day is in the room, 0..1. */
  dim(light: number): void {
    this.#brightness = light;
    this.#puff();
  }

  /** Let the smoke rise and the ember glow. */
  burn(seconds: number): void {
    if (this.#share >= 1) return;
    this.#smoke.rise(seconds);
    this.#ember.emissiveIntensity =
      EMBER * (0.85 + 0.15 * Math.sin(seconds * 1.9)) * (1 - smooth(0.5, 0.7, this.#share));
  }

  #puff(): void {
    this.#source.copy(this.#stick.position);
    this.#source.y += 0.004;
    this.#smoke.show(1 - smooth(0.45, 0.85, this.#share), this.#brightness, this.#source);
  }
}
