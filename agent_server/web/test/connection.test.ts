import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { LATER_MS, SOON_MS } from "../src/net/backoff.ts";
import { Connection, type ConnectionOptions } from "../src/net/connection.ts";
import { jsonCodec } from "../src/protocol/codec.ts";
import { msgpackCodec } from "../src/protocol/msgpack.ts";
import { FakeHost, FakeListener, WELCOME, decision } from "./fakes.ts";

const URL = "ws://host/v1/sessions/demo/monitor";
const HEARTBEAT_MS = 1000 * WELCOME.heartbeat_s;
const OPTIONS: ConnectionOptions = {
  url: URL,
  session: "demo",
  role: "monitor",
  client: { name: "page", version: "1.2", token: null },
  codec: jsonCodec,
};

let host: FakeHost;
let listener: FakeListener;
let connection: Connection;

beforeEach(() => {
  host = new FakeHost();
  listener = new FakeListener();
  connection = connect();
});

function connect(change: Partial<ConnectionOptions> = {}): Connection {
  return new Connection({ ...OPTIONS, ...change }, host, listener);
}

function goLive(): void {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say(WELCOME);
}

test("says hello first and is live after the welcome", () => {
  connection.start();
  assert.equal(host.socket.url, URL);
  assert.equal(host.socket.subprotocol, "agent-server.v1.json");
  assert.deepEqual(host.socket.sent, []);
  host.socket.events.onOpen();
  assert.deepEqual(host.socket.sent, [
    {
      type: "hello",
      protocol: "1.0",
      client: "page",
      client_version: "1.2",
      instance: "8".repeat(32),
      session: "demo",
      role: "monitor",
      capabilities: ["heartbeat"],
    },
  ]);
  assert.equal(connection.status.phase, "greeting");
  host.socket.say(WELCOME);
  assert.equal(connection.status.phase, "live");
  assert.deepEqual(listener.messages, [WELCOME]);
});

test("sends the token in hello when there is one", () => {
  connection = connect({ client: { name: "page", version: "1.2", token: "secret" } });
  connection.start();
  host.socket.events.onOpen();
  assert.equal(host.socket.sent[0]?.["token"], "secret");
});

test("what hello says beside is asked for each time, with the epoch that was lost", () => {
  let n = 0;
  connection = connect({ capabilities: ["resume"], greeting: () => ({ last_sequence: ++n }) });
  goLive();
  const [first] = host.socket.sent;
  assert.equal(first?.["last_epoch"], undefined);
  host.socket.events.onClose(1006, "");
  host.pass(SOON_MS);
  host.socket.events.onOpen();
  const [second] = host.socket.sent;
  assert.equal(second?.["last_epoch"], WELCOME.epoch);
  assert.deepEqual(second?.["capabilities"], ["heartbeat", "resume"]);
  assert.deepEqual([first?.["last_sequence"], second?.["last_sequence"]], [1, 2]);
  assert.equal(second?.["instance"], first?.["instance"]);
});

test("measures round trip and offset with its own clock", () => {
  goLive();
  assert.equal(connection.serverNs, null);
  const ping = host.socket.sent.at(-1);
  assert.equal(ping?.["type"], "ping");
  host.pass(12);
  host.socket.say({ type: "pong", sent_ns: ping?.["sent_ns"], time_ns: 5_006_000_000 });
  assert.equal(connection.status.roundTripMs, 12);
  assert.equal(connection.status.offsetMs, 5_000);
  host.pass(1_000);
  assert.equal(connection.serverNs, 6_012_000_000);
});

test("tells of a clock that jumped", () => {
  goLive();
  for (const aheadMs of [0, 0, 400, 400, 400]) {
    host.socket.say({ type: "pong", sent_ns: host.time * 1e6, time_ns: (host.time + aheadMs) * 1e6 });
    host.pass(100);
  }
  assert.deepEqual(listener.jumps, [400]);
  assert.equal(connection.status.offsetMs, 400);
});

test("another connection knows nothing of the clock at first", () => {
  goLive();
  host.socket.say({ type: "pong", sent_ns: 0, time_ns: 9_000_000 });
  host.socket.events.onClose(1006, "");
  assert.equal(connection.status.offsetMs, null);
  host.pass(SOON_MS);
  host.socket.events.onOpen();
  assert.equal(connection.serverNs, null);
});

test("keeps pinging, and answers the server's pings", () => {
  goLive();
  host.pass(HEARTBEAT_MS);
  assert.equal(host.socket.sent.filter(({ type }) => type === "ping").length, 2);
  host.socket.say({ type: "ping", sent_ns: 41 });
  const pong = host.socket.sent.at(-1);
  assert.equal(pong?.["type"], "pong");
  assert.equal(pong?.["sent_ns"], 41);
  assert.equal(pong?.["time_ns"], HEARTBEAT_MS * 1e6);
});

test("a server that is silent for two and a half heartbeats is left and asked again", () => {
  goLive();
  host.pass(HEARTBEAT_MS * 2.5 - 1);
  assert.equal(connection.status.phase, "live");
  const first = host.socket;
  host.pass(1);
  assert.equal(connection.status.fault?.kind, "silent");
  assert.ok(first.isClosed);
  // No goodbye: the server is to keep the place.
  assert.equal(first.closeCode, undefined);
  host.pass(SOON_MS);
  assert.equal(host.sockets.length, 2);
  assert.equal(first.sent.filter(({ type }) => type === "ping").length, 3);
});

test("anything that is heard keeps a connection alive, even what cannot be read", () => {
  goLive();
  for (let i = 0; i < 12; i++) {
    host.pass(HEARTBEAT_MS * 2.4);
    if (i % 2 === 0) host.socket.say(decision(i));
    else host.socket.events.onMessage("?");
  }
  assert.equal(connection.status.phase, "live");
});

test("a heartbeat that makes no sense is held within bounds", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, heartbeat_s: 0 });
  host.pass(240);
  assert.equal(host.socket.sent.filter(({ type }) => type === "ping").length, 3);
});

test("waits longer after every failed attempt, and starts over once live", () => {
  connection.start();
  const waits: number[] = [];
  for (let i = 0; i < 5; i++) {
    host.socket.events.onClose(1006, "");
    assert.equal(connection.status.fault?.kind, "unreachable");
    const wait = (connection.status.retryAt ?? 0) - host.time;
    waits.push(wait);
    host.pass(wait);
  }
  assert.deepEqual(waits, [125, 250, 500, 750, 750]);
  host.socket.events.onOpen();
  host.socket.say(WELCOME);
  host.socket.events.onClose(1006, "");
  assert.equal((connection.status.retryAt ?? 0) - host.time, 125);
});

test("a socket that neither opens nor fails is given up", () => {
  connection.start();
  host.pass(10_000);
  assert.equal(connection.status.fault?.kind, "unreachable");
  assert.ok(host.socket.isClosed);
});

test("a close code says when to come back: soon, later, or never", () => {
  const waitAfter = (code: number): number | null => {
    goLive();
    host.socket.events.onClose(code, "why");
    const { retryAt } = connection.status;
    const wait = retryAt === null ? null : retryAt - host.time;
    connection.stop();
    return wait;
  };
  for (const soon of [1001, 1006, 1011, 4408, 4410, 4413]) assert.equal(waitAfter(soon), 125);
  for (const later of [1009, 4400, 4401, 4422, 4429]) assert.equal(waitAfter(later), LATER_MS);
  for (const never of [1000, 4409]) assert.equal(waitAfter(never), null);
});

test("never means: stopped, with the reason, until somebody starts it again", () => {
  goLive();
  host.socket.events.onClose(4409, "taken over");
  const fault = { kind: "lost", closeCode: 4409, reason: "taken over" };
  assert.deepEqual(connection.status.fault, fault);
  assert.equal(connection.status.phase, "stopped");
  host.pass(10 * LATER_MS);
  connection.retryNow();
  assert.equal(host.sockets.length, 1);
  connection.start();
  assert.equal(host.sockets.length, 2);
  assert.equal(connection.status.fault, null);
});

test("a server that cuts the connection says why, and one comes back when the code says so", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ type: "error", code: "stopping", message: "it is stopping", fatal: true });
  host.socket.events.onClose(1001, "");
  const { fault, retryAt } = connection.status;
  const closeCode = 1001;
  assert.deepEqual(fault, { kind: "lost", closeCode, reason: "it is stopping" });
  assert.equal((retryAt ?? 0) - host.time, 125);
});

test("an attempt that is refused outright is retried like any other", () => {
  host.isForbidden = true;
  connection.start();
  assert.equal(connection.status.phase, "waiting");
  host.isForbidden = false;
  host.pass(SOON_MS);
  assert.equal(host.sockets.length, 1);
});

test("an open socket without a welcome is given up", () => {
  connection.start();
  host.socket.events.onOpen();
  host.pass(10_000);
  assert.equal(connection.status.fault?.kind, "silent");
});

test("a fatal error is kept as the reason, and the next attempt takes its time", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ type: "error", code: "wrong_version", message: "1 is not 2", fatal: true });
  host.socket.events.onClose(4401, "");
  assert.deepEqual(connection.status.fault, { kind: "version", message: "1 is not 2" });
  assert.equal((connection.status.retryAt ?? 0) - host.time, LATER_MS);
});

test("an error that is not fatal changes nothing but is passed on", () => {
  goLive();
  host.socket.say({ type: "error", code: "wrong_role", message: "no" });
  assert.equal(connection.status.phase, "live");
  assert.equal(listener.messages.at(-1)?.type, "error");
});

test("a welcome in another major version is refused by the page itself", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, protocol: "2.0" });
  const { fault } = connection.status;
  assert.equal(fault?.kind, "version");
  assert.match(fault?.kind === "version" ? fault.message : "", /2\.0.*1\.0/);
  assert.deepEqual(listener.messages, []);
});

test("a newer minor version is welcome, and what it adds is passed over", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, protocol: "1.7" });
  host.socket.say({ type: "novelty" });
  host.socket.say({ ...decision(1), novelty: 5 });
  assert.equal(connection.status.phase, "live");
  assert.deepEqual(listener.messages.at(-1), decision(1));
  assert.equal(listener.messages.length, 2);
});

test("what cannot be read is told of and passed over", () => {
  goLive();
  for (const text of ["", "{", "null", "[1]", '{"kind":"pose"}', '{"type":3}']) {
    host.socket.events.onMessage(text);
  }
  host.socket.say({ ...WELCOME.scene, mode: 3 });
  assert.equal(listener.messages.length, 1);
  assert.equal(listener.unreadable.length, 7);
  assert.equal(listener.unreadable.at(-1), "mode");
  assert.equal(connection.status.phase, "live");
});

test("speaks MessagePack where it is told to", () => {
  connection = connect({ codec: msgpackCodec });
  connection.start();
  assert.equal(host.socket.subprotocol, "agent-server.v1.msgpack");
  host.socket.events.onOpen();
  const [hello] = host.socket.sentBytes;
  assert.ok(hello instanceof Uint8Array);
  assert.equal(msgpackCodec.decodeClient(hello as Uint8Array<ArrayBuffer>)?.type, "hello");
  host.socket.events.onMessage(msgpackCodec.encode(WELCOME));
  assert.deepEqual(listener.messages, [WELCOME]);
});

test("what is posted without a live connection is lost, and what is no message is refused", () => {
  connection.post({ type: "ping", sent_ns: 1 });
  goLive();
  const before = host.socket.sent.length;
  connection.post({ type: "scene_event", object: "window", state: "open" });
  assert.equal(host.socket.sent.length, before + 1);
  const bad = { type: "scene_event", object: "", state: "open" } as const;
  assert.throws(() => connection.post(bad), { name: "ProtocolError", field: "object" });
});

test("a socket that was left is not heard any more", () => {
  goLive();
  const old = host.socket;
  old.events.onClose(1006, "");
  host.pass(SOON_MS);
  old.say(decision(1));
  old.events.onClose(1006, "");
  assert.equal(connection.status.phase, "opening");
  assert.equal(listener.messages.length, 1);
});

test("retry now cuts the wait short, and only the wait", () => {
  connection.start();
  connection.retryNow();
  assert.equal(host.sockets.length, 1);
  host.socket.events.onClose(1006, "");
  connection.retryNow();
  assert.equal(host.sockets.length, 2);
  host.pass(5_000);
  assert.equal(host.sockets.length, 2);
});

test("stop says goodbye and leaves no timer behind", () => {
  goLive();
  connection.stop();
  assert.equal(host.socket.closeCode, 1000);
  host.pass(10 * LATER_MS);
  assert.equal(host.sockets.length, 1);
  assert.equal(connection.status.phase, "stopped");
});
