/** "Try it yourself": gestures of a made-up person, and the mood that its face shows. */

import type { Recorded } from "../play/recorded.ts";
import { CONTENT, NEUTRAL, UNCOMFORTABLE, type Mood, type StandIn } from "../play/stand_in.ts";
import { sentenceCase } from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

const GESTURES = ["hello", "cold", "loud", "bright", "smell", "hot"] as const;
const MOODS: readonly (readonly [string, Mood])[] = [
  ["Uncomfortable", UNCOMFORTABLE],
  ["Neutral", NEUTRAL],
  ["Content", CONTENT],
];

export class PlayPanel {
  readonly #root: HTMLElement;
  readonly #gestures = new Map<string, HTMLButtonElement>();
  readonly #moods = new Map<Mood, HTMLButtonElement>();
  readonly #valence = level("Valence", "unpleasant to pleasant");
  readonly #arousal = level("Arousal", "calm to excited");
  readonly #words = h("p", { class: "play-words", role: "status" });
  readonly #stop = h("button", { type: "button", class: "quiet-button" }, "Stop");
  readonly #instead = h("button", { type: "button", class: "quiet-button" }, "Play instead");
  readonly #recordings = h("select", { class: "recordings", "aria-label": "Play a recording" });

  readonly #label = h("a", { class: "quiet-button", hidden: "" }, "Label\u2026");

  constructor(root: HTMLElement) {
    this.#root = root;
    const gestures = h("div", { class: "play-row" });
    for (const name of GESTURES) {
      const button = h("button", { type: "button", class: "chip" }, sentenceCase(name));
      this.#gestures.set(name, button);
      gestures.append(button);
    }
    const moods = h("div", { class: "play-row moods" }, h("span", { class: "play-title" }, "Mood"));
    for (const [name, mood] of MOODS) {
      const button = h("button", { type: "button", class: "chip" }, name);
      this.#moods.set(mood, button);
      moods.append(button);
    }
    const fine = h(
      "details",
      { class: "fine" },
      h("summary", {}, "Fine"),
      h("div", { class: "fine-body" }, this.#valence.root, this.#arousal.root),
    );
    moods.append(fine);
    const title = h("span", { class: "play-title" }, "Try it");
    gestures.prepend(title);
    this.#recordings.append(h("option", { value: "" }, "Play a recording\u2026"));
    root.append(
      gestures,
      h("div", { class: "play-side" }, this.#recordings, this.#label),
      moods,
      h("div", { class: "play-side" }, this.#words, this.#instead, this.#stop),
    );
  }

  /** Offer recordings, and the page that labels them. */
  offer(names: readonly string[], labelUrl: string): void {
    this.#label.href = labelUrl;
    this.#label.hidden = false;
    for (const name of names) {
      this.#recordings.append(h("option", { value: name }, sentenceCase(name.replaceAll("_", " "))));
    }
  }

  connect(person: StandIn, recorded: Recorded): void {
    for (const [name, button] of this.#gestures) {
      button.addEventListener("click", () => {
        recorded.stop();
        void person.perform(name);
      });
    }
    for (const [mood, button] of this.#moods) {
      button.addEventListener("click", () => person.setMood(mood));
    }
    const fine = (): void => {
      const valence = this.#valence.input.valueAsNumber;
      person.setMood({ valence, arousal: this.#arousal.input.valueAsNumber });
    };
    this.#valence.input.addEventListener("input", fine);
    this.#arousal.input.addEventListener("input", fine);
    this.#stop.addEventListener("click", () => {
      person.stop();
      recorded.stop();
    });
    this.#instead.addEventListener("click", () => {
      const { name } = recorded.state;
      if (name === null) void person.start(true);
      else void recorded.start(name, true);
    });
    this.#recordings.addEventListener("change", () => {
      const name = this.#recordings.value;
      person.stop();
      if (name === "") recorded.stop();
      else void recorded.start(name);
    });
  }

  render({ doing, mood, ...person }: StandIn["state"], recorded: Recorded["state"]): void {
    const { phase, link, fault } = recorded.phase === "off" ? person : recorded;
    const isOn = phase === "playing" || phase === "loading";
    const isAway = link === "taken" || link === "replaced";
    setState(this.#root, "phase", phase);
    for (const [name, button] of this.#gestures) {
      setAttribute(button, "aria-pressed", `${person.phase === "playing" && doing === name}`);
    }
    for (const [own, button] of this.#moods) {
      const isIt = own.valence === mood.valence && own.arousal === mood.arousal;
      setAttribute(button, "aria-pressed", `${isIt}`);
    }
    this.#valence.show(mood.valence);
    this.#arousal.show(mood.arousal);
    this.#stop.hidden = !isOn || isAway;
    this.#instead.hidden = !isOn || !isAway;
    if (this.#recordings.value !== (recorded.name ?? "")) this.#recordings.value = recorded.name ?? "";
    const who = recorded.phase === "off" ? "A made-up person" : "A recorded person";
    setText(this.#words, wordsOf(who, phase, isAway, fault));
  }
}

function wordsOf(who: string, phase: string, isAway: boolean, fault: string | null): string {
  if (fault !== null) return fault;
  if (phase === "off") return "";
  if (isAway) return "Another sensor plays in this session.";
  return phase === "loading" ? `${who} comes in.` : `${who}.`;
}

interface Slider {
  readonly root: HTMLElement;
  readonly input: HTMLInputElement;
  show(value: number): void;
}

function level(name: string, meaning: string): Slider {
  const attributes = { type: "range", min: "-10", max: "10", step: "0.5", "aria-label": `${name}, ${meaning}` };
  const input = h("input", attributes);
  const shown = h("output");
  const root = h("label", { class: "level" }, h("span", {}, name), input, shown);
  return {
    root,
    input,
    show(value) {
      if (input.valueAsNumber !== value) input.valueAsNumber = value;
      setText(shown, value.toFixed(1));
    },
  };
}
