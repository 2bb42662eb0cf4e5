/** What moves at the hi-fi: the volume knob, a row of lamps, and the speakers' cones. */

import {
  Box3,
  Color,
  CylinderGeometry,
  DoubleSide,
  Group,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Object3D,
  PlaneGeometry,
  Vector3,
  type Texture,
} from "three";
import { HIFI } from "../layout.ts";
import { Batch } from "./batch.ts";
import { CABINET, SPEAKER, SPEAKER_FACE, SPEAKERS } from "./cabinet.ts";
import type { Materials } from "./materials.ts";
import type { Movable } from "./movable.ts";
import { mix } from "./noise.ts";
import { bar, box } from "./shapes.ts";

const [X, Z] = HIFI.cabinet;
const [KNOB_X, KNOB_Y, FACE_Z] = HIFI.knob;
const LAMPS = 14;
/** How many lamps are on, and how far a speaker moves, by volume. */
const LIT = { low: 3, high: 11.5 } as const;
const KNOB_TURN = { low: 2.1, high: -0.9 } as const;

export class Hifi implements Movable {
  readonly root = new Group();
  readonly place = new Object3D();
  readonly bounds = [
    new Box3(
      new Vector3(X - CABINET.width / 2, HIFI.top, Z - 0.2),
      new Vector3(X + CABINET.width / 2, HIFI.top + SPEAKER.height, FACE_Z + 0.03),
    ),
  ];
  readonly #knob = new Group();
  readonly #lamps: InstancedMesh;
  readonly #cones: InstancedMesh;
  readonly #isCalm: boolean;
  #share = 0;
  #lit = -1;

  constructor(materials: Materials, environment: Texture, isCalm: boolean) {
    this.#isCalm = isCalm;
    const batch = new Batch();
    batch.add("metal", bar(0.028, 0.031, 0.026, 32), {
      at: [0, 0, 0.013],
      turn: [Math.PI / 2, 0, 0],
      color: 0xd5d7d8,
    });
    batch.add("metal", box(0.004, 0.02, 0.002), { at: [0, 0.016, 0.0265], color: 0x2a2d31 });
    this.#knob.add(...batch.meshes(materials));
    this.#knob.position.set(KNOB_X, KNOB_Y, FACE_Z - 0.012);
    this.place.position.set(0, 0, 0.03);
    this.#knob.add(this.place);

    this.#lamps = new InstancedMesh(
      new PlaneGeometry(0.0125, 0.026),
      new MeshBasicMaterial({ toneMapped: false }),
      LAMPS,
    );
    this.#cones = new InstancedMesh(
      new CylinderGeometry(0.071, 0.024, 0.022, 32, 1, true).rotateX(Math.PI / 2),
      new MeshStandardMaterial({
        envMap: environment,
        color: 0x54585e,
        roughness: 0.6,
        side: DoubleSide,
      }),
      SPEAKERS.length,
    );
    const matrix = new Matrix4();
    for (let i = 0; i < LAMPS; i += 1) {
      this.#lamps.setMatrixAt(
        i,
        matrix.makeTranslation(KNOB_X - 0.3275 + i * 0.0172, KNOB_Y + 0.012, FACE_Z - 0.0115),
      );
    }
    this.root.add(this.#knob, this.#lamps, this.#cones);
    this.show(0);
  }

  /** 0 high, 1 low. */
  show(share: number): void {
    this.#share = share;
    this.#knob.rotation.z = -mix(-KNOB_TURN.high, -KNOB_TURN.low, share);
    this.#light(mix(LIT.high, LIT.low, share));
    this.#move(0);
  }

  /** Let the lamps and the speakers follow the music. */
  play(seconds: number): void {
    if (this.#isCalm) return;
    // Four chords of two seconds, each struck and dying away, over a steady pulse.
    const struck = Math.exp(-1.1 * (seconds % 2));
    const pulse = Math.exp(-5 * (seconds % 0.5));
    const level = 0.55 * struck + 0.45 * pulse;
    this.#light(mix(LIT.high, LIT.low, this.#share) * (0.8 + 0.28 * level));
    this.#move(mix(1, 0.22, this.#share) * Math.sin(seconds * 38) * pulse);
  }

  #light(lit: number): void {
    const whole = Math.round(lit);
    if (whole === this.#lit) return;
    this.#lit = whole;
    for (let i = 0; i < LAMPS; i += 1) {
      const isOn = i < whole;
      const color = i < 8 ? GREEN : i < 11 ? AMBER : RED;
      this.#lamps.setColorAt(i, isOn ? color : OFF);
    }
    if (this.#lamps.instanceColor !== null) this.#lamps.instanceColor.needsUpdate = true;
  }

  /** @param beat From -1 to 1. */
  #move(beat: number): void {
    const wide = 1 + 0.02 * beat;
    for (let i = 0; i < SPEAKERS.length; i += 1) {
      const x = SPEAKERS[i] ?? 0;
      scaled
        .makeScale(wide, wide, 1 + 0.35 * beat)
        .setPosition(x, HIFI.top + SPEAKER.height / 2 - 0.05, SPEAKER_FACE + 0.006 + 0.004 * beat);
      this.#cones.setMatrixAt(i, scaled);
    }
    this.#cones.instanceMatrix.needsUpdate = true;
  }
}

const scaled = new Matrix4();
const GREEN = new Color(0x35e08a);
const AMBER = new Color(0xffb43c);
const RED = new Color(0xff5a4a);
const OFF = new Color(0x16211c);
