/**
 * A renderer without a picture: carries commands out by their usual durations and prints what
 * happens, one JSON object a line. `effect` is what must happen once a command. The end of the
 * input is the goodbye.
 *
 *     node tools/renderer.ts --url ws://127.0.0.1:8765 --session demo --coding msgpack --step-scale 0.1
 */

import { parseArgs } from "node:util";
import { browserHost } from "../src/net/browser.ts";
import { RendererClient } from "../src/net/renderer.ts";
import { jsonCodec } from "../src/protocol/codec.ts";
import type { CommandMessage } from "../src/protocol/messages.ts";
import { msgpackCodec } from "../src/protocol/msgpack.ts";

const CODECS = { json: jsonCodec, msgpack: msgpackCodec };
/** A server that does not answer the goodbye is not waited for any longer. */
const GOODBYE_WITHIN_MS = 2_000;

const { values: given } = parseArgs({
  options: {
    url: { type: "string", default: "ws://127.0.0.1:8765" },
    session: { type: "string", default: "demo" },
    coding: { type: "string", default: "json" },
    "step-scale": { type: "string", default: "1" },
    token: { type: "string" },
    // Nothing but JSON is printed anyway.
    json: { type: "boolean" },
  },
});
const scale = Number(given["step-scale"]);
const codec = CODECS[given.coding as keyof typeof CODECS];
if (codec === undefined) throw new Error(`--coding is ${given.coding}: give json or msgpack`);
if (!(scale >= 0)) throw new Error(`--step-scale is ${given["step-scale"]}: give a number from 0`);

/** Stops the command under way; there is never more than one. */
let stop: () => void = () => {};

const client = new RendererClient(
  {
    server: given.url,
    session: given.session,
    client: { name: "console-renderer", version: "", token: given.token ?? null },
    codec,
  },
  browserHost,
  {
    onWelcome: ({ epoch, ledger, resumed }) => print("welcome", { epoch, ledger, resumed }),
    onCommand(command) {
      arrive(command);
      if (client.start(command.id)) carryOut(command, 0);
    },
    onCancel({ id }, reason) {
      stop();
      print("cancel", { id, reason });
    },
    onDifferences: (differences) => print("differences", { differences }),
    onError: ({ code, message }) => print("error", { code, message }),
    onUnreadable: ({ message }) => print("unreadable", { message }),
    onClockJump: (by_ms) => print("clock_jump", { by_ms }),
    onStatus: announce,
  },
);

let announced = "";

/** Print the phase, where it or its fault is another one. */
function announce(): void {
  const { phase, fault } = client.status;
  const state = JSON.stringify([phase, fault]);
  if (state === announced) return;
  announced = state;
  print("phase", { phase, fault });
}

/**
 * `latency_ns` is the time from the decision at the server to now, by the estimate of its clock, or
 * null before there is one; `direct_ns` the same on the clock that all processes of one machine
 * share.
 */
function arrive({ id, server_ns }: CommandMessage): void {
  const { serverNs, roundTripNs } = client;
  print("command", {
    id,
    latency_ns: serverNs === null ? null : serverNs - server_ns,
    direct_ns: Number(process.hrtime.bigint()) - server_ns,
    round_trip_ns: roundTripNs,
  });
}

function carryOut(command: CommandMessage, index: number): void {
  const { id, steps } = command;
  const step = steps[index];
  if (step === undefined) {
    if (client.done(id)) print("effect", { id });
    return;
  }
  stop = browserHost.after(step.duration_s * 1000 * scale, () => {
    client.progress(id, index);
    carryOut(command, index + 1);
  });
}

function print(event: string, more: object = {}): void {
  process.stdout.write(`${JSON.stringify({ event, ...more })}\n`);
}

function leave(): void {
  stop();
  client.close();
  print("end");
  setTimeout(() => process.exit(0), GOODBYE_WITHIN_MS).unref();
}

client.open();
process.stdin.on("end", leave);
process.stdin.resume();
