/** Names of the protocol in words for people. */

import type { AckTelemetry, DecisionBody } from "../protocol/messages.ts";
import { endOf } from "./running.ts";

const OUTCOMES: Readonly<Record<string, string>> = {
  command: "Command",
  idle: "Idle",
  unsure: "Unsure",
  cooling_down: "Cooling down",
  handled: "Already handled",
  gated: "Held back",
  busy: "Busy",
  nothing_to_do: "Nothing to do",
};

const SOURCES: Readonly<Record<string, string>> = {
  client: "sensor",
  mesh: "landmarks",
  points68: "68 landmarks",
  blendshapes: "blendshapes",
};

const ENDS: Readonly<Record<string, readonly [title: string, text: string]>> = {
  expired: ["Expired", "nobody started it in time"],
  preempted: ["Cut short", "another command came"],
  timed_out: ["Timed out", "the renderer said nothing more"],
  assumed: ["Assumed done", "its usual time has passed, and no renderer reports"],
};

const ERRORS: Readonly<Record<string, string>> = {
  scene_differs: "Room differs",
  clock_jump: "Clock jump",
};

/** How a command ended: `expired` -> `Expired`. */
export function endWord(end: string): string {
  return ENDS[end]?.[0] ?? sentenceCase(end);
}

/** Which command ended, and why. */
export function endText(ack: AckTelemetry, reaction: string | null): string {
  const which = sentenceCase(reaction ?? ack.command_id);
  const why = ENDS[endOf(ack)]?.[1] ?? ack.reason;
  return why === null ? which : `${which}: ${why}`;
}

/** Telemetry that was lost: `12 pose, 3 forecast`. */
export function missedText(topics: Readonly<Record<string, number>>): string {
  const kinds = Object.entries(topics).map(([topic, n]) => `${count(n)} ${topic.replaceAll("_", " ")}`);
  return `This page was too slow for ${kinds.join(", ")}`;
}

export function errorWord(code: string): string {
  return ERRORS[code] ?? "Error";
}

/** What affect was read from; `client` is a sensor that gives valence and arousal itself. */
export function sourceWord(source: string): string {
  return SOURCES[source] ?? sentenceCase(source);
}

/** `close_window` -> `Close window`. */
export function sentenceCase(name: string): string {
  const words = name.replaceAll("_", " ").replaceAll("hifi", "hi-fi");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export function outcomeWord(outcome: string): string {
  return OUTCOMES[outcome] ?? sentenceCase(outcome);
}

/**
 * A decision's reason without the gesture before it, which is shown beside it; a command's begins
 * with the state of the room that asked for it.
 */
export function reasonOf(decision: Pick<DecisionBody, "gesture" | "reason" | "outcome" | "scene">): string {
  const { gesture, reason, outcome, scene } = decision;
  const prefix = `${gesture}: `;
  const rest = reason.startsWith(prefix) ? reason.slice(prefix.length) : reason;
  const state = outcome === "command" ? scene?.precondition : null;
  return sentenceCase(state == null ? rest : `${state}, ${rest}`);
}

/** Nanoseconds on the session's time line -> `1:04.2`. */
export function sessionTime(ns: number): string {
  const tenths = Math.floor(ns / 1e8);
  const minutes = Math.floor(tenths / 600);
  const seconds = Math.floor((tenths % 600) / 10);
  return `${minutes}:${String(seconds).padStart(2, "0")}.${tenths % 10}`;
}

/** A signed level of affect, with a real minus sign. */
export function level(value: number): string {
  const text = Math.abs(value).toFixed(1);
  return value < 0 && text !== "0.0" ? `\u2212${text}` : text;
}

/** Milliseconds with as many digits as matter. */
export function milliseconds(value: number): string {
  return `${value < 10 ? value.toFixed(1) : value.toFixed(0)} ms`;
}

/** Milliseconds, ahead or behind, in seconds with a real sign. */
export function signedSeconds(ms: number): string {
  return `${ms < 0 ? "\u2212" : "+"}${(Math.abs(ms) / 1000).toFixed(3)} s`;
}

export function percent(share: number): string {
  return `${Math.round(share * 100)} %`;
}

export function count(n: number): string {
  return n.toLocaleString("en");
}
