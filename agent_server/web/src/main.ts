import "./styles/base.css";
import "./styles/view.css";
import "./styles/camera.css";
import "./styles/panels.css";
import "./styles/room.css";
import "./styles/log.css";
import "./styles/layout.css";

import { App } from "./app.ts";
import type { CameraState } from "./face/camera.ts";
import { placeOf } from "./place.ts";
import { Stage } from "./scene3d/stage.ts";
import type { Summary } from "./state/summary.ts";
import { h, need } from "./ui/dom.ts";

declare global {
  interface Window {
    /** What browser tests drive the page with; `step` exists under `?step` only. */
    agentPage: {
      state(): Summary;
      camera(): CameraState;
      step?(ms: number): void;
    };
  }
}

function openStage(isStepped: boolean): Stage | null {
  const view = need<HTMLElement>("#view");
  try {
    return new Stage(view, {
      isCalm: matchMedia("(prefers-reduced-motion: reduce)").matches,
      pixelRatio: isStepped ? 1 : Math.min(devicePixelRatio, 2),
    });
  } catch {
    view.append(
      h(
        "p",
        { class: "no-webgl" },
        "The 3D view needs WebGL, which this browser does not offer or has switched off. ",
        "Everything else on this page works without it.",
      ),
    );
    return null;
  }
}

const place = placeOf(location.href);
const stage = openStage(place.isStepped);

if (place.isStepped) {
  document.documentElement.dataset["stepped"] = "";
  let now = 0;
  const app = new App(place, stage, now);
  window.agentPage = {
    state: () => app.summary(),
    camera: () => app.camera(),
    step(ms) {
      now += ms;
      app.advance(now);
    },
  };
  app.start();
} else {
  const app = new App(place, stage, performance.now());
  window.agentPage = { state: () => app.summary(), camera: () => app.camera() };
  const frame = (): void => {
    app.advance(performance.now());
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  app.start();
}
