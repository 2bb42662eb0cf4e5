/** The strip at the top and the counters at the bottom. */

import type { Status } from "../net/status.ts";
import type { StatsMessage, Welcome } from "../protocol/messages.ts";
import type { SensorState } from "../state/view.ts";
import { count, milliseconds, signedSeconds } from "../state/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

const CONNECTION_WORDS: Readonly<Record<Status["phase"], string>> = {
  stopped: "stopped",
  opening: "connecting",
  greeting: "connecting",
  live: "connected",
  waiting: "not connected",
};

const BROKEN: ReadonlySet<Status["phase"]> = new Set(["waiting", "stopped"]);

const SENSOR_WORDS: Readonly<Record<SensorState, string>> = {
  unknown: "unknown",
  none: "none yet",
  no_body: "nobody in view",
  live: "streaming",
};

/** Counters in the order shown, and whether they ought to stay at zero. */
const COUNTERS: readonly (readonly [keyof StatsMessage & string, string, boolean])[] = [
  ["frames", "frames", false],
  ["windows", "windows", false],
  ["decisions", "decisions", false],
  ["commands", "commands", false],
  ["skipped_windows", "skipped windows", true],
  ["predictor_failures", "predictor failures", true],
  ["rejected_messages", "rejected messages", true],
  ["missed_telemetry", "missed telemetry", false],
];

export class StatusStrip {
  readonly #session: HTMLElement;
  readonly #connection = field("Server");
  readonly #sensor = field("Sensor");
  readonly #rate = field("Body");
  readonly #latency = field("Decision");
  readonly #roundTrip = field("Round trip");

  constructor(session: HTMLElement, lamps: HTMLElement, gauges: HTMLElement) {
    this.#session = session;
    lamps.append(this.#connection.root, this.#sensor.root);
    gauges.append(this.#rate.root, this.#latency.root, this.#roundTrip.root);
  }

  render(
    session: string,
    status: Status,
    sensor: SensorState,
    rateHz: number | null,
    latencyMs: number | null,
  ): void {
    setText(this.#session, session);
    setText(this.#connection.value, CONNECTION_WORDS[status.phase]);
    setState(
      this.#connection.root,
      "lamp",
      status.phase === "live" ? "good" : BROKEN.has(status.phase) ? "bad" : "wait",
    );
    const shown = status.phase === "live" ? sensor : "unknown";
    setText(this.#sensor.value, SENSOR_WORDS[shown]);
    setState(this.#sensor.root, "lamp", shown === "live" ? "good" : "wait");
    setText(this.#rate.value, rateHz === null ? "\u2013" : `${rateHz.toFixed(0)} fps`);
    setText(this.#latency.value, latencyMs === null ? "\u2013" : milliseconds(latencyMs));
    const { roundTripMs, offsetMs } = status;
    setText(this.#roundTrip.value, roundTripMs === null ? "\u2013" : milliseconds(roundTripMs));
    const clock = offsetMs === null ? null : `The server\u2019s clock less this page\u2019s: ${signedSeconds(offsetMs)}`;
    setAttribute(this.#roundTrip.root, "title", clock);
  }
}

export class Counters {
  readonly #values = new Map<string, ReturnType<typeof field>>();
  readonly #server: HTMLElement;

  constructor(list: HTMLElement, server: HTMLElement) {
    this.#server = server;
    for (const [key, words] of COUNTERS) {
      const item = field(words);
      this.#values.set(key, item);
      list.append(item.root);
    }
  }

  render(stats: StatsMessage | null, welcome: Welcome | null): void {
    for (const [key, , isTrouble] of COUNTERS) {
      const item = this.#values.get(key);
      const value = stats?.[key];
      if (item === undefined) continue;
      setText(item.value, typeof value === "number" ? count(value) : "\u2013");
      setState(item.root, "trouble", `${isTrouble && typeof value === "number" && value > 0}`);
    }
    setText(
      this.#server,
      welcome === null ? "" : `${welcome.server} ${welcome.server_version}, protocol ${welcome.protocol}`,
    );
  }
}

function field(name: string): { readonly root: HTMLElement; readonly value: HTMLElement } {
  const value = h("dd", {}, "\u2013");
  return { root: h("div", { class: "field" }, h("dt", {}, name), value), value };
}
