// Loads the .jslib as Emscripten would, and plays browser and program around it.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import vm from "node:vm";

class FakeWebSocket {
  static last = null;

  constructor(url, subprotocol) {
    if (url === "bad") throw new Error("the address cannot be read");
    Object.assign(this, { url, subprotocol, readyState: 0, bufferedAmount: 0, sent: [], closes: [] });
    FakeWebSocket.last = this;
  }

  send(data) {
    this.sent.push(data);
  }

  close(code, reason) {
    if (code !== 1000 && (code < 3000 || code > 4999)) throw new Error("InvalidAccessError");
    this.closes.push([code, reason]);
  }

  open() {
    this.readyState = 1;
    this.onopen();
  }
}

function load() {
  const texts = [];
  const context = {
    HEAPU8: new Uint8Array(1024),
    LibraryManager: { library: {} },
    TextDecoder,
    TextEncoder,
    Uint8Array,
    WebSocket: FakeWebSocket,
    UTF8ToString: (at) => texts[at],
    autoAddDeps: () => {},
    mergeInto: (library, functions) => Object.assign(library, functions),
  };
  vm.createContext(context);
  vm.runInContext(readFileSync(process.argv[2], "utf8"), context);
  const library = context.LibraryManager.library;
  context.agentSockets = library.$agentSockets;
  const text = (value) => texts.push(value) - 1;
  const open = (url = "ws://host/") => library.AgentServerOpen(text(url), text("agent-server.v1.json"));
  const put = (bytes) => (context.HEAPU8.set(bytes, 100), [100, bytes.length]);
  const take = (id) => {
    const size = library.AgentServerSize(id);
    library.AgentServerTake(id, 200);
    return Buffer.from(context.HEAPU8.slice(200, 200 + size));
  };
  return { library, open, put, take, text, sockets: context.agentSockets };
}

let passed = 0;
function test(name, body) {
  try {
    body(load());
    passed += 1;
  } catch (error) {
    console.error(`${name}: ${error.stack}`);
    process.exitCode = 1;
  }
}

test("a socket is opened with its subprotocol", ({ library, open }) => {
  const id = open();
  assert.equal(id, 1);
  assert.equal(FakeWebSocket.last.subprotocol, "agent-server.v1.json");
  assert.equal(FakeWebSocket.last.binaryType, "arraybuffer");
  assert.equal(library.AgentServerNext(id), 0);
});

test("events are taken in order, each once", ({ library, open, take }) => {
  const id = open();
  FakeWebSocket.last.open();
  FakeWebSocket.last.onmessage({ data: "grüße" });
  FakeWebSocket.last.onmessage({ data: new Uint8Array([1, 2, 3]).buffer });
  assert.equal(library.AgentServerNext(id), 1);
  take(id);
  assert.equal(library.AgentServerNext(id), 2);
  assert.equal(library.AgentServerSize(id), 7);
  assert.equal(take(id).toString(), "grüße");
  assert.equal(library.AgentServerNext(id), 3);
  assert.deepEqual([...take(id)], [1, 2, 3]);
  assert.equal(library.AgentServerNext(id), 0);
});

test("the end has its code and reason", ({ library, open, take }) => {
  const id = open();
  FakeWebSocket.last.onclose({ code: 4409, reason: "taken" });
  assert.equal(library.AgentServerNext(id), 4);
  assert.equal(library.AgentServerCode(id), 4409);
  assert.equal(take(id).toString(), "taken");
});

test("an address that cannot be read is an end", ({ library, open, take }) => {
  const id = open("bad");
  assert.equal(library.AgentServerNext(id), 4);
  assert.equal(library.AgentServerCode(id), 1006);
  assert.match(take(id).toString(), /cannot be read/);
  library.AgentServerClose(id, 1000, 0);
});

test("texts and bytes are sent", ({ library, open, put }) => {
  const id = open();
  FakeWebSocket.last.open();
  library.AgentServerSend(id, ...put(new TextEncoder().encode("grüße")), 1);
  library.AgentServerSend(id, ...put(new Uint8Array([7, 8])), 0);
  const [first, second] = FakeWebSocket.last.sent;
  assert.equal(first, "grüße");
  put(new Uint8Array([0, 0]));
  assert.deepEqual([...second], [7, 8], "a copy, which the heap does not change");
});

test("nothing is sent before it is open", ({ library, open, put }) => {
  const id = open();
  library.AgentServerSend(id, ...put(new Uint8Array([1])), 0);
  assert.deepEqual(FakeWebSocket.last.sent, []);
});

test("only codes that a page may say are said, and a goodbye stays one", ({ library, open, text }) => {
  for (const [code, said] of [[1000, 1000], [1001, 1000], [1002, 4000], [4410, 4410]]) {
    library.AgentServerClose(open(), code, text("why"));
    assert.deepEqual(FakeWebSocket.last.closes, [[said, "why"]]);
  }
});

test("a page that does not read loses its socket, not its memory", ({ library, open, sockets }) => {
  const id = open();
  FakeWebSocket.last.open();
  for (let i = 0; i < 10000; i += 1) FakeWebSocket.last.onmessage({ data: "pose" });
  assert.ok(sockets.byId[id].events.length <= 1);
  assert.equal(library.AgentServerNext(id), 4);
  assert.equal(library.AgentServerCode(id), 4000);
  assert.equal(FakeWebSocket.last.closes.length, 1);
});

test("what waits is told", ({ library, open }) => {
  const id = open();
  FakeWebSocket.last.bufferedAmount = 12;
  assert.equal(library.AgentServerWaiting(id), 12);
});

test("a socket that is over is forgotten", ({ library, open, sockets }) => {
  const id = open();
  FakeWebSocket.last.onclose({ code: 1000, reason: "" });
  library.AgentServerFree(id);
  assert.deepEqual(Object.keys(sockets.byId), []);
  assert.equal(library.AgentServerNext(id), 0);
  library.AgentServerClose(id, 1000, 0);
});

console.log(`${passed} passed`);
