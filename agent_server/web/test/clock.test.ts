import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { ClockEstimate } from "../src/net/clock.ts";

const MS = 1e6;

let clock: ClockEstimate;

beforeEach(() => {
  clock = new ClockEstimate();
});

/** A pong after `roundTripMs`, from a server whose clock is ahead by `offsetMs`. */
function pong(atMs: number, offsetMs: number, roundTripMs: number): number | null {
  const nowNs = (atMs + roundTripMs) * MS;
  const timeNs = nowNs - (roundTripMs * MS) / 2 + offsetMs * MS;
  return clock.push(atMs * MS, timeNs, nowNs);
}

test("the first sample is taken as it is", () => {
  assert.equal(clock.offsetNs, null);
  pong(0, 700, 10);
  assert.equal(clock.offsetNs, 700 * MS);
  assert.equal(clock.roundTripNs, 10 * MS);
});

test("the estimate follows the sample of the shortest way by a quarter", () => {
  pong(0, 0, 10);
  pong(1, 4, 8);
  assert.equal(clock.offsetNs, 1 * MS);
  // A longer way tells less: the best of before is followed on.
  pong(2, 40, 30);
  assert.equal(clock.offsetNs, 1.75 * MS);
  assert.equal(clock.roundTripNs, 8 * MS);
});

test("the estimate does not stay where the best sample rules it out", () => {
  pong(0, 0, 10);
  pong(1, 8, 4);
  assert.equal(clock.offsetNs, 6 * MS);
});

test("a first pong that was slow on one way is no jump", () => {
  assert.equal(clock.push(0, 600 * MS, 601 * MS), null);
  for (let i = 1; i < 10; i++) {
    assert.equal(pong(1000 * i, 0, 2), null);
    assert.ok(Math.abs(clock.offsetNs ?? NaN) <= MS);
  }
});

test("only the last eight samples count", () => {
  pong(0, 0, 1);
  for (let i = 1; i <= 7; i++) pong(i, 20, 5);
  assert.equal(clock.offsetNs, 0);
  pong(8, 20, 5);
  assert.equal(clock.offsetNs, 17.5 * MS);
});

test("an offset is an integer of nanoseconds, on either side of zero", () => {
  clock.push(0, 1, 3);
  assert.equal(clock.offsetNs, -1);
  clock.push(10, 8, 12);
  assert.equal(clock.offsetNs, -2);
});

test("three samples far away to the same side are a jump, and the last one holds", () => {
  pong(0, 0, 2);
  assert.equal(pong(1, 100, 2), null);
  assert.equal(pong(2, 110, 2), null);
  assert.equal(clock.offsetNs, 0);
  assert.equal(pong(3, 120, 2), 120 * MS);
  assert.equal(clock.offsetNs, 120 * MS);
  pong(4, 121, 2);
  assert.equal(clock.offsetNs, 120 * MS);
  pong(5, 120.4, 1);
  assert.equal(clock.offsetNs, 120.1 * MS);
});

test("samples to both sides, or with a good one in between, are no jump", () => {
  pong(0, 0, 2);
  const far = [100, -100, 100, 100, 0, -100, -100, 1, 100, 100];
  for (const [i, offset] of far.entries()) assert.equal(pong(i + 1, offset, 2), null);
  assert.ok(Math.abs(clock.offsetNs ?? 0) <= MS);
});

test("half of the round trip is allowed for", () => {
  pong(0, 0, 20);
  for (let i = 1; i <= 6; i++) assert.equal(pong(i, 60, 4), null);
  clock = new ClockEstimate();
  pong(0, 0, 2);
  for (let i = 1; i <= 6; i++) assert.equal(pong(i, 140, 200), null);
});

test("a pong from before its ping is passed over", () => {
  assert.equal(clock.push(5, 9, 4), null);
  assert.equal(clock.offsetNs, null);
});
