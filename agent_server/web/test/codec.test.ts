import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { ProtocolError } from "../src/protocol/check.ts";
import { jsonCodec, type Codec, type Wire } from "../src/protocol/codec.ts";
import { msgpackCodec } from "../src/protocol/msgpack.ts";
import type { CommandMessage, Hello } from "../src/protocol/messages.ts";
import { WELCOME, affectState, commanded, decision } from "./fakes.ts";

interface Fixture {
  readonly name: string;
  readonly direction: "client" | "server";
  readonly outcome: "ok" | "unknown" | "error";
  readonly json: string | null;
  readonly json_binary_hex: string | null;
  readonly msgpack_hex: string | null;
  readonly json_again: string | null;
  readonly msgpack_hex_again: string | null;
}

const path = new URL("../../../tests/fixtures/protocol/messages.json", import.meta.url);
const fixtures = JSON.parse(readFileSync(path, "utf8")) as readonly Fixture[];

/** JSON as JavaScript writes it: zero has no sign, whole numbers no point. */
const compact = (json: string): string => JSON.stringify(JSON.parse(json));
const bytes = (hex: string): Uint8Array<ArrayBuffer> => new Uint8Array(Buffer.from(hex, "hex"));
const hex = (wire: Wire): string => Buffer.from(wire).toString("hex");

function decode(codec: Codec, { direction }: Pick<Fixture, "direction">, data: Wire) {
  return direction === "client" ? codec.decodeClient(data) : codec.decodeServer(data);
}

/** The field that a message is refused for; null for the message as a whole. */
function refused(codec: Codec, direction: Fixture["direction"], data: Wire): string | null {
  try {
    decode(codec, { direction }, data);
  } catch (error) {
    assert.ok(error instanceof ProtocolError, String(error));
    return error.field;
  }
  assert.fail("it was read");
}

test("messages of every kind are written again as the server writes them", () => {
  const good = fixtures.filter(({ outcome }) => outcome === "ok");
  assert.ok(good.length > 50);
  for (const fixture of good) {
    const { name, json, json_binary_hex, msgpack_hex, json_again, msgpack_hex_again } = fixture;
    if (json !== null && json_again !== null) {
      const message = decode(jsonCodec, fixture, json);
      assert.ok(message !== null, name);
      assert.equal(jsonCodec.encode(message), compact(json_again), name);
      if (msgpack_hex !== null) {
        assert.deepEqual(decode(msgpackCodec, fixture, bytes(msgpack_hex)), message, name);
      }
    }
    if (json_binary_hex !== null) {
      const message = decode(jsonCodec, fixture, bytes(json_binary_hex));
      assert.ok(message !== null, name);
      assert.equal(hex(jsonCodec.encode(message)), json_binary_hex, name);
    }
    if (msgpack_hex !== null && msgpack_hex_again !== null) {
      const message = decode(msgpackCodec, fixture, bytes(msgpack_hex));
      assert.ok(message !== null, name);
      assert.equal(hex(msgpackCodec.encode(message)), msgpack_hex_again, name);
    }
  }
});

test("types that are not known are passed over, what is broken is refused", () => {
  const other = fixtures.filter(({ outcome }) => outcome !== "ok");
  assert.ok(other.length > 20);
  for (const { name, direction, outcome, json, msgpack_hex } of other) {
    const codec = json === null ? msgpackCodec : jsonCodec;
    const data = json ?? bytes(msgpack_hex ?? "");
    if (outcome === "unknown") assert.equal(decode(codec, { direction }, data), null, name);
    else refused(codec, direction, data);
  }
});

test("what was left out holds its default when it was read", () => {
  const text = jsonCodec.encode({ type: "hello", protocol: "1.0", client: "a" });
  assert.equal(text, '{"type":"hello","protocol":"1.0","client":"a"}');
  const hello = jsonCodec.decodeClient(text) as Hello;
  assert.deepEqual([hello.face, hello.capabilities, hello.token], ["expected", [], null]);
  const command = commanded();
  for (const codec of [jsonCodec, msgpackCodec]) {
    const wire = codec.encode(command);
    const names = Buffer.from(wire).toString("latin1");
    for (const name of ["preempts", "age_ms", "server_ns"]) assert.ok(!names.includes(name));
    assert.deepEqual(codec.decodeServer(wire), command);
  }
});

test("what is refused is named by its path", () => {
  const { objects: _, ...roomless } = WELCOME.scene;
  const cases: readonly (readonly [object, string])[] = [
    [{ ...WELCOME, scene: roomless }, "scene.objects"],
    [{ ...WELCOME, labels: ["cold", 3] }, "labels[1]"],
    [{ ...WELCOME, decide: { enter: { cold: 2 }, leave: 0 } }, 'decide.enter["cold"]'],
    [{ ...WELCOME, heartbeat_s: "2" }, "heartbeat_s"],
    [{ ...WELCOME, protocol: "one" }, "protocol"],
    [{ ...WELCOME, session: null }, "session"],
    [commanded({ steps: [{ action: "", duration_s: 1, target: null }] }), "steps[0].action"],
    [commanded({ age_ms: 0.5 }), "age_ms"],
    [commanded({ server_ns: 2 ** 53 }), "server_ns"],
    [commanded({ server_ns: -1 }), "server_ns"],
    [{ type: "pose", originating_ns: 1, body_id: 0, joints: [[0, 0, 0]] }, "joints[0]"],
    [{ type: "pose", originating_ns: 1, body_id: 0, joints: [[0, 0, true, 1]] }, "joints[0][2]"],
    [decision(1, { probabilities: { cold: -0.1 } }), 'decision.probabilities["cold"]'],
    [{ mode: "working" }, "type"],
  ];
  for (const [message, field] of cases) {
    assert.equal(refused(jsonCodec, "server", JSON.stringify(message)), field);
  }
  assert.equal(refused(jsonCodec, "client", '{"type":"ack","command_id":"a","status":"won"}'), "status");
  const seconds = (n: number) => `{"type":"calibrate","originating_ns":1,"seconds":${n}}`;
  assert.equal(refused(jsonCodec, "client", seconds(0)), "seconds");
  assert.notEqual(jsonCodec.decodeClient(seconds(1e-9)), null);
});

test("a message that does not fit is not sent", () => {
  const gaze = { type: "gaze", originating_ns: 1, origin: [0, 0, 0] } as const;
  for (const codec of [jsonCodec, msgpackCodec]) {
    for (const wrong of [Number.NaN, Number.POSITIVE_INFINITY]) {
      assert.throws(() => codec.encode({ ...gaze, direction: [0, wrong, 0] }), {
        name: "ProtocolError",
        field: "direction[1]",
      });
    }
    assert.throws(() => codec.encode({ type: "novelty" } as never), { field: "type" });
    const half = { type: "scene_event", object: "\ud83c", state: "on" } as const;
    assert.throws(() => codec.encode(half), { field: "object" });
  }
});

test("lengths of texts are counted in code points", () => {
  const event = (object: string) => ({ type: "scene_event", object, state: "on" }) as const;
  assert.ok(jsonCodec.encode(event("\u{1f3a5}".repeat(64))));
  assert.throws(() => jsonCodec.encode(event("\u{1f3a5}".repeat(65))), { field: "object" });
});

test("names that objects of the language have are names like others", () => {
  const text = '{"type":"scene","mode":"working","objects":{"__proto__":"open","constructor":"x"}}';
  const scene = jsonCodec.decodeServer(text);
  assert.ok(scene !== null);
  assert.deepEqual(msgpackCodec.decodeServer(msgpackCodec.encode(scene)), scene);
  assert.equal(Object.keys((scene as { objects: object }).objects).length, 2);
  assert.equal(refused(jsonCodec, "server", '{"type":"scene","mode":"working","__proto__":{"objects":{}}}'), "objects");
});

test("every number of MessagePack is read, and integers are written in their smallest form", () => {
  const forms: readonly (readonly [number, string])[] = [
    [0, "00"],
    [127, "7f"],
    [128, "cc80"],
    [256, "cd0100"],
    [65_536, "ce00010000"],
    [2 ** 32, "cf0000000100000000"],
    [Number.MAX_SAFE_INTEGER, "cf001fffffffffffff"],
  ];
  const head = "82a474797065a470696e67a773656e745f6e73";
  for (const [n, form] of forms) {
    assert.equal(hex(msgpackCodec.encode({ type: "ping", sent_ns: n })), head + form);
    assert.deepEqual(msgpackCodec.decodeClient(bytes(head + form)), { type: "ping", sent_ns: n });
  }
  // Larger than they need to be, and signed.
  for (const form of ["d005", "d10005", "d200000005", "d30000000000000005", "cc05"]) {
    assert.deepEqual(msgpackCodec.decodeClient(bytes(head + form)), { type: "ping", sent_ns: 5 });
  }
  for (const form of ["ff", "d0ff", "cfffffffffffffffff", "c0", "c3", "a0", "cb3ff8000000000000"]) {
    assert.equal(refused(msgpackCodec, "client", bytes(head + form)), "sent_ns");
  }
  const affect = { type: "affect", originating_ns: 1, valence: -1, arousal: 0.5 } as const;
  assert.match(hex(msgpackCodec.encode(affect)), /cbbff0000000000000.*cb3fe0000000000000$/);
  // A whole number and a float of 32 bits are numbers all the same.
  const written = hex(msgpackCodec.encode(affect));
  const short = written.replace("cbbff0000000000000", "ff").replace("cb3fe0000000000000", "ca3f000000");
  assert.deepEqual(msgpackCodec.decodeClient(bytes(short)), affect);
});

test("unknown fields are passed over, whatever they hold", () => {
  const head = (n: number) => `8${n}a474797065a57363656e65a46d6f6465a177a76f626a6563747380`;
  const read = { type: "scene", mode: "w", objects: {}, command_id: null };
  for (const value of ["d40500", "c70105ff", "8101c0", "c403010203", "93c2c3c0", "cfffffffffffffffff"]) {
    assert.deepEqual(msgpackCodec.decodeServer(bytes(`${head(4)}a178${value}`)), read);
  }
  // A key that is no text belongs to no message.
  assert.equal(refused(msgpackCodec, "server", bytes(`${head(4)}0505`)), null);
});

test("a message cut short anywhere is refused, and so is one with a flipped byte, or it is read", () => {
  const wire = msgpackCodec.encode(WELCOME) as Uint8Array<ArrayBuffer>;
  for (let n = 0; n < wire.length; n++) refused(msgpackCodec, "server", wire.slice(0, n));
  for (let i = 0; i < wire.length; i++) {
    for (const mask of [0x01, 0x80, 0xff]) {
      const broken = wire.slice();
      broken[i] = (broken[i] ?? 0) ^ mask;
      try {
        msgpackCodec.decodeServer(broken);
      } catch (error) {
        assert.ok(error instanceof ProtocolError, String(error));
      }
    }
  }
});

test("lengths that lie cost nothing, and depth has an end", () => {
  for (const lie of ["dd7fffffff", "df7fffffff", "c67fffffff", "db7fffffff", "c97fffffff05", "dcffff"]) {
    const before = performance.now();
    refused(msgpackCodec, "server", bytes(`81a474797065${lie}`));
    assert.ok(performance.now() - before < 200);
  }
  const deep = 100_000;
  refused(msgpackCodec, "server", bytes(`82a474797065a470696e67a178${"91".repeat(deep)}c0`));
  const text = `{"type":"ping","sent_ns":1,"x":${"[".repeat(deep)}${"]".repeat(deep)}}`;
  refused(jsonCodec, "server", text);
});

test("an image is a binary message in the JSON coding too", () => {
  const image = { type: "image", originating_ns: 1_000_001, jpeg: new Uint8Array([1, 2]) } as const;
  const frame = jsonCodec.encode(image) as Uint8Array<ArrayBuffer>;
  assert.deepEqual([...frame], [65, 70, 74, 49, 0, 0, 0, 0, 65, 66, 15, 0, 0, 0, 0, 0, 1, 2]);
  assert.deepEqual(jsonCodec.decodeClient(frame), image);
  const changed = (at: number, to: number) => frame.with(at, to);
  assert.equal(refused(jsonCodec, "client", changed(0, 66)), null);
  assert.equal(refused(jsonCodec, "client", changed(4, 1)), "flags");
  assert.equal(refused(jsonCodec, "client", changed(15, 255)), "originating_ns");
  assert.equal(refused(jsonCodec, "client", changed(15, 1)), "originating_ns");
  assert.equal(refused(jsonCodec, "client", frame.slice(0, 16)), null);
  assert.throws(() => jsonCodec.encode({ ...image, originating_ns: -1 }), { field: "originating_ns" });
});

test("text in MessagePack and binary in JSON are refused", () => {
  refused(msgpackCodec, "server", "{}");
  refused(jsonCodec, "server", bytes("80"));
});

test("affect keeps the precision of its numbers", () => {
  const state = affectState(1, 0.1 + 0.2, -1e-7);
  for (const codec of [jsonCodec, msgpackCodec]) {
    assert.deepEqual(codec.decodeServer(codec.encode(state)), state);
  }
});

test("a list of sixteen and a text of 32 bytes need longer heads", () => {
  const step = { action: "walk", duration_s: 1, target: null };
  const command: CommandMessage = commanded({ steps: Array(16).fill(step), reaction: "r".repeat(32) });
  const wire = msgpackCodec.encode(command);
  assert.match(hex(wire), /dc0010/);
  assert.match(hex(wire), /d920(72){32}/);
  assert.deepEqual(msgpackCodec.decodeServer(wire), command);
});
