/** A line over the room: who acts in it, whether it can be heard, and what is missing. */

import type { Actor } from "../room/actor.ts";
import { h, setText } from "../ui/dom.ts";

export type RoomPhase = "loading" | "ready" | "failed" | "no_webgl";

export class ActLine {
  readonly #words = h("p", { class: "act-words", role: "status" });
  readonly #take = h("button", { type: "button", class: "quiet-button" }, "Act here");
  readonly #headset = h("button", { type: "button", class: "quiet-button" }, "Enter with the headset");
  readonly #sound = h("button", { type: "button", class: "quiet-button", "aria-pressed": "false" }, "Sound");

  constructor(root: HTMLElement) {
    this.#headset.hidden = true;
    root.append(this.#words, this.#take, this.#headset, this.#sound);
  }

  /** Offer the way in with a headset. */
  offerHeadset(enter: () => void): void {
    this.#headset.hidden = false;
    this.#headset.addEventListener("click", enter);
  }

  connect(actor: Actor, setSound: (isOn: boolean) => void): void {
    this.#take.addEventListener("click", () => actor.takeOver());
    this.#sound.addEventListener("click", () => {
      const isOn = this.#sound.getAttribute("aria-pressed") !== "true";
      this.#sound.setAttribute("aria-pressed", `${isOn}`);
      setSound(isOn);
    });
  }

  render(phase: RoomPhase, actor: Actor | null): void {
    setText(this.#words, wordsOf(phase, actor));
    this.#take.hidden = actor?.part !== "watching";
    this.#sound.hidden = phase !== "ready";
  }
}

function wordsOf(phase: RoomPhase, actor: Actor | null): string {
  switch (phase) {
    case "loading":
      return "The agent comes in.";
    case "no_webgl":
      return "The room needs WebGL, which this browser does not offer or has switched off. Everything else works without it.";
    case "failed":
      return "The room could not be loaded: load the page again.";
    case "ready":
      return actor?.part === "watching" ? "Another renderer acts; this room follows it." : "";
  }
}
