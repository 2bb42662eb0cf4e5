import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { placeOf } from "../src/place.ts";
import { Recorded, type Recording } from "../src/play/recorded.ts";
import { FakeHost, WELCOME } from "./fakes.ts";

const RECORDING: Recording = [0, 40, 80, 1_000].map((at_ms) => ({
  at_ms,
  message: { type: "affect", originating_ns: 5e9 + at_ms * 1e6, valence: -5, arousal: 4 },
}));
const client = { name: "page", version: "1", token: null };
let host: FakeHost;
let person: Recorded;

beforeEach(() => {
  host = new FakeHost();
  const recordings = {
    names: () => Promise.resolve(["cold"]),
    open: (name: string) =>
      name === "cold" ? Promise.resolve(RECORDING) : Promise.reject(new Error(`no ${name}`)),
  };
  person = new Recorded(placeOf("http://host/?session=lab"), client, host, recordings, () => {});
});

const stamps = (): unknown[] =>
  host.socket.sent.filter(({ type }) => type === "affect").map(({ originating_ns }) => originating_ns);

async function live(): Promise<void> {
  await person.start("cold");
  assert.equal(person.state.phase, "loading");
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, role: "sensor" });
}

test("a recording is sent at its own pace and with its own stamps, and then is over", async () => {
  await live();
  assert.deepEqual(stamps(), [5e9]);
  host.pass(85);
  assert.deepEqual(stamps(), [5e9, 5.04e9, 5.08e9]);
  assert.equal(person.state.phase, "playing");
  host.pass(1_000);
  assert.equal(stamps().length, 4);
  assert.deepEqual(person.state, { phase: "off", link: "opening", name: null, fault: null });
});

test("somebody who stops it sends no more", async () => {
  await live();
  person.stop();
  host.pass(2_000);
  assert.equal(stamps().length, 1);
});

test("what the server does not have is said", async () => {
  await person.start("hot");
  assert.equal(person.state.phase, "failed");
  assert.equal(person.state.fault, "no hot");
});

test("another sensor keeps its place until it is pushed aside", async () => {
  await live();
  host.socket.say({ type: "error", code: "stream_taken", message: "there is one", fatal: false });
  assert.equal(person.state.link, "taken");
  await person.start("cold", true);
  host.socket.events.onOpen();
  assert.equal(host.socket.sent[0]?.["take_over"], true);
});
