/** The agent: a body that carries out commands, and is alive between them. */

import { Vector3 } from "three";
import type { PoseStreamMessage } from "../../protocol/messages.ts";
import { VIEW, type Vec3 } from "../layout.ts";
import { Director, isDeed, type Play, type PlayCallbacks } from "./director.ts";
import { Face } from "./face.ts";
import { Idle, ROOM_IDLE, type IdleBehaviour } from "./idle.ts";
import { Chance } from "./maths.ts";
import { Mover } from "./mover.ts";
import { MotionStream } from "./stream.ts";
import { SIGHTS } from "./places.ts";
import type { Props } from "./props.ts";
import { SIDES, type Rig, type Side } from "./rig.ts";

export type Mode = "working" | "attention" | "reacting";

export interface AgentOptions {
  /** Of everything that is left to chance. */
  readonly seed?: number;
  /** What it does unasked; as in the product's rule file unless given. */
  readonly idle?: IdleBehaviour;
  /** Told once of each step that the agent does not know. */
  readonly say?: (sentence: string) => void;
}

/** What the agent is doing, as plain JSON. */
export interface AgentState {
  /** A step of the command, or what it does unasked. */
  readonly doing: string;
  /** Index of the present step, null without a command. */
  readonly step: number | null;
  readonly stance: "seated" | "standing" | "walking" | "between";
  /** Of the hips over the floor, metres; and where the body faces, radians. */
  readonly position: readonly [x: number, z: number];
  readonly heading: number;
  readonly gaze: Vec3;
  readonly hands: Readonly<
    Record<Side, { readonly holds: string | null; readonly error_m: number; readonly led: boolean }>
  >;
}

/** How the face answers a deed's cause, and somebody who is looked at. */
const DISCOMFORT = { level: 0.55, seconds: 1.6 } as const;
const ATTENTION = 0.6;
/** A step of the clock longer than this is taken as a pause of the page, milliseconds. */
const LONGEST_MS = 100;
/** A shift of gaze further than this, in metres, goes with a blink. */
const FAR_GAZE = 0.5;

export class Agent {
  readonly #mover: Mover;
  readonly #director: Director;
  readonly #face: Face;
  readonly #idle: Idle;
  readonly #stream = new MotionStream();
  readonly #lookedAt = new Vector3();
  #mode: Mode = "working";
  #discomfortLeft = 0;

  constructor(rig: Rig, props: Props, options: AgentOptions = {}) {
    const { seed = 1, idle = ROOM_IDLE, say = console.warn } = options;
    const chance = new Chance(seed);
    this.#mover = new Mover(rig, chance);
    this.#director = new Director(this.#mover, props, say);
    this.#face = new Face(rig, chance);
    this.#idle = new Idle(idle, chance);
    this.lookAt(VIEW.from);
    this.#idle.begin("working");
  }

  /** Carry this out, instead of what is under way. */
  play(command: Play, callbacks: PlayCallbacks = {}): void {
    this.#director.play(command, callbacks);
    this.#stream.clear();
    this.#mover.isTyping = false;
    const answers = command.steps.some(({ action }) => isDeed(action));
    this.#discomfortLeft = answers ? DISCOMFORT.seconds : 0;
  }

  /** Give up what is under way: let go, finish the step, stay there. No callback follows. */
  cut(): void {
    this.#director.cut();
    this.#stream.clear();
    this.#discomfortLeft = 0;
  }

  /** Take more of the motion of the command under way: it leads the hands and the trunk. */
  move(stretch: PoseStreamMessage): void {
    this.#stream.push(stretch);
  }

  setMode(mode: Mode): void {
    if (mode === this.#mode) return;
    this.#mode = mode;
    if (mode !== "reacting") this.#idle.begin(mode);
  }

  /** Where the person's eyes are, in the room. */
  lookAt([x, y, z]: Vec3): void {
    this.#director.person.set(x, y, z);
  }

  /** @param dtMs Time since the last step, in milliseconds. */
  step(dtMs: number): void {
    const dt = Math.min(dtMs, LONGEST_MS) / 1000;
    if (!(dt > 0)) return;
    if (this.#director.isPlaying) {
      this.#director.step(dt);
    } else {
      this.#beIdle(dt);
    }
    this.#stream.step(dt);
    this.#placeHands();
    this.#mover.inclination = this.#stream.lean;
    this.#mover.step(dt);
    this.#express(dt);
  }

  get state(): AgentState {
    const { pose, gaze, body } = this.#mover;
    const holding = this.#director.holding;
    const hand = (side: Side) => ({
      holds: holding?.deed.grip.side === side ? holding.deed.object : null,
      error_m: body.arms[side].error,
      led: this.#stream.leads(side),
    });
    return {
      doing: this.#director.doing ?? `${this.#mode}: ${this.#idle.action}`,
      step: this.#director.index,
      stance: this.#stance(),
      position: [pose.hips.x, pose.hips.z],
      heading: pose.heading,
      gaze: [gaze.target.x, gaze.target.y, gaze.target.z],
      hands: { Left: hand("Left"), Right: hand("Right") },
    };
  }

  #stance(): AgentState["stance"] {
    const mover = this.#mover;
    if (mover.isUpright) return mover.isWalking ? "walking" : "standing";
    return mover.isSeated ? "seated" : "between";
  }

  /** Whoever is to work sits down first; whoever attends turns to the person. */
  #beIdle(dt: number): void {
    const mover = this.#mover;
    mover.isTyping = false;
    if (this.#mode === "reacting") return;
    if (this.#mode === "working" && !this.#director.sit()) {
      mover.gaze.aim(SIGHTS["screen"] ?? this.#director.person);
      return;
    }
    this.#idle.step(dt);
    const { action, target } = this.#idle;
    const sight = SIGHTS[target ?? ""] ?? this.#director.person;
    switch (action) {
      case "type_on":
        mover.isTyping = mover.hands.Left.task === "type";
        mover.gaze.aim(SIGHTS["screen"] ?? sight);
        break;
      case "look_at_person":
        this.#director.face(this.#director.person);
        break;
      default:
        mover.gaze.aim(sight);
    }
  }

  /** Hands that hold nothing are on the keys at work, on the desk else, or hang. */
  #placeHands(): void {
    const mover = this.#mover;
    const task = !mover.isAtDesk ? "free" : this.#isWorking() ? "type" : "desk";
    for (const side of SIDES) {
      const hand = mover.hands[side];
      if (hand.task === "hold") continue;
      if (this.#stream.leads(side)) hand.be(this.#stream.arms[side]);
      else hand.do(task);
    }
  }

  #isWorking(): boolean {
    return this.#mover.isTyping || (this.#mode === "working" && !this.#director.isPlaying);
  }

  #express(dt: number): void {
    const { target } = this.#mover.gaze;
    if (target.distanceTo(this.#lookedAt) > FAR_GAZE) this.#face.blink();
    this.#lookedAt.copy(target);
    this.#discomfortLeft -= dt;
    this.#face.discomfort = this.#discomfortLeft > 0 ? DISCOMFORT.level : 0;
    const isAttentive = target.equals(this.#director.person);
    this.#face.attention = isAttentive && this.#discomfortLeft <= 0 ? ATTENTION : 0;
    this.#face.step(dt);
  }
}

