import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import type { PoseMessage } from "../src/protocol/messages.ts";
import { Store } from "../src/state/store.ts";
import { summaryOf } from "../src/state/summary.ts";
import { affectNow } from "../src/state/view.ts";
import {
  COMMAND,
  SCENE,
  WELCOME,
  ackState,
  affectState as affect,
  commanded,
  decision,
  error,
} from "./fakes.ts";

let store: Store;

beforeEach(() => {
  store = new Store();
  store.apply(WELCOME, 0);
});

function pose(stampMs: number, body = 7): PoseMessage {
  const joints = Array.from({ length: 9 }, () => [0, 0, 2, 1] as const);
  return { type: "pose", originating_ns: stampMs * 1e6, body_id: body, joints };
}

test("the rate is that of the capture times, not of the arrivals", () => {
  for (let i = 0; i < 60; i++) store.apply(pose(i * 40), i < 30 ? 0 : 5);
  assert.equal(Math.round(store.poseRateHz ?? 0), 25);
});

test("the rate forgets another body and a clock that went back", () => {
  store.apply(pose(0), 0);
  store.apply(pose(40), 0);
  store.apply(pose(80, 8), 0);
  assert.equal(store.poseRateHz, null);
  store.apply(pose(120, 8), 0);
  store.apply(pose(20, 8), 0);
  assert.equal(store.poseRateHz, null);
});

test("the trail of affect holds four seconds", () => {
  for (let t = 0; t <= 10_000; t += 100) store.apply(affect(t, -1, 1), t);
  assert.equal(store.affect[0]?.at, 6_000);
  assert.equal(store.affect.at(-1)?.at, 10_000);
});

test("affect is stale after a while, and when the gate found no usable face", () => {
  store.apply(affect(1_000, -4, 5), 1_000);
  assert.deepEqual(affectNow(store, 1_500), {
    valence: -4,
    arousal: 5,
    isFresh: true,
    spread: null,
    source: "client",
  });
  assert.equal(affectNow(store, 2_600)?.isFresh, false);
  const blind = { mode: "required", is_open: false, reason: "the face is stale" } as const;
  const none = { valence: null, arousal: null, face: null, source: null, gaze_deg: null };
  const gate = { ...blind, ...none, age_ms: 1_200 };
  store.apply(decision(1, { gate, end_ns: 2_200e6 }), 1_500);
  assert.equal(affectNow(store, 1_500)?.isFresh, false);
});

test("objects that changed are remembered with the time, the first state is no change", () => {
  assert.equal(store.changedAt.size, 0);
  store.apply({ ...SCENE, objects: { window: "closed", curtain: "open" } }, 700);
  assert.deepEqual([...store.changedAt], [["window", 700]]);
});

test("a command is followed through its acks", () => {
  store.apply(decision(3, { outcome: "command", gesture: "cold", command: COMMAND }), 0);
  assert.equal(store.running?.status, null);
  store.apply(ackState("accepted"), 0);
  assert.equal(store.running?.step, null);
  store.apply(ackState("started"), 0);
  assert.equal(store.running?.step, 0);
  store.apply(ackState("progress", { step: 1 }), 0);
  store.apply(ackState("failed", { reason: "stuck" }), 0);
  assert.deepEqual(
    [store.running?.step, store.running?.status, store.running?.reason],
    [1, "failed", "stuck"],
  );
  store.apply(ackState("done", { command_id: "another" }), 0);
  assert.equal(store.running?.status, "failed");
});

test("how a command ended is listed, unless it was simply carried out", () => {
  store.apply(decision(3, { outcome: "command", gesture: "cold", command: COMMAND }), 0);
  for (const status of ["accepted", "started", "progress", "done"]) {
    store.apply(ackState(status), 0);
  }
  assert.equal(store.log.rows.length, 1);
  store.apply(ackState("timed_out"), 0);
  assert.equal(store.running?.status, "timed_out");
  assert.equal(store.log.rows.at(-1)?.kind, "end");
});

test("telemetry that was missed is listed", () => {
  store.apply({ type: "missed", topics: { pose: 4 } }, 0);
  assert.equal(store.log.rows.at(-1)?.kind, "missed");
});

test("the renderer's copy of a command does not start it over", () => {
  store.apply(decision(3, { outcome: "command", command: COMMAND }), 0);
  store.apply(ackState("done"), 0);
  store.apply(commanded(), 0);
  assert.equal(store.running?.status, "done");
});

test("a welcome of the same epoch keeps what is known, another one forgets it", () => {
  store.apply(decision(1), 0);
  store.apply(affect(1, 1, 1), 0);
  store.apply(WELCOME, 10);
  assert.equal(store.log.rows.length, 1);
  store.apply({ ...WELCOME, epoch: "second" }, 20);
  assert.equal(store.log.rows.length, 0);
  assert.equal(store.decision, null);
  assert.deepEqual(store.affect, []);
  assert.deepEqual(store.scene?.value, SCENE);
});

test("only the last errors are kept", () => {
  for (let i = 0; i < 9; i++) store.apply(error(`c${i}`), 0);
  assert.deepEqual(store.errors.map(({ code }) => code), ["c4", "c5", "c6", "c7", "c8"]);
});

test("the summary is plain JSON and lets go of what is old", () => {
  store.apply(pose(40), 100);
  store.apply(decision(1, { gesture: "cold", outcome: "gated" }), 100);
  const status = { phase: "live", fault: null, retryAt: null, roundTripMs: 1, offsetMs: 7 } as const;
  const room = {
    phase: "loading",
    part: null,
    playing: null,
    agent: null,
    pictures: 0,
    counts: null,
  } as const;
  const at = (now: number) =>
    summaryOf({ store, status, problem: null, sensor: "live", pictures: 4, room, now });
  const fresh = at(200);
  assert.deepEqual(JSON.parse(JSON.stringify(fresh)), fresh);
  assert.equal(fresh.poseNs, 40e6);
  assert.equal(fresh.gesture, "cold");
  assert.deepEqual(fresh.log, [{ outcome: "gated", gesture: "cold", count: 1 }]);
  const late = at(5_000);
  assert.equal(late.poseNs, null);
  assert.equal(late.gesture, null);
  assert.equal(late.lastDecision?.id, "demo-1");
});
