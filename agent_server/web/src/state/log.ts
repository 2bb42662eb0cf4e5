/** The log of decisions: notable ones one by one, like ones in a row collapsed. */

import type {
  AckTelemetry,
  CommandBody,
  CommandMessage,
  DecisionMessage,
  ErrorMessage,
} from "../protocol/messages.ts";

/** Outcomes in which nothing asked for anything; they share one row however they alternate. */
const QUIET = new Set(["idle", "unsure"]);

export type Row =
  | {
      readonly kind: "decisions";
      readonly key: number;
      readonly isQuiet: boolean;
      /** How many decisions the row stands for. */
      readonly count: number;
      readonly first: DecisionMessage;
      readonly last: DecisionMessage;
    }
  /** A command that no decision gave, for example the return to work after a time. */
  | { readonly kind: "command"; readonly key: number; readonly command: CommandMessage }
  /** Something that the server could not do; the same in a row is counted. */
  | {
      readonly kind: "error";
      readonly key: number;
      readonly count: number;
      readonly error: ErrorMessage;
    }
  /** A command that ended otherwise than by being carried out. */
  | {
      readonly kind: "end";
      readonly key: number;
      readonly ack: AckTelemetry;
      /** What the command was for; null where the log does not know it. */
      readonly reaction: string | null;
    }
  /** Telemetry of each kind that this page was too slow for, added up while it goes on. */
  | {
      readonly kind: "missed";
      readonly key: number;
      readonly topics: Readonly<Record<string, number>>;
    };

/** Telemetry that is missed again this few rows later is added to the row that stands. */
const MISSED_TOGETHER = 10;

export class DecisionLog {
  /** Oldest first; a row that grows is replaced, so that rows can be compared by identity. */
  rows: readonly Row[] = [];

  readonly #limit: number;
  #nextKey = 0;
  #group: string | null = null;

  /** @param limit Rows that are kept; older ones are let go. */
  constructor(limit = 300) {
    this.#limit = limit;
  }

  addDecision(message: DecisionMessage): void {
    const { id, command } = message.decision;
    if (this.rows.some((row) => row.kind === "decisions" && row.last.decision.id === id)) return;
    if (command !== null) {
      // The renderer's copy may have come first; the decision tells more.
      this.rows = this.rows.filter(
        (row) => row.kind !== "command" || row.command.id !== command.id,
      );
    }
    const group = groupOf(message);
    const open = this.rows.at(-1);
    if (group !== null && group === this.#group && open?.kind === "decisions") {
      this.#replaceLast({ ...open, count: open.count + 1, last: message });
      return;
    }
    this.#group = group;
    this.#append({
      kind: "decisions",
      key: this.#nextKey++,
      isQuiet: QUIET.has(message.decision.outcome),
      count: 1,
      first: message,
      last: message,
    });
  }

  /** Take a command on its way to the renderer; one that a decision explains has its row there. */
  addCommand(command: CommandMessage): void {
    if (this.rows.some((row) => commandOf(row)?.id === command.id)) return;
    this.#append({ kind: "command", key: this.#nextKey++, command });
  }

  addError(error: ErrorMessage): void {
    const open = this.rows.at(-1);
    if (open?.kind === "error" && open.error.code === error.code) {
      this.#replaceLast({ ...open, count: open.count + 1, error });
      return;
    }
    this.#append({ kind: "error", key: this.#nextKey++, count: 1, error });
  }

  /** Take the end of a command; what is said of it once more is not listed again. */
  addEnd(ack: AckTelemetry): void {
    const id = ack.command_id;
    if (this.rows.some((row) => row.kind === "end" && row.ack.command_id === id)) return;
    const given = this.rows.findLast((row) => commandOf(row)?.id === id);
    const reaction = given === undefined ? null : (commandOf(given)?.reaction ?? null);
    this.#append({ kind: "end", key: this.#nextKey++, ack, reaction });
  }

  addMissed(topics: Readonly<Record<string, number>>): void {
    const index = this.rows.findLastIndex(({ kind }) => kind === "missed");
    const open = this.rows[index];
    if (open?.kind !== "missed" || this.rows.length - index > MISSED_TOGETHER) {
      this.#append({ kind: "missed", key: this.#nextKey++, topics });
      return;
    }
    const sum = { ...open.topics };
    for (const [topic, n] of Object.entries(topics)) sum[topic] = (sum[topic] ?? 0) + n;
    this.rows = this.rows.with(index, { ...open, topics: sum });
  }

  clear(): void {
    this.rows = [];
    this.#group = null;
  }

  #replaceLast(row: Row): void {
    this.rows = [...this.rows.slice(0, -1), row];
  }

  #append(row: Row): void {
    this.rows = [...this.rows, row].slice(-this.#limit);
  }
}

function commandOf(row: Row): CommandBody | null {
  if (row.kind === "command") return row.command;
  return row.kind === "decisions" ? row.last.decision.command : null;
}

/** What a decision must share with the one before to be counted into its row; null: nothing. */
function groupOf({ decision }: DecisionMessage): string | null {
  if (decision.command !== null) return null;
  if (QUIET.has(decision.outcome)) return "quiet";
  return JSON.stringify([decision.outcome, decision.gesture, decision.scene?.rule ?? null]);
}
