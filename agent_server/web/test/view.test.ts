import assert from "node:assert/strict";
import { test } from "node:test";
import type { Fault, Status } from "../src/net/status.ts";
import { readDirectory, type Directory } from "../src/net/directory.ts";
import { placeOf } from "../src/place.ts";
import type { SceneState } from "../src/protocol/messages.ts";
import { COMMAND, SCENE, ackState, decision } from "./fakes.ts";
import { progressOf, type Running } from "../src/state/running.ts";
import { Store } from "../src/state/store.ts";
import { problemOf, sensorState, type SensorState } from "../src/state/view.ts";
import {
  endText,
  endWord,
  errorWord,
  level,
  missedText,
  reasonOf,
  sentenceCase,
  sessionTime,
  signedSeconds,
} from "../src/state/words.ts";

const place = placeOf("https://host/some/prefix/?session=lab%201&step#token=a%2Bb");

const listed = (sensor: boolean): Directory => ({
  kind: "listed",
  sessions: [{ id: "lab 1", sensor }],
});

function waiting(fault: Fault): Status {
  return { phase: "waiting", fault, retryAt: 5, roundTripMs: null, offsetMs: null };
}

const live: Status = { phase: "live", fault: null, retryAt: null, roundTripMs: null, offsetMs: null };

test("the page's address says the session, the token and the server's paths", () => {
  assert.deepEqual(place, {
    session: "lab 1",
    token: "a+b",
    isStepped: true,
    serverUrl: "https://host/some/prefix/",
    monitorUrl: "wss://host/some/prefix/v1/sessions/lab%201/monitor",
    sensorUrl: "wss://host/some/prefix/v1/sessions/lab%201/sensor",
    sessionUrl: "https://host/some/prefix/v1/sessions/lab%201/",
    directoryUrl: "https://host/some/prefix/v1/sessions",
    standInUrl: "https://host/some/prefix/v1/stand-in",
    streamsUrl: "https://host/some/prefix/v1/streams",
    modelsUrl: "https://host/some/prefix/v1/models/",
    labelUrl: "https://host/some/prefix/label.html#token=a%2Bb",
    sendsPictures: false,
  });
  const plain = placeOf("http://127.0.0.1:8765/");
  assert.equal(plain.session, "demo");
  assert.equal(plain.token, null);
  assert.equal(plain.monitorUrl, "ws://127.0.0.1:8765/v1/sessions/demo/monitor");
});

test("the sensor is live while poses come, else what the directory says", () => {
  const store = new Store();
  assert.equal(sensorState(store, { kind: "unknown" }, place, 0), "unknown");
  assert.equal(sensorState(store, listed(false), place, 0), "none");
  assert.equal(sensorState(store, { kind: "listed", sessions: [] }, place, 0), "none");
  store.apply({ type: "pose", originating_ns: 1, body_id: 1, joints: [] }, 100);
  assert.equal(sensorState(store, listed(false), place, 1_000), "live");
  assert.equal(sensorState(store, listed(true), place, 5_000), "no_body");
});

test("each trouble is named, with the address or the server's own words", () => {
  const unknown: Directory = { kind: "unknown" };
  const ask = (status: Status, directory: Directory = unknown, sensor: SensorState = "live") =>
    problemOf(status, directory, sensor, place, false);
  assert.equal(ask(live), null);
  assert.equal(ask({ ...live, phase: "opening" })?.kind, "connecting");
  assert.match(ask(live, listed(false), "none")?.text ?? "", /lab%201\/sensor/);
  assert.equal(ask(live, listed(true), "no_body")?.kind, "no_body");
  const gone = ask(waiting({ kind: "unreachable" }), { kind: "unreachable" });
  assert.equal(gone?.kind, "unreachable");
  assert.match(gone?.text ?? "", /wss:\/\/host/);
  assert.equal(gone?.retryAt, 5);
  const version = ask(waiting({ kind: "version", message: "speaks 2.0" }));
  assert.equal(version?.kind, "version");
  assert.match(version?.text ?? "", /speaks 2\.0/);
  assert.match(ask(waiting({ kind: "lost", closeCode: 4429, reason: "full" }))?.text ?? "", /full/);
  assert.equal(ask(waiting({ kind: "silent" }))?.kind, "lost");
});

test("a connection that is given up says so, and offers to connect again", () => {
  const fault: Fault = { kind: "lost", closeCode: 4409, reason: "taken over" };
  const unknown: Directory = { kind: "unknown" };
  const ask = (status: Status) => problemOf(status, unknown, "live", place, false);
  const problem = ask({ ...waiting(fault), phase: "stopped", retryAt: null });
  assert.equal(problem?.isGivenUp, true);
  assert.match(problem?.text ?? "", /taken over.*does not come back by itself/);
  assert.equal(ask(waiting(fault))?.isGivenUp, false);
});

test("a server that answers but opens no session is told from one that is gone", () => {
  const fault = waiting({ kind: "unreachable" });
  const other: Directory = { kind: "listed", sessions: [{ id: "kitchen", sensor: true }] };
  assert.match(problemOf(fault, other, "live", place, false)?.text ?? "", /kitchen/);
  const token = problemOf(fault, { kind: "refused", status: 401 }, "live", place, false);
  assert.match(token?.title ?? "", /token/);
});

test("the directory is read with the token, and every failure is an answer", async () => {
  const asked: RequestInit[] = [];
  const answer = (body: unknown, status = 200) => (_url: string, init: RequestInit) => {
    asked.push(init);
    return Promise.resolve(new Response(JSON.stringify(body), { status }));
  };
  const sessions = [{ id: "demo", sensor: true, more: 1 }, { id: "x" }, { sensor: true }, 3];
  assert.deepEqual(await readDirectory("u", "t", answer({ sessions })), {
    kind: "listed",
    sessions: [
      { id: "demo", sensor: true },
      { id: "x", sensor: false },
    ],
  });
  assert.deepEqual(asked[0]?.headers, { authorization: "Bearer t" });
  assert.deepEqual(await readDirectory("u", null, answer({}, 403)), { kind: "refused", status: 403 });
  assert.deepEqual(await readDirectory("u", null, answer([])), { kind: "listed", sessions: [] });
  const down = () => Promise.reject(new TypeError("down"));
  assert.deepEqual(await readDirectory("u", null, down), { kind: "unreachable" });
});

test("a command's progress is the renderer's word, or the usual time where none speaks", () => {
  const silent: Running = { command: COMMAND, at: 0, status: null, step: null, reason: null };
  const busy = { ...SCENE, mode: "reacting", command_id: COMMAND.id };
  const ask = (running: Running, now: number, scene: SceneState = busy) =>
    progressOf(running, scene, now);
  assert.deepEqual(ask(silent, 500), { state: "under_way", step: 0, isReported: false });
  assert.deepEqual(ask(silent, 1_500), { state: "under_way", step: 1, isReported: false });
  assert.equal(ask(silent, 60_000).step, 1);
  assert.equal(ask(silent, 3_000, SCENE).state, "done");
  assert.equal(ask(silent, 1_000, SCENE).state, "ended");
  const spoken = { ...silent, status: "progress", step: 0 };
  assert.deepEqual(ask(spoken, 60_000), { state: "under_way", step: 0, isReported: true });
  assert.equal(ask({ ...spoken, status: "done" }, 0).state, "done");
  for (const status of ["failed", "expired", "preempted", "timed_out"]) {
    assert.equal(ask({ ...spoken, status }, 0, SCENE).state, "failed");
  }
  const assumed = ask({ ...spoken, status: "assumed" }, 0, SCENE);
  assert.deepEqual(assumed, { state: "done", step: null, isReported: false });
});

test("names and numbers in words", () => {
  assert.equal(sentenceCase("close_window"), "Close window");
  assert.equal(sessionTime(64_250_000_000), "1:04.2");
  assert.equal(level(-3.04), "\u22123.0");
  assert.equal(level(-0.01), "0.0");
  assert.equal(sentenceCase("turn_down_hifi"), "Turn down hi-fi");
  const { decision: quiet } = decision(0);
  assert.equal(reasonOf({ ...quiet, gesture: "cold", reason: "cold: busy" }), "Busy");
  assert.equal(reasonOf({ ...quiet, reason: "cold: busy" }), "Cold: busy");
  const scene = { mode: "working", rule: "r", precondition: "window = open", met: true, reason: "" };
  const command = { ...quiet, outcome: "command", gesture: "cold", reason: "cold: free", scene };
  assert.equal(reasonOf(command), "Window = open, free");
});

test("ends, missed telemetry and what is no error are said in words", () => {
  assert.equal(endText(ackState("expired"), "close_window"), "Close window: nobody started it in time");
  const word = ackState("failed", { reason: "preempted" });
  assert.equal(endText(word, null), "Demo-c1: another command came");
  assert.equal(endText(ackState("failed", { reason: "it is stuck" }), "greet"), "Greet: it is stuck");
  assert.equal(endWord("timed_out"), "Timed out");
  assert.equal(endWord("failed"), "Failed");
  assert.match(missedText({ pose: 1_200, affect_state: 1 }), /1,200 pose, 1 affect state/);
  assert.equal(errorWord("scene_differs"), "Room differs");
  assert.equal(errorWord("no_model"), "Error");
  assert.equal(signedSeconds(-1_234.6), "\u22121.235 s");
});

test("a page whose camera is the only sensor asks for a body, not for a sensor", () => {
  const asked = problemOf(live, listed(true), "no_body", place, true);
  assert.equal(asked?.kind, "no_body");
  assert.match(asked?.text ?? "", /camera of this page sends the face/);
  assert.equal(problemOf(live, listed(true), "live", place, true), null);
});
