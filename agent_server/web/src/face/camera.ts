/**
 * The page as a sensor: reads the face off the camera's pictures and sends its landmarks, or sends
 * the pictures where it cannot.
 */

import type { Looked } from "./exchange.ts";
import { CameraError, Eye, type CameraFault } from "./eye.ts";
import { SensorLink, type LinkState } from "./link.ts";
import { storeNeutral, storedNeutral, type Neutral } from "./neutral.ts";
import { FaceReader } from "./reader.ts";
import { faceMessage, imageMessage, stampOf } from "./wire.ts";
import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import type { Outgoing } from "../protocol/codec.ts";
import type { CalibrationState } from "../protocol/messages.ts";

export type CameraPhase = "off" | "asking" | "loading" | "running" | "failed";

/** What the panel shows. */
export interface CameraState {
  readonly phase: CameraPhase;
  readonly fault: CameraFault | null;
  readonly link: LinkState;
  /** Whether the page reads the face itself; else the server does. */
  readonly readsHere: boolean;
  /** Whether the last picture shows a face; null where only the server knows. */
  readonly hasFace: boolean | null;
  /** Faces, or pictures, that left in the last second. */
  readonly rateHz: number;
  /** Time to read the last face, in milliseconds. */
  readonly tookMs: number | null;
  /** When the calibration that was asked for ends, on the page's clock, or null. */
  readonly neutralUntil: number | null;
  /** What the neutral face is held to be; null without a calibration. */
  readonly neutral: Neutral | null;
  /** Something that has just happened, in words; empty for nothing. */
  readonly said: string;
}

const OFF: Omit<CameraState, "neutral"> = {
  phase: "off",
  fault: null,
  link: "opening",
  readsHere: true,
  hasFace: null,
  rateHz: 0,
  tookMs: null,
  neutralUntil: null,
  said: "",
};
export const NEUTRAL_S = 3;
/** The answer comes with the first face after the calibration; later than this none will. */
const ANSWER_WITHIN_MS = 2_000;
const SAID_FOR_MS = 4_000;
const PICTURE_EVERY_MS = 100;

export class Camera {
  state: CameraState = { ...OFF, neutral: storedNeutral() };
  /** Landmarks of the last picture, with its size. */
  latest: Looked | null = null;

  readonly #place: Place;
  readonly #host: Host;
  readonly #client: Client;
  readonly #video: HTMLVideoElement;
  readonly #onChange: () => void;
  #link: SensorLink | null = null;
  #eye: Eye | null = null;
  #reader: FaceReader | null = null;
  #sentAt: number[] = [];
  #cancelAnswer: () => void = () => {};
  #cancelSaid: () => void = () => {};
  /** Counts the times that the camera was switched; what an earlier time began is dropped. */
  #turn = 0;

  constructor(
    place: Place,
    host: Host,
    client: Client,
    video: HTMLVideoElement,
    onChange: () => void,
  ) {
    this.#place = place;
    this.#host = host;
    this.#client = client;
    this.#video = video;
    this.#onChange = onChange;
  }

  /** @param takesOver Whether to push aside a sensor that sends the face already. */
  async start(takesOver = false): Promise<void> {
    this.stop();
    const turn = this.#turn;
    this.#enter({ phase: "asking" });
    try {
      const eye = await Eye.open(this.#video, () => {
        if (turn === this.#turn) this.#fail("lost");
      });
      if (turn !== this.#turn) {
        eye.close();
        return;
      }
      this.#eye = eye;
    } catch (error) {
      if (turn === this.#turn) this.#fail(error instanceof CameraError ? error.fault : "unknown");
      return;
    }
    this.#join(turn, takesOver);
    if (this.#place.sendsPictures) this.#sendPictures(turn);
    else this.#readHere(turn);
  }

  stop(): void {
    this.#close();
    this.#enter(OFF);
  }

  /** The person looks neutral for the next seconds. */
  calibrate(): void {
    const now = this.#host.now();
    const originating_ns = stampOf(now);
    if (!this.#post({ type: "calibrate", originating_ns, seconds: NEUTRAL_S })) return;
    const durationMs = NEUTRAL_S * 1000;
    this.#enter({ neutralUntil: now + durationMs, said: "" });
    this.#cancelAnswer = this.#host.after(durationMs + ANSWER_WITHIN_MS, () =>
      this.#endCalibration("No face was seen; try again."),
    );
  }

  /** Hold nothing against a neutral face any more. */
  forget(): void {
    storeNeutral(null);
    this.#enter({ neutral: null });
    this.#postNeutral({ valence: 0, arousal: 0 });
    this.#say("Your neutral face is forgotten.");
  }

  // ------------------------------------------------------------------ the session

  #join(turn: number, takesOver: boolean): void {
    this.#link = new SensorLink(this.#place, this.#client, "expected", takesOver, this.#host, {
      onState: (link) => {
        if (turn !== this.#turn) return;
        this.#enter({ link });
        if (link === "live" && this.state.neutral !== null) this.#postNeutral(this.state.neutral);
      },
      onCalibration: (calibration) => this.#calibrated(calibration),
      onRefusal: ({ message }) => this.#say(`The server says: ${message}.`),
    });
    this.#link.start();
  }

  #post(message: Outgoing): boolean {
    return this.#link?.post(message) ?? false;
  }

  #postNeutral({ valence, arousal }: Neutral): void {
    const originating_ns = stampOf(this.#host.now());
    this.#post({ type: "calibrate", originating_ns, valence, arousal });
  }

  #calibrated({ valence, arousal, is_done }: CalibrationState): void {
    // A neutral face that was posted is answered too.
    if (this.state.neutralUntil === null) return;
    if (!is_done) {
      this.#endCalibration("Too few faces were seen; try again.");
      return;
    }
    storeNeutral({ valence, arousal });
    this.#enter({ neutral: { valence, arousal } });
    this.#endCalibration("Your neutral face is known now.");
  }

  #endCalibration(said: string): void {
    this.#cancelAnswer();
    this.#enter({ neutralUntil: null });
    this.#say(said);
  }

  #say(said: string): void {
    this.#cancelSaid();
    this.#enter({ said });
    this.#cancelSaid = this.#host.after(SAID_FOR_MS, () => this.#enter({ said: "" }));
  }

  // ------------------------------------------------------------------ reading here

  #readHere(turn: number): void {
    this.#enter({ phase: "loading" });
    try {
      this.#reader = new FaceReader(this.#place.modelsUrl, {
        onAsk: () => {
          if (this.state.phase !== "running") this.#enter({ phase: "running" });
          const picture = this.#eye?.picture() ?? null;
          return picture === null ? null : { picture, capturedAt: this.#host.now() };
        },
        onLooked: (looked) => this.#sendFace(looked),
        onFailed: () => this.#sendPictures(turn),
      });
    } catch {
      this.#sendPictures(turn);
    }
  }

  #sendFace(looked: Looked): void {
    this.latest = looked;
    const message = faceMessage(looked);
    this.#enter({
      hasFace: message !== null,
      tookMs: looked.tookMs,
      rateHz: this.#rateWith(message !== null && this.#post(message)),
    });
  }

  /** @returns What left in the last second, with what has left just now. */
  #rateWith(hasLeft: boolean): number {
    const now = this.#host.now();
    this.#sentAt = this.#sentAt.filter((at) => now - at < 1000);
    if (hasLeft) this.#sentAt.push(now);
    return this.#sentAt.length;
  }

  // ------------------------------------------------------------------ reading at the server

  #sendPictures(turn: number): void {
    this.#reader?.close();
    this.#reader = null;
    this.latest = null;
    this.#enter({ phase: "running", readsHere: false, hasFace: null, tookMs: null });
    const next = async (): Promise<void> => {
      const now = this.#host.now();
      const jpeg = (await this.#eye?.jpeg()) ?? null;
      if (turn !== this.#turn) return;
      const hasLeft = jpeg !== null && this.#post(imageMessage(jpeg, now));
      this.#enter({ rateHz: this.#rateWith(hasLeft) });
      this.#host.after(PICTURE_EVERY_MS, () => void next());
    };
    void next();
  }

  // ------------------------------------------------------------------ switching

  #fail(fault: CameraFault): void {
    this.#close();
    this.#enter({ ...OFF, phase: "failed", fault });
  }

  #close(): void {
    this.#turn += 1;
    this.#cancelAnswer();
    this.#cancelSaid();
    this.#reader?.close();
    this.#reader = null;
    this.#eye?.close();
    this.#eye = null;
    this.#link?.close();
    this.#link = null;
    this.#sentAt = [];
    this.latest = null;
  }

  #enter(change: Partial<CameraState>): void {
    this.state = { ...this.state, ...change };
    this.#onChange();
  }
}
