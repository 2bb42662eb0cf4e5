/** The page's state as plain values, for tests: `window.agentPage.state()`. */

import type { AgentState } from "../room/agent/agent.ts";
import type { Status } from "../net/status.ts";
import type { StatsMessage } from "../protocol/messages.ts";
import type { Row } from "./log.ts";
import { endOf, progressOf, type Progress } from "./running.ts";
import type { Store } from "./store.ts";
import { affectNow, decisionNow, isFresh, type Affect, type Problem, type SensorState } from "./view.ts";

export interface RowSummary {
  readonly outcome: string;
  readonly gesture: string | null;
  readonly count: number;
}

export interface Summary {
  readonly connection: {
    readonly phase: string;
    readonly fault: string | null;
    readonly roundTripMs: number | null;
    /** The server's clock less the page's. */
    readonly offsetMs: number | null;
  };
  /** Kind of the problem that the notice names, or null. */
  readonly problem: string | null;
  readonly sensor: SensorState;
  readonly session: string | null;
  readonly lastDecision: {
    readonly id: string;
    readonly index: number;
    readonly outcome: string;
    readonly gesture: string;
    readonly reason: string;
    readonly reaction: string | null;
  } | null;
  /** The gesture that is held to be going on now, or null without a recent decision. */
  readonly gesture: string | null;
  readonly gateOpen: boolean | null;
  readonly affect: Affect | null;
  readonly mode: string | null;
  readonly objects: Readonly<Record<string, string>>;
  /** The latest command and how far it is. */
  readonly command: ({ readonly id: string } & Progress) | null;
  /** Capture time of the pose on show, or null while nobody is. */
  readonly poseNs: number | null;
  readonly forecastFrames: number;
  /**
   * Rows of the log, newest first; `outcome` is `error` for what the server could not do, `missed`
   * for telemetry that was lost, and for the end of a command how it ended.
   */
  readonly log: readonly RowSummary[];
  readonly errors: readonly { readonly code: string; readonly message: string }[];
  readonly stats: StatsMessage | null;
  /** Pictures that the 3D view has drawn; null where there is no WebGL. */
  readonly pictures: number | null;
  /** The agent's room. */
  readonly room: RoomSummary;
}

export interface RoomSummary {
  /** `loading`, `ready`, `failed` or `no_webgl`. */
  readonly phase: string;
  /** `waiting`, `acting` or `watching`; null before the room is there. */
  readonly part: string | null;
  /** Id of the command that the agent is at. */
  readonly playing: string | null;
  readonly agent: AgentState | null;
  readonly pictures: number;
  /** Triangles that are there, and draw calls of the last picture. */
  readonly counts: { readonly triangles: number; readonly drawCalls: number } | null;
}

export function summaryOf(page: {
  readonly store: Store;
  readonly status: Status;
  readonly problem: Problem | null;
  readonly sensor: SensorState;
  readonly pictures: number | null;
  readonly room: RoomSummary;
  readonly now: number;
}): Summary {
  const { store, status, now } = page;
  const last = store.decision?.value.decision;
  const scene = store.scene?.value ?? null;
  const { running } = store;
  const current = decisionNow(store, now)?.decision;
  return {
    connection: {
      phase: status.phase,
      fault: status.fault?.kind ?? null,
      roundTripMs: status.roundTripMs,
      offsetMs: status.offsetMs,
    },
    problem: page.problem?.kind ?? null,
    sensor: page.sensor,
    session: store.welcome?.session ?? null,
    lastDecision:
      last === undefined
        ? null
        : {
            id: last.id,
            index: last.index,
            outcome: last.outcome,
            gesture: last.gesture,
            reason: last.reason,
            reaction: last.command?.reaction ?? null,
          },
    gesture: current?.gesture ?? null,
    gateOpen: current?.gate.is_open ?? null,
    affect: affectNow(store, now),
    mode: scene?.mode ?? null,
    objects: scene?.objects ?? {},
    command: running === null ? null : { id: running.command.id, ...progressOf(running, scene, now) },
    poseNs: isFresh(store.pose, now) ? store.pose.value.originating_ns : null,
    forecastFrames: isFresh(store.forecast, now) ? store.forecast.value.positions.length : 0,
    log: store.log.rows
      .map(brief)
      .reverse(),
    errors: store.errors.map(({ code, message }) => ({ code, message })),
    stats: store.stats,
    pictures: page.pictures,
    room: page.room,
  };
}

function brief(row: Row): RowSummary {
  switch (row.kind) {
    case "decisions":
      return {
        outcome: row.last.decision.outcome,
        gesture: row.last.decision.gesture,
        count: row.count,
      };
    case "command":
      return { outcome: "command", gesture: null, count: 1 };
    case "error":
      return { outcome: "error", gesture: null, count: row.count };
    case "end":
      return { outcome: endOf(row.ack), gesture: null, count: 1 };
    case "missed":
      return { outcome: "missed", gesture: null, count: 1 };
  }
}
