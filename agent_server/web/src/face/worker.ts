/** Reads faces off pictures, away from the page's own thread. */

import type { FromWorker, ToWorker } from "./exchange.ts";
import { loadNetworks } from "./networks.ts";
import { FaceTracker } from "./tracker.ts";

let tracker: FaceTracker | null = null;

const say = (message: FromWorker): void => postMessage(message);

onmessage = async ({ data }: MessageEvent<ToWorker>): Promise<void> => {
  try {
    if (data.kind === "open") {
      tracker = new FaceTracker(await loadNetworks(data.modelsUrl));
      say({ kind: "ready" });
    } else if (tracker !== null) {
      const { picture, capturedAt } = data;
      const began = performance.now();
      const points = await tracker.find(picture);
      const { width, height } = picture;
      const tookMs = performance.now() - began;
      say({ kind: "looked", capturedAt, width, height, points, tookMs });
    }
  } catch (error) {
    say({ kind: "failed", message: error instanceof Error ? error.message : `${error}` });
  }
};
