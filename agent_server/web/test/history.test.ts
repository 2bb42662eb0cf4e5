import assert from "node:assert/strict";
import { test } from "node:test";
import type { PoseMessage } from "../src/protocol/messages.ts";
import { History, SPAN_MS } from "../src/state/history.ts";
import { Playhead } from "../src/state/playhead.ts";
import { WELCOME, affectState, decision } from "./fakes.ts";

function pose(stampMs: number): PoseMessage {
  const joints = Array.from({ length: 9 }, () => [0, 0, 2, 1] as const);
  return { type: "pose", originating_ns: stampMs * 1e6, body_id: 7, joints };
}

test("what was known at a moment is the last that had come by then", () => {
  const history = new History();
  history.add(WELCOME, 0, false);
  for (let at = 0; at <= 1_000; at += 100) history.add(pose(at), at, false);
  history.add(affectState(450, -4, 4), 450, false);
  assert.equal(history.at(-1).pose, null);
  assert.equal(history.at(349).pose?.value.originating_ns, 300e6);
  assert.equal(history.at(350).affect.length, 0);
  assert.equal(history.at(450).affect.at(-1)?.value.valence, -4);
  assert.equal(history.at(9_999).pose?.at, 1_000);
});

test("a minute is kept, and more while somebody looks at the past", () => {
  const history = new History();
  history.add(pose(0), 0, false);
  history.add(pose(1), SPAN_MS + 1, true);
  assert.equal(history.at(0).pose?.at, 0);
  history.add(pose(2), SPAN_MS + 2, false);
  assert.equal(history.at(1).pose, null);
});

test("another epoch begins without a past", () => {
  const history = new History();
  history.add(WELCOME, 0, false);
  history.add(pose(0), 0, false);
  history.add(WELCOME, 1, false);
  assert.notEqual(history.at(1).pose, null);
  history.add({ ...WELCOME, epoch: "another" }, 2, false);
  assert.equal(history.at(2).pose, null);
});

test("marks are notable decisions, of like ones in a row the first", () => {
  const history = new History();
  history.add(decision(0, { outcome: "idle", gesture: "idle" }), 100, false);
  history.add(decision(1, { outcome: "gated", gesture: "cold" }), 200, false);
  history.add(decision(2, { outcome: "gated", gesture: "cold" }), 300, false);
  history.add(decision(3, { outcome: "command", gesture: "cold" }), 400, false);
  assert.deepEqual(
    history.marks(0, 1_000).map(({ at }) => at),
    [200, 400],
  );
  assert.equal(history.nextMark(300, 1), 400);
  assert.equal(history.nextMark(400, 1), null);
  assert.equal(history.nextMark(400, -1), 200);
  assert.equal(history.nextMark(200, -1), null);
});

test("the playhead stops, goes on behind the present, and comes back to it", () => {
  const head = new Playhead();
  assert.equal(head.time(5_000), 5_000);
  head.stop(5_000);
  assert.equal(head.time(9_000), 5_000);
  assert.equal(head.end(9_000), 5_000);
  head.seek(3_000, 9_000);
  head.seek(7_000, 9_000);
  assert.equal(head.time(9_000), 5_000, "what came after the stop is not on the line");
  head.seek(3_000, 9_000);
  head.go(9_000);
  assert.ok(!head.isLive);
  assert.equal(head.time(10_000), 4_000);
  assert.equal(head.end(10_000), 10_000);
  head.goLive();
  assert.ok(head.isLive);
  head.stop(11_000);
  head.go(11_000);
  assert.ok(head.isLive, "who goes on at once has missed nothing");
});
