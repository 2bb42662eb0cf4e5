/**
 * Reads messages in both codings and writes them again, for a comparison with other languages.
 *
 *     node tools/fixtures.ts FILE
 *
 * The file is a list of `{name, direction, json, json_binary_hex, msgpack_hex}`; what is not there
 * is null, or left out. For each entry a line is printed: `{name, outcome: "ok"}` with the same
 * three as they are when written again, or `{name, outcome}` with `unknown` or `error` (and
 * `field`, `message`) where nothing was read. What was read as JSON is written as MessagePack, and
 * the other way round, where both are given; `mixed` says that the two did not come to the same.
 */

import { readFileSync } from "node:fs";
import { ProtocolError } from "../src/protocol/check.ts";
import { jsonCodec, type Codec, type Incoming, type Outgoing, type Wire } from "../src/protocol/codec.ts";
import { msgpackCodec } from "../src/protocol/msgpack.ts";

interface Fixture {
  readonly name: string;
  readonly direction: "client" | "server";
  readonly json?: string | null;
  readonly json_binary_hex?: string | null;
  readonly msgpack_hex?: string | null;
}

type Message = Incoming | Outgoing;

type Outcome =
  | { readonly outcome: "ok"; readonly message: Message }
  | { readonly outcome: "unknown" }
  | { readonly outcome: "error"; readonly field: string | null; readonly message: string };

function outcomeOf(codec: Codec, direction: Fixture["direction"], data: Wire): Outcome {
  try {
    const message = direction === "client" ? codec.decodeClient(data) : codec.decodeServer(data);
    return message === null ? { outcome: "unknown" } : { outcome: "ok", message };
  } catch (error) {
    if (!(error instanceof ProtocolError)) throw error;
    return { outcome: "error", field: error.field, message: error.message };
  }
}

function answerTo(fixture: Fixture): object {
  const { name, direction, json = null, json_binary_hex = null, msgpack_hex = null } = fixture;
  const jsonWire = json ?? (json_binary_hex === null ? null : bytesOf(json_binary_hex));
  const text = jsonWire === null ? null : outcomeOf(jsonCodec, direction, jsonWire);
  const packed =
    msgpack_hex === null ? null : outcomeOf(msgpackCodec, direction, bytesOf(msgpack_hex));
  const outcomes = [text, packed].filter((one) => one !== null);
  const [first] = outcomes;
  if (outcomes.some(({ outcome }) => outcome !== first?.outcome)) {
    return { name, outcome: "mixed", text, packed };
  }
  if (first?.outcome !== "ok") return { name, ...first };
  const fromText = text?.outcome === "ok" ? text.message : null;
  const fromPacked = packed?.outcome === "ok" ? packed.message : null;
  const again = fromText === null ? null : jsonCodec.encode(fromPacked ?? fromText);
  return {
    name,
    outcome: "ok",
    json: typeof again === "string" ? again : null,
    json_binary_hex: again instanceof Uint8Array ? hexOf(again) : null,
    msgpack_hex: fromPacked === null ? null : hexOf(msgpackCodec.encode(fromText ?? fromPacked)),
  };
}

function bytesOf(hex: string): Uint8Array<ArrayBuffer> {
  return new Uint8Array(Buffer.from(hex, "hex"));
}

function hexOf(wire: Wire): string {
  return Buffer.from(wire).toString("hex");
}

const [file] = process.argv.slice(2);
if (file === undefined) throw new Error("give the file of messages");
const fixtures = JSON.parse(readFileSync(file, "utf8")) as readonly Fixture[];
for (const fixture of fixtures) {
  process.stdout.write(`${JSON.stringify(answerTo(fixture))}\n`);
}
