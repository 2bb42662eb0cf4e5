/**
 * A recorded person before the agent: what the sensors of a recording sent is sent again, at the
 * pace at which it was captured. The page is the session's sensor meanwhile.
 */

import { SensorLink, type LinkState } from "../face/link.ts";
import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import type { Outgoing } from "../protocol/codec.ts";
import type { FaceKind } from "../protocol/messages.ts";

/** What was sent, each message with its time from the first, in milliseconds. */
export type Recording = readonly { readonly at_ms: number; readonly message: Outgoing }[];

export interface Recordings {
  names(): Promise<readonly string[]>;
  open(name: string): Promise<Recording>;
}

export interface RecordedState {
  readonly phase: "off" | "loading" | "playing" | "failed";
  readonly link: LinkState;
  readonly name: string | null;
  readonly fault: string | null;
}

const OFF: RecordedState = { phase: "off", link: "opening", name: null, fault: null };

/** The recordings that the server offers at `url`. */
export function recordingsOf(url: string, fetcher: typeof fetch): Recordings {
  const get = async (address: string): Promise<Response> => {
    const response = await fetcher(address);
    if (!response.ok) throw new Error(`the server does not give ${address} (${response.status})`);
    return response;
  };
  return {
    names: async () => ((await (await get(url)).json()) as { streams: readonly string[] }).streams,
    open: async (name) => {
      const text = await (await get(`${url}/${encodeURIComponent(name)}`)).text();
      const lines = text.split("\n").filter((line) => line !== "");
      return lines.map((line) => JSON.parse(line) as Recording[number]);
    },
  };
}

/** What a recording has of a face. */
function faceOf(recording: Recording): FaceKind {
  const types = new Set<string>(recording.map(({ message }) => message.type));
  if (["affect", "face", "blendshapes"].some((type) => types.has(type))) return "expected";
  return types.has("gaze") ? "gaze" : "none";
}

export class Recorded {
  state = OFF;

  readonly #place: Place;
  readonly #client: Client;
  readonly #host: Host;
  readonly #recordings: Recordings;
  readonly #onChange: () => void;
  #link: SensorLink | null = null;
  #cancelTimer: () => void = () => {};
  #turn = 0;

  constructor(
    place: Place,
    client: Client,
    host: Host,
    recordings: Recordings,
    onChange: () => void,
  ) {
    this.#place = place;
    this.#client = client;
    this.#host = host;
    this.#recordings = recordings;
    this.#onChange = onChange;
  }

  /**
   * Play a recording from its start.
   *
   * @param takesOver Whether to push aside a sensor that sends a body already.
   */
  async start(name: string, takesOver = false): Promise<void> {
    this.stop();
    const turn = this.#turn;
    this.#enter({ phase: "loading", name });
    let recording: Recording;
    try {
      recording = await this.#recordings.open(name);
    } catch (error) {
      if (turn !== this.#turn) return;
      this.stop();
      const fault = error instanceof Error ? error.message : `${error}`;
      this.#enter({ phase: "failed", name, fault });
      return;
    }
    if (turn !== this.#turn) return;
    const face = faceOf(recording);
    this.#link = new SensorLink(this.#place, this.#client, face, takesOver, this.#host, {
      onState: (state) => {
        this.#enter({ link: state });
        if (state !== "live" || this.state.phase !== "loading") return;
        this.#enter({ phase: "playing" });
        this.#send(recording, 0, this.#host.now());
      },
      onCalibration: () => {},
      onRefusal: ({ message }) => this.#enter({ fault: message }),
    });
    this.#link.start();
  }

  stop(): void {
    this.#turn += 1;
    this.#cancelTimer();
    this.#link?.close();
    this.#link = null;
    this.#enter(OFF);
  }

  /** Send what is due, and come back for the next; at the end the person leaves. */
  #send(recording: Recording, from: number, startedAt: number): void {
    const passedMs = this.#host.now() - startedAt;
    let sent = from;
    for (const { at_ms, message } of recording.slice(from)) {
      if (at_ms > passedMs) {
        const goOn = (): void => this.#send(recording, sent, startedAt);
        this.#cancelTimer = this.#host.after(at_ms - passedMs, goOn);
        return;
      }
      this.#link?.post(message);
      sent += 1;
    }
    this.stop();
  }

  #enter(change: Partial<RecordedState>): void {
    this.state = { ...this.state, ...change };
    this.#onChange();
  }
}
