/** The person's own camera: what it sees, what it does, and what can be done with it. */

import type { Camera } from "../face/camera.ts";
import { CONTOURS } from "../face/contours.ts";
import { cameraWords } from "../face/words.ts";
import { h, setAttribute, setState, setText } from "../ui/dom.ts";

export class CameraPanel {
  readonly video = h("video", { playsinline: "", muted: "", "aria-label": "Your camera" });
  readonly #root: HTMLElement;
  readonly #lines = h("canvas", { "aria-hidden": "true" });
  readonly #words = h("p", { class: "camera-words", role: "status" });
  readonly #toggle = h("button", { type: "button", class: "quiet-button" });
  readonly #takeOver = h("button", { type: "button", class: "quiet-button" }, "Send mine instead");
  readonly #neutral = h("button", { type: "button", class: "quiet-button" }, "My face is neutral");
  readonly #forget = h("button", { type: "button", class: "quiet-button" }, "Forget it");
  #drawn: object | null = null;

  constructor(root: HTMLElement) {
    this.#root = root;
    this.video.muted = true;
    root.append(
      h("div", { class: "camera-view" }, this.video, this.#lines),
      h(
        "div",
        { class: "camera-side" },
        this.#words,
        h("div", { class: "camera-row" }, this.#toggle, this.#takeOver, this.#neutral, this.#forget),
      ),
    );
  }

  connect(camera: Camera): void {
    this.#toggle.addEventListener("click", () => {
      const { phase } = camera.state;
      if (phase === "off" || phase === "failed") void camera.start();
      else camera.stop();
    });
    this.#takeOver.addEventListener("click", () => void camera.start(true));
    this.#neutral.addEventListener("click", () => camera.calibrate());
    this.#forget.addEventListener("click", () => camera.forget());
  }

  /** @param clock The camera's clock, in milliseconds. */
  render(camera: Camera, clock: number): void {
    const { state } = camera;
    const isOn = state.phase !== "off" && state.phase !== "failed";
    setState(this.#root, "phase", state.phase);
    setText(this.#words, cameraWords(state, clock));
    setAttribute(this.#toggle, "title", isOn ? null : cameraWords(state, clock));
    setText(this.#toggle, isOn ? "Stop the camera" : "Use my camera");
    const isLive = state.phase === "running" && state.link === "live";
    this.#takeOver.hidden = state.link !== "taken" && state.link !== "replaced";
    this.#neutral.hidden = !isLive || state.neutralUntil !== null;
    this.#forget.hidden = !isLive || state.neutral === null;
    setAttribute(this.#forget, "title", "Forget how your face looks when it is neutral");
    setAttribute(this.#neutral, "title", "Makes the face you have now the middle of the plane");
    this.#draw(camera);
  }

  #draw(camera: Camera): void {
    const { latest } = camera;
    if (latest === this.#drawn) return;
    this.#drawn = latest;
    const canvas = this.#lines;
    canvas.width = latest?.width ?? 1;
    canvas.height = latest?.height ?? 1;
    const context = canvas.getContext("2d");
    const points = latest?.points ?? null;
    if (context === null || points === null) return;
    // Amber is the face, as everywhere on the page.
    context.strokeStyle = getComputedStyle(canvas).color;
    context.lineWidth = canvas.width / 160;
    context.lineJoin = "round";
    for (const contour of CONTOURS) {
      context.beginPath();
      for (const i of contour) context.lineTo(points[3 * i] ?? 0, points[3 * i + 1] ?? 0);
      context.stroke();
    }
  }
}
