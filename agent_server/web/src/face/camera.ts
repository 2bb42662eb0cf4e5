/**
 * The page as a sensor: reads the face off the camera's pictures and sends its landmarks, or sends
 * the pictures where it cannot.
 */

import type { FromWorker, Looked, ToWorker } from "./exchange.ts";
import { CameraError, Eye, type CameraFault } from "./eye.ts";
import { faceMessage, imageFrame, stampOf } from "./wire.ts";
import { Connection, type Host } from "../net/connection.ts";
import type { Place } from "../place.ts";
import type { CalibrationState, ServerMessage } from "../protocol.ts";

export type CameraPhase = "off" | "asking" | "loading" | "running" | "failed";

/** What the panel shows. */
export interface CameraState {
  readonly phase: CameraPhase;
  readonly fault: CameraFault | null;
  /** Whether the page reads the face itself; else the server does. */
  readonly readsHere: boolean;
  /** Whether the last picture shows a face; null where only the server knows. */
  readonly hasFace: boolean | null;
  /** Faces, or pictures, that left in the last second. */
  readonly rateHz: number;
  /** Time to read the last face, in milliseconds. */
  readonly tookMs: number | null;
  /** Whether another sensor sends this session's face. */
  readonly isTaken: boolean;
  /** When the calibration that was asked for ends, on the page's clock, or null. */
  readonly neutralUntil: number | null;
  /** What the neutral face is held to be; null without a calibration. */
  readonly neutral: Pick<CalibrationState, "valence" | "arousal"> | null;
  /** What the last calibration came to, in words; empty for none. */
  readonly said: string;
}

const OFF: CameraState = {
  phase: "off",
  fault: null,
  readsHere: true,
  hasFace: null,
  rateHz: 0,
  tookMs: null,
  isTaken: false,
  neutralUntil: null,
  neutral: null,
  said: "",
};
export const NEUTRAL_S = 3;
const POINTS_EVERY_MS = 50;
const PICTURE_EVERY_MS = 100;
const RETRY_MS = 15;
/** With more than this waiting to leave, a picture is left out. */
const MAX_BACKLOG = 100_000;
const STORED = "agent-server.neutral-face";

export class Camera {
  state: CameraState = OFF;
  /** Landmarks of the last picture, with its size. */
  latest: Looked | null = null;

  readonly #place: Place;
  readonly #host: Host;
  readonly #client: { readonly name: string; readonly version: string };
  readonly #video: HTMLVideoElement;
  readonly #onChange: () => void;
  #connection: Connection | null = null;
  #eye: Eye | null = null;
  #worker: Worker | null = null;
  #sentAt: number[] = [];
  /** Counts the times that the camera was switched; what an earlier time began is dropped. */
  #turn = 0;

  constructor(
    place: Place,
    host: Host,
    client: { readonly name: string; readonly version: string },
    video: HTMLVideoElement,
    onChange: () => void,
  ) {
    this.#place = place;
    this.#host = host;
    this.#client = client;
    this.#video = video;
    this.#onChange = onChange;
    this.state = { ...OFF, neutral: storedNeutral() };
  }

  async start(takeOver = false): Promise<void> {
    this.stop();
    const turn = this.#turn;
    this.#enter({ phase: "asking", fault: null, isTaken: false });
    try {
      const eye = await Eye.open(this.#video, () => this.#fail("lost"));
      if (turn !== this.#turn) {
        eye.close();
        return;
      }
      this.#eye = eye;
    } catch (error) {
      if (turn === this.#turn) this.#fail(error instanceof CameraError ? error.fault : "unknown");
      return;
    }
    this.#connect(takeOver);
    if (this.#place.sendsPictures) this.#sendPictures(turn);
    else this.#openWorker(turn);
  }

  stop(): void {
    this.#turn += 1;
    this.#close();
    this.#enter({ ...OFF, neutral: this.state.neutral });
  }

  /** The person looks neutral for the next seconds. */
  calibrate(): void {
    const now = this.#host.now();
    this.#connection?.post({
      type: "calibrate",
      originating_ns: stampOf(now),
      seconds: NEUTRAL_S,
    });
    this.#enter({ neutralUntil: now + NEUTRAL_S * 1000, said: "" });
  }

  /** Hold nothing against a neutral face any more. */
  forget(): void {
    localStorage.removeItem(STORED);
    this.#enter({ neutral: null, said: "" });
    this.#postNeutral({ valence: 0, arousal: 0 });
  }

  #connect(takeOver: boolean): void {
    const sensor = { face: "expected", ...(takeOver ? { take_over: true } : {}) } as const;
    this.#connection = new Connection(
      this.#place.sensorUrl,
      { ...this.#client, token: this.#place.token, sensor },
      this.#host,
      {
        onMessage: (message) => this.#hear(message),
        onStatus: () => this.#onChange(),
      },
    );
    this.#connection.start();
  }

  #hear(message: ServerMessage): void {
    if (message.type === "welcome" && this.state.neutral !== null) {
      this.#postNeutral(this.state.neutral);
    } else if (message.type === "calibration_state") {
      this.#calibrated(message);
    } else if (message.type === "error" && message.code === "stream_taken") {
      this.#enter({ isTaken: true });
    }
  }

  #calibrated({ valence, arousal, is_done }: CalibrationState): void {
    const wasAsked = this.state.neutralUntil !== null;
    if (!wasAsked) return;
    if (is_done) localStorage.setItem(STORED, JSON.stringify({ valence, arousal }));
    this.#enter({
      neutralUntil: null,
      neutral: is_done ? { valence, arousal } : this.state.neutral,
      said: is_done ? "Your neutral face is known now." : "Too few faces were seen; try again.",
    });
  }

  #postNeutral({ valence, arousal }: Pick<CalibrationState, "valence" | "arousal">): void {
    const originating_ns = stampOf(this.#host.now());
    this.#connection?.post({ type: "calibrate", originating_ns, valence, arousal });
  }

  // ------------------------------------------------------------------ reading here

  #openWorker(turn: number): void {
    this.#enter({ phase: "loading" });
    try {
      const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
      this.#worker = worker;
      worker.addEventListener("error", () => this.#giveUpReading(turn));
      worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
        if (turn === this.#turn) this.#answer(turn, data);
      });
      this.#tell({ kind: "open", modelsUrl: this.#place.modelsUrl });
    } catch {
      this.#giveUpReading(turn);
    }
  }

  #answer(turn: number, data: FromWorker): void {
    switch (data.kind) {
      case "failed":
        this.#giveUpReading(turn);
        return;
      case "ready":
        this.#enter({ phase: "running", readsHere: true });
        this.#offer(turn, this.#host.now());
        return;
      case "looked": {
        this.latest = data;
        const message = faceMessage(data);
        const hasRoom = (this.#connection?.backlog ?? 0) < MAX_BACKLOG;
        if (message !== null && hasRoom) this.#connection?.post(message);
        this.#enter({
          hasFace: message !== null,
          tookMs: data.tookMs,
          rateHz: message === null ? 0 : this.#count(),
        });
        this.#offer(turn, data.capturedAt + POINTS_EVERY_MS);
      }
    }
  }

  /** Give the worker the next picture, not before `due`. */
  #offer(turn: number, due: number): void {
    this.#host.after(Math.max(0, due - this.#host.now()), () => {
      if (turn !== this.#turn) return;
      const picture = this.#eye?.picture() ?? null;
      const now = this.#host.now();
      if (picture === null) this.#offer(turn, now + RETRY_MS);
      else this.#tell({ kind: "picture", picture, capturedAt: now });
    });
  }

  #tell(message: ToWorker): void {
    const given = message.kind === "picture" ? [message.picture.data.buffer as ArrayBuffer] : [];
    this.#worker?.postMessage(message, given);
  }

  #giveUpReading(turn: number): void {
    if (turn !== this.#turn) return;
    this.#worker?.terminate();
    this.#worker = null;
    this.#sendPictures(turn);
  }

  // ------------------------------------------------------------------ reading at the server

  #sendPictures(turn: number): void {
    this.latest = null;
    this.#enter({ phase: "running", readsHere: false, hasFace: null, tookMs: null });
    const next = async (): Promise<void> => {
      const eye = this.#eye;
      if (turn !== this.#turn || eye === null) return;
      const now = this.#host.now();
      if ((this.#connection?.backlog ?? 0) < MAX_BACKLOG) {
        const jpeg = await eye.jpeg();
        if (jpeg !== null && turn === this.#turn) {
          this.#connection?.post(imageFrame(jpeg, now));
          this.#enter({ rateHz: this.#count() });
        }
      }
      this.#host.after(PICTURE_EVERY_MS, () => void next());
    };
    void next();
  }

  #count(): number {
    const now = this.#host.now();
    this.#sentAt = [...this.#sentAt.filter((at) => now - at < 1000), now];
    return this.#sentAt.length;
  }

  #fail(fault: CameraFault): void {
    this.#turn += 1;
    this.#close();
    this.#enter({ ...OFF, neutral: this.state.neutral, phase: "failed", fault });
  }

  #close(): void {
    this.#worker?.terminate();
    this.#worker = null;
    this.#eye?.close();
    this.#eye = null;
    this.#connection?.stop();
    this.#connection = null;
    this.#sentAt = [];
    this.latest = null;
  }

  #enter(change: Partial<CameraState>): void {
    this.state = { ...this.state, ...change };
    this.#onChange();
  }
}

function storedNeutral(): CameraState["neutral"] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(STORED) ?? "null");
    if (typeof kept !== "object" || kept === null) return null;
    const { valence, arousal } = kept as Record<string, unknown>;
    return typeof valence === "number" && typeof arousal === "number" ? { valence, arousal } : null;
  } catch {
    return null;
  }
}
