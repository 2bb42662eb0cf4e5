import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import type { CameraState } from "../src/face/camera.ts";
import { SensorLink, type LinkState } from "../src/face/link.ts";
import { cameraWords } from "../src/face/words.ts";
import { LATER_MS } from "../src/net/backoff.ts";
import type { CalibrationState, ErrorMessage } from "../src/protocol/messages.ts";
import { FakeHost, WELCOME } from "./fakes.ts";

const PLACE = { session: "demo", sensorUrl: "ws://host/v1/sessions/demo/sensor" };
const FACE = {
  type: "face",
  originating_ns: 1,
  format: "mesh478",
  width: 640,
  height: 480,
  points: [],
} as const;

let host: FakeHost;
let states: LinkState[];
let calibrations: CalibrationState[];
let refusals: ErrorMessage[];

beforeEach(() => {
  host = new FakeHost();
  states = [];
  calibrations = [];
  refusals = [];
});

function joined(takesOver = false): SensorLink {
  const client = { name: "page", version: "1.2", token: "secret" };
  const link = new SensorLink(PLACE, client, "expected", takesOver, host, {
    onState: (state) => states.push(state),
    onCalibration: (calibration) => calibrations.push(calibration),
    onRefusal: (error) => refusals.push(error),
  });
  link.start();
  return link;
}

function welcomed(takesOver = false): SensorLink {
  const link = joined(takesOver);
  host.socket.events.onOpen();
  host.socket.say(WELCOME);
  return link;
}

const faces = (): number => host.socket.sent.filter(({ type }) => type === "face").length;

test("the camera comes as a sensor that has a face, and pushes nobody aside unasked", () => {
  welcomed();
  const { type, token, session, role, take_over } = host.socket.sent[0] ?? {};
  assert.deepEqual([type, token, session, role], ["hello", "secret", "demo", "sensor"]);
  // That a face follows is the default, which is left out.
  assert.equal(take_over, undefined);
  welcomed(true);
  assert.equal(host.socket.sent[0]?.["take_over"], true);
});

test("what cannot leave at once is left out", () => {
  const link = joined();
  assert.equal(link.post(FACE), false);
  host.socket.events.onOpen();
  assert.equal(link.post(FACE), false);
  host.socket.say(WELCOME);
  assert.equal(link.post(FACE), true);
  host.socket.backlog = 1e6;
  assert.equal(link.post(FACE), false);
  host.socket.backlog = 0;
  assert.equal(link.post({ type: "image", originating_ns: 1, jpeg: new Uint8Array([65]) }), true);
  assert.equal(faces(), 1);
  assert.equal(host.socket.sentBytes.length, 1);
});

test("a connection that is lost comes back", () => {
  const link = welcomed();
  host.socket.events.onClose(1006, "");
  assert.equal(link.post(FACE), false);
  host.pass(LATER_MS);
  host.socket.events.onOpen();
  host.socket.say(WELCOME);
  assert.equal(link.post(FACE), true);
  assert.deepEqual(states, ["live", "waiting", "live"]);
});

test("the place of another sensor is left to it, and nothing more is sent", () => {
  const link = welcomed();
  host.socket.say({ type: "error", code: "stream_taken", message: "another sensor sends it" });
  assert.deepEqual(states, ["live", "taken"]);
  assert.ok(host.socket.isClosed);
  assert.equal(link.post(FACE), false);
  host.pass(10 * LATER_MS);
  assert.equal(host.sockets.length, 1);
  assert.deepEqual(refusals, []);
});

test("a place that was taken over is not taken back unasked", () => {
  welcomed(true);
  host.socket.events.onClose(4409, "another sensor took over the face");
  assert.deepEqual(states, ["live", "replaced"]);
  host.pass(10 * LATER_MS);
  assert.equal(host.sockets.length, 1);
});

test("calibrations and refusals are passed on", () => {
  welcomed();
  const calibration = { type: "calibration_state", valence: 1, arousal: 2, faces: 9, is_done: true };
  host.socket.say(calibration);
  host.socket.say({ type: "error", code: "no_model", message: "no" });
  assert.deepEqual(calibrations, [calibration]);
  assert.equal(refusals[0]?.code, "no_model");
  assert.deepEqual(states, ["live"]);
});

const RUNNING: CameraState = {
  phase: "running",
  fault: null,
  link: "live",
  readsHere: true,
  hasFace: true,
  rateHz: 19,
  tookMs: 21.4,
  neutralUntil: null,
  neutral: null,
  said: "",
};

test("every state of the camera has words that say what is so and what to do", () => {
  const words = (change: Partial<CameraState>): string =>
    cameraWords({ ...RUNNING, ...change }, 1_000);
  const cases: readonly (readonly [Partial<CameraState>, RegExp])[] = [
    [{ phase: "off" }, /pictures do not leave/],
    [{ phase: "asking" }, /browser asks you/],
    [{ phase: "loading" }, /6 MB/],
    [{ phase: "failed", fault: "refused" }, /Allow it/],
    [{ phase: "failed", fault: "missing" }, /Connect one/],
    [{ phase: "failed", fault: "busy" }, /in use/],
    [{ phase: "failed", fault: "lost" }, /lost/],
    [{ phase: "failed", fault: "insecure" }, /https/],
    [{}, /19 times a second, 21 ms/],
    [{ hasFace: false }, /No face/],
    [{ hasFace: null }, /Looking/],
    [{ readsHere: false, hasFace: null }, /Pictures go to the server, 19 a second/],
    [{ link: "waiting" }, /Not connected/],
    [{ link: "taken" }, /already/],
    [{ link: "replaced" }, /taken over/],
    [{ neutralUntil: 3_200 }, /3 of 3 s/],
    [{ neutralUntil: 1_500 }, /1 of 3 s/],
    [{ neutralUntil: 900 }, /1 of 3 s/],
    [{ said: "Done." }, /^Done\.$/],
  ];
  for (const [change, expected] of cases) assert.match(words(change), expected);
});
