/** The page's end of the worker that reads faces. */

import type { FromWorker, Looked, ToWorker } from "./exchange.ts";
import type { Picture } from "./picture.ts";

export interface ReaderEvents {
  /** The worker has time for a picture; null where there is no new one yet. */
  onAsk(): { readonly picture: Picture; readonly capturedAt: number } | null;
  onLooked(looked: Looked): void;
  /** Faces cannot be read here. */
  onFailed(message: string): void;
}

export class FaceReader {
  readonly #worker: Worker;
  readonly #events: ReaderEvents;

  /** @param modelsUrl Folder of the server's models. */
  constructor(modelsUrl: string, events: ReaderEvents) {
    this.#events = events;
    this.#worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    this.#worker.addEventListener("error", ({ message }) => {
      events.onFailed(message || "the worker did not start");
    });
    this.#worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
      this.#hear(data);
    });
    this.#tell({ kind: "open", modelsUrl });
  }

  close(): void {
    this.#worker.terminate();
  }

  #hear(message: FromWorker): void {
    switch (message.kind) {
      case "ask": {
        const taken = this.#events.onAsk();
        if (taken === null) this.#tell({ kind: "nothing" });
        else this.#tell({ kind: "picture", ...taken }, [taken.picture.data.buffer as ArrayBuffer]);
        return;
      }
      case "looked":
        this.#events.onLooked(message);
        return;
      case "failed":
        this.#events.onFailed(message.message);
    }
  }

  #tell(message: ToWorker, handedOver: Transferable[] = []): void {
    this.#worker.postMessage(message, handedOver);
  }
}
