/** How far a command is: by the renderer's word, or by its usual duration where none speaks. */

import type { AckTelemetry, CommandBody, SceneState } from "../protocol/messages.ts";

/** Ends of a command that are worth a word of their own; `assumed` is that of no renderer. */
const ENDS = new Set(["failed", "expired", "preempted", "timed_out", "assumed"]);

/** Whether a command has ended otherwise than by a renderer's `done`. */
export function isOddEnd(ack: AckTelemetry): boolean {
  return ENDS.has(ack.status);
}

/** How it ended: the server's word, or the reason that a renderer gave for its `failed`. */
export function endOf({ status, reason }: AckTelemetry): string {
  return status === "failed" && reason !== null && ENDS.has(reason) ? reason : status;
}

/** The latest command, and what the renderer said of it. */
export interface Running {
  readonly command: CommandBody;
  /** When the page heard of it, on the page's clock. */
  readonly at: number;
  /** The renderer's last word; null while there is none. */
  readonly status: string | null;
  /** Index of the step that the renderer spoke of, or null. */
  readonly step: number | null;
  readonly reason: string | null;
}

export interface Progress {
  readonly state: "under_way" | "done" | "failed" | "ended";
  /** Index of the step under way, or null where none is known to be. */
  readonly step: number | null;
  /** Whether a renderer reports; without one the room goes by the usual duration of each step. */
  readonly isReported: boolean;
}

export function acknowledged(running: Running, ack: AckTelemetry): Running {
  const step = ack.step ?? (ack.status === "started" ? 0 : running.step);
  return { ...running, status: endOf(ack), step, reason: ack.reason };
}

export function progressOf(running: Running, scene: SceneState | null, now: number): Progress {
  const { command, status } = running;
  const isReported = status !== null && status !== "assumed";
  if (status === "done" || status === "assumed") return { state: "done", step: null, isReported };
  if (status !== null && ENDS.has(status)) return { state: "failed", step: null, isReported };
  const passedS = (now - running.at) / 1000;
  if (scene?.command_id !== command.id) {
    const total = command.steps.reduce((sum, { duration_s }) => sum + duration_s, 0);
    // The stream that the room's time follows may run a little ahead of the page's clock.
    const isOver = !isReported && passedS >= 0.8 * total;
    return { state: isOver ? "done" : "ended", step: null, isReported };
  }
  return {
    state: "under_way",
    step: isReported ? running.step : stepAfter(command, passedS),
    isReported,
  };
}

function stepAfter({ steps }: CommandBody, passedS: number): number {
  let end = 0;
  const index = steps.findIndex(({ duration_s }) => (end += duration_s) > passedS);
  return index < 0 ? steps.length - 1 : index;
}
