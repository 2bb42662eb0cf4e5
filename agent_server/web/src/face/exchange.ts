/** What the page and its face worker say to each other. */

import type { Picture } from "./picture.ts";

export type ToWorker =
  /** Load the networks; `modelsUrl` is the folder of the server's models. */
  | { readonly kind: "open"; readonly modelsUrl: string }
  /** Answers `ask`: look for the face in a picture taken at `capturedAt`, in milliseconds. */
  | { readonly kind: "picture"; readonly picture: Picture; readonly capturedAt: number }
  /** Answers `ask`: there is no new picture yet. */
  | { readonly kind: "nothing" };

/** What came of a picture. */
export interface Looked {
  readonly kind: "looked";
  readonly capturedAt: number;
  readonly width: number;
  readonly height: number;
  /** x, y, z of each landmark in pixels, or null without a face. */
  readonly points: Float32Array | null;
  readonly tookMs: number;
}

export type FromWorker =
  /** The worker has time for a picture; the first time, its networks are loaded. */
  { readonly kind: "ask" } | Looked | { readonly kind: "failed"; readonly message: string };
