/** The agent's room: what the agent does, the command under way, the state of every object. */

import type { SceneState, StepMessage } from "../protocol/messages.ts";
import { progressOf, type Progress, type Running } from "../state/running.ts";
import { endWord, sentenceCase } from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";
import { pictogram } from "./pictograms.ts";

const MODES = ["working", "attention", "reacting"];
const FLASH_MS = 2_000;

interface Tile {
  readonly root: HTMLElement;
  readonly picture: HTMLElement;
  readonly word: HTMLElement;
  state: string;
}

export class RoomPanel {
  readonly #modes = new Map<string, HTMLElement>();
  readonly #title = h("p", { class: "run-title" });
  readonly #status = h("p", { class: "run-status" });
  readonly #steps = h("ol", { class: "steps", "aria-label": "Steps of the command" });
  readonly #step = h("p", { class: "run-step" });
  readonly #onToggle: (object: string) => void;
  readonly #tiles = h("ul", { class: "tiles" });
  readonly #tile = new Map<string, Tile>();
  #shownCommand: string | null = null;

  /** @param onToggle Somebody wants an object in its next state. */
  constructor(root: HTMLElement, modes: HTMLElement, onToggle: (object: string) => void) {
    this.#onToggle = onToggle;
    for (const mode of MODES) {
      const item = h("li", {}, sentenceCase(mode));
      this.#modes.set(mode, item);
      modes.append(item);
    }
    const head = h("div", { class: "run-head" }, this.#title, this.#status);
    root.append(h("div", { class: "run" }, head, this.#steps, this.#step), this.#tiles);
  }

  render(
    scene: SceneState | null,
    running: Running | null,
    changedAt: ReadonlyMap<string, number>,
    now: number,
  ): void {
    for (const [mode, item] of this.#modes) {
      setAttribute(item, "aria-current", scene?.mode === mode ? "true" : null);
    }
    const progress = running === null ? null : progressOf(running, scene, now);
    if (running === null || progress === null) {
      const isUnknown = (scene?.command_id ?? null) !== null;
      setText(this.#title, isUnknown ? "A command" : "No command yet");
      setText(this.#status, isUnknown ? "under way since before this page was opened" : "");
    } else {
      this.#renderCommand(running, progress);
    }
    const target = running !== null && progress !== null ? targetOf(running, progress) : null;
    this.#renderObjects(scene?.objects ?? {}, target, changedAt, now);
  }

  #renderCommand(running: Running, progress: Progress): void {
    const { id, reaction, steps } = running.command;
    if (this.#shownCommand !== id) {
      this.#shownCommand = id;
      this.#steps.replaceChildren(
        ...steps.map((step) => h("li", {}, h("span", { class: "visually-hidden" }, stepWords(step)))),
      );
    }
    setText(this.#title, sentenceCase(reaction));
    setText(this.#status, statusOf(running, progress));
    for (const [i, item] of [...this.#steps.children].entries()) {
      if (!(item instanceof HTMLElement)) continue;
      const isDone = progress.state === "done" || (progress.step !== null && i < progress.step);
      const isNow = i === progress.step;
      setState(item, "step", isDone ? "done" : isNow ? "now" : "next");
      setAttribute(item, "aria-current", isNow ? "step" : null);
    }
    const step = progress.step === null ? undefined : steps[progress.step];
    const all = steps.map(stepWords).join(", ");
    setText(this.#step, step === undefined ? sentenceCase(all.toLowerCase()) : stepWords(step));
    setState(this.#step, "now", `${step !== undefined}`);
  }

  #renderObjects(
    states: Readonly<Record<string, string>>,
    target: string | null,
    changedAt: ReadonlyMap<string, number>,
    now: number,
  ): void {
    const objects = Object.entries(states);
    if (objects.length !== this.#tile.size || objects.some(([name]) => !this.#tile.has(name))) {
      this.#buildTiles(objects.map(([name]) => name));
    }
    for (const [name, state] of objects) {
      const tile = this.#tile.get(name);
      if (tile === undefined) continue;
      if (tile.state !== state) {
        tile.state = state;
        tile.picture.replaceChildren(pictogram(name, state));
        setText(tile.word, state.replaceAll("_", " "));
      }
      const changed = changedAt.get(name);
      const isNew = changed !== undefined && now - changed < FLASH_MS;
      setState(tile.root, "mark", isNew ? "changed" : target === name ? "target" : "");
    }
  }

  #buildTiles(names: readonly string[]): void {
    this.#tile.clear();
    this.#tiles.replaceChildren();
    for (const name of names) {
      const picture = h("span");
      const word = h("span", { class: "tile-state" });
      const title = h("span", { class: "tile-name" }, sentenceCase(name));
      const root = h("button", { type: "button", class: "tile" }, picture, title, word);
      root.addEventListener("click", () => this.#onToggle(name));
      setAttribute(root, "title", `Change the ${sentenceCase(name).toLowerCase()} by hand`);
      this.#tile.set(name, { root, picture, word, state: "" });
      this.#tiles.append(h("li", {}, root));
    }
  }
}

export function stepWords(step: StepMessage): string {
  const words = sentenceCase(step.action);
  return step.target === null ? words : `${words} ${sentenceCase(step.target).toLowerCase()}`;
}

function statusOf({ command, status, reason }: Running, { state, isReported }: Progress): string {
  switch (state) {
    case "failed": {
      const word = endWord(status ?? "failed").toLowerCase();
      return reason === null || reason === status ? word : `${word}: ${reason}`;
    }
    case "done":
    case "ended":
      return state;
    case "under_way":
      return `because of ${command.cause.replaceAll("_", " ")}${isReported ? "" : ", no renderer"}`;
  }
}

/** The object that the command is about: that of the present step, or the first one changed. */
function targetOf({ command }: Running, { state, step }: Progress): string | null {
  if (state !== "under_way") return null;
  const now = step === null ? undefined : command.steps[step]?.target;
  return now ?? command.steps.find(({ target }) => target !== null)?.target ?? null;
}
