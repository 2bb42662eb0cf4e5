import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { LATER_MS } from "../src/net/backoff.ts";
import { RendererClient } from "../src/net/renderer.ts";
import { FakeHost, SCENE, WELCOME, commanded } from "./fakes.ts";

let host: FakeHost;
/** What the application saw, in order. */
let seen: string[];
let shown: Record<string, string>;
let renderer: RendererClient;

beforeEach(() => {
  host = new FakeHost();
  seen = [];
  shown = { window: "open" };
  renderer = new RendererClient(
    {
      server: "http://host:8765/",
      session: "lab",
      client: { name: "r", version: "1", token: null },
      objects: () => shown,
    },
    host,
    {
      onCommand: ({ id }) => seen.push(`command ${id}`),
      onCancel: ({ id }, reason) => seen.push(`cancel ${id} ${reason}`),
      onMotion: ({ first_frame }) => seen.push(`motion ${first_frame}`),
      onScene: ({ mode }) => seen.push(`scene ${mode}`),
      onDifferences: (differences) => seen.push(`differs ${differences.map((d) => d.object).join()}`),
    },
  );
});

function join(change: object = {}): void {
  renderer.open();
  if (renderer.status.phase === "waiting") renderer.retryNow();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, role: "renderer", ...change });
}

function lose(): void {
  host.socket.events.onClose(1006, "");
}

const hello = () => host.socket.sent[0] ?? {};

const acks = (): string[] =>
  host.socket.sent
    .filter(({ type }) => type === "ack")
    .map(({ command_id, status, step, reason }) =>
      [command_id, status, step ?? reason].filter((word) => word !== undefined).join(" "),
    );

test("it comes as a renderer that resumes and reports, and says what it shows", () => {
  join();
  assert.equal(host.socket.url, "ws://host:8765/v1/sessions/lab/renderer");
  assert.deepEqual(hello()["capabilities"], ["heartbeat", "resume", "progress"]);
  assert.deepEqual(hello()["objects"], { window: "open" });
  assert.equal(hello()["ledger"], undefined);
  assert.equal(hello()["last_sequence"], undefined);
  assert.deepEqual(seen, ["scene working"]);
});

test("a command is accepted before the application sees it, and answered step by step", () => {
  join();
  host.socket.say(commanded({ id: "c1" }));
  assert.deepEqual(acks(), ["c1 accepted"]);
  assert.equal(renderer.start("c1"), true);
  assert.equal(renderer.progress("c1", 0), true);
  assert.equal(renderer.done("c1"), true);
  assert.equal(renderer.fail("c1", "late"), false);
  assert.deepEqual(acks(), ["c1 accepted", "c1 started", "c1 progress 0", "c1 done"]);
  assert.deepEqual(seen, ["scene working", "command c1"]);
});

test("a command that comes while another one runs: the cancellation first", () => {
  join();
  host.socket.say(commanded({ id: "c1" }));
  host.socket.say(commanded({ id: "c2", sequence: 2 }));
  assert.deepEqual(seen.slice(1), ["command c1", "cancel c1 preempted", "command c2"]);
  assert.deepEqual(acks(), ["c1 accepted", "c1 failed preempted", "c2 accepted"]);
});

test("what ended without a connection is said behind the next welcome, once", () => {
  join();
  host.socket.say(commanded({ id: "c1", sequence: 9 }));
  renderer.start("c1");
  lose();
  shown = { window: "closed" };
  assert.equal(renderer.done("c1"), true);
  join({ resumed: true });
  assert.deepEqual(hello()["objects"], { window: "closed" });
  assert.deepEqual([hello()["ledger"], hello()["last_sequence"]], ["book", 9]);
  assert.equal(hello()["last_epoch"], "first");
  assert.deepEqual(acks(), ["c1 done"]);
  host.socket.say(commanded({ id: "c1", sequence: 9, age_ms: 400 }));
  assert.deepEqual(acks(), ["c1 done", "c1 done"]);
  assert.deepEqual(seen.filter((event) => event.startsWith("command")), ["command c1"]);
  lose();
  join({ resumed: true });
  assert.deepEqual(acks(), []);
});

test("a server that lost its ledger is obeyed from the start", () => {
  join();
  host.socket.say(commanded({ id: "c1", sequence: 9 }));
  lose();
  join({ epoch: "second", ledger: "another" });
  assert.deepEqual(acks(), []);
  assert.deepEqual(seen.slice(-2), ["cancel c1 forgotten", "scene working"]);
  host.socket.say(commanded({ id: "c1", sequence: 1 }));
  assert.equal(seen.at(-1), "command c1");
});

test("differences are told before the room as it is now", () => {
  const differences = [{ object: "window", renderer: "open", server: "closed", kept: "server" }];
  join({ differences, scene: { ...SCENE, mode: "attention" } });
  assert.deepEqual(seen, ["differs window", "scene attention"]);
});

test("an object that was changed by hand is reported while there is a connection", () => {
  join();
  renderer.reportObject("window", "closed");
  assert.deepEqual(host.socket.sent.at(-1), { type: "scene_event", object: "window", state: "closed" });
  lose();
  const before = host.sockets.length;
  renderer.reportObject("window", "open");
  assert.equal(host.sockets.length, before);
});

test("a renderer that was replaced stays away until it is opened again", () => {
  join();
  host.socket.events.onClose(4409, "another renderer took over");
  host.pass(10 * LATER_MS);
  assert.equal(host.sockets.length, 1);
  assert.equal(renderer.status.phase, "stopped");
  renderer.open();
  assert.equal(host.sockets.length, 2);
});

test("it says goodbye, and knows what it did when it comes back", () => {
  join();
  host.socket.say(commanded({ id: "c1", sequence: 3 }));
  renderer.close();
  assert.equal(host.socket.closeCode, 1000);
  join();
  assert.equal(hello()["last_sequence"], 3);
  host.socket.say(commanded({ id: "c1", sequence: 3, age_ms: 10 }));
  assert.deepEqual(seen.filter((event) => event.startsWith("command")), ["command c1"]);
});

test("the server's clock is known from its pongs", () => {
  join();
  assert.equal(renderer.serverNs, null);
  const ping = host.socket.sent.find(({ type }) => type === "ping");
  host.pass(10);
  host.socket.say({ type: "pong", sent_ns: ping?.["sent_ns"], time_ns: 1_000_000_000 });
  assert.equal(renderer.serverNs, 1_005_000_000);
});

test("motion is handed on for the command that is under way, and for no other", () => {
  join();
  const stretch = { type: "pose_stream", rate_hz: 25, joints: ["torso"], positions: [[[0, 1, 0]]] };
  const say = (command_id: string, first_frame: number) => host.socket.say({ ...stretch, command_id, first_frame });
  host.socket.say(commanded({ id: "lab/c1", motion: "generated" }));
  renderer.start("lab/c1");
  seen = [];
  say("lab/c1", 0);
  say("lab/c0", 5);
  say("lab/c1", 1);
  renderer.done("lab/c1");
  say("lab/c1", 2);
  assert.deepEqual(seen, ["motion 0", "motion 1"]);
});
