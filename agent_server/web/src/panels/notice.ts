/** Says in words, over the 3D view, what keeps the page from showing a live session. */

import type { Problem } from "../state/view.ts";
import { h, setState, setText } from "../ui/dom.ts";

export class Notice {
  readonly #root: HTMLElement;
  readonly #title = h("p", { class: "notice-title" });
  readonly #text = h("p", { class: "notice-text" });
  readonly #wait = h("span", { class: "notice-wait", "aria-live": "off" });
  readonly #retry = h("button", { type: "button", class: "button" }, "Try now");
  readonly #row = h("p", { class: "notice-row" }, this.#retry, this.#wait);

  constructor(root: HTMLElement, onRetry: () => void) {
    this.#root = root;
    this.#retry.addEventListener("click", onRetry);
    root.append(this.#title, this.#text, this.#row);
  }

  /** @param clock The connection's clock, in milliseconds, that `retryAt` refers to. */
  render(problem: Problem | null, clock: number): void {
    this.#root.hidden = problem === null;
    if (problem === null) return;
    setState(this.#root, "kind", problem.kind);
    setText(this.#title, problem.title);
    setText(this.#text, problem.text);
    this.#row.hidden = problem.retryAt === null && !problem.isGivenUp;
    setText(this.#retry, problem.isGivenUp ? "Connect again" : "Try now");
    if (problem.isGivenUp) setText(this.#wait, "");
    if (problem.retryAt !== null) {
      const seconds = Math.max(0, Math.ceil((problem.retryAt - clock) / 1000));
      setText(this.#wait, seconds === 0 ? "trying\u2026" : `next attempt in ${seconds} s`);
    }
  }
}
