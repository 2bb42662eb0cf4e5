import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4, Vector3 } from "three";
import { placeOf } from "../src/place.ts";
import { GazeSender, gazeOf } from "../src/room/gaze_sender.ts";
import { FakeHost, WELCOME } from "./fakes.ts";

const AGENT = new Vector3(0, 1.2, -0.4);
const round = (values: readonly number[]): number[] => values.map((value) => Number(value.toFixed(6)) + 0);

test("whoever stands before the agent and looks straight ahead looks along -z", () => {
  const head = new Matrix4().makeTranslation(0, 1.6, 2.6);
  const { origin, direction } = gazeOf(head, AGENT);
  assert.deepEqual(round(origin), [0, 0.4, 3]);
  assert.deepEqual(round(direction), [0, 0, -1]);
});

test("a head that turns left looks to the room's left", () => {
  const head = new Matrix4().makeRotationY(Math.PI / 2);
  assert.deepEqual(round(gazeOf(head, AGENT).direction), [-1, 0, 0]);
});

test("the gaze is sent ten times a second, by a sensor whose face is the gaze", () => {
  const host = new FakeHost();
  const sender = new GazeSender(
    placeOf("http://host/?session=lab"),
    { name: "page", version: "1", token: null },
    host,
  );
  host.socket.events.onOpen();
  assert.equal(host.socket.sent[0]?.["face"], "gaze");
  host.socket.say({ ...WELCOME, role: "sensor" });
  const head = new Matrix4();
  for (let ms = 0; ms < 1_000; ms += 11) {
    sender.look(head, AGENT);
    host.pass(11);
  }
  const sent = host.socket.sent.filter(({ type }) => type === "gaze");
  assert.ok(sent.length === 9 || sent.length === 10, `${sent.length}`);
  const stamps = sent.map(({ originating_ns }) => originating_ns as number);
  assert.deepEqual(stamps, [...stamps].sort((a, b) => a - b));
});
