/** A sensor's place in the session: kept while nobody else sends the same, given up otherwise. */

import { Connection, type Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import { jsonCodec, type Outgoing } from "../protocol/codec.ts";
import type { CalibrationState, ErrorMessage, FaceKind } from "../protocol/messages.ts";

export type LinkState =
  | "opening"
  | "live"
  /** The connection is gone; it comes back by itself. */
  | "waiting"
  /** Another sensor sent the face already. */
  | "taken"
  /** Another sensor took over. */
  | "replaced";

export interface LinkEvents {
  onState(state: LinkState): void;
  onCalibration(calibration: CalibrationState): void;
  /** The server refused something that was sent. */
  onRefusal(error: ErrorMessage): void;
}

/** With more than this waiting to leave, what is new is better left out. */
const MAX_BACKLOG = 100_000;

export class SensorLink {
  state: LinkState = "opening";

  readonly #connection: Connection;
  readonly #events: LinkEvents;

  /**
   * @param face What the sensor has of the face.
   * @param takesOver Whether to push aside a sensor that sends the same already.
   */
  constructor(
    { sensorUrl, session }: Pick<Place, "sensorUrl" | "session">,
    client: Client,
    face: FaceKind,
    takesOver: boolean,
    host: Host,
    events: LinkEvents,
  ) {
    this.#events = events;
    this.#connection = new Connection(
      {
        url: sensorUrl,
        session,
        role: "sensor",
        client,
        codec: jsonCodec,
        greeting: () => ({ face, take_over: takesOver }),
      },
      host,
      {
        onMessage: (message) => {
          if (message.type === "calibration_state") events.onCalibration(message);
          else if (message.type === "error") this.#refused(message);
        },
        onStatus: ({ phase, fault }) => {
          // Coming back would push aside the one that has just taken over.
          if (phase === "stopped" && fault !== null) this.#leave("replaced");
          else if (phase === "live" || phase === "waiting") this.#enter(phase);
        },
      },
    );
  }

  start(): void {
    this.#connection.start();
  }

  /** Send unless it would have to wait; tells whether it went out. */
  post(message: Outgoing): boolean {
    if (this.state !== "live" || this.#connection.backlog >= MAX_BACKLOG) return false;
    this.#connection.post(message);
    return true;
  }

  close(): void {
    this.#connection.stop();
  }

  #refused(error: ErrorMessage): void {
    if (error.code === "stream_taken") this.#leave("taken");
    else this.#events.onRefusal(error);
  }

  #leave(state: "taken" | "replaced"): void {
    if (this.state === state) return;
    this.#enter(state);
    this.#connection.stop();
  }

  #enter(state: LinkState): void {
    if (this.state === state || this.state === "taken" || this.state === "replaced") return;
    this.state = state;
    this.#events.onState(state);
  }
}
