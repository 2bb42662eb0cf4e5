/** What can be measured of the agent's motion, frame by frame, from the bones alone. */

import { Quaternion, Vector3 } from "three";
import { Agent } from "../src/room/agent/agent.ts";
import { RANGES, eachAngle } from "../src/room/agent/limits.ts";
import { Chance } from "../src/room/agent/maths.ts";
import { SIDES, type Joint, type Rig, type Side } from "../src/room/agent/rig.ts";
import { BOXES, outside } from "../src/room/agent/route.ts";
import type { StepMessage } from "../src/protocol/messages.ts";
import { FakeProps } from "./agent-room.ts";

const DEGREE = Math.PI / 180;
/** A sole this near to the floor stands on it, metres. */
const ON_FLOOR = 0.002;
/** Of the toes before their joint, metres. */
const TOES = 0.06;
/** Longest that anything may take, seconds. */
const PATIENCE_S = 20;

/** Frame durations, in milliseconds. */
export type Frames = () => number;

export const steady = (perSecond: number): Frames => () => 1000 / perSecond;

/** Frames of 15 to 60 Hz, in no order. */
export function jittery(seed: number): Frames {
  const chance = new Chance(seed);
  return () => 1000 / chance.between(15, 60);
}

/** The worst of what was seen. */
export interface Worst {
  /** Way of a foot over the floor while it stands, metres a step. */
  slide_m: number;
  /** Of the sole below the floor. */
  sunk_m: number;
  /** Between grip and handle while the hand holds on. */
  contact_m: number;
  /** Beyond the normal range of any joint, degrees; below 0 inside. */
  beyond_range_deg: number;
  beyond_range_of: string;
  /** Of any joint against its parent, degrees a second. */
  joint_speed_deg_s: number;
  joint_speed_of: string;
  /** Change of that speed from frame to frame, degrees a second. */
  speed_change_deg_s: number;
  speed_change_of: string;
  /** Of the hips from the edge of desk and chair while it stands or walks, metres. */
  clearance_m: number;
  clearance_of: string;
}

export function nothing(): Worst {
  return {
    slide_m: 0,
    sunk_m: 0,
    contact_m: 0,
    beyond_range_deg: -180,
    beyond_range_of: "",
    joint_speed_deg_s: 0,
    joint_speed_of: "",
    speed_change_deg_s: 0,
    speed_change_of: "",
    clearance_m: 9,
    clearance_of: "",
  };
}

/** A contact of heel or ball with the floor, since it began. */
interface Contact {
  isOn: boolean;
  readonly began: Vector3;
}

const point = new Vector3();
const turn = new Quaternion();

export class Probe {
  readonly #rig: Rig;
  readonly #agent: Agent;
  readonly #worst: Worst;
  readonly #contacts: Readonly<Record<Side, readonly [Contact, Contact]>>;
  readonly #turns: Quaternion[];
  readonly #speeds: number[];
  /** Added to names, to find the moment again. */
  label = "";
  #frames = 0;

  constructor(rig: Rig, agent: Agent, worst: Worst) {
    this.#rig = rig;
    this.#agent = agent;
    this.#worst = worst;
    const contact = (): Contact => ({ isOn: false, began: new Vector3() });
    this.#contacts = { Left: [contact(), contact()], Right: [contact(), contact()] };
    this.#turns = rig.all.map(() => new Quaternion());
    this.#speeds = rig.all.map(() => 0);
  }

  /** Look at the pose that the agent's last step has made. */
  look(dtMs: number): void {
    this.#lookAtFeet();
    this.#lookAtJoints(dtMs / 1000);
    const worst = this.#worst;
    const { hands, stance, position } = this.#agent.state;
    for (const side of SIDES) {
      const { holds, error_m } = hands[side];
      if (holds !== null) worst.contact_m = Math.max(worst.contact_m, error_m);
    }
    eachAngle(this.#rig, (motion, angle, side) => {
      const [least, most] = RANGES[motion];
      const beyond = Math.max(least - angle, angle - most);
      if (beyond <= worst.beyond_range_deg) return;
      worst.beyond_range_deg = beyond;
      worst.beyond_range_of = `${side ?? ""}${motion} ${this.label}`;
    });
    if (stance === "standing" || stance === "walking") {
      for (const box of [BOXES.desk, BOXES.chair]) {
        const clearance = outside(position, box);
        if (clearance >= worst.clearance_m) continue;
        worst.clearance_m = clearance;
        worst.clearance_of = this.label;
      }
    }
    this.#frames += 1;
  }

  #lookAtFeet(): void {
    for (const side of SIDES) {
      const leg = this.#rig.legs[side];
      const [heel, ball] = this.#contacts[side];
      this.#touch(heel, soleAt(leg.foot, -leg.heel, leg.ankleHeight));
      soleAt(leg.toes, TOES, leg.ballHeight);
      this.#worst.sunk_m = Math.max(this.#worst.sunk_m, -point.y);
      this.#touch(ball, soleAt(leg.toes, 0, leg.ballHeight));
    }
  }

  #touch(contact: Contact, at: Vector3): void {
    const worst = this.#worst;
    worst.sunk_m = Math.max(worst.sunk_m, -at.y);
    const isOn = at.y < ON_FLOOR;
    if (isOn && !contact.isOn) contact.began.copy(at);
    contact.isOn = isOn;
    if (!isOn) return;
    worst.slide_m = Math.max(worst.slide_m, Math.hypot(at.x - contact.began.x, at.z - contact.began.z));
  }

  #lookAtJoints(dt: number): void {
    const worst = this.#worst;
    for (const [i, joint] of this.#rig.all.entries()) {
      const before = this.#turns[i];
      if (before === undefined || joint.parent === null) continue;
      turn.copy(joint.parent.delta).invert().multiply(joint.delta);
      const speed = turn.angleTo(before) / DEGREE / dt;
      before.copy(turn);
      const change = Math.abs(speed - (this.#speeds[i] ?? 0));
      this.#speeds[i] = speed;
      if (this.#frames > 0 && speed > worst.joint_speed_deg_s) {
        worst.joint_speed_deg_s = speed;
        worst.joint_speed_of = `${joint.object.name} ${this.label}`;
      }
      if (this.#frames > 1 && change > worst.speed_change_deg_s) {
        worst.speed_change_deg_s = change;
        worst.speed_change_of = `${joint.object.name} ${this.label}`;
      }
    }
  }
}

function soleAt(joint: Joint, ahead: number, height: number): Vector3 {
  return point.set(0, -height, ahead).applyQuaternion(joint.delta).add(joint.place);
}

export type Start = "seated" | "standing";

/** An agent that has worked for a while, or stands before the window after something was cut short. */
export function agentAt(rig: Rig, start: Start, seed: number, frames: Frames): { agent: Agent; props: FakeProps } {
  const props = new FakeProps();
  const agent = new Agent(rig, props, { seed, say: () => {} });
  const pass = (seconds: number): void => {
    for (let t = 0; t < seconds; ) {
      const dt = frames();
      agent.step(dt);
      t += dt / 1000;
    }
  };
  pass(1.5);
  if (start === "standing") {
    agent.setMode("reacting");
    agent.play({ steps: [{ action: "walk_to", target: "window", duration_s: 2 }] });
    pass(4);
    agent.cut();
    agent.setMode("attention");
    pass(1.5);
  }
  return { agent, props };
}

/** Bring the room into the state in which a reaction has something to do. */
export function prepare(props: FakeProps, reaction: string): void {
  if (reaction === "open_window") props.setProgress("window", "closed", 1);
}

export interface Performance {
  readonly seconds: number;
  /** Seconds until a joint differs by half a degree from what it would do without the command. */
  readonly first_motion_s: number;
  readonly steps: number;
}

/** Play a reaction to its end. */
export function perform(
  makeRig: () => Rig,
  start: Start,
  reaction: string,
  steps: readonly StepMessage[],
  makeFrames: () => Frames,
  worst: Worst,
): Performance {
  const rig = makeRig();
  const twin = makeRig();
  const [frames, twinFrames] = [makeFrames(), makeFrames()];
  const { agent, props } = agentAt(rig, start, 1, frames);
  const other = agentAt(twin, start, 1, twinFrames).agent;
  prepare(props, reaction);
  const probe = new Probe(rig, agent, worst);
  let isDone = false;
  let done = 0;
  let seconds = 0;
  let first = Number.POSITIVE_INFINITY;
  agent.setMode("reacting");
  agent.play({ steps }, { onProgress: () => (done += 1), onDone: () => (isDone = true) });
  while (!isDone && seconds < PATIENCE_S) {
    const dt = frames();
    agent.step(dt);
    other.step(dt);
    seconds += dt / 1000;
    probe.label = `${reaction} ${start} ${agent.state.doing}@${seconds.toFixed(2)}`;
    probe.look(dt);
    if (first > seconds && differ(rig, twin) > 0.5) first = seconds;
  }
  const ended = isDone ? seconds : Number.POSITIVE_INFINITY;
  // What follows is part of it: hands come back, attention begins.
  agent.setMode("attention");
  for (let t = 0; t < 1.5; ) {
    const dt = frames();
    agent.step(dt);
    t += dt / 1000;
    probe.label = `${reaction} ${start} after@${t.toFixed(2)}`;
    probe.look(dt);
  }
  return { seconds: ended, first_motion_s: first, steps: done };
}

/** Largest difference between two poses at one joint, degrees. */
function differ(a: Rig, b: Rig): number {
  let most = 0;
  for (const [i, joint] of a.all.entries()) {
    const other = b.all[i];
    if (other !== undefined) most = Math.max(most, joint.object.quaternion.angleTo(other.object.quaternion));
  }
  for (const [i, eye] of a.eyes.entries()) {
    const other = b.eyes[i];
    if (other !== undefined) most = Math.max(most, eye.object.quaternion.angleTo(other.object.quaternion));
  }
  return most / DEGREE;
}

/** Cut a random reaction at a random moment and play another one to its end. @returns Its seconds. */
export function cutAndGoOn(
  makeRig: () => Rig,
  reactions: Readonly<Record<string, readonly StepMessage[]>>,
  seed: number,
  frames: Frames,
  worst: Worst,
): number {
  const chance = new Chance(seed);
  const names = Object.keys(reactions);
  const some = (): string => names[Math.floor(chance.next() * names.length)] ?? "greet";
  const rig = makeRig();
  const { agent, props } = agentAt(rig, "seated", seed, frames);
  const probe = new Probe(rig, agent, worst);
  const [one, two] = [some(), some()];
  let seconds = 0;
  const pass = (until: number, what: string): void => {
    while (seconds < until) {
      const dt = frames();
      agent.step(dt);
      seconds += dt / 1000;
      probe.label = `cut ${seed}: ${what} ${agent.state.doing}@${seconds.toFixed(2)}`;
      probe.look(dt);
    }
  };
  prepare(props, one);
  agent.setMode("reacting");
  agent.play({ steps: reactions[one] ?? [] });
  pass(chance.between(0.05, 7.5), `${one} before ${two}`);
  agent.cut();
  // At once, or after a moment.
  pass(seconds + (chance.next() < 0.5 ? 0 : chance.between(0, 0.8)), `${one} cut`);
  let ended = Number.POSITIVE_INFINITY;
  const began = seconds;
  agent.play({ steps: reactions[two] ?? [] }, { onDone: () => (ended = seconds) });
  while (ended > seconds && seconds < began + PATIENCE_S) pass(seconds + 1e-6, `${two} after ${one}`);
  return ended - began;
}
