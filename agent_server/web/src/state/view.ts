/** What the panels show, derived from store, connection and directory at one instant. */

import type { Directory } from "../net/directory.ts";
import type { Fault, Status } from "../net/status.ts";
import type { Place } from "../place.ts";
import type { DecisionMessage } from "../protocol/messages.ts";
import type { Moment, Store, Timed } from "./store.ts";

/** Telemetry of a kind that has not come for this long counts as gone. */
export const STALE_MS = 1_500;

export type SensorState = "unknown" | "none" | "no_body" | "live";

export interface Affect {
  readonly valence: number;
  readonly arousal: number;
  /** False while no face is in use: the values are those of the last face. */
  readonly isFresh: boolean;
  /** Standard deviations, or null where the sensor gave the affect itself. */
  readonly spread: { readonly valence: number; readonly arousal: number } | null;
  /** What it was read from: `client`, `mesh`, `points68` or `blendshapes`. */
  readonly source: string;
}

/** Something that keeps the page from showing a live session, and what to do about it. */
export interface Problem {
  readonly kind:
    | "connecting"
    | "unreachable"
    | "lost"
    | "refused"
    | "version"
    | "no_sensor"
    | "no_body";
  readonly title: string;
  readonly text: string;
  /** When the next attempt starts on the connection's clock, or null. */
  readonly retryAt: number | null;
  /** Whether the page does not try again unless somebody asks it to. */
  readonly isGivenUp: boolean;
}

/** Whether there is a value that still speaks of the present. */
export function isFresh<T>(timed: Timed<T> | null, now: number): timed is Timed<T> {
  return timed !== null && now - timed.at <= STALE_MS;
}

export function sensorState(
  store: Store,
  directory: Directory,
  place: Place,
  now: number,
): SensorState {
  if (isFresh(store.pose, now)) return "live";
  if (directory.kind !== "listed") return "unknown";
  const mine = directory.sessions.find(({ id }) => id === place.session);
  return mine?.sensor === true ? "no_body" : "none";
}

export function affectNow(moment: Moment, now: number): Affect | null {
  const latest = moment.affect.at(-1) ?? null;
  if (latest === null) return null;
  const { valence, arousal, originating_ns, valence_sd, arousal_sd, source } = latest.value;
  const decision = moment.decision?.value.decision;
  const isRefused =
    decision !== undefined && decision.end_ns > originating_ns && decision.gate.valence === null;
  return {
    valence,
    arousal,
    isFresh: isFresh(latest, now) && !isRefused,
    spread: valence_sd === null || arousal_sd === null ? null : { valence: valence_sd, arousal: arousal_sd },
    source,
  };
}

/** The decision that still speaks of the present, or null. */
export function decisionNow({ decision }: Moment, now: number): DecisionMessage | null {
  return isFresh(decision, now) ? decision.value : null;
}

/** @param hasCamera Whether this page is a sensor of the session itself. */
export function problemOf(
  status: Status,
  directory: Directory,
  sensor: SensorState,
  place: Place,
  hasCamera: boolean,
): Problem | null {
  const { phase, fault, retryAt } = status;
  if (phase !== "live") {
    if (fault === null) {
      return {
        kind: "connecting",
        title: "Connecting",
        text: `Asking for session \u201c${place.session}\u201d at ${place.monitorUrl}.`,
        retryAt,
        isGivenUp: false,
      };
    }
    const isGivenUp = phase === "stopped";
    return { ...explain(fault, directory, place, isGivenUp), retryAt, isGivenUp };
  }
  if (sensor === "none") {
    return {
      kind: "no_sensor",
      title: "Waiting for a sensor",
      text:
        `Session \u201c${place.session}\u201d has no sensor yet. ` +
        `Connect one to ${place.sensorUrl}, or send a recording there with agent-server replay.`,
      retryAt: null,
      isGivenUp: false,
    };
  }
  if (sensor === "no_body" && hasCamera) {
    return {
      kind: "no_body",
      title: "A face, but no body",
      text:
        "The camera of this page sends the face. The body comes from a sensor of its own: " +
        `connect one to ${place.sensorUrl}, or send a recording there with agent-server replay.`,
      retryAt: null,
      isGivenUp: false,
    };
  }
  if (sensor === "no_body") {
    return {
      kind: "no_body",
      title: "Nobody in view",
      text: "The sensor is connected, but it sees no body at the moment.",
      retryAt: null,
      isGivenUp: false,
    };
  }
  return null;
}

type Explained = Pick<Problem, "kind" | "title" | "text">;

const GIVEN_UP = " The page does not come back by itself: another client has its place, or the server said goodbye.";

function explain(
  fault: Fault,
  directory: Directory,
  place: Place,
  isGivenUp: boolean,
): Explained {
  switch (fault.kind) {
    case "version":
      return {
        kind: "version",
        title: "Versions do not match",
        text:
          `The server refused this page: ${fault.message}. Reload the page; ` +
          "if that does not help, it comes from another release than the server.",
      };
    case "refused":
      return {
        kind: "refused",
        title: "The server refused this page",
        text: `${fault.message} (${fault.code}).${isGivenUp ? GIVEN_UP : ""}`,
      };
    case "silent":
      return {
        kind: "lost",
        title: "The server has gone silent",
        text: "The connection was open, but nothing came through it any more.",
      };
    case "lost":
      return {
        kind: "lost",
        title: "Connection lost",
        text:
          `The server closed the connection (${fault.reason || `code ${fault.closeCode}`}).` +
          (isGivenUp ? GIVEN_UP : ""),
      };
    case "unreachable":
      return unreachable(directory, place);
  }
}

function unreachable(directory: Directory, place: Place): Explained {
  if (directory.kind === "refused" && (directory.status === 401 || directory.status === 403)) {
    return {
      kind: "refused",
      title: "The server wants a token",
      text: "Add #token=\u2026 to the address of this page, with the token that the server was started with.",
    };
  }
  if (directory.kind === "listed") {
    const others = directory.sessions.map(({ id }) => id);
    return {
      kind: "refused",
      title: "The server did not open the session",
      text:
        `It answers, but not at ${place.monitorUrl}. ` +
        (others.length > 0 && !others.includes(place.session)
          ? `It has these sessions: ${others.join(", ")}.`
          : "Is the session\u2019s name right, and is there room for one more?"),
    };
  }
  return {
    kind: "unreachable",
    title: "The server cannot be reached",
    text: `Nothing answers at ${place.monitorUrl}. Start it with agent-server serve; this page connects by itself.`,
  };
}
