import "./styles/base.css";
import "./styles/frame.css";
import "./styles/view.css";
import "./styles/theatre.css";
import "./styles/camera.css";
import "./styles/panels.css";
import "./styles/room.css";
import "./styles/log.css";
import "./styles/layout.css";

import { App } from "./app.ts";
import type { CameraState } from "./face/camera.ts";
import type { RecordedState } from "./play/recorded.ts";
import type { StandInState } from "./play/stand_in.ts";
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
      standIn(): StandInState;
      recorded(): RecordedState;
      /** Let time pass, in steps as of a smooth picture, and draw at the end unless told not to. */
      step?(ms: number, draws?: boolean): void;
    };
  }
}

/** A picture of a test's clock. */
const FRAME_MS = 1000 / 60;

const place = placeOf(location.href);
const picture = {
  isCalm: matchMedia("(prefers-reduced-motion: reduce)").matches,
  pixelRatio: place.isStepped ? 1 : Math.min(devicePixelRatio, 2),
};

function openStage(): Stage | null {
  const view = need<HTMLElement>("#view");
  try {
    return new Stage(view, picture);
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

/** The room comes by itself when it is there; everything else does not wait for it. */
async function openRoom(app: App): Promise<void> {
  if (stage === null) {
    app.missRoom("no_webgl");
    return;
  }
  try {
    const { RoomView } = await import("./room/view.ts");
    const room = new RoomView(need<HTMLElement>("#room-view"), {
      ...picture,
      adapts: !place.isStepped,
      onPick: (object) => app.toggle(object),
    });
    await room.load(new URL("human.glb", place.serverUrl).href);
    if (!place.isStepped) await room.prepare();
    app.enterRoom(room);
  } catch (error) {
    console.error(error);
    app.missRoom("failed");
  }
}

const stage = openStage();

if (place.isStepped) {
  document.documentElement.dataset["stepped"] = "";
  let now = 0;
  const app = new App(place, stage, now);
  window.agentPage = {
    state: () => app.summary(),
    camera: () => app.camera(),
    standIn: () => app.standIn(),
    recorded: () => app.recorded(),
    step(ms, draws = true) {
      const end = now + ms;
      do {
        now = Math.min(end, now + FRAME_MS);
        app.advance(now);
      } while (now < end);
      if (draws) app.draw();
    },
  };
  app.start();
  void openRoom(app);
} else {
  const app = new App(place, stage, performance.now());
  window.agentPage = {
    state: () => app.summary(),
    camera: () => app.camera(),
    standIn: () => app.standIn(),
    recorded: () => app.recorded(),
  };
  const frame = (): void => {
    if (!app.isWorn) {
      app.advance(performance.now());
      app.draw();
    }
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  app.start();
  void openRoom(app);
}
