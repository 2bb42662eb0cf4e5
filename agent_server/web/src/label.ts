import "./styles/base.css";
import "./styles/frame.css";
import "./styles/view.css";
import "./styles/label.css";

import { Desk } from "./label/desk.ts";
import { sourceOf } from "./label/source.ts";
import { placeOf } from "./place.ts";
import { Stage } from "./scene3d/stage.ts";
import { need } from "./ui/dom.ts";

const place = placeOf(location.href);

function openStage(): Stage | null {
  try {
    return new Stage(need<HTMLElement>("#view"), {
      isCalm: matchMedia("(prefers-reduced-motion: reduce)").matches,
      pixelRatio: Math.min(devicePixelRatio, 2),
    });
  } catch {
    need("#view").append("The body is drawn with WebGL, which this browser does not offer. Labels can be made all the same.");
    return null;
  }
}

/** Ask the server with the token of the page's address, if there is one. */
const ask: typeof fetch = (input, init) => {
  const headers = new Headers(init?.headers);
  if (place.token !== null) headers.set("Authorization", `Bearer ${place.token}`);
  return fetch(input, { ...init, headers });
};

need<HTMLAnchorElement>("#home").href = `./${location.hash}`;
const desk = new Desk(sourceOf(place.streamsUrl, ask), openStage());
let before = performance.now();
const frame = (now: number): void => {
  desk.advance(Math.max(0, now - before));
  before = now;
  requestAnimationFrame(frame);
};
requestAnimationFrame(frame);
void desk.start(new URL(location.href).searchParams.get("recording"));
