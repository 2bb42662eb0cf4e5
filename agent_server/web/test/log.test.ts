import assert from "node:assert/strict";
import { test } from "node:test";
import { DecisionLog, type Row } from "../src/state/log.ts";
import { COMMAND, ackState, commanded, decision, error as failure } from "./fakes.ts";

const copy = commanded();

const counts = (rows: readonly Row[]) => rows.map((row) => ("count" in row ? row.count : row.kind === "command" ? "c" : row.kind));

test("quiet decisions share a row, whether idle or unsure", () => {
  const log = new DecisionLog();
  log.addDecision(decision(0));
  log.addDecision(decision(1, { outcome: "unsure" }));
  log.addDecision(decision(2));
  assert.deepEqual(counts(log.rows), [3]);
  const [row] = log.rows;
  assert.ok(row?.kind === "decisions" && row.isQuiet);
  assert.equal(row.first.decision.index, 0);
  assert.equal(row.last.decision.index, 2);
});

test("notable decisions alike collapse, different ones do not", () => {
  const log = new DecisionLog();
  const gated = { outcome: "gated", gesture: "smell" };
  log.addDecision(decision(0, gated));
  log.addDecision(decision(1, gated));
  log.addDecision(decision(2, { ...gated, gesture: "cold" }));
  log.addDecision(decision(3));
  log.addDecision(decision(4, gated));
  assert.deepEqual(counts(log.rows), [2, 1, 1, 1]);
});

test("every command has a row of its own", () => {
  const log = new DecisionLog();
  const given = { outcome: "command", gesture: "cold" };
  log.addDecision(decision(0, { ...given, command: COMMAND }));
  log.addDecision(decision(1, { ...given, command: { ...COMMAND, id: "demo-c2" } }));
  assert.deepEqual(counts(log.rows), [1, 1]);
});

test("a command that a decision explains is listed once, whichever comes first", () => {
  const explained = decision(5, { outcome: "command", command: COMMAND });
  const before = new DecisionLog();
  before.addCommand(copy);
  before.addDecision(explained);
  const after = new DecisionLog();
  after.addDecision(explained);
  after.addCommand(copy);
  assert.deepEqual(counts(before.rows), [1]);
  assert.deepEqual(counts(after.rows), [1]);
});

test("a command without a decision is listed, once", () => {
  const log = new DecisionLog();
  log.addDecision(decision(0));
  log.addCommand(copy);
  log.addCommand(copy);
  log.addDecision(decision(1));
  assert.deepEqual(counts(log.rows), [1, "c", 1]);
});

test("errors are listed, the same in a row are counted", () => {
  const log = new DecisionLog();
  const error = failure("classifier_failed", "no");
  log.addError(error);
  log.addError({ ...error, message: "not again" });
  log.addDecision(decision(0));
  log.addError(error);
  assert.deepEqual(counts(log.rows), [2, 1, 1]);
  const [first] = log.rows;
  assert.ok(first?.kind === "error" && first.error.message === "not again");
});

test("a decision that comes again is not counted again", () => {
  const log = new DecisionLog();
  log.addDecision(decision(0));
  log.addDecision(decision(0));
  assert.deepEqual(counts(log.rows), [1]);
});

test("old rows are let go, keys stay unique", () => {
  const log = new DecisionLog(10);
  for (let i = 0; i < 40; i++) log.addDecision(decision(i, { outcome: "gated", gesture: `g${i}` }));
  assert.equal(log.rows.length, 10);
  assert.equal(new Set(log.rows.map(({ key }) => key)).size, 10);
  const last = log.rows.at(-1);
  assert.ok(last?.kind === "decisions");
  assert.equal(last.last.decision.gesture, "g39");
});

test("the end of a command is listed once, with what the command was for", () => {
  const log = new DecisionLog();
  log.addDecision(decision(0, { outcome: "command", command: COMMAND }));
  log.addEnd(ackState("expired"));
  log.addEnd(ackState("failed", { reason: "expired" }));
  log.addEnd(ackState("assumed", { command_id: "another" }));
  assert.deepEqual(counts(log.rows), [1, "end", "end"]);
  const [, known, unknown] = log.rows;
  assert.ok(known?.kind === "end" && known.reaction === "close_window");
  assert.ok(known.ack.status === "expired");
  assert.ok(unknown?.kind === "end" && unknown.reaction === null);
});

test("telemetry that is missed again and again shares a row, for a while", () => {
  const log = new DecisionLog();
  log.addMissed({ pose: 3 });
  log.addDecision(decision(0));
  log.addMissed({ pose: 2, forecast: 1 });
  assert.deepEqual(counts(log.rows), ["missed", 1]);
  const [row] = log.rows;
  assert.ok(row?.kind === "missed");
  assert.deepEqual(row.topics, { pose: 5, forecast: 1 });
  for (let i = 1; i < 12; i++) log.addDecision(decision(i, { outcome: "gated", gesture: `g${i}` }));
  log.addMissed({ pose: 1 });
  assert.equal(log.rows.at(-1)?.kind, "missed");
});
