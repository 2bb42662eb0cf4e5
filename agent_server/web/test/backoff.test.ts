import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff, LATER_MS, SOON_MS } from "../src/net/backoff.ts";

/** The bounds of a server that is away, asked again as soon as each wait is over. */
function boundsWhileAway(untilMs: number): { readonly at: number; readonly bound: number }[] {
  const backoff = new Backoff(() => 1);
  const bounds: { at: number; bound: number }[] = [];
  for (let at = 0; at < untilMs; ) {
    const bound = backoff.next(at);
    bounds.push({ at, bound });
    at += bound;
  }
  return bounds;
}

test("the bound doubles up to one and a half seconds, and after 20 s on to 15 s", () => {
  const bounds = boundsWhileAway(120_000);
  assert.deepEqual(bounds.slice(0, 5).map(({ bound }) => bound), [250, 500, 1_000, 1_500, 1_500]);
  for (const { at, bound } of bounds) {
    if (at < 20_000) assert.ok(bound <= SOON_MS, `${bound} at ${at}`);
  }
  const patient = bounds.filter(({ at }) => at >= 20_000).map(({ bound }) => bound);
  assert.deepEqual(patient.slice(0, 6), [1_500, 3_000, 6_000, 12_000, 15_000, 15_000]);
});

test("the wait is spread over the whole bound", () => {
  assert.equal(new Backoff(() => 0).next(0), 0);
  assert.equal(new Backoff(() => 0.5).next(0), 125);
});

test("a connection sets it back", () => {
  const backoff = new Backoff(() => 1);
  for (let i = 0; i < 9; i++) backoff.next(i * 10_000);
  assert.equal(backoff.next(90_000), LATER_MS);
  backoff.reset();
  assert.equal(backoff.next(100_000), 250);
  assert.equal(backoff.next(119_000), 500);
});
