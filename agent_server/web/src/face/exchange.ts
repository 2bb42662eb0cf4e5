/** What the page and its face worker say to each other. */

import type { Picture } from "./picture.ts";

export type ToWorker =
  /** Load the networks; `modelsUrl` is the folder of the server's models. */
  | { readonly kind: "open"; readonly modelsUrl: string }
  /** Look for the face in a picture taken at `capturedAt`, in milliseconds; one at a time. */
  | { readonly kind: "picture"; readonly picture: Picture; readonly capturedAt: number };

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
  /** The networks are loaded. */
  { readonly kind: "ready" } | Looked | { readonly kind: "failed"; readonly message: string };
