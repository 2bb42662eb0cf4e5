/**
 * Carries out a command's steps one after the other, from wherever the body is. A step sees to
 * what it needs first: who is to close the window and sits gets up and walks there.
 */

import { Vector3 } from "three";
import type { StepMessage } from "../../protocol/messages.ts";
import type { Mover } from "./mover.ts";
import { GRIPS, SIGHTS, isPlace, sideOf, spotOf, type PlaceName } from "./places.ts";
import type { Props } from "./props.ts";
import { Reach } from "./reach.ts";

/** A command as far as the agent needs to know it; the message `command` is one. */
export interface Play {
  readonly steps: readonly StepMessage[];
}

export interface PlayCallbacks {
  /** The first step has begun. */
  onStarted?(): void;
  /** A step has ended. */
  onProgress?(step: number): void;
  onDone?(): void;
}

/** What deeds make of their objects, and how long the hand leads them, in seconds. */
const DEEDS: Readonly<Record<string, { readonly state: string; readonly seconds: number }>> = {
  open: { state: "open", seconds: 0.85 },
  close: { state: "closed", seconds: 0.85 },
  turn_down: { state: "low", seconds: 0.7 },
  put_out: { state: "out", seconds: 1.2 },
};

/** Whether a step does something to an object: such a command answers a discomfort. */
export const isDeed = (action: string): boolean => action in DEEDS;

/** Seconds that a turn or a look takes at least. */
const TURN_S = 0.7;
const LOOK_S = 1.1;
/** The next step may begin this long before a walk ends. */
const EARLY_S = 0.36;
const SIT_EARLY_S = 0.22;
/** Who stands turns the whole body to what is further aside than this, radians. */
const ASIDE = 0.6;

export class Director {
  /** Between the person's eyes. */
  readonly person = new Vector3();
  readonly #mover: Mover;
  readonly #props: Props;
  readonly #say: (sentence: string) => void;
  readonly #unknown = new Set<string>();
  #steps: readonly StepMessage[] = [];
  #callbacks: PlayCallbacks = {};
  #index = 0;
  /** Of the present step, in seconds; -1 before it begins. */
  #time = -1;
  #reach: Reach | null = null;
  #goal: PlaceName | "here" | null = null;

  constructor(mover: Mover, props: Props, say: (sentence: string) => void) {
    this.#mover = mover;
    this.#props = props;
    this.#say = say;
  }

  get isPlaying(): boolean {
    return this.#index < this.#steps.length;
  }

  /** Index of the present step; null when there is none. */
  get index(): number | null {
    return this.isPlaying ? this.#index : null;
  }

  get doing(): string | null {
    const step = this.#steps[this.#index];
    if (step === undefined) return null;
    return step.target === null ? step.action : `${step.action} ${step.target}`;
  }

  /** What the hand holds; null when it holds nothing. */
  get holding(): Reach | null {
    return this.#reach?.isHolding === true ? this.#reach : null;
  }

  play({ steps }: Play, callbacks: PlayCallbacks): void {
    this.#release();
    this.#steps = steps;
    this.#callbacks = callbacks;
    this.#index = 0;
    this.#time = -1;
    this.#goal = null;
  }

  /** Give up what is under way; nothing more is said of it. */
  cut(): void {
    this.#steps = [];
    this.#index = 0;
    this.#release();
    this.#goal = null;
    this.#mover.halt();
  }

  step(dt: number): void {
    if (!this.isPlaying) return;
    if (this.#time < 0) {
      this.#time = 0;
      if (this.#index === 0) this.#callbacks.onStarted?.();
      if (!this.isPlaying) return;
    } else this.#time += dt;
    this.#reach?.step(dt);
    const step = this.#steps[this.#index];
    if (step === undefined || !this.#perform(step)) return;
    const index = this.#index;
    this.#reach = null;
    this.#goal = null;
    this.#time = -1;
    this.#index += 1;
    this.#callbacks.onProgress?.(index);
    if (this.#index === this.#steps.length && index === this.#index - 1) this.#finish();
  }

  /** Go and sit down at the desk. @returns Whether it sits there. */
  sit(): boolean {
    const mover = this.#mover;
    if (mover.isUpright) {
      if (!this.#walk("chair") || mover.gait.remaining > SIT_EARLY_S) return false;
      mover.sitDown();
      this.#goal = null;
    }
    if (mover.seat.goal !== "seated") mover.sitDown();
    return mover.isSeated;
  }

  /** Turn to somebody or something, with the whole body where one stands. @returns Whether it has. */
  face(sight: Vector3): boolean {
    const mover = this.#mover;
    mover.gaze.aim(sight);
    if (!mover.isUpright) return true;
    if (this.#goal === "here") return mover.gait.hasArrived;
    const { x, z, heading } = mover.gait.now;
    const to = Math.atan2(sight.x - x, sight.z - z);
    this.#goal = "here";
    if (Math.abs(Math.sin((to - heading) / 2)) < ASIDE / 2) return true;
    mover.walkTo({ at: [x, z], heading: to });
    return false;
  }

  #finish(): void {
    const { onDone } = this.#callbacks;
    this.#steps = [];
    this.#index = 0;
    onDone?.();
  }

  /** @returns Whether the step is over. */
  #perform(step: StepMessage): boolean {
    const mover = this.#mover;
    const { action, target } = step;
    switch (action) {
      case "stand_up":
        mover.gaze.aim(this.#ahead());
        return this.#stand();
      case "sit_down":
        mover.gaze.aim(this.person);
        return this.sit();
      case "walk_to":
        if (target === null || !isPlace(target)) return this.#pass(step);
        mover.gaze.aim(target === "chair" ? this.person : this.#sight(target));
        return this.#walk(target) && mover.gait.remaining < EARLY_S;
      case "turn_to":
        return this.face(this.#sight(target)) && this.#time >= TURN_S;
      case "turn_to_person":
        if (this.#time === 0) mover.gaze.nod();
        return this.face(this.person) && this.#time >= TURN_S;
      case "look_at":
        mover.gaze.aim(this.#sight(target));
        return this.#time >= LOOK_S;
      case "look_at_person":
        mover.gaze.aim(this.person);
        return this.#time >= LOOK_S;
      case "type_on":
        return this.sit() && this.#type(step);
      default:
        return isDeed(action) && target !== null && target in GRIPS
          ? this.#handle(action, target)
          : this.#pass(step);
    }
  }

  #stand(): boolean {
    this.#mover.standUp(sideOf(this.#ahead().x));
    return this.#mover.isUpright;
  }

  /** @returns Whether one is on the last steps to a place, or there. */
  #walk(to: PlaceName): boolean {
    const mover = this.#mover;
    if (!this.#stand()) return false;
    if (this.#goal !== to) {
      this.#goal = to;
      const spot = spotOf(to, sideOf(mover.gait.now.x));
      if (!mover.isAt(spot)) mover.walkTo(spot);
    }
    return true;
  }

  #handle(action: string, object: string): boolean {
    const mover = this.#mover;
    if (this.#reach !== null) return this.#reach.phase === "over";
    mover.gaze.aim(this.#sight(object));
    if (isPlace(object)) {
      if (!this.#walk(object) || mover.gait.remaining > EARLY_S) return false;
    } else if (!this.sit()) return false;
    const handle = this.#props.handleOf(object);
    const [deed, grip] = [DEEDS[action], GRIPS[object]];
    if (handle === null || deed === undefined || grip === undefined) return true;
    this.#reach = new Reach(mover, this.#props, { object, ...deed, handle: handle.place, grip });
    return false;
  }

  #type({ duration_s }: StepMessage): boolean {
    const mover = this.#mover;
    if (!mover.isTyping) this.#time = 0;
    mover.isTyping = true;
    mover.hands.Left.do("type");
    mover.hands.Right.do("type");
    mover.gaze.aim(this.#sight("screen"));
    return this.#time >= duration_s;
  }

  /** A step that is not known takes its usual time. */
  #pass({ action, target, duration_s }: StepMessage): boolean {
    const words = target === null ? action : `${action} ${target}`;
    if (!this.#unknown.has(words)) {
      this.#unknown.add(words);
      this.#say(`the agent does not know the step "${words}": it waits for ${duration_s} s instead`);
    }
    return this.#time >= duration_s;
  }

  #release(): void {
    if (this.#reach !== null && this.#reach.phase !== "over") this.#reach.letGo();
    this.#reach = null;
  }

  #sight(name: string | null): Vector3 {
    return SIGHTS[name ?? ""] ?? this.person;
  }

  /** What the walk after getting up leads to. */
  #ahead(): Vector3 {
    for (let i = this.#index; i < this.#steps.length; i += 1) {
      const target = this.#steps[i]?.target;
      if (target !== null && target !== undefined) return this.#sight(target);
    }
    return this.person;
  }
}
