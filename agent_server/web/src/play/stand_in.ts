/**
 * A made-up person in front of a made-up sensor: anybody can play without hardware. The page is the
 * session's sensor meanwhile; frames leave at 30 Hz, the mood ten times a second.
 */

import { SensorLink, type LinkState } from "../face/link.ts";
import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import type { Clip, ClipSource } from "./clips.ts";
import { Reel } from "./reel.ts";

/** Valence and arousal, each in [-10, 10]. */
export interface Mood {
  readonly valence: number;
  readonly arousal: number;
}

export interface StandInState {
  readonly phase: "off" | "loading" | "playing" | "failed";
  readonly link: LinkState;
  /** What is done, `idle` at rest. */
  readonly doing: string;
  readonly mood: Mood;
  readonly fault: string | null;
}

export const UNCOMFORTABLE: Mood = { valence: -6, arousal: 5 };
export const NEUTRAL: Mood = { valence: 0, arousal: 0 };
export const CONTENT: Mood = { valence: 6, arousal: 3 };

const FRAME_MS = 1000 / 30;
const MOOD_EVERY = 3;
const RESTS = 2;

const OFF = { phase: "off", link: "opening", doing: "idle", fault: null } as const;

export class StandIn {
  state: StandInState = { ...OFF, mood: UNCOMFORTABLE };

  readonly #place: Place;
  readonly #client: Client;
  readonly #host: Host;
  readonly #clips: ClipSource;
  readonly #onChange: () => void;
  #reel = new Reel();
  #link: SensorLink | null = null;
  #cancelTimer: () => void = () => {};
  #startedAt = 0;
  #sent = 0;
  #take = 0;

  constructor(place: Place, client: Client, host: Host, clips: ClipSource, onChange: () => void) {
    this.#place = place;
    this.#client = client;
    this.#host = host;
    this.#clips = clips;
    this.#onChange = onChange;
  }

  /**
   * Come before the sensor.
   *
   * @param takesOver Whether to push aside a sensor that sends a body already.
   */
  async start(takesOver = false): Promise<void> {
    this.stop();
    this.#enter({ phase: "loading", fault: null });
    const link = new SensorLink(this.#place, this.#client, "expected", takesOver, this.#host, {
      onState: (state) => this.#enter({ link: state }),
      onCalibration: () => {},
      onRefusal: ({ message }) => this.#enter({ fault: message }),
    });
    this.#link = link;
    const rests = await this.#load(() =>
      Promise.all(Array.from({ length: RESTS }, (_, take) => this.#clips("idle", take))),
    );
    if (rests === null || this.#link !== link) return;
    this.#reel = new Reel();
    this.#reel.rests = rests;
    this.#startedAt = this.#host.now();
    this.#sent = 0;
    link.start();
    this.#enter({ phase: "playing" });
    this.#send();
  }

  /** Leave. */
  stop(): void {
    this.#cancelTimer();
    this.#link?.close();
    this.#link = null;
    this.#enter(OFF);
  }

  /** Do something; comes before the sensor first if need be. */
  async perform(gesture: string): Promise<void> {
    if (this.state.phase !== "playing") await this.start();
    const clip = await this.#load(() => this.#clips(gesture, this.#take++));
    if (clip !== null && this.state.phase === "playing") this.#reel.play(clip);
  }

  setMood(mood: Mood): void {
    this.#enter({ mood });
  }

  async #load<T extends Clip | readonly Clip[]>(get: () => Promise<T>): Promise<T | null> {
    try {
      return await get();
    } catch (error) {
      this.stop();
      const fault = error instanceof Error ? error.message : String(error);
      this.#enter({ phase: "failed", fault });
      return null;
    }
  }

  /** Send what is due, at even times, whatever the timer makes of them. */
  #send(): void {
    const dueMs = this.#startedAt + (this.#sent + 1) * FRAME_MS;
    this.#cancelTimer = this.#host.after(Math.max(0, dueMs - this.#host.now()), () => this.#send());
    const originating_ns = Math.round(this.#sent * FRAME_MS * 1e6);
    const frame = this.#reel.next();
    if (frame !== null) this.#link?.post({ ...frame, originating_ns });
    if (this.#sent % MOOD_EVERY === 0) {
      this.#link?.post({ type: "affect", originating_ns, ...this.state.mood });
    }
    this.#sent += 1;
    const doing = this.#reel.doing ?? "idle";
    if (doing !== this.state.doing) this.#enter({ doing });
  }

  #enter(change: Partial<StandInState>): void {
    this.state = { ...this.state, ...change };
    this.#onChange();
  }
}
