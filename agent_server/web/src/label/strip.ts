/** The time line: figures, what was decided, the labels, and the moment that is looked at. */

import type { DecisionBody } from "../protocol/messages.ts";
import { outcomeWord, sentenceCase } from "../state/words.ts";
import { h, need, setAttribute, setState, setText } from "../ui/dom.ts";
import type { Film } from "./film.ts";
import { rowsOf, type Mark, type Marks } from "./marks.ts";
import { clockText, type Ruler } from "./ruler.ts";

const TICK_PX = 90;
const ROW_PX = 26;

export interface StripActions {
  seek(timeS: number): void;
  choose(id: number): void;
}

export class Strip {
  readonly #actions: StripActions;
  readonly #track = need<HTMLElement>("#track");
  readonly #slider = need<HTMLInputElement>("#moment");
  readonly #ticks = need<HTMLElement>("#ticks");
  readonly #decisions = need<HTMLElement>("#decided");
  readonly #marks = need<HTMLElement>("#marks");
  readonly #begun = h("div", { class: "begun", hidden: "" });
  readonly #head = need<HTMLElement>("#head");
  readonly #bars = new Map<number, HTMLButtonElement>();
  #ruler: Ruler | null = null;

  constructor(actions: StripActions) {
    this.#actions = actions;
    this.#slider.addEventListener("input", () => actions.seek(this.#slider.valueAsNumber));
    const seek = ({ clientX }: PointerEvent): void => {
      const { left, width } = this.#track.getBoundingClientRect();
      if (this.#ruler !== null) actions.seek(this.#ruler.timeAt((clientX - left) / width));
    };
    this.#track.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || (event.target as Element).closest("button") !== null) return;
      this.#track.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.#track.addEventListener("pointermove", (event) => {
      if (this.#track.hasPointerCapture(event.pointerId)) seek(event);
    });
    this.#marks.append(this.#begun);
  }

  render(ruler: Ruler, film: Film, marks: Marks, timeS: number): void {
    const isMoved = this.#ruler !== ruler || this.#shown !== `${ruler.fromS} ${ruler.toS} ${this.#width}`;
    this.#ruler = ruler;
    if (isMoved) this.#showPart(ruler, film);
    this.#slider.value = `${timeS}`;
    setAttribute(this.#slider, "aria-valuetext", clockText(timeS));
    this.#head.style.left = percent(ruler.share(timeS));
    this.#showMarks(ruler, marks, timeS);
  }

  #shown = "";

  get #width(): number {
    return this.#track.clientWidth;
  }

  /** What does not move with the moment. */
  #showPart(ruler: Ruler, film: Film): void {
    this.#shown = `${ruler.fromS} ${ruler.toS} ${this.#width}`;
    setAttribute(this.#slider, "min", `${ruler.fromS}`);
    setAttribute(this.#slider, "max", `${ruler.toS}`);
    const times = ruler.ticks(Math.max(2, this.#width / TICK_PX));
    const [first = 0, second = first + 1] = times;
    const decimals = second - first < 1 ? 1 : 0;
    this.#ticks.replaceChildren(
      ...times.map((time) => at(ruler, time, h("span", { class: "tick" }, clockText(time, decimals)))),
    );
    const inView = film.decisions.filter(({ end_ns }) => isInView(ruler, end_ns / 1e9, end_ns / 1e9));
    this.#decisions.replaceChildren(...inView.map((decision) => this.#decision(ruler, decision)));
  }

  #decision(ruler: Ruler, decision: DecisionBody): HTMLElement {
    const timeS = decision.end_ns / 1e9;
    const words = decisionWords(decision);
    const button = h("button", { type: "button", class: "decided", title: words, tabindex: "-1" });
    setAttribute(button, "aria-label", words);
    setState(button, "outcome", decision.outcome);
    button.addEventListener("click", () => this.#actions.seek(timeS));
    return at(ruler, timeS, button);
  }

  #showMarks(ruler: Ruler, marks: Marks, timeS: number): void {
    const rows = rowsOf(marks.list);
    const seen = new Set<number>();
    for (const mark of marks.list) {
      if (!isInView(ruler, mark.onsetS, mark.offsetS)) continue;
      seen.add(mark.id);
      const bar = this.#bars.get(mark.id) ?? this.#newBar(mark.id);
      bar.style.top = `${(rows.get(mark.id) ?? 0) * ROW_PX}px`;
      stretch(bar, ruler, mark.onsetS, mark.offsetS);
      setText(bar, markWords(mark));
      setAttribute(bar, "title", `${markWords(mark)}, ${spanWords(mark)}`);
      setAttribute(bar, "aria-pressed", `${mark.id === marks.chosenId}`);
      setState(bar, "asks", asks(mark));
    }
    for (const [id, bar] of this.#bars) {
      if (seen.has(id)) continue;
      bar.remove();
      this.#bars.delete(id);
    }
    const count = Math.max(1, ...[...rows.values()].map((row) => row + 1));
    this.#marks.style.height = `${count * ROW_PX}px`;
    this.#begun.hidden = marks.begunS === null;
    if (marks.begunS !== null) {
      stretch(this.#begun, ruler, Math.min(marks.begunS, timeS), Math.max(marks.begunS, timeS));
    }
  }

  #newBar(id: number): HTMLButtonElement {
    const bar = h("button", { type: "button", class: "mark" });
    bar.addEventListener("click", () => this.#actions.choose(id));
    this.#bars.set(id, bar);
    this.#marks.append(bar);
    return bar;
  }
}

/** `Cold → Close window`, `Idle, quiet`. */
export function markWords({ gesture, expected, quiet }: Mark): string {
  const what = sentenceCase(gesture);
  if (expected !== null) return `${what} \u2192 ${sentenceCase(expected)}`;
  return quiet ? `${what}, quiet` : what;
}

export function spanWords({ onsetS, offsetS }: Mark): string {
  return `${clockText(onsetS).replace(" s", "")} \u2013 ${clockText(offsetS)}`;
}

/** What a mark asks for: `reaction`, `quiet` or `nothing`. */
export function asks({ expected, quiet }: Mark): string {
  if (expected !== null) return "reaction";
  return quiet ? "quiet" : "nothing";
}

export function decisionWords({ gesture, outcome, command }: DecisionBody): string {
  const what = command === null ? outcomeWord(outcome) : sentenceCase(command.reaction);
  return `${sentenceCase(gesture)}: ${what}`;
}

function isInView(ruler: Ruler, fromS: number, toS: number): boolean {
  return toS >= ruler.fromS && fromS <= ruler.toS;
}

function stretch(element: HTMLElement, ruler: Ruler, fromS: number, toS: number): void {
  // A bar that begins before what is shown keeps its words in view.
  const left = Math.max(0, ruler.share(fromS));
  element.style.left = percent(left);
  element.style.width = percent(Math.min(1, ruler.share(toS)) - left);
}

function at<E extends HTMLElement>(ruler: Ruler, timeS: number, element: E): E {
  element.style.left = percent(ruler.share(timeS));
  return element;
}

function percent(share: number): string {
  return `${(100 * share).toFixed(4)}%`;
}
