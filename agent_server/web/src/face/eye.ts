/** The person's camera: asked for, opened, lost; and its pictures one by one. */

import type { Picture } from "./picture.ts";

/** Why there is no camera. */
export type CameraFault = "insecure" | "refused" | "missing" | "busy" | "lost" | "unknown";

export class CameraError extends Error {
  readonly fault: CameraFault;

  constructor(fault: CameraFault, cause?: unknown) {
    super(fault, { cause });
    this.fault = fault;
  }
}

const MAX_WIDTH = 640;
const QUALITY = 0.8;

export class Eye {
  readonly video: HTMLVideoElement;
  readonly #stream: MediaStream;
  readonly #canvas = document.createElement("canvas");
  readonly #context: CanvasRenderingContext2D;
  #shown = -1;

  private constructor(video: HTMLVideoElement, stream: MediaStream) {
    this.video = video;
    this.#stream = stream;
    const context = this.#canvas.getContext("2d", { willReadFrequently: true });
    if (context === null) throw new CameraError("unknown");
    this.#context = context;
  }

  /**
   * Ask for the camera and wait for its first picture.
   *
   * @throws {CameraError} With the reason why there is none.
   */
  static async open(video: HTMLVideoElement, onLost: () => void): Promise<Eye> {
    if (!isSecureContext || navigator.mediaDevices === undefined) throw new CameraError("insecure");
    let stream: MediaStream;
    try {
      stream = await navigator.mediaDevices.getUserMedia({
        video: { width: { ideal: MAX_WIDTH }, height: { ideal: 480 }, facingMode: "user" },
        audio: false,
      });
    } catch (error) {
      throw new CameraError(faultOf(error), error);
    }
    for (const track of stream.getVideoTracks()) track.addEventListener("ended", onLost);
    const eye = new Eye(video, stream);
    video.srcObject = stream;
    try {
      await video.play();
    } catch (error) {
      eye.close();
      throw new CameraError("unknown", error);
    }
    return eye;
  }

  close(): void {
    for (const track of this.#stream.getTracks()) track.stop();
    this.video.srcObject = null;
  }

  /** The present picture, or null while it is still the last one. */
  picture(): Picture | null {
    if (!this.#draw()) return null;
    const { width, height } = this.#canvas;
    return this.#context.getImageData(0, 0, width, height);
  }

  /** The present picture as JPEG, or null while it is still the last one. */
  async jpeg(): Promise<Uint8Array<ArrayBuffer> | null> {
    if (!this.#draw()) return null;
    const blob = await new Promise<Blob | null>((resolve) =>
      this.#canvas.toBlob(resolve, "image/jpeg", QUALITY),
    );
    return blob === null ? null : new Uint8Array(await blob.arrayBuffer());
  }

  #draw(): boolean {
    const { video } = this;
    if (video.videoWidth === 0 || video.currentTime === this.#shown) return false;
    this.#shown = video.currentTime;
    const scale = Math.min(1, MAX_WIDTH / video.videoWidth);
    this.#canvas.width = Math.round(video.videoWidth * scale);
    this.#canvas.height = Math.round(video.videoHeight * scale);
    this.#context.drawImage(video, 0, 0, this.#canvas.width, this.#canvas.height);
    return true;
  }
}

/** By the name of what `getUserMedia` throws. */
export function faultOf(error: unknown): CameraFault {
  switch (error instanceof Error || error instanceof DOMException ? error.name : "") {
    case "NotAllowedError":
    case "SecurityError":
      return "refused";
    case "NotFoundError":
    case "OverconstrainedError":
      return "missing";
    case "NotReadableError":
    case "AbortError":
      return "busy";
    default:
      return "unknown";
  }
}
