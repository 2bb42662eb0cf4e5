/** The codings of a message, and the one that is JSON text. */

import { ProtocolError, checkDepth, checked, isMap } from "./check.ts";
import type { RecordLayout } from "./kinds.ts";
import { CLIENT_JSON, SERVER_JSON, SUBPROTOCOL_JSON } from "./layout.ts";
import type {
  ClientMessage,
  Image,
  PackedClientMessage,
  PackedServerMessage,
  ServerMessage,
} from "./messages.ts";

/** What a websocket carries. */
export type Wire = string | Uint8Array<ArrayBuffer>;
/** What a client sends, in either coding. */
export type Outgoing = ClientMessage | PackedClientMessage;
/** What a server sends, in either coding. */
export type Incoming = ServerMessage | PackedServerMessage;

/** Turns messages into what a websocket carries, and back. */
export interface Codec {
  /** Name of the websocket subprotocol. */
  readonly subprotocol: string;
  /**
   * Fields that hold their default are left out.
   *
   * @throws {ProtocolError} If the message does not fit its layout.
   */
  encode(message: Outgoing | Incoming): Wire;
  /**
   * Fields that were left out hold their default; unknown ones are left behind.
   *
   * @returns The message, or null for one of a type that this version does not know.
   * @throws {ProtocolError} Naming what cannot be read, and the field.
   */
  decodeServer(data: Wire): Incoming | null;
  /** The same for what a client sent. */
  decodeClient(data: Wire): Outgoing | null;
}

/** Layouts by the `type` of their message. */
export type Table = ReadonlyMap<string, RecordLayout>;

export function tableOf(...layouts: readonly (readonly RecordLayout[])[]): Table {
  return new Map(layouts.flat().map((layout) => [layout.tag ?? layout.name, layout]));
}

/** @returns The message with every field, or null where the table does not have its type. */
export function fromTable(table: Table, value: unknown): object | null {
  const layout = layoutOf(table, value);
  return layout === null ? null : checked(layout, value, "filled");
}

/** @returns The layout and what is to be written. */
export function toTable(table: Table, message: object): readonly [RecordLayout, object] {
  const layout = layoutOf(table, message);
  if (layout === null) throw new ProtocolError("this coding has no such message", "type");
  return [layout, checked(layout, message, "omitted")];
}

function layoutOf(table: Table, value: unknown): RecordLayout | null {
  if (!isMap(value)) throw new ProtocolError("expected a map");
  const { type } = value as { readonly type?: unknown };
  if (type === undefined) throw new ProtocolError("it is missing", "type");
  if (typeof type !== "string") throw new ProtocolError("expected text", "type");
  return table.get(type) ?? null;
}

const fromClient = tableOf(CLIENT_JSON);
const fromServer = tableOf(SERVER_JSON);
const fromEither = tableOf(CLIENT_JSON, SERVER_JSON);

/** Text messages; an image is a binary one. */
export const jsonCodec: Codec = {
  subprotocol: SUBPROTOCOL_JSON,
  encode(message) {
    if (message.type === "image") return imageFrame(message);
    return JSON.stringify(toTable(fromEither, message)[1]);
  },
  decodeServer(data) {
    if (typeof data !== "string") throw wrongCoding(data);
    return fromTable(fromServer, parsed(data)) as Incoming | null;
  },
  decodeClient(data) {
    if (typeof data !== "string") return imageOf(data);
    return fromTable(fromClient, parsed(data)) as Outgoing | null;
  },
};

function parsed(text: string): unknown {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (error) {
    const reason = error instanceof Error ? error.message : "no JSON";
    throw new ProtocolError(`the message cannot be read: ${reason}`);
  }
  checkDepth(value);
  return value;
}

/** `AFJ1` */
const MAGIC = [0x41, 0x46, 0x4a, 0x31];
const FLAGS_AT = 4;
const STAMP_AT = 8;
const HEADER_BYTES = 16;

/** `AFJ1`, flags, the stamp in 64 bits, all little-endian, and the JPEG. */
function imageFrame({ originating_ns, jpeg }: Image): Uint8Array<ArrayBuffer> {
  const frame = new Uint8Array(HEADER_BYTES + jpeg.length);
  frame.set(MAGIC);
  new DataView(frame.buffer).setBigInt64(STAMP_AT, BigInt(stamp(originating_ns)), true);
  frame.set(jpeg, HEADER_BYTES);
  return frame;
}

function imageOf(frame: Uint8Array<ArrayBuffer>): Image {
  if (!MAGIC.every((byte, i) => frame[i] === byte)) throw wrongCoding(frame);
  if (frame.length <= HEADER_BYTES) {
    throw new ProtocolError(`the image has ${frame.length} bytes, its header alone ${HEADER_BYTES}`);
  }
  const view = new DataView(frame.buffer, frame.byteOffset);
  const flags = view.getUint32(FLAGS_AT, true);
  if (flags !== 0) throw new ProtocolError(`expected 0, got ${flags}`, "flags");
  const originating_ns = stamp(Number(view.getBigInt64(STAMP_AT, true)));
  return { type: "image", originating_ns, jpeg: frame.slice(HEADER_BYTES) };
}

function stamp(ns: number): number {
  if (Number.isSafeInteger(ns) && ns >= 0) return ns;
  throw new ProtocolError(`expected nanoseconds from 0 up to 2^53 - 1, got ${ns}`, "originating_ns");
}

function wrongCoding(data: Uint8Array): ProtocolError {
  return new ProtocolError(`expected text in JSON, got ${data.length} bytes of binary`);
}
