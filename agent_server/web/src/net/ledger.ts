/**
 * What a renderer knows of its commands, so that each takes effect once whatever happens to the
 * connection. It survives connections, not the page or process. It does nothing itself: each call
 * says what is to be said to the server, and what the application is to see.
 */

import type { AckMessage, CommandMessage } from "../protocol/messages.ts";

/** Commands that are over and still remembered; the server never has more than one open. */
export const REMEMBERED = 256;
const MAX_STEP = 1000;
const MAX_REASON = 500;

/** Why a command is cut short: a newer one has come, or the server has begun anew. */
export type CancelReason = "preempted" | "forgotten";

interface Entry {
  readonly command: CommandMessage;
  /** When it came, in milliseconds. */
  readonly cameAt: number;
  /** The last thing that was said of it, or is to be said. */
  word: AckMessage;
}

/** What follows from a message of the server. */
export interface Heard {
  /** To be said to the server, in this order, before the application hears of anything. */
  readonly say: readonly AckMessage[];
  /** The command that was running and is cut short. */
  readonly cancel: CommandMessage | null;
  /** Whether the command that came is to be carried out. */
  readonly isNew: boolean;
}

/** What follows from a report of the application. */
export interface Reported {
  readonly say: readonly AckMessage[];
  /** Whether the command goes on, or has just ended as reported. */
  readonly isTaken: boolean;
}

const NOTHING: Heard = { say: [], cancel: null, isNew: false };
const REFUSED: Reported = { say: [], isTaken: false };

export class CommandLedger {
  /** Name of the ledger that the commands belong to; null before the first welcome. */
  name: string | null = null;
  /** Highest sequence that came, 0 before the first command. */
  lastSequence = 0;

  readonly #entries = new Map<string, Entry>();
  /** Ids whose word is to be said, or said once more, when the connection is live again. */
  readonly #owed = new Set<string>();
  #isLive = false;

  /** The command that is not over, or null. */
  get running(): CommandMessage | null {
    return this.#open()?.command ?? null;
  }

  /** The connection is live; `name` is the ledger of the welcome. */
  welcome(name: string): Heard {
    this.#isLive = true;
    const cancel = name === this.name ? null : this.running;
    if (name !== this.name) this.#forget(name);
    const say = [...this.#owed].flatMap((id) => this.#entries.get(id)?.word ?? []);
    this.#owed.clear();
    return { ...NOTHING, say, cancel };
  }

  /** The connection is not live any more. */
  lost(): void {
    this.#isLive = false;
    const open = this.#open();
    if (open !== null) this.#owed.add(open.command.id);
  }

  /** @param now When it came, in milliseconds. */
  receive(command: CommandMessage, now: number): Heard {
    const known = this.#entries.get(command.id);
    if (known !== undefined) return { ...NOTHING, say: [known.word] };
    const isLate = command.sequence < this.lastSequence;
    this.lastSequence = Math.max(command.sequence, this.lastSequence);
    if (command.age_ms >= command.ttl_ms) {
      return { ...NOTHING, say: [this.#enter(command, now, failed(command.id, "expired"))] };
    }
    if (isLate) {
      return { ...NOTHING, say: [this.#enter(command, now, failed(command.id, "preempted"))] };
    }
    const before = this.#open();
    const say: AckMessage[] = [];
    if (before !== null) say.push(this.#put(before, failed(before.command.id, "preempted")));
    say.push(this.#enter(command, now, ack(command.id, "accepted")));
    return { say, cancel: before?.command ?? null, isNew: true };
  }

  /**
   * The application starts a command.
   *
   * @param now In milliseconds.
   * @returns Not taken when the command was started already, is over, or its time is up: do
   *   nothing then.
   */
  start(id: string, now: number): Reported {
    const entry = this.#entries.get(id);
    if (entry?.word.status !== "accepted") return REFUSED;
    const { ttl_ms, age_ms } = entry.command;
    if (now - entry.cameAt > ttl_ms - age_ms) {
      return { say: this.#said(entry, failed(id, "expired")), isTaken: false };
    }
    return { say: this.#said(entry, ack(id, "started")), isTaken: true };
  }

  /** @param step Index of the step that has ended. */
  progress(id: string, step: number): Reported {
    if (!Number.isInteger(step) || step < 0 || step > MAX_STEP) {
      throw new RangeError(`step is ${step}: give its index, an integer from 0 to ${MAX_STEP}`);
    }
    return this.#report(id, { ...ack(id, "progress"), step });
  }

  /** A command that was started has been carried out. */
  done(id: string): Reported {
    return this.#report(id, ack(id, "done"));
  }

  /**
   * A command cannot be carried out, whether it was started or not.
   *
   * @param reason For people; what is longer than the protocol allows is cut.
   */
  fail(id: string, reason: string): Reported {
    return this.#report(id, failed(id, [...reason].slice(0, MAX_REASON).join("")));
  }

  #report(id: string, word: AckMessage): Reported {
    const entry = this.#entries.get(id);
    if (entry === undefined || isOver(entry)) return REFUSED;
    if (entry.word.status === "accepted" && word.status !== "failed") return REFUSED;
    return { say: this.#said(entry, word), isTaken: true };
  }

  /** @returns The word, unless there is no connection that it could be said on. */
  #said(entry: Entry, word: AckMessage): readonly AckMessage[] {
    this.#put(entry, word);
    if (this.#isLive) return [word];
    this.#owed.add(entry.command.id);
    return [];
  }

  #enter(command: CommandMessage, cameAt: number, word: AckMessage): AckMessage {
    const entry = { command, cameAt, word };
    this.#entries.set(command.id, entry);
    return this.#put(entry, word);
  }

  #put(entry: Entry, word: AckMessage): AckMessage {
    entry.word = word;
    if (isOver(entry)) {
      // Those that are over stand in the order in which they ended.
      this.#entries.delete(entry.command.id);
      this.#entries.set(entry.command.id, entry);
      this.#trim();
    }
    return word;
  }

  #trim(): void {
    const over = [...this.#entries.values()].filter(isOver);
    for (const { command } of over.slice(0, Math.max(0, over.length - REMEMBERED))) {
      this.#entries.delete(command.id);
      this.#owed.delete(command.id);
    }
  }

  #open(): Entry | null {
    for (const entry of this.#entries.values()) if (!isOver(entry)) return entry;
    return null;
  }

  #forget(name: string): void {
    this.#entries.clear();
    this.#owed.clear();
    this.name = name;
    this.lastSequence = 0;
  }
}

function isOver({ word }: Entry): boolean {
  return word.status === "done" || word.status === "failed";
}

function ack(command_id: string, status: AckMessage["status"]): AckMessage {
  return { type: "ack", command_id, status };
}

function failed(command_id: string, reason: string): AckMessage {
  return { ...ack(command_id, "failed"), reason };
}
