/** Holds a value against its layout, on its way in and on its way out. */

import type { FieldLayout, Kind, RecordLayout } from "./kinds.ts";

/** A message that cannot be read, or must not be sent. */
export class ProtocolError extends Error {
  /** Path of the field, for example `joints[3][1]`; null for the message as a whole. */
  readonly field: string | null;

  constructor(sentence: string, field: string | null = null) {
    super(field === null ? sentence : `${field}: ${sentence}`);
    this.name = "ProtocolError";
    this.field = field;
  }
}

/** A value that no field can hold: an extension of MessagePack, or a map with keys other than text. */
export const OTHER = Symbol("other");

/** No value lies deeper than this in a message; what an unknown field holds neither. */
export const MAX_DEPTH = 64;

type Plain = Readonly<Record<string, unknown>>;

/** What becomes of fields that hold their default: filled in when read, left out when written. */
export type Defaults = "filled" | "omitted";

/**
 * Copy what a record's layout names, with every value checked; fields that it does not name are
 * left behind.
 *
 * @throws {ProtocolError} Naming the field that is missing, of another kind, or out of range.
 */
export function checked(
  layout: RecordLayout,
  value: unknown,
  defaults: Defaults,
  path = "",
): Plain {
  if (!isMap(value)) throw wrong(path, "a map", value);
  const copy: Record<string, unknown> = layout.tag === null ? {} : { type: layout.tag };
  for (const field of layout.fields) {
    const at = path === "" ? field.name : `${path}.${field.name}`;
    const held = heldBy(field, value[field.name], defaults, at);
    const isLeftOut =
      defaults === "omitted" && layout.omitsDefaults && isDefault(field, held);
    if (!isLeftOut) copy[field.name] = held;
  }
  return copy;
}

function heldBy(field: FieldLayout, value: unknown, defaults: Defaults, path: string): unknown {
  if (value === undefined) {
    if (!("default" in field)) throw new ProtocolError("it is missing", path);
    return field.default;
  }
  if (value === null && field.isNullable === true) return null;
  return read(field.kind, value, defaults, path);
}

function isDefault(field: FieldLayout, value: unknown): boolean {
  if (!("default" in field)) return false;
  const isEmpty = Array.isArray(value) && value.length === 0;
  return value === field.default || (isEmpty && Array.isArray(field.default));
}

function read(kind: Kind, value: unknown, defaults: Defaults, path: string): unknown {
  switch (kind[0]) {
    case "bool":
      if (typeof value !== "boolean") throw wrong(path, "true or false", value);
      return value;
    case "int": {
      const [, least, most] = kind;
      if (typeof value !== "number") throw wrong(path, "an integer", value);
      const isWhole = Number.isSafeInteger(value) || Math.abs(value) > Number.MAX_SAFE_INTEGER;
      if (!isWhole) throw wrong(path, "an integer", value);
      if (!Number.isSafeInteger(value) || !isWithin(value, least, most)) {
        throw outside(path, value, least, most);
      }
      // Minus zero is no integer of its own.
      return value + 0;
    }
    case "float": {
      const [, least, most, isOpen = false] = kind;
      if (typeof value !== "number") throw wrong(path, "a number", value);
      if (!Number.isFinite(value)) throw new ProtocolError(`expected a finite number, got ${value}`, path);
      if (!isWithin(value, least, most) || (isOpen && value === least)) {
        throw outside(path, value, least, most, isOpen);
      }
      return value;
    }
    case "str":
      return text(kind, value, path);
    case "bytes": {
      const [, longest] = kind;
      if (!(value instanceof Uint8Array)) throw wrong(path, "bytes", value);
      if (longest !== null && value.length > longest) {
        throw new ProtocolError(`expected at most ${longest} bytes, got ${value.length}`, path);
      }
      return value;
    }
    case "choice": {
      const [, values] = kind;
      if (typeof value !== "string") throw wrong(path, "text", value);
      if (!values.includes(value)) {
        throw new ProtocolError(`expected one of ${values.join(", ")}, got ${quoted(value)}`, path);
      }
      return value;
    }
    case "list": {
      const [, item, longest] = kind;
      if (!Array.isArray(value)) throw wrong(path, "a list", value);
      if (longest !== null && value.length > longest) {
        throw new ProtocolError(`expected at most ${longest} items, got ${value.length}`, path);
      }
      return value.map((one: unknown, i) => read(item, one, defaults, `${path}[${i}]`));
    }
    case "tuple": {
      const [, items] = kind;
      if (!Array.isArray(value)) throw wrong(path, "a list", value);
      if (value.length !== items.length) {
        throw new ProtocolError(`expected ${items.length} items, got ${value.length}`, path);
      }
      return items.map((item, i) => read(item, value[i], defaults, `${path}[${i}]`));
    }
    case "map": {
      const [, inner, longest] = kind;
      if (!isMap(value)) throw wrong(path, "a map", value);
      const entries = Object.entries(value);
      if (longest !== null && entries.length > longest) {
        throw new ProtocolError(`expected at most ${longest} entries, got ${entries.length}`, path);
      }
      // `fromEntries` makes a property of its own even of `__proto__`.
      return Object.fromEntries(
        entries.map(([key, one]) => [key, read(inner, one, defaults, `${path}[${quoted(key)}]`)]),
      );
    }
    case "record":
      return checked(kind[1], value, defaults, path);
  }
}

function text(kind: Kind & readonly ["str", ...unknown[]], value: unknown, path: string): string {
  const [, shortest, longest, pattern] = kind;
  if (typeof value !== "string") throw wrong(path, "text", value);
  // With the flag, half of a surrogate pair is found only where the other half is missing.
  if (/[\ud800-\udfff]/u.test(value)) throw new ProtocolError("expected text in Unicode", path);
  const isTooLong = longest !== null && value.length > longest && codePoints(value) > longest;
  if (isTooLong || value.length < shortest) {
    const range = longest === null ? `at least ${shortest}` : `${shortest} to ${longest}`;
    throw new ProtocolError(`expected ${range} characters, got ${codePoints(value)}`, path);
  }
  if (pattern !== undefined && !new RegExp(pattern, "u").test(value)) {
    throw new ProtocolError(`expected text like ${pattern}, got ${quoted(value)}`, path);
  }
  return value;
}

function codePoints(value: string): number {
  let n = 0;
  for (const _ of value) n += 1;
  return n;
}

/** @throws {ProtocolError} If lists and maps lie in each other too deep. */
export function checkDepth(value: unknown, depth = 0): void {
  if (typeof value !== "object" || value === null || value instanceof Uint8Array) return;
  if (depth >= MAX_DEPTH) throw tooDeep();
  for (const inner of Array.isArray(value) ? value : Object.values(value)) {
    checkDepth(inner, depth + 1);
  }
}

export function tooDeep(): ProtocolError {
  return new ProtocolError(`the message cannot be read: it is more than ${MAX_DEPTH} deep`);
}

export function isMap(value: unknown): value is Plain {
  return (
    typeof value === "object" &&
    value !== null &&
    !Array.isArray(value) &&
    !(value instanceof Uint8Array)
  );
}

function isWithin(value: number, least: number | null, most: number | null): boolean {
  return (least === null || value >= least) && (most === null || value <= most);
}

function outside(
  path: string,
  value: number,
  least: number | null,
  most: number | null,
  isOpen = false,
): ProtocolError {
  const from = least === null ? "" : isOpen ? `above ${least}` : `from ${least}`;
  const to = most === null ? "" : `up to ${most}`;
  const range = [from, to].filter((words) => words !== "").join(" and ");
  return new ProtocolError(`expected a number ${range || "below 2^53"}, got ${value}`, path);
}

function wrong(path: string, expected: string, value: unknown): ProtocolError {
  return new ProtocolError(`expected ${expected}, got ${nameOf(value)}`, path === "" ? null : path);
}

function nameOf(value: unknown): string {
  if (value === null) return "null";
  if (Array.isArray(value)) return "a list";
  if (value instanceof Uint8Array) return "bytes";
  switch (typeof value) {
    case "string":
      return "text";
    case "number":
      return `${value}`;
    case "boolean":
      return `${value}`;
    case "object":
      return "a map";
    default:
      return "something else";
  }
}

function quoted(value: string): string {
  return JSON.stringify(value.length > 40 ? `${value.slice(0, 40)}\u2026` : value);
}
