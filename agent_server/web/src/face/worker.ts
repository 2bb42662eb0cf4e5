/**
 * Reads faces off pictures, away from the page's own thread. It sets the pace too: browsers slow
 * the timers of a page that is out of sight, but not those of its workers.
 */

import type { FromWorker, ToWorker } from "./exchange.ts";
import { loadNetworks } from "./networks.ts";
import { FaceTracker } from "./tracker.ts";

const EVERY_MS = 50;
const RETRY_MS = 15;

let tracker: FaceTracker | null = null;
let askedAt = 0;

const say = (message: FromWorker): void => postMessage(message);

function ask(): void {
  askedAt = performance.now();
  say({ kind: "ask" });
}

async function answer(message: ToWorker): Promise<void> {
  switch (message.kind) {
    case "open":
      tracker = new FaceTracker(await loadNetworks(message.modelsUrl));
      ask();
      return;
    case "nothing":
      setTimeout(ask, RETRY_MS);
      return;
    case "picture": {
      if (tracker === null) return;
      const { picture, capturedAt } = message;
      const began = performance.now();
      const points = await tracker.find(picture);
      const { width, height } = picture;
      const tookMs = performance.now() - began;
      say({ kind: "looked", capturedAt, width, height, points, tookMs });
      setTimeout(ask, Math.max(0, askedAt + EVERY_MS - performance.now()));
    }
  }
}

onmessage = ({ data }: MessageEvent<ToWorker>): void => {
  answer(data).catch((error: unknown) => {
    say({ kind: "failed", message: error instanceof Error ? error.message : `${error}` });
  });
};
