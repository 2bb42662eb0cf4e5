/** The list of labels, and the fields of the one that is chosen. */

import { sentenceCase } from "../state/words.ts";
import { h, need, setAttribute, setState, setText } from "../ui/dom.ts";
import type { Marks } from "./marks.ts";
import type { About } from "./source.ts";
import { asks, markWords, spanWords } from "./strip.ts";
import { clockText } from "./ruler.ts";
import type { Label } from "./table.ts";

const NOTHING = "";
const QUIET = "quiet";
const REACTION = "reaction:";
const TIME_DECIMALS = 3;

export interface PanelActions {
  choose(id: number): void;
  change(change: Partial<Label>): void;
  remove(): void;
}

export class Panel {
  readonly #actions: PanelActions;
  readonly #rows = new Map<number, HTMLButtonElement>();
  readonly #list = need<HTMLElement>("#list");
  readonly #count = need<HTMLElement>("#count");
  readonly #form = need<HTMLFormElement>("#form");
  readonly #hint = need<HTMLElement>("#hint");
  readonly #gesture = need<HTMLSelectElement>("#gesture");
  readonly #onset = need<HTMLInputElement>("#onset");
  readonly #offset = need<HTMLInputElement>("#offset");
  readonly #then = need<HTMLSelectElement>("#then");
  readonly #subject = need<HTMLInputElement>("#subject");

  constructor(actions: PanelActions) {
    this.#actions = actions;
    this.#form.addEventListener("submit", (event) => event.preventDefault());
    this.#gesture.addEventListener("change", () => actions.change({ gesture: this.#gesture.value }));
    this.#onset.addEventListener("change", () => actions.change({ onsetS: this.#onset.valueAsNumber }));
    this.#offset.addEventListener("change", () => actions.change({ offsetS: this.#offset.valueAsNumber }));
    this.#subject.addEventListener("change", () => actions.change({ subject: this.#subject.value.trim() }));
    this.#then.addEventListener("change", () => actions.change(thenOf(this.#then.value)));
    need<HTMLButtonElement>("#remove").addEventListener("click", () => actions.remove());
  }

  /** Offer what may be written, and what is written already. */
  open({ gestures, reactions }: About, labels: readonly Label[]): void {
    const names = new Set([...gestures, ...labels.map(({ gesture }) => gesture)]);
    this.#gesture.replaceChildren(...[...names].map((name) => option(name, sentenceCase(name))));
    const written = labels.flatMap(({ expected }) => (expected === null ? [] : [expected]));
    this.#then.replaceChildren(
      option(NOTHING, "Nothing is asked"),
      option(QUIET, "The agent stays quiet"),
      ...[...new Set([...reactions, ...written])].map((name) => option(REACTION + name, sentenceCase(name))),
    );
  }

  focus(): void {
    this.#gesture.focus();
  }

  /** The chosen row comes into view. */
  reveal(id: number | null): void {
    if (id !== null) this.#rows.get(id)?.scrollIntoView({ block: "nearest" });
  }

  render(marks: Marks): void {
    this.#showList(marks);
    const { chosen } = marks;
    this.#form.hidden = chosen === null;
    this.#hint.hidden = chosen !== null;
    const begun = marks.begunS;
    setText(
      this.#hint,
      begun === null
        ? "Press I where something begins and O where it ends, or choose a label to change it."
        : `It begins at ${clockText(begun)}. Press O where it ends; Escape forgets it.`,
    );
    if (chosen === null) return;
    show(this.#gesture, chosen.gesture);
    show(this.#onset, timeText(chosen.onsetS));
    show(this.#offset, timeText(chosen.offsetS));
    show(this.#subject, chosen.subject);
    const quiet = chosen.quiet ? QUIET : NOTHING;
    show(this.#then, chosen.expected === null ? quiet : REACTION + chosen.expected);
  }

  #showList({ list, chosenId }: Marks): void {
    setText(this.#count, list.length === 0 ? "None yet" : `${list.length}`);
    const ids = new Set(list.map(({ id }) => id));
    for (const [id, row] of this.#rows) {
      if (ids.has(id)) continue;
      row.parentElement?.remove();
      this.#rows.delete(id);
    }
    list.forEach((mark, index) => {
      const row = this.#rows.get(mark.id) ?? this.#newRow(mark.id);
      const item = row.parentElement as HTMLElement;
      // Moving an element takes the focus away from it.
      if (this.#list.children[index] !== item) this.#list.insertBefore(item, this.#list.children[index] ?? null);
      setText(row.children[0] as HTMLElement, markWords(mark));
      setText(row.children[1] as HTMLElement, mark.subject);
      setText(row.children[2] as HTMLElement, spanWords(mark));
      setAttribute(row, "aria-pressed", `${mark.id === chosenId}`);
      setState(row, "asks", asks(mark));
    });
  }

  #newRow(id: number): HTMLButtonElement {
    const row = h("button", { type: "button", class: "label-row" });
    row.append(h("span", { class: "what" }), h("span", { class: "who" }), h("span", { class: "when" }));
    row.addEventListener("click", () => this.#actions.choose(id));
    this.#rows.set(id, row);
    this.#list.append(h("li", {}, row));
    return row;
  }
}

function thenOf(value: string): Pick<Label, "expected" | "quiet"> {
  const expected = value.startsWith(REACTION) ? value.slice(REACTION.length) : null;
  return { expected, quiet: value === QUIET };
}

function option(value: string, words: string): HTMLOptionElement {
  return h("option", { value }, words);
}

function timeText(timeS: number): string {
  return `${Number(timeS.toFixed(TIME_DECIMALS))}`;
}

/** A field that is being filled in keeps what is typed. */
function show(field: HTMLInputElement | HTMLSelectElement, value: string): void {
  if (field.value !== value && document.activeElement !== field) field.value = value;
}
