import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { CommandLedger, REMEMBERED } from "../src/net/ledger.ts";
import type { AckMessage } from "../src/protocol/messages.ts";
import { commanded } from "./fakes.ts";

let ledger: CommandLedger;

beforeEach(() => {
  ledger = new CommandLedger();
  ledger.welcome("book");
});

const command = (sequence: number, change = {}) =>
  commanded({ id: `c${sequence}`, sequence, ttl_ms: 3_000, ...change });

const words = (say: readonly AckMessage[]) =>
  say.map(({ command_id, status, step, reason }) =>
    [command_id, status, step ?? reason].filter((word) => word !== undefined).join(" "),
  );

test("a new command is accepted, and the application's to carry out", () => {
  const { say, cancel, isNew } = ledger.receive(command(1), 0);
  assert.deepEqual(words(say), ["c1 accepted"]);
  assert.equal(cancel, null);
  assert.equal(isNew, true);
  assert.equal(ledger.running?.id, "c1");
  assert.equal(ledger.lastSequence, 1);
});

test("a command that is known is answered with its last word, and not seen again", () => {
  ledger.receive(command(1), 0);
  const again = () => ledger.receive(command(1, { age_ms: 2_000 }), 10);
  assert.deepEqual(words(again().say), ["c1 accepted"]);
  ledger.start("c1", 10);
  ledger.progress("c1", 0);
  assert.deepEqual(words(again().say), ["c1 progress 0"]);
  ledger.fail("c1", "stuck");
  assert.deepEqual(words(again().say), ["c1 failed stuck"]);
  assert.equal(again().isNew, false);
});

test("a command that is too old when it comes has failed", () => {
  const { say, isNew } = ledger.receive(command(1, { age_ms: 3_000 }), 0);
  assert.deepEqual(words(say), ["c1 failed expired"]);
  assert.equal(isNew, false);
  assert.equal(ledger.lastSequence, 1);
  assert.deepEqual(words(ledger.receive(command(1), 0).say), ["c1 failed expired"]);
});

test("one that is too old cuts nothing short", () => {
  ledger.receive(command(1), 0);
  const { cancel } = ledger.receive(command(2, { age_ms: 9_000 }), 0);
  assert.equal(cancel, null);
  assert.equal(ledger.running?.id, "c1");
});

test("a command from before one that is known makes way for it", () => {
  ledger.receive(command(5), 0);
  const { say, isNew, cancel } = ledger.receive(command(4), 0);
  assert.deepEqual(words(say), ["c4 failed preempted"]);
  assert.equal(isNew, false);
  assert.equal(cancel, null);
  assert.equal(ledger.running?.id, "c5");
});

test("a new command cuts the running one short", () => {
  ledger.receive(command(1), 0);
  ledger.start("c1", 0);
  const { say, cancel, isNew } = ledger.receive(command(2), 0);
  assert.deepEqual(words(say), ["c1 failed preempted", "c2 accepted"]);
  assert.equal(cancel?.id, "c1");
  assert.equal(isNew, true);
  assert.equal(ledger.done("c1").isTaken, false);
});

test("reports become words; those on a command that is over, or unknown, do not", () => {
  ledger.receive(command(1), 0);
  assert.deepEqual(words(ledger.start("c1", 5).say), ["c1 started"]);
  assert.deepEqual(ledger.start("c1", 6), { say: [], isTaken: false });
  assert.deepEqual(words(ledger.progress("c1", 0).say), ["c1 progress 0"]);
  assert.deepEqual(words(ledger.done("c1").say), ["c1 done"]);
  for (const report of [
    ledger.start("c1", 7),
    ledger.progress("c1", 1),
    ledger.done("c1"),
    ledger.fail("c1", "no"),
    ledger.done("nobody's"),
  ]) {
    assert.deepEqual(report, { say: [], isTaken: false });
  }
  assert.deepEqual(words(ledger.receive(command(1), 8).say), ["c1 done"]);
});

test("what was not started makes no progress and is not done, but may fail", () => {
  ledger.receive(command(1), 0);
  assert.deepEqual(ledger.progress("c1", 0), { say: [], isTaken: false });
  assert.deepEqual(ledger.done("c1"), { say: [], isTaken: false });
  assert.deepEqual(words(ledger.fail("c1", "no legs").say), ["c1 failed no legs"]);
});

test("the start is refused once the time is up, counted from when it was issued", () => {
  ledger.receive(command(1, { age_ms: 1_000 }), 500);
  const late = ledger.start("c1", 2_501);
  assert.deepEqual(words(late.say), ["c1 failed expired"]);
  assert.equal(late.isTaken, false);
  ledger.receive(command(2, { age_ms: 1_000 }), 500);
  assert.equal(ledger.start("c2", 2_500).isTaken, true);
  // What has been started goes on beyond its time.
  assert.equal(ledger.progress("c2", 0).isTaken, true);
});

test("words without a connection are kept, the last one of each command, and said once", () => {
  ledger.receive(command(1), 0);
  ledger.start("c1", 0);
  ledger.lost();
  assert.deepEqual(ledger.progress("c1", 0), { say: [], isTaken: true });
  assert.deepEqual(ledger.done("c1"), { say: [], isTaken: true });
  assert.deepEqual(words(ledger.welcome("book").say), ["c1 done"]);
  ledger.lost();
  assert.deepEqual(ledger.welcome("book").say, []);
});

test("a command that was open when the connection was lost is spoken of again", () => {
  ledger.receive(command(1), 0);
  ledger.start("c1", 0);
  ledger.lost();
  assert.deepEqual(words(ledger.welcome("book").say), ["c1 started"]);
  ledger.done("c1");
  ledger.lost();
  assert.deepEqual(ledger.welcome("book").say, []);
});

test("another ledger cuts short without a word, and forgets everything", () => {
  ledger.receive(command(7), 0);
  ledger.lost();
  const { say, cancel } = ledger.welcome("another");
  assert.deepEqual(say, []);
  assert.equal(cancel?.id, "c7");
  assert.equal(ledger.lastSequence, 0);
  assert.equal(ledger.running, null);
  assert.equal(ledger.receive(command(1), 0).isNew, true);
  // The same id in another ledger is another command.
  assert.equal(ledger.receive(command(7), 0).isNew, true);
});

test("the same ledger goes on over any number of connections", () => {
  ledger.receive(command(1), 0);
  ledger.lost();
  assert.equal(ledger.welcome("book").cancel, null);
  assert.equal(ledger.receive(command(1, { age_ms: 50 }), 50).isNew, false);
});

test("the last commands that are over are remembered, the open one always", () => {
  ledger.receive(command(1), 0);
  for (let i = 1; i <= REMEMBERED + 1; i++) {
    ledger.start(`c${i}`, 0);
    ledger.done(`c${i}`);
    ledger.receive(command(i + 1), 0);
  }
  assert.deepEqual(words(ledger.receive(command(2), 0).say), ["c2 done"]);
  assert.deepEqual(words(ledger.receive(command(1), 0).say), ["c1 failed preempted"]);
  assert.equal(ledger.running?.id, `c${REMEMBERED + 2}`);
});

test("what does not fit the protocol is refused before it changes anything, or cut", () => {
  ledger.receive(command(1), 0);
  for (const step of [-1, 1.5, 1001, Number.NaN]) {
    assert.throws(() => ledger.progress("c1", step), RangeError);
  }
  assert.deepEqual(words(ledger.receive(command(1), 0).say), ["c1 accepted"]);
  const [word] = ledger.fail("c1", "\u{1f3a5}".repeat(600)).say;
  assert.equal([...(word?.reason ?? "")].length, 500);
});
