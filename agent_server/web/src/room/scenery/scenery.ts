/**
 * The agent's room as it looks: furniture, light, and the four objects that change their state.
 *
 * It is built from code alone and follows the time that is passed to `step`. The stage that shows
 * it uses `TONE_MAPPING` and `EXPOSURE`, switches the renderer's shadows on (`PCFShadowMap`), and gives
 * `environment`, with its intensity, to what else stands in the room.
 */

import {
  ACESFilmicToneMapping,
  Group,
  InstancedBufferGeometry,
  InstancedMesh,
  Mesh,
  type Box3,
  type Object3D,
  type Ray,
  type Texture,
} from "three";
import { bakeShell, shadeVertices } from "./bake.ts";
import { Batch } from "./batch.ts";
import { hifiCabinet } from "./cabinet.ts";
import { ashtray, Cigarette } from "./cigarette.ts";
import { contactShadows } from "./contact.ts";
import { curtainRail, Curtains } from "./curtains.ts";
import { Daylight, surroundings } from "./daylight.ts";
import { pictures, plant, shelf } from "./decor.ts";
import { desktop } from "./desktop.ts";
import { chair, desk, rug } from "./furniture.ts";
import { Hifi } from "./hifi.ts";
import { createMaterials } from "./materials.ts";
import type { Movable } from "./movable.ts";
import { outside } from "./outside.ts";
import { nearest, STILL_BOUNDS } from "./pick.ts";
import { fittings, shell, SURFACES } from "./shell.ts";
import { RoomSound } from "./sound.ts";
import { Transition } from "./transition.ts";
import { Sash, windowFrame } from "./window.ts";

export const TONE_MAPPING = ACESFilmicToneMapping;
export const EXPOSURE = 0.95;

export type MovableName = "window" | "curtain" | "hifi" | "cigarette";

export interface SceneryOptions {
  /** Whether nothing moves of its own accord: no smoke that rises, no lamps that flicker. */
  readonly isCalm: boolean;
}

interface Piece {
  readonly object: Movable;
  readonly transition: Transition;
}

/** States as in the room's rule file, in the order of `Movable.show`. */
const STATES: Readonly<Record<MovableName, readonly [string, string]>> = {
  window: ["open", "closed"],
  curtain: ["open", "closed"],
  hifi: ["high", "low"],
  cigarette: ["lit", "out"],
};

const DURATIONS_MS: Readonly<Record<MovableName, number>> = {
  window: 1400,
  curtain: 1500,
  hifi: 900,
  cigarette: 2200,
};
const NAMES = Object.keys(STATES) as readonly MovableName[];

export class Scenery {
  readonly root = new Group();
  readonly counts: { readonly triangles: number; readonly drawCalls: number };
  /** What surfaces in the room mirror. */
  readonly environment: Texture;

  readonly #isCalm: boolean;
  readonly #light: Daylight;
  readonly #curtains: Curtains;
  readonly #hifi: Hifi;
  readonly #cigarette: Cigarette;
  readonly #pieces: Readonly<Record<MovableName, Piece>>;
  readonly #bounds: (readonly [string, Box3])[];
  readonly #sound = new RoomSound();
  #seconds = 0;

  constructor({ isCalm }: SceneryOptions) {
    this.#isCalm = isCalm;
    this.environment = surroundings();
    const still = stillParts();
    const materials = createMaterials(this.environment, bakeShell(SURFACES, still.blocks));
    this.#light = new Daylight(materials);
    this.#curtains = new Curtains(materials);
    this.#hifi = new Hifi(materials, this.environment, isCalm);
    this.#cigarette = new Cigarette(materials);
    const piece = (name: MovableName, object: Movable): Piece => ({
      object,
      transition: new Transition(STATES[name], DURATIONS_MS[name]),
    });
    this.#pieces = {
      window: piece("window", new Sash(materials)),
      curtain: piece("curtain", this.#curtains),
      hifi: piece("hifi", this.#hifi),
      cigarette: piece("cigarette", this.#cigarette),
    };
    this.#bounds = [
      ...NAMES.flatMap((name) => this.#pieces[name].object.bounds.map((box) => [name, box] as const)),
      ...STILL_BOUNDS,
    ];
    this.root.add(
      outside(),
      ...shell(materials),
      ...still.meshes(materials, (geometry) => shadeVertices(geometry, still.blocks)),
      contactShadows(),
      ...NAMES.map((name) => this.#pieces[name].object.root),
      this.#light.root,
    );
    this.counts = count(this.root);
    this.#settle();
  }

  /**
   * Show the room's objects. Names and states that it does not know are passed over.
   *
   * @param animate Whether what differs goes there by itself; else it is there at once.
   */
  apply(objects: Readonly<Record<string, string>>, { animate }: { readonly animate: boolean }): void {
    for (const name of NAMES) {
      const state = objects[name];
      if (state === undefined) continue;
      if (this.#pieces[name].transition.set(state, animate && !this.#isCalm)) this.#show(name);
    }
  }

  /** Where a hand takes hold of an object; its world place moves with sash, curtain, knob or cigarette. */
  handleOf(object: MovableName): { readonly place: Object3D } {
    return { place: this.#pieces[object].object.place };
  }

  /**
   * Lead an object to a state by hand, from wherever it is.
   *
   * @param share How far on its way, 0..1; at 1 it is there, as after `apply`.
   */
  setProgress(object: MovableName, state: string, share: number): void {
    if (this.#pieces[object].transition.lead(state, share)) this.#show(object);
  }

  /** Let time pass. @returns Whether the picture changed. */
  step(dtMs: number): boolean {
    let hasChanged = false;
    for (const name of NAMES) {
      if (!this.#pieces[name].transition.step(dtMs)) continue;
      this.#show(name);
      hasChanged = true;
    }
    if (this.#isCalm) return hasChanged;
    this.#seconds += dtMs / 1000;
    this.#hifi.play(this.#seconds);
    this.#cigarette.burn(this.#seconds);
    this.#curtains.sway(this.#seconds, 1 - this.#pieces.window.transition.at);
    return true;
  }

  /** How strongly the `environment` shines at present, as in `Scene.environmentIntensity`. */
  get environmentIntensity(): number {
    return this.#light.environmentIntensity;
  }

  /** Draw shadows anew with the next picture: somebody else in the room has moved. */
  moveShadows(): void {
    this.#light.moveShadows();
  }

  /** @returns The first object that a ray in the room's frame meets, by its name in the rule file. */
  pick(ray: Ray): string | null {
    return nearest(this.#bounds, ray);
  }

  /** Let the hi-fi and the outside be heard, or not. Browsers allow it only after a click or key. */
  setVolumeSound(isOn: boolean): void {
    this.#sound.set(isOn);
    this.#settle();
  }

  #show(name: MovableName): void {
    const { object, transition } = this.#pieces[name];
    object.show(transition.at);
    this.#settle();
    if (name !== "hifi") this.#light.moveShadows();
  }

  /** Bring light and sound in line with how far things are open. */
  #settle(): void {
    const { window, curtain, hifi } = this.#pieces;
    this.#light.set(window.transition.at, curtain.transition.at);
    this.#cigarette.dim(this.#light.brightness);
    this.#sound.mix(1 - hifi.transition.at, 1 - window.transition.at);
  }
}

function stillParts(): Batch {
  const batch = new Batch();
  const builders = [
    fittings,
    windowFrame,
    curtainRail,
    desk,
    desktop,
    ashtray,
    chair,
    rug,
    hifiCabinet,
    shelf,
    plant,
    pictures,
  ];
  for (const build of builders) build(batch);
  return batch;
}

/** Of the whole room as it is drawn, its shadow map not counted. */
function count(root: Object3D): { triangles: number; drawCalls: number } {
  let triangles = 0;
  let drawCalls = 0;
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const { geometry } = object as Mesh;
    let copies = 1;
    if (object instanceof InstancedMesh) copies = object.count;
    else if (geometry instanceof InstancedBufferGeometry) copies = geometry.instanceCount;
    triangles += (copies * (geometry.getIndex()?.count ?? geometry.getAttribute("position").count)) / 3;
    drawCalls += 1;
  });
  return { triangles, drawCalls };
}
