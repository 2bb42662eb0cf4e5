/** The log of decisions: newest first, each row a button that opens its reasons. */

import type { Row } from "../state/log.ts";
import { endOf } from "../state/running.ts";
import {
  endText,
  endWord,
  errorWord,
  milliseconds,
  missedText,
  outcomeWord,
  reasonOf,
  sentenceCase,
  sessionTime,
} from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

/** Outcomes that are worth reading out to those who do not see the log. */
const ANNOUNCED = new Set(["command", "gated", "nothing_to_do", "busy"]);

interface Line {
  readonly root: HTMLElement;
  readonly button: HTMLButtonElement;
  readonly cells: Readonly<Record<"time" | "outcome" | "gesture" | "why" | "count" | "took", HTMLElement>>;
  row: Row;
}

export class LogPanel {
  readonly #root: HTMLElement;
  readonly #announcer: HTMLElement;
  readonly #onOpen: (row: Row) => void;
  readonly #empty = h("p", { class: "empty" }, "No decision yet.");
  #lines = new Map<number, Line>();
  #shown: readonly Row[] = [];
  #opened: number | null = null;

  constructor(root: HTMLElement, announcer: HTMLElement, onOpen: (row: Row) => void) {
    this.#root = root;
    this.#announcer = announcer;
    this.#onOpen = onOpen;
    root.append(this.#empty);
    root.addEventListener("keydown", (event) => this.#move(event));
  }

  /** @param rows Oldest first. */
  render(rows: readonly Row[]): void {
    if (rows === this.#shown) return;
    this.#shown = rows;
    this.#empty.hidden = rows.length > 0;
    const kept = new Set(rows.map(({ key }) => key));
    for (const [key, line] of this.#lines) {
      if (kept.has(key)) continue;
      line.root.remove();
      this.#lines.delete(key);
    }
    for (const row of rows) {
      const line = this.#lines.get(row.key);
      if (line === undefined) this.#add(row);
      else if (line.row !== row) fill(line, row);
    }
  }

  /** Mark the row whose reasons are open; null when they are closed. */
  mark(key: number | null): void {
    for (const k of [this.#opened, key]) {
      const line = k === null ? undefined : this.#lines.get(k);
      if (line !== undefined) setAttribute(line.button, "aria-expanded", `${k === key}`);
    }
    this.#opened = key;
  }

  /** Give the focus back to a row, or to the log where the row is gone. */
  focus(key: number): void {
    (this.#lines.get(key)?.button ?? this.#root).focus();
  }

  #add(row: Row): void {
    const cell = (name: string) => h("span", { class: `cell ${name}` });
    const cells = {
      time: cell("time"),
      outcome: cell("outcome"),
      gesture: cell("gesture"),
      why: cell("why"),
      count: cell("count"),
      took: cell("took"),
    };
    const button = h(
      "button",
      { type: "button", class: "row", "aria-expanded": "false", "aria-controls": "inspector" },
      ...Object.values(cells),
    );
    const root = h("div", { role: "listitem" }, button);
    const line: Line = { root, button, cells, row };
    button.addEventListener("click", () => this.#onOpen(line.row));
    fill(line, row);
    this.#lines.set(row.key, line);
    this.#root.prepend(root);
    if (row.kind !== "decisions" || ANNOUNCED.has(row.last.decision.outcome)) {
      setText(this.#announcer, `${cells.outcome.textContent}: ${cells.why.textContent}`);
    }
  }

  #move(event: KeyboardEvent): void {
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    if (step === 0) return;
    const buttons = [...this.#root.querySelectorAll<HTMLButtonElement>("button.row")];
    const from = buttons.findIndex((button) => button === document.activeElement);
    buttons[from + step]?.focus();
    event.preventDefault();
  }
}

function fill(line: Line, row: Row): void {
  line.row = row;
  const { cells, button } = line;
  const times = "count" in row ? row.count : 1;
  setText(cells.count, times > 1 ? `\u00d7 ${times}` : "");
  setAttribute(cells.count, "aria-label", times > 1 ? `${times} in a row` : null);
  if (row.kind === "error") {
    setState(button, "outcome", "error");
    setText(cells.outcome, errorWord(row.error.code));
    setText(cells.why, sentenceCase(row.error.message));
    return;
  }
  if (row.kind === "end") {
    const end = endOf(row.ack);
    setState(button, "outcome", end);
    setText(cells.outcome, endWord(end));
    setText(cells.why, endText(row.ack, row.reaction));
    return;
  }
  if (row.kind === "missed") {
    setState(button, "outcome", "missed");
    setText(cells.outcome, "Missed");
    setText(cells.why, missedText(row.topics));
    return;
  }
  if (row.kind === "command") {
    const { command } = row;
    setState(button, "outcome", "command");
    setText(cells.time, sessionTime(command.issued_ns));
    setText(cells.outcome, sentenceCase(command.reaction));
    setText(cells.why, `Because of ${command.cause.replaceAll("_", " ")}`);
    return;
  }
  const { decision, timing } = row.last;
  setState(button, "outcome", decision.outcome);
  setText(cells.time, sessionTime(row.first.decision.end_ns));
  const { command } = decision;
  setText(
    cells.outcome,
    command !== null
      ? sentenceCase(command.reaction)
      : row.isQuiet
        ? "Quiet"
        : outcomeWord(decision.outcome),
  );
  setText(cells.gesture, row.isQuiet ? "" : sentenceCase(decision.gesture));
  setText(cells.why, reasonOf(decision));
  setText(cells.took, milliseconds(timing.total_ms));
}
