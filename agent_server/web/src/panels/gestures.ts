/** One bar a class: its probability, its threshold, and which gesture is held to be going on. */

import type { DecisionBody } from "../protocol/messages.ts";
import { sentenceCase } from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

/** Probability from which each gesture counts; a label without one never does. */
export type Thresholds = Readonly<Record<string, number>>;

interface Bar {
  readonly root: HTMLElement;
  readonly fill: HTMLElement;
  readonly value: HTMLElement;
}

export class Bars {
  readonly root = h("div", { class: "bars" });
  readonly #bars = new Map<string, Bar>();
  #shape = "";

  render(
    labels: readonly string[],
    thresholds: Thresholds | null,
    probabilities: Readonly<Record<string, number>> | null,
    gesture: string | null,
  ): void {
    const shape = JSON.stringify([labels, thresholds]);
    if (shape !== this.#shape) {
      this.#shape = shape;
      this.#build(labels, thresholds);
    }
    for (const [label, bar] of this.#bars) {
      const share = probabilities?.[label] ?? 0;
      const percent = probabilities === null ? "\u2013" : (share * 100).toFixed(0);
      bar.fill.style.transform = `scaleX(${share.toFixed(3)})`;
      setText(bar.value, percent);
      setState(bar.root, "now", label !== gesture ? "no" : label === "idle" ? "idle" : "yes");
      const threshold = thresholds?.[label];
      setState(bar.root, "over", `${threshold !== undefined && share >= threshold}`);
      setAttribute(bar.root, "aria-valuenow", (share * 100).toFixed(0));
    }
  }

  #build(labels: readonly string[], thresholds: Thresholds | null): void {
    this.#bars.clear();
    this.root.replaceChildren();
    for (const label of labels) {
      const fill = h("span", { class: "fill" });
      const track = h("span", { class: "track" }, fill);
      const threshold = thresholds?.[label];
      if (threshold !== undefined) {
        const tick = h("span", { class: "tick" });
        tick.style.left = `${threshold * 100}%`;
        track.append(tick);
      }
      const value = h("span", { class: "value" });
      const root = h(
        "div",
        {
          class: "bar",
          role: "meter",
          "aria-label": `Probability of ${label}, in percent`,
          "aria-valuemin": "0",
          "aria-valuemax": "100",
        },
        h("span", { class: "name" }, sentenceCase(label)),
        track,
        value,
      );
      this.#bars.set(label, { root, fill, value });
      this.root.append(root);
    }
  }
}

export class GesturePanel {
  readonly #bars = new Bars();
  readonly #hint: HTMLElement;

  constructor(root: HTMLElement, hint: HTMLElement) {
    this.#hint = hint;
    root.append(this.#bars.root);
  }

  render(labels: readonly string[], thresholds: Thresholds | null, decision: DecisionBody | null): void {
    this.#bars.render(
      labels,
      thresholds,
      decision?.probabilities ?? null,
      decision?.gesture ?? null,
    );
    setText(this.#hint, thresholds === null ? "" : "percent, counts from the mark on");
  }
}
