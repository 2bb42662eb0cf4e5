import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { BACKOFF_BASE_MS, BACKOFF_CAP_MS } from "../src/net/backoff.ts";
import { Connection, PING_EVERY_MS } from "../src/net/connection.ts";
import { FakeHost, FakeListener, WELCOME, decision } from "./fakes.ts";

const URL = "ws://host/v1/sessions/demo/monitor";

let host: FakeHost;
let listener: FakeListener;
let connection: Connection;

beforeEach(() => {
  host = new FakeHost();
  listener = new FakeListener();
  connection = connect(null);
});

function connect(token: string | null): Connection {
  return new Connection(URL, { name: "page", version: "1.2", token }, host, listener);
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
    { type: "hello", protocol: "1.0", client: "page", client_version: "1.2" },
  ]);
  assert.equal(connection.status.phase, "greeting");
  host.socket.say(WELCOME);
  assert.equal(connection.status.phase, "live");
  assert.deepEqual(listener.messages, [WELCOME]);
});

test("sends the token in hello when there is one", () => {
  connection = connect("secret");
  connection.start();
  host.socket.events.onOpen();
  assert.equal(host.socket.sent[0]?.["token"], "secret");
});

test("measures the round trip with its own clock", () => {
  goLive();
  const ping = host.socket.sent.at(-1);
  assert.equal(ping?.["type"], "ping");
  host.pass(12.5);
  host.socket.say({ type: "pong", sent_ns: ping?.["sent_ns"], time_ns: 99 });
  assert.equal(connection.status.roundTripMs, 12.5);
});

test("keeps pinging, and answers the server's pings", () => {
  goLive();
  host.pass(PING_EVERY_MS);
  assert.equal(host.socket.sent.filter(({ type }) => type === "ping").length, 2);
  host.socket.say({ type: "ping", sent_ns: 41 });
  const pong = host.socket.sent.at(-1);
  assert.equal(pong?.["type"], "pong");
  assert.equal(pong?.["sent_ns"], 41);
  assert.equal(pong?.["time_ns"], PING_EVERY_MS * 1e6);
});

test("a server that goes silent is left and asked again", () => {
  goLive();
  host.pass(PING_EVERY_MS * 3);
  assert.equal(connection.status.phase, "live");
  const first = host.socket;
  host.pass(PING_EVERY_MS);
  assert.equal(connection.status.fault?.kind, "silent");
  assert.ok(first.isClosed);
  host.pass(BACKOFF_BASE_MS);
  assert.equal(host.sockets.length, 2);
});

test("telemetry keeps a connection alive whose pongs are late", () => {
  goLive();
  for (let i = 0; i < 12; i++) {
    host.pass(PING_EVERY_MS);
    host.socket.say(decision(i));
  }
  assert.equal(connection.status.phase, "live");
});

test("waits longer after every failed attempt, up to a bound, and starts over once live", () => {
  connection.start();
  const waits: number[] = [];
  for (let i = 0; i < 10; i++) {
    host.socket.events.onClose(1006, "");
    assert.equal(connection.status.fault?.kind, "unreachable");
    const wait = (connection.status.retryAt ?? 0) - host.time;
    waits.push(wait);
    host.pass(wait);
  }
  assert.deepEqual(waits.slice(0, 4), [200, 400, 800, 1600]);
  assert.equal(waits.at(-1), BACKOFF_CAP_MS / 2);
  host.socket.events.onOpen();
  host.socket.say(WELCOME);
  host.socket.events.onClose(1006, "");
  assert.equal((connection.status.retryAt ?? 0) - host.time, 200);
});

test("an attempt that is refused outright is retried like any other", () => {
  host.isForbidden = true;
  connection.start();
  assert.equal(connection.status.phase, "waiting");
  host.isForbidden = false;
  host.pass(BACKOFF_BASE_MS);
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
  assert.equal((connection.status.retryAt ?? 0) - host.time, BACKOFF_CAP_MS);
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

test("a newer minor version is welcome, and types that it adds are passed on", () => {
  connection.start();
  host.socket.events.onOpen();
  host.socket.say({ ...WELCOME, protocol: "1.7" });
  host.socket.say({ type: "novelty" });
  assert.equal(connection.status.phase, "live");
  assert.equal(listener.messages.length, 2);
});

test("text that is no message is passed over", () => {
  goLive();
  for (const text of ["", "{", "null", "[1]", '{"kind":"pose"}', '{"type":3}']) {
    host.socket.events.onText(text);
  }
  assert.equal(listener.messages.length, 1);
  assert.equal(connection.status.phase, "live");
});

test("a socket that was left is not heard any more", () => {
  goLive();
  const old = host.socket;
  old.events.onClose(1006, "");
  host.pass(BACKOFF_BASE_MS);
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

test("stop leaves no timer behind", () => {
  goLive();
  connection.stop();
  assert.ok(host.socket.isClosed);
  host.pass(10 * BACKOFF_CAP_MS);
  assert.equal(host.sockets.length, 1);
  assert.equal(connection.status.phase, "stopped");
});
