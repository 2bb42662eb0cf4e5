/** The room as the agent needs it, without furniture; and the reactions of the rule file. */

import { readFileSync } from "node:fs";
import { Object3D } from "three";
import { CURTAIN, HIFI, ON_DESK, DESK, WINDOW } from "../src/room/layout.ts";
import type { Props } from "../src/room/agent/props.ts";
import type { StepMessage } from "../src/protocol/messages.ts";

/** Handles that move as those of the scenery do. */
export class FakeProps implements Props {
  /** Share of the way to the second state, by object. */
  readonly at: Record<string, number> = { window: 0, curtain: 0, hifi: 0, cigarette: 0 };
  readonly said: string[] = [];
  readonly #handles: Record<string, { readonly place: Object3D }> = {};
  #led: { object: string; state: string; from: number; share: number } | null = null;

  constructor() {
    for (const name of Object.keys(this.at)) {
      this.#handles[name] = { place: new Object3D() };
      this.#put(name);
    }
  }

  handleOf(object: string): { readonly place: Object3D } | null {
    return this.#handles[object] ?? null;
  }

  setProgress(object: string, state: string, share: number): void {
    const to = state === "open" ? 0 : 1;
    const isNew = this.#led?.object !== object || this.#led.state !== state || share < this.#led.share;
    const from = isNew ? (this.at[object] ?? 0) : (this.#led?.from ?? 0);
    this.#led = { object, state, from, share };
    this.at[object] = from + (to - from) * share;
    this.#put(object);
    if (share === 1) this.said.push(`${object} ${state}`);
  }

  #put(object: string): void {
    const share = this.at[object] ?? 0;
    const place = this.#handles[object]?.place.position;
    const [x, , z] = WINDOW.centre;
    switch (object) {
      case "window": {
        // The left half, hinged at its left, opens outwards.
        const angle = WINDOW.openAngle * (1 - share);
        const [along, inwards] = [0.454, 0.06];
        const hinge = x - WINDOW.width / 2 + 0.045;
        place?.set(
          hinge + along * Math.cos(angle) + inwards * Math.sin(angle),
          1.31,
          z - 0.05 - along * Math.sin(angle) + inwards * Math.cos(angle),
        );
        break;
      }
      case "curtain":
        place?.set(x + 0.76 - 0.75 * (0.27 + 0.73 * share), CURTAIN.pullHeight, z + CURTAIN.depth + 0.03);
        break;
      case "hifi":
        place?.set(...HIFI.knob);
        break;
      default: {
        // It is lifted off the rim and pressed into the bowl.
        const [tx, tz] = ON_DESK.ashtray.at;
        place?.set(tx - 0.03 * share, DESK.top + 0.04 + 0.09 * Math.sin(Math.PI * share), tz - 0.07 * (1 - share));
      }
    }
  }
}

const RULES = new URL("../../scene/room.toml", import.meta.url);

export interface RuleFile {
  readonly reactions: Readonly<Record<string, readonly StepMessage[]>>;
  readonly idle: Readonly<Record<string, Readonly<Record<string, number>>>>;
}

/** What the agent needs of the rule file; its own few lines of TOML. */
export function readRules(): RuleFile {
  const durations: Record<string, number> = {};
  const reactions: Record<string, StepMessage[]> = {};
  const idle: Record<string, Record<string, number>> = {};
  let section = "";
  for (const line of readFileSync(RULES, "utf8").split("\n")) {
    section = /^\[+([\w.]+)\]/.exec(line)?.[1] ?? section;
    const [, key = "", value = ""] = /^"?([\w ]+)"? = (.+)$/.exec(line) ?? [];
    const [head = "", name = ""] = section.split(".");
    if (head === "steps" && key !== "") durations[key] = Number(/duration_s = ([\d.]+)/.exec(value)?.[1]);
    if (head === "idle" && key !== "") (idle[name] ??= {})[key] = Number(value);
    if (head === "reactions" && key === "steps") {
      reactions[name] = [...value.matchAll(/"([^"]+)"/g)].map(([, words = ""]) => {
        const [action = "", target = null] = words.split(" ");
        return { action, target, duration_s: durations[action] ?? 1 };
      });
    }
  }
  return { reactions, idle };
}
