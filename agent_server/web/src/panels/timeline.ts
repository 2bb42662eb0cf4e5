/** The last minute as a strip: how sure the server was of a gesture, and what became of it. */

import type { DecisionMessage } from "../protocol/messages.ts";
import { SPAN_MS, type History } from "../state/history.ts";
import type { Playhead } from "../state/playhead.ts";
import type { Timed } from "../state/store.ts";
import { outcomeWord, sentenceCase } from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

const SEEK_STEP_MS = 100;
const TICK_MS = 10_000;
const MARK_PX = 9;

export interface TimelineActions {
  toggle(): void;
  seek(time: number): void;
  jump(direction: -1 | 1): void;
  goLive(): void;
}

export class TimelinePanel {
  readonly #root: HTMLElement;
  readonly #toggle: HTMLButtonElement;
  readonly #before: HTMLButtonElement;
  readonly #after: HTMLButtonElement;
  readonly #live: HTMLButtonElement;
  readonly #slider: HTMLInputElement;
  readonly #canvas = h("canvas", { class: "track", "aria-hidden": "true" });
  readonly #words = h("p", { class: "moment", role: "status" });
  #end = 0;

  constructor(root: HTMLElement, actions: TimelineActions) {
    this.#root = root;
    this.#toggle = button("", () => actions.toggle());
    this.#before = button("\u2039", () => actions.jump(-1), "To the decision before");
    this.#after = button("\u203a", () => actions.jump(1), "To the next decision");
    this.#live = button("Back to now", () => actions.goLive());
    this.#slider = h("input", {
      type: "range",
      min: `${-SPAN_MS}`,
      max: "0",
      step: `${SEEK_STEP_MS}`,
      "aria-label": "Moment of the last minute",
    });
    this.#slider.addEventListener("input", () =>
      actions.seek(this.#end + this.#slider.valueAsNumber),
    );
    root.append(
      this.#before,
      this.#toggle,
      this.#after,
      h("div", { class: "track-box" }, this.#canvas, this.#slider),
      this.#words,
      this.#live,
    );
  }

  render(history: History, head: Playhead, now: number): void {
    this.#end = head.end(now);
    const time = head.time(now);
    const behindS = (now - time) / 1000;
    setState(this.#root, "live", `${head.isLive}`);
    const isStopped = head.isStopped;
    setText(this.#toggle, isStopped ? "\u25b6" : "\u275a\u275a");
    setAttribute(this.#toggle, "aria-label", isStopped ? "Go on from here" : "Stop at this moment");
    this.#before.disabled = history.nextMark(time, -1) === null;
    this.#after.disabled = history.nextMark(time, 1) === null;
    this.#live.hidden = head.isLive;
    this.#slider.value = `${Math.max(-SPAN_MS, time - this.#end)}`;
    setAttribute(this.#slider, "aria-valuetext", head.isLive ? "now" : `${behindS.toFixed(1)} seconds ago`);
    const decision = head.isLive ? null : history.at(time).decision;
    const what = decision === null ? "" : ` \u00b7 ${momentWords(decision)}`;
    setText(this.#words, head.isLive ? "Last minute" : `${behindS.toFixed(1)} s ago${what}`);
    const from = this.#end - SPAN_MS;
    this.#draw(history.decisions(from, this.#end), history.marks(from, this.#end), time);
  }

  #draw(
    decisions: readonly Timed<DecisionMessage>[],
    marks: readonly Timed<DecisionMessage>[],
    time: number,
  ): void {
    const canvas = this.#canvas;
    const ratio = devicePixelRatio;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    const context = canvas.getContext("2d");
    if (context === null || width === 0) return;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const css = getComputedStyle(canvas);
    const ink = (name: string): string => css.getPropertyValue(name).trim();
    const x = (at: number): number => width * (1 - (this.#end - at) / SPAN_MS);
    context.clearRect(0, 0, width, height);
    context.fillStyle = ink("--line");
    for (let ms = TICK_MS; ms < SPAN_MS; ms += TICK_MS) {
      context.fillRect(Math.round(x(this.#end - ms)), 0, ratio, height);
    }
    // A decision stands until the next one.
    decisions.forEach((one, i) => {
      const { gesture, probabilities } = one.value.decision;
      if (gesture === "idle") return;
      const until = Math.min(decisions[i + 1]?.at ?? one.at + 200, one.at + 400);
      const tall = (probabilities[gesture] ?? 0) * height * 0.72;
      context.globalAlpha = 0.55;
      context.fillStyle = ink("--gesture");
      context.fillRect(x(one.at), height - tall, Math.max(ratio, x(until) - x(one.at)), tall);
    });
    context.globalAlpha = 1;
    for (const one of marks) {
      const isCommand = one.value.decision.outcome === "command";
      this.#mark(context, x(one.at), ratio, ink(isCommand ? "--action" : "--ink-2"), isCommand);
    }
    context.fillStyle = ink("--ink");
    context.fillRect(Math.min(width - 2 * ratio, x(time)), 0, 2 * ratio, height);
  }

  /** A diamond at the upper edge: full for a command, hollow for what led to none. */
  #mark(
    context: CanvasRenderingContext2D,
    x: number,
    ratio: number,
    color: string,
    isFull: boolean,
  ): void {
    const half = (MARK_PX * ratio) / 2;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x + half, half);
    context.lineTo(x, 2 * half);
    context.lineTo(x - half, half);
    context.closePath();
    if (isFull) {
      context.fillStyle = color;
      context.fill();
    } else {
      context.strokeStyle = color;
      context.lineWidth = 1.2 * ratio;
      context.stroke();
    }
  }
}

/** What was decided at a moment. */
function momentWords({ value: { decision } }: Timed<DecisionMessage>): string {
  return `${sentenceCase(decision.gesture)}: ${outcomeWord(decision.outcome)}`;
}

function button(text: string, onClick: () => void, label?: string): HTMLButtonElement {
  const made = h("button", { type: "button", class: "quiet-button" }, text);
  if (label !== undefined) made.setAttribute("aria-label", label);
  made.addEventListener("click", onClick);
  return made;
}
