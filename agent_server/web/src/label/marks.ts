/** The labels that are being made: which is chosen, what is begun, and what can be taken back. */

import { formatTable, type Label } from "./table.ts";

export interface Mark extends Label {
  readonly id: number;
}

/** What a new mark takes over from the one before it. */
type Habits = Pick<Label, "gesture" | "subject">;

export class Marks {
  /** Sorted by onset. */
  list: readonly Mark[] = [];
  /** Id of the mark that is changed, or null. */
  chosenId: number | null = null;
  /** Where a new mark begins, in seconds, or null. */
  begunS: number | null = null;

  #past: (readonly Mark[])[] = [];
  #saved = "";
  #nextId = 1;
  #habits: Habits;

  /** @param gesture What the first mark is of. */
  constructor(labels: readonly Label[], gesture: string) {
    this.list = sorted(labels.map((label) => ({ ...label, id: this.#nextId++ })));
    this.#habits = { gesture, subject: this.list[0]?.subject ?? "" };
    this.#saved = this.table;
  }

  get chosen(): Mark | null {
    return this.list.find(({ id }) => id === this.chosenId) ?? null;
  }

  get table(): string {
    return formatTable(this.list);
  }

  get isSaved(): boolean {
    return this.table === this.#saved;
  }

  /** The server has this table now. */
  markSaved(table: string): void {
    this.#saved = table;
  }

  choose(id: number | null): void {
    this.chosenId = id;
    this.begunS = null;
  }

  /** Choose the mark before or after the chosen one, or else the one nearest to a time. */
  chooseNext(direction: -1 | 1, timeS: number): void {
    const at = this.list.findIndex(({ id }) => id === this.chosenId);
    const found =
      at >= 0
        ? this.list[at + direction]
        : direction === 1
          ? this.list.find(({ onsetS }) => onsetS >= timeS)
          : this.list.findLast(({ onsetS }) => onsetS <= timeS);
    if (found !== undefined) this.choose(found.id);
  }

  /**
   * It begins here: the chosen mark, or a new one.
   *
   * @returns Why it cannot, or null.
   */
  begin(timeS: number): string | null {
    const { chosen } = this;
    if (chosen !== null) return this.change({ onsetS: timeS });
    this.begunS = timeS;
    return null;
  }

  /** It ends here: the chosen mark, or the one that was begun, which is chosen then. */
  end(timeS: number): string | null {
    const { chosen, begunS } = this;
    if (chosen !== null) return this.change({ offsetS: timeS });
    if (begunS === null) return "Press I first, where it begins.";
    const mark: Mark = {
      ...this.#habits,
      onsetS: begunS,
      offsetS: timeS,
      expected: null,
      quiet: false,
      id: this.#nextId,
    };
    const fault = faultOf(mark);
    if (fault !== null) return fault;
    this.#nextId += 1;
    this.#enter([...this.list, mark]);
    this.choose(mark.id);
    return null;
  }

  /** Change the chosen mark. */
  change(change: Partial<Label>): string | null {
    const { chosen } = this;
    if (chosen === null) return null;
    const changed = { ...chosen, ...change };
    const fault = faultOf(changed);
    if (fault !== null) return fault;
    this.#habits = { gesture: changed.gesture, subject: changed.subject };
    this.#enter(this.list.map((mark) => (mark.id === chosen.id ? changed : mark)));
    return null;
  }

  /** Delete the chosen mark. */
  remove(): void {
    if (this.chosen === null) return;
    this.#enter(this.list.filter(({ id }) => id !== this.chosenId));
    this.choose(null);
  }

  undo(): void {
    const before = this.#past.pop();
    if (before === undefined) return;
    this.list = before;
    if (this.chosen === null) this.chosenId = null;
  }

  #enter(list: readonly Mark[]): void {
    this.#past.push(this.list);
    this.list = sorted(list);
  }
}

function faultOf({ onsetS, offsetS }: Label): string | null {
  if (!(onsetS >= 0 && Number.isFinite(offsetS))) return "Times are seconds from the start.";
  return onsetS < offsetS ? null : "It has to end after it begins.";
}

function sorted(list: readonly Mark[]): readonly Mark[] {
  return list.toSorted((a, b) => a.onsetS - b.onsetS || a.offsetS - b.offsetS);
}

/** Rows in which marks that overlap do not hide each other: id -> row, from 0. */
export function rowsOf(list: readonly Mark[]): ReadonlyMap<number, number> {
  const ends: number[] = [];
  const rows = new Map<number, number>();
  for (const { id, onsetS, offsetS } of list) {
    const free = ends.findIndex((end) => end <= onsetS);
    const row = free === -1 ? ends.length : free;
    ends[row] = offsetS;
    rows.set(id, row);
  }
  return rows;
}
