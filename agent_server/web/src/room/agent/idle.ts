/** What the agent does unasked, by weights, as in the rule file. */

import type { Chance } from "./maths.ts";

/** How often each step is done relative to the others: `"look_at notebook": 1`. */
export type Weights = Readonly<Record<string, number>>;

export interface IdleBehaviour {
  readonly working: Weights;
  readonly attention: Weights;
}

/** As in the product's own `room.toml`. */
export const ROOM_IDLE: IdleBehaviour = {
  working: { "type_on keyboard": 6, "look_at screen": 3, "look_at notebook": 1 },
  attention: { look_at_person: 8, "look_at notebook": 1, "look_at cigarette": 1 },
};

/** Seconds that one of them lasts; looks aside are short. */
const LASTS: Readonly<Record<string, readonly [number, number]>> = {
  type_on: [2.5, 5.5],
  look_at_person: [2.2, 5],
};
const LOOK: readonly [number, number] = [1, 2.2];

interface Choice {
  readonly action: string;
  readonly target: string | null;
  readonly weight: number;
}

export class Idle {
  action = "";
  target: string | null = null;
  readonly #chance: Chance;
  readonly #choices: Readonly<Record<keyof IdleBehaviour, readonly Choice[]>>;
  #mode: keyof IdleBehaviour = "working";
  #left = 0;

  constructor(behaviour: IdleBehaviour, chance: Chance) {
    this.#chance = chance;
    this.#choices = {
      working: choicesOf(behaviour.working),
      attention: choicesOf(behaviour.attention),
    };
  }

  /** Begin anew with the likeliest one. */
  begin(mode: keyof IdleBehaviour): void {
    this.#mode = mode;
    const choices = this.#choices[mode];
    let best: Choice | undefined = choices[0];
    for (const choice of choices) if (best !== undefined && choice.weight > best.weight) best = choice;
    this.#take(best);
  }

  /** @returns Whether it changed to another behaviour. */
  step(dt: number): boolean {
    this.#left -= dt;
    if (this.#left > 0) return false;
    const choices = this.#choices[this.#mode];
    let sum = 0;
    for (const { weight } of choices) sum += weight;
    let at = this.#chance.next() * sum;
    let chosen = choices[0];
    for (const choice of choices) {
      chosen = choice;
      at -= choice.weight;
      if (at < 0) break;
    }
    this.#take(chosen);
    return true;
  }

  #take(choice: Choice | undefined): void {
    this.action = choice?.action ?? "";
    this.target = choice?.target ?? null;
    const [least, most] = LASTS[this.action] ?? LOOK;
    this.#left = this.#chance.between(least, most);
  }
}

function choicesOf(weights: Weights): Choice[] {
  return Object.entries(weights).map(([step, weight]) => {
    const [action = "", target = null] = step.split(" ");
    return { action, target, weight };
  });
}
