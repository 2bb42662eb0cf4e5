/** How `layout.ts` spells a record: plain data that both codings follow. */

/** What a value may be. A bound, or a length, that is null does not bind. */
export type Kind =
  | readonly ["bool"]
  | readonly ["int", least: number | null, most: number | null]
  /** `isOpen`: `least` itself is left out. */
  | readonly ["float", least: number | null, most: number | null, isOpen?: boolean]
  /** Lengths in code points. */
  | readonly ["str", shortest: number, longest: number | null, pattern?: string]
  | readonly ["bytes", longest: number | null]
  | readonly ["choice", values: readonly string[]]
  | readonly ["list", item: Kind, longest: number | null]
  | readonly ["tuple", items: readonly Kind[]]
  | readonly ["map", value: Kind, longest: number | null]
  | readonly ["record", layout: RecordLayout];

export interface FieldLayout {
  readonly name: string;
  readonly kind: Kind;
  readonly isNullable?: true;
  /** What holds when the field is left out; a field without a default must be there. */
  readonly default?: unknown;
}

export interface RecordLayout {
  readonly name: string;
  /** Value of `type`; null for a part of a message. */
  readonly tag: string | null;
  /** Whether fields that hold their default are left out. */
  readonly omitsDefaults: boolean;
  /** In the order in which they are encoded, after `type`. */
  readonly fields: readonly FieldLayout[];
}
