import assert from "node:assert/strict";
import { test } from "node:test";
import {
  InstancedMesh,
  Light,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Ray,
  Vector3,
  type Object3D,
} from "three";
import { ON_DESK, DESK, HIFI, SPOTS, VIEW, WINDOW } from "../src/room/layout.ts";
import { Scenery, type MovableName } from "../src/room/scenery/scenery.ts";
import { chords } from "../src/room/scenery/sound.ts";
import { Transition } from "../src/room/scenery/transition.ts";

const STATES = {
  window: ["open", "closed"],
  curtain: ["open", "closed"],
  hifi: ["high", "low"],
  cigarette: ["lit", "out"],
} as const satisfies Record<MovableName, readonly [string, string]>;
const NAMES = Object.keys(STATES) as MovableName[];
/** Where the agent is when it reaches for an object. */
const SPOT_OF = {
  window: SPOTS.window,
  curtain: SPOTS.curtain,
  hifi: SPOTS.hifi,
  cigarette: SPOTS.chair,
} as const;
const NOW = { animate: false } as const;
const GRADUALLY = { animate: true } as const;

const scenery = new Scenery({ isCalm: false });
const calm = new Scenery({ isCalm: true });

function reset(room: Scenery): void {
  room.apply(Object.fromEntries(NAMES.map((name) => [name, STATES[name][0]])), NOW);
}

/** Everything that can be seen to change, as one string. */
function look({ root }: Scenery): string {
  const seen: unknown[] = [];
  const rounded = (values: ArrayLike<number>): number[] =>
    Array.from(values, (value) => Math.round(value * 1e6) / 1e6);
  root.updateMatrixWorld(true);
  root.traverse((object: Object3D) => {
    seen.push(object.visible, rounded(object.matrixWorld.elements));
    if (object instanceof Light) seen.push(rounded([object.intensity]));
    if (object instanceof InstancedMesh) {
      seen.push(rounded(object.instanceMatrix.array), rounded(object.instanceColor?.array ?? []));
    }
    if (object instanceof Mesh && object.material instanceof MeshStandardMaterial) {
      seen.push(
        rounded([
          object.material.emissiveIntensity,
          object.material.envMapIntensity,
          object.material.lightMapIntensity,
        ]),
      );
    }
  });
  return JSON.stringify(seen);
}

function placeOf(name: MovableName): Vector3 {
  scenery.root.updateMatrixWorld(true);
  return scenery.handleOf(name).place.getWorldPosition(new Vector3());
}

test("the room stays within what a weak graphics card draws", () => {
  assert.ok(
    scenery.counts.triangles > 5_000 && scenery.counts.triangles <= 30_000,
    String(scenery.counts.triangles),
  );
  assert.ok(
    scenery.counts.drawCalls > 10 && scenery.counts.drawCalls <= 60,
    String(scenery.counts.drawCalls),
  );
});

test("every object looks different in its two states, and the same again afterwards", () => {
  for (const name of NAMES) {
    reset(calm);
    const before = look(calm);
    calm.apply({ [name]: STATES[name][1] }, NOW);
    assert.notEqual(look(calm), before, name);
    calm.apply({ [name]: STATES[name][0] }, NOW);
    assert.equal(look(calm), before, name);
  }
});

test("objects and states that it does not know are passed over", () => {
  reset(calm);
  const before = look(calm);
  calm.apply({ window: "ajar", door: "open", chair: "high" }, NOW);
  calm.setProgress("hifi", "silent", 1);
  assert.equal(look(calm), before);
});

test("an object that a hand has led to its state looks as if it had been set", () => {
  for (const name of NAMES) {
    for (const [from, to] of [STATES[name], STATES[name].toReversed()] as [string, string][]) {
      reset(calm);
      calm.apply({ [name]: to }, NOW);
      const expected = look(calm);
      calm.apply({ [name]: from }, NOW);
      for (let share = 0; share <= 1; share += 0.125) calm.setProgress(name, to, share);
      assert.equal(look(calm), expected, `${name} ${to}`);
    }
  }
});

test("handles are within reach of where the agent stands, all the way", () => {
  for (const name of NAMES) {
    reset(scenery);
    const [x, z] = SPOT_OF[name].at;
    const first = placeOf(name);
    for (let share = 0; share <= 1; share += 0.125) {
      scenery.setProgress(name, STATES[name][1], share);
      const place = placeOf(name);
      const away = Math.hypot(place.x - x, place.z - z);
      assert.ok(away >= 0.25 && away <= 0.75, `${name} at ${share}: ${away.toFixed(3)} m away`);
      assert.ok(place.y >= 0.5 && place.y <= 1.9, `${name} at ${share}: ${place.y.toFixed(3)} m high`);
    }
    if (name !== "hifi") assert.ok(placeOf(name).distanceTo(first) > 0.02, `${name}'s handle moves`);
  }
  reset(scenery);
});

test("a change that nobody leads takes its time, and ends where it should", () => {
  reset(scenery);
  const open = placeOf("window");
  scenery.apply({ window: "closed" }, GRADUALLY);
  assert.ok(placeOf("window").distanceTo(open) < 1e-6);
  scenery.step(500);
  const half = placeOf("window");
  scenery.apply({ window: "closed" }, GRADUALLY);
  scenery.step(5_000);
  const closed = placeOf("window");
  assert.ok(half.distanceTo(open) > 0.02 && half.distanceTo(closed) > 0.02);
  scenery.apply({ window: "closed" }, NOW);
  assert.ok(placeOf("window").distanceTo(closed) < 1e-6);
  reset(scenery);
});

test("the same steps make the same picture, and a calm room only moves when told to", () => {
  const [one, other] = [new Scenery({ isCalm: false }), new Scenery({ isCalm: false })];
  for (const room of [one, other]) {
    room.apply({ curtain: "closed", cigarette: "out" }, GRADUALLY);
    for (let i = 0; i < 40; i += 1) assert.equal(room.step(33), true);
  }
  assert.equal(look(one), look(other));
  reset(calm);
  const before = look(calm);
  assert.equal(calm.step(500), false);
  assert.equal(look(calm), before);
});

test("closed curtains dim the room", () => {
  reset(calm);
  const open = calm.environmentIntensity;
  calm.apply({ window: "closed" }, NOW);
  const glazed = calm.environmentIntensity;
  calm.apply({ curtain: "closed" }, NOW);
  assert.ok(glazed < open && calm.environmentIntensity < 0.5 * glazed);
});

test("steps add nothing to the scene and leave its buffers where they are", () => {
  const inventory = (): unknown[] => {
    const found: unknown[] = [];
    scenery.root.traverse((object) => {
      found.push(object);
      if (object instanceof Mesh)
        found.push(object.geometry, object.material, ...Object.values(object.geometry.attributes));
      if (object instanceof InstancedMesh)
        found.push(object.instanceMatrix.array, object.instanceColor?.array);
    });
    return found;
  };
  const before = inventory();
  for (let i = 0; i < 500; i += 1) scenery.step(16);
  const after = inventory();
  assert.equal(after.length, before.length);
  assert.ok(after.every((item, i) => item === before[i]));
});

test("a click meets each object through its middle", () => {
  reset(scenery);
  const eye = new Vector3(...VIEW.from);
  const pick = (...at: [number, number, number]): string | null =>
    scenery.pick(new Ray(eye, new Vector3(...at).sub(eye).normalize()));
  const [x, y, z] = WINDOW.centre;
  assert.equal(pick(x, y, z), "window");
  assert.equal(pick(x + WINDOW.width / 2 + 0.12, y, z + 0.15), "curtain");
  assert.equal(pick(x - WINDOW.width / 2 - 0.12, y, z + 0.15), "curtain");
  assert.equal(pick(...HIFI.knob), "hifi");
  assert.equal(pick(ON_DESK.ashtray.at[0], DESK.top + 0.02, ON_DESK.ashtray.at[1]), "cigarette");
  assert.equal(pick(ON_DESK.screen.at[0], DESK.top + 0.2, ON_DESK.screen.at[1]), "screen");
  assert.equal(pick(ON_DESK.keyboard.at[0], DESK.top + 0.01, ON_DESK.keyboard.at[1]), "keyboard");
  assert.equal(pick(ON_DESK.notebook.at[0], DESK.top + 0.01, ON_DESK.notebook.at[1]), "notebook");
  assert.equal(pick(-0.2, 2.4, -2.1), null);
  scenery.apply({ curtain: "closed" }, NOW);
  assert.equal(pick(x, y, z), "curtain");
  reset(scenery);
});

test("the user sees the agent's face beside the screen, and window and hi-fi whole", () => {
  const eye = new Vector3(...VIEW.from);
  for (const dx of [-0.13, 0, 0.13]) {
    for (const dy of [-0.16, 0, 0.16]) {
      const face = new Vector3(SPOTS.chair.at[0] + dx, 1.2 + dy, SPOTS.chair.at[1]);
      assert.notEqual(scenery.pick(new Ray(eye, face.sub(eye).normalize())), "screen", `${dx} ${dy}`);
    }
  }
  const camera = new PerspectiveCamera(VIEW.fov, 16 / 9, 0.05, 30);
  camera.position.copy(eye);
  camera.lookAt(...VIEW.to);
  camera.updateMatrixWorld();
  const [x, y, z] = WINDOW.centre;
  for (const dx of [-WINDOW.width / 2, WINDOW.width / 2]) {
    for (const dy of [-WINDOW.height / 2, WINDOW.height / 2]) {
      const seen = new Vector3(x + dx, y + dy, z).project(camera);
      assert.ok(Math.abs(seen.x) < 0.95 && Math.abs(seen.y) < 0.95);
    }
  }
  const knob = new Vector3(...HIFI.knob).project(camera);
  assert.ok(Math.abs(knob.x) < 0.95 && Math.abs(knob.y) < 0.95);
});

test("a hand takes an object from where it is, and one that comes again goes on from there", () => {
  const transition = new Transition(["open", "closed"], 1000);
  assert.equal(transition.lead("closed", 0), false);
  transition.lead("closed", 0.6);
  assert.ok(Math.abs(transition.at - 0.6) < 1e-9);
  transition.lead("closed", 0.1); // another hand
  assert.ok(Math.abs(transition.at - 0.64) < 1e-9);
  transition.lead("open", 0.5);
  assert.ok(Math.abs(transition.at - 0.32) < 1e-9);
  transition.lead("open", 1);
  assert.equal(transition.at, 0);
  assert.equal(transition.lead("ajar", 1), false);
  transition.set("closed", true);
  assert.equal(transition.step(400), true);
  assert.ok(transition.at > 0 && transition.at < 1);
  transition.step(600);
  assert.equal(transition.at, 1);
  assert.equal(transition.step(1), false);
});

test("the hi-fi's loop has a sound, is never too loud, and joins at its ends", () => {
  const rate = 8_000;
  const samples = chords(rate);
  assert.equal(samples.length, 8 * rate);
  const peak = samples.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
  assert.ok(peak > 0.2 && peak < 1, String(peak));
  const jump = Math.abs((samples[0] ?? 0) - (samples.at(-1) ?? 0));
  assert.ok(jump < 0.1, String(jump));
});

test("sound that was never switched on needs no audio", () => {
  scenery.setVolumeSound(false);
  scenery.apply({ hifi: "low" }, NOW);
  reset(scenery);
});
