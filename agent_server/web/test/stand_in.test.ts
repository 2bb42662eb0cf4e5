import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { placeOf } from "../src/place.ts";
import type { Clip } from "../src/play/clips.ts";
import { Reel } from "../src/play/reel.ts";
import { CONTENT, StandIn } from "../src/play/stand_in.ts";
import type { Skeleton } from "../src/protocol/messages.ts";
import { FakeHost, WELCOME } from "./fakes.ts";

function clip(gesture: string, count: number, x: number): Clip {
  const frames = Array.from({ length: count }, (_, index) => ({
    type: "skeleton" as const,
    originating_ns: index,
    body_id: 3,
    format: "core9",
    joints: Array.from({ length: 9 }, (): [number, number, number, number] => [x, 0, 2, 1]),
  }));
  return { gesture, frames };
}

const xs = (frames: readonly (Skeleton | null)[]): (number | undefined)[] =>
  frames.map((frame) => frame?.joints[0]?.[0]);

test("a reel rests until something is asked for, and leads over without a jump", () => {
  const reel = new Reel();
  assert.equal(reel.next(), null);
  reel.rests = [clip("idle", 3, 0)];
  assert.deepEqual(xs([reel.next(), reel.next()]), [0, 0]);
  assert.equal(reel.doing, "idle");
  reel.play(clip("cold", 20, 1));
  const seen = xs(Array.from({ length: 20 }, () => reel.next()));
  assert.equal(seen.at(8), 1);
  const steps = seen.map((x, index) => (x ?? 0) - (seen[index - 1] ?? 0));
  assert.ok(Math.max(...steps) < 0.25 && Math.min(...steps) >= 0, `${steps}`);
  assert.equal(reel.doing, "cold");
  reel.next();
  assert.equal(reel.doing, "idle");
});

const place = placeOf("http://host/?session=lab");
const client = { name: "page", version: "1", token: null };
let host: FakeHost;
let asked: [string, number][];
let person: StandIn;

beforeEach(() => {
  host = new FakeHost();
  asked = [];
  const clips = (gesture: string, take: number): Promise<Clip> => {
    asked.push([gesture, take]);
    if (gesture === "juggle") return Promise.reject(new Error("the server has no juggle"));
    return Promise.resolve(clip(gesture, 30, gesture === "idle" ? 0 : 1));
  };
  person = new StandIn(place, client, host, clips, () => {});
});

async function live(): Promise<void> {
  await person.start();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, role: "sensor" });
}

const sent = (type: string): Record<string, unknown>[] =>
  host.socket.sent.filter((message) => message["type"] === type);

test("it sends thirty frames and ten moods a second, with even stamps", async () => {
  await live();
  host.pass(1000);
  const stamps = sent("skeleton").map((frame) => frame["originating_ns"] as number);
  assert.ok(Math.abs(stamps.length - 30) <= 1, `${stamps.length}`);
  assert.ok(Math.abs(sent("affect").length - 10) <= 1);
  for (let i = 1; i < stamps.length; i++) {
    assert.ok(Math.abs((stamps[i] ?? 0) - (stamps[i - 1] ?? 0) - 1e9 / 30) < 2);
  }
  assert.equal(host.socket.url, "ws://host/v1/sessions/lab/sensor");
});

test("it does what is asked for, then rests, and shows the mood that was chosen", async () => {
  await live();
  host.pass(200);
  await person.perform("cold");
  host.pass(300);
  assert.equal(person.state.doing, "cold");
  person.setMood(CONTENT);
  host.pass(1500);
  assert.equal(person.state.doing, "idle");
  assert.deepEqual(
    [sent("affect").at(0)?.["valence"], sent("affect").at(-1)?.["valence"]],
    [-6, 6],
  );
});

test("asked for something at once, it comes before the sensor first", async () => {
  await person.perform("hello");
  assert.equal(person.state.phase, "playing");
  assert.deepEqual(asked, [["idle", 0], ["idle", 1], ["hello", 0]]);
  await person.perform("hello");
  assert.deepEqual(asked.at(-1), ["hello", 1]);
});

test("where another sensor sends a body it says so, and sends nothing more", async () => {
  await live();
  host.socket.say({ type: "error", code: "stream_taken", message: "taken" });
  assert.equal(person.state.link, "taken");
  const count = host.socket.sent.length;
  host.pass(500);
  assert.equal(host.socket.sent.length, count);
});

test("what the server cannot play ends it with a reason", async () => {
  await live();
  await person.perform("juggle");
  assert.equal(person.state.phase, "failed");
  assert.match(person.state.fault ?? "", /juggle/);
  assert.ok(host.socket.isClosed);
});

test("it leaves when it is told to", async () => {
  await live();
  person.stop();
  assert.ok(host.socket.isClosed);
  const count = host.socket.sent.length;
  host.pass(500);
  assert.equal(host.socket.sent.length, count);
  assert.equal(person.state.phase, "off");
});
