/** The camera's state in words. */

import { NEUTRAL_S, type CameraState } from "./camera.ts";
import type { CameraFault } from "./eye.ts";

const FAULTS: Record<CameraFault, string> = {
  insecure:
    "A page may use the camera only over https or on this very machine (127.0.0.1). Open it so.",
  refused:
    "The camera was refused. Allow it for this page in the browser's address bar, and try again.",
  missing: "There is no camera. Connect one, and try again.",
  busy: "The camera is in use by another program. Close that one, and try again.",
  lost: "The camera was lost. Connect it again, and start anew.",
  unknown: "The camera cannot be opened. Try again, or try another browser.",
};

export function cameraWords(state: CameraState, now: number): string {
  switch (state.phase) {
    case "off":
      return "Reads your face in this page; pictures do not leave it.";
    case "asking":
      return "The browser asks you whether this page may use the camera.";
    case "loading":
      return "Loading the networks that read a face (6 MB, once).";
    case "failed":
      return FAULTS[state.fault ?? "unknown"];
    case "running":
      return running(state, now);
  }
}

function running(state: CameraState, now: number): string {
  switch (state.link) {
    case "taken":
      return "Another sensor sends this session's face already.";
    case "replaced":
      return "Another sensor has taken over this session's face.";
    case "opening":
    case "waiting":
      return "Not connected to the session. What the camera sees goes nowhere meanwhile.";
    case "live":
  }
  if (state.neutralUntil !== null) {
    const left = Math.max(1, Math.ceil((state.neutralUntil - now) / 1000));
    return `Look neutral, as you do when nothing happens: ${left} of ${NEUTRAL_S} s.`;
  }
  if (state.said !== "") return state.said;
  if (!state.readsHere) {
    return `Pictures go to the server, ${state.rateHz} a second: this browser cannot read them.`;
  }
  if (state.hasFace === false) return "No face is seen. Come closer, or turn to the light.";
  if (state.hasFace === null) return "Looking for a face.";
  return `Face seen: landmarks ${state.rateHz} times a second, ${Math.round(state.tookMs ?? 0)} ms each.`;
}
