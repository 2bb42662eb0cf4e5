/** The coding that is MessagePack, byte for byte as the server writes it. */

import { MAX_DEPTH, OTHER, ProtocolError, tooDeep } from "./check.ts";
import { fromTable, tableOf, toTable, type Codec, type Incoming, type Outgoing } from "./codec.ts";
import type { Kind, RecordLayout } from "./kinds.ts";
import { CLIENT_MSGPACK, SERVER_MSGPACK, SUBPROTOCOL_MSGPACK } from "./layout.ts";

const fromClient = tableOf(CLIENT_MSGPACK);
const fromServer = tableOf(SERVER_MSGPACK);
const fromEither = tableOf(CLIENT_MSGPACK, SERVER_MSGPACK);

/** Binary messages, with joints and points as packed float32. */
export const msgpackCodec: Codec = {
  subprotocol: SUBPROTOCOL_MSGPACK,
  encode(message) {
    const [layout, fields] = toTable(fromEither, message);
    const writer = new Writer();
    writer.record(layout, fields);
    return writer.taken();
  },
  decodeServer: (data) => fromTable(fromServer, unpacked(data)) as Incoming | null,
  decodeClient: (data) => fromTable(fromClient, unpacked(data)) as Outgoing | null,
};

function unpacked(data: string | Uint8Array<ArrayBuffer>): unknown {
  if (typeof data === "string") {
    throw new ProtocolError(`expected MessagePack, got ${data.length} characters of text`);
  }
  const reader = new Reader(data);
  const value = reader.value(0);
  reader.end();
  return value;
}

const FIRST_ROOM = 256;
/** A list or map of so many items has their number in its tag. */
const SHORT = 15;

/** Writes values that were checked; their layout tells integers and floats apart. */
class Writer {
  #bytes = new Uint8Array(FIRST_ROOM);
  #view = new DataView(this.#bytes.buffer);
  #at = 0;

  taken(): Uint8Array<ArrayBuffer> {
    return this.#bytes.slice(0, this.#at);
  }

  record(layout: RecordLayout, value: object): void {
    const held = value as Readonly<Record<string, unknown>>;
    const n = Object.keys(held).length;
    // The server makes room for a count of all fields before it knows which it leaves out.
    if (layout.fields.length + (layout.tag === null ? 0 : 1) <= SHORT) this.#byte(0x80 | n);
    else this.#view.setUint16(this.#tagged(0xde, 2), n);
    if (layout.tag !== null) {
      this.#text("type");
      this.#text(layout.tag);
    }
    for (const { name, kind } of layout.fields) {
      if (!Object.hasOwn(held, name)) continue;
      this.#text(name);
      this.#value(kind, held[name]);
    }
  }

  #value(kind: Kind, value: unknown): void {
    if (value === null) {
      this.#byte(0xc0);
      return;
    }
    switch (kind[0]) {
      case "bool":
        this.#byte(value === true ? 0xc3 : 0xc2);
        return;
      case "int":
        this.#int(value as number);
        return;
      case "float": {
        const at = this.#take(9);
        this.#view.setUint8(at, 0xcb);
        this.#view.setFloat64(at + 1, value as number);
        return;
      }
      case "str":
      case "choice":
        this.#text(value as string);
        return;
      case "bytes": {
        const bytes = value as Uint8Array;
        this.#sized(bytes.length, [0xc4, 0xc5, 0xc6]);
        this.#raw(bytes);
        return;
      }
      case "list": {
        const items = value as readonly unknown[];
        this.#size(items.length, 0x90, [0xdc, 0xdd]);
        for (const item of items) this.#value(kind[1], item);
        return;
      }
      case "tuple": {
        const items = value as readonly unknown[];
        this.#size(items.length, 0x90, [0xdc, 0xdd]);
        for (const [i, item] of kind[1].entries()) this.#value(item, items[i]);
        return;
      }
      case "map": {
        const entries = Object.entries(value as object);
        this.#size(entries.length, 0x80, [0xde, 0xdf]);
        for (const [key, inner] of entries) {
          this.#text(key);
          this.#value(kind[1], inner);
        }
        return;
      }
      case "record":
        this.record(kind[1], value as object);
    }
  }

  #int(value: number): void {
    if (value >= 0) {
      if (value < 0x80) this.#byte(value);
      else if (value <= 0xffff_ffff) this.#sized(value, [0xcc, 0xcd, 0xce]);
      else this.#big(0xcf, value);
    } else if (value >= -0x20) this.#byte(value & 0xff);
    else if (value >= -0x80) this.#view.setInt8(this.#tagged(0xd0, 1), value);
    else if (value >= -0x8000) this.#view.setInt16(this.#tagged(0xd1, 2), value);
    else if (value >= -0x8000_0000) this.#view.setInt32(this.#tagged(0xd2, 4), value);
    else this.#big(0xd3, value);
  }

  #big(tag: number, value: number): void {
    this.#view.setBigInt64(this.#tagged(tag, 8), BigInt(value));
  }

  #text(value: string): void {
    const bytes = encoder.encode(value);
    if (bytes.length < 32) this.#byte(0xa0 | bytes.length);
    else this.#sized(bytes.length, [0xd9, 0xda, 0xdb]);
    this.#raw(bytes);
  }

  /** A number in one, two or four bytes after the tag of its size. */
  #sized(value: number, tags: readonly [number, number, number]): void {
    if (value <= 0xff) this.#view.setUint8(this.#tagged(tags[0], 1), value);
    else if (value <= 0xffff) this.#view.setUint16(this.#tagged(tags[1], 2), value);
    else this.#view.setUint32(this.#tagged(tags[2], 4), value);
  }

  /** How many items follow: in the tag itself, or in two or four bytes. */
  #size(n: number, tag: number, tags: readonly [number, number]): void {
    if (n <= SHORT) this.#byte(tag | n);
    else if (n <= 0xffff) this.#view.setUint16(this.#tagged(tags[0], 2), n);
    else this.#view.setUint32(this.#tagged(tags[1], 4), n);
  }

  #byte(value: number): void {
    const at = this.#take(1);
    this.#bytes[at] = value;
  }

  #raw(bytes: Uint8Array): void {
    const at = this.#take(bytes.length);
    this.#bytes.set(bytes, at);
  }

  /** @returns Where `size` bytes after the tag are to be written. */
  #tagged(tag: number, size: number): number {
    const at = this.#take(size + 1);
    this.#bytes[at] = tag;
    return at + 1;
  }

  /** @returns Where `size` bytes are to be written. */
  #take(size: number): number {
    const at = this.#at;
    this.#at += size;
    if (this.#at > this.#bytes.length) {
      const larger = new Uint8Array(Math.max(2 * this.#bytes.length, this.#at));
      larger.set(this.#bytes);
      this.#bytes = larger;
      this.#view = new DataView(larger.buffer);
    }
    return at;
  }
}

const encoder = new TextEncoder();
const decoder = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });

/** Reads any MessagePack value; a length that the bytes cannot hold is refused before it counts. */
class Reader {
  readonly #bytes: Uint8Array<ArrayBuffer>;
  readonly #view: DataView;
  #at = 0;

  constructor(bytes: Uint8Array<ArrayBuffer>) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  /** @throws {ProtocolError} If anything follows the message. */
  end(): void {
    const left = this.#bytes.length - this.#at;
    if (left > 0) throw new ProtocolError(`the message cannot be read: ${left} bytes follow its end`);
  }

  value(depth: number): unknown {
    const tag = this.#uint8();
    if (tag < 0x80) return tag;
    if (tag < 0x90) return this.#map(tag & 0x0f, depth);
    if (tag < 0xa0) return this.#list(tag & 0x0f, depth);
    if (tag < 0xc0) return this.#text(tag & 0x1f);
    if (tag >= 0xe0) return tag - 0x100;
    switch (tag) {
      case 0xc0:
        return null;
      case 0xc2:
        return false;
      case 0xc3:
        return true;
      case 0xc4:
        return this.#raw(this.#uint8()).slice();
      case 0xc5:
        return this.#raw(this.#uint16()).slice();
      case 0xc6:
        return this.#raw(this.#uint32()).slice();
      case 0xc7:
        return this.#extension(this.#uint8());
      case 0xc8:
        return this.#extension(this.#uint16());
      case 0xc9:
        return this.#extension(this.#uint32());
      case 0xca:
        return this.#view.getFloat32(this.#pass(4));
      case 0xcb:
        return this.#view.getFloat64(this.#pass(8));
      case 0xcc:
        return this.#uint8();
      case 0xcd:
        return this.#uint16();
      case 0xce:
        return this.#uint32();
      case 0xcf:
        return Number(this.#view.getBigUint64(this.#pass(8)));
      case 0xd0:
        return this.#view.getInt8(this.#pass(1));
      case 0xd1:
        return this.#view.getInt16(this.#pass(2));
      case 0xd2:
        return this.#view.getInt32(this.#pass(4));
      case 0xd3:
        return Number(this.#view.getBigInt64(this.#pass(8)));
      case 0xd4:
      case 0xd5:
      case 0xd6:
      case 0xd7:
      case 0xd8:
        return this.#extension(1 << (tag - 0xd4));
      case 0xd9:
        return this.#text(this.#uint8());
      case 0xda:
        return this.#text(this.#uint16());
      case 0xdb:
        return this.#text(this.#uint32());
      case 0xdc:
        return this.#list(this.#uint16(), depth);
      case 0xdd:
        return this.#list(this.#uint32(), depth);
      case 0xde:
        return this.#map(this.#uint16(), depth);
      case 0xdf:
        return this.#map(this.#uint32(), depth);
      default:
        throw new ProtocolError(`the message cannot be read: 0x${tag.toString(16)} begins no value`);
    }
  }

  #list(n: number, depth: number): unknown[] {
    this.#enter(n, depth);
    const items: unknown[] = [];
    for (let i = 0; i < n; i++) items.push(this.value(depth + 1));
    return items;
  }

  #map(n: number, depth: number): unknown {
    this.#enter(2 * n, depth);
    const entries: [string, unknown][] = [];
    let hasOtherKeys = false;
    for (let i = 0; i < n; i++) {
      const key = this.value(depth + 1);
      const value = this.value(depth + 1);
      if (typeof key === "string") entries.push([key, value]);
      else hasOtherKeys = true;
    }
    return hasOtherKeys ? OTHER : Object.fromEntries(entries);
  }

  /** Every item takes a byte at least. */
  #enter(items: number, depth: number): void {
    if (depth >= MAX_DEPTH) throw tooDeep();
    if (items > this.#bytes.length - this.#at) throw truncated();
  }

  #text(size: number): string {
    const bytes = this.#raw(size);
    try {
      return decoder.decode(bytes);
    } catch {
      throw new ProtocolError("the message cannot be read: a text is no UTF-8");
    }
  }

  #extension(size: number): typeof OTHER {
    this.#pass(1 + size);
    return OTHER;
  }

  #raw(size: number): Uint8Array<ArrayBuffer> {
    const at = this.#pass(size);
    return this.#bytes.subarray(at, at + size);
  }

  #uint8(): number {
    return this.#view.getUint8(this.#pass(1));
  }

  #uint16(): number {
    return this.#view.getUint16(this.#pass(2));
  }

  #uint32(): number {
    return this.#view.getUint32(this.#pass(4));
  }

  /** @returns Where the next `size` bytes begin, which are passed. */
  #pass(size: number): number {
    const at = this.#at;
    if (size > this.#bytes.length - at) throw truncated();
    this.#at += size;
    return at;
  }
}

function truncated(): ProtocolError {
  return new ProtocolError("the message cannot be read: it is cut short");
}
