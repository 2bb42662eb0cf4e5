/** Puts the page together: telemetry into the store, the store into the panels and the view. */

import { browserHost } from "./net/browser.ts";
import { Camera, type CameraState } from "./face/camera.ts";
import { Connection, type Client } from "./net/connection.ts";
import { readDirectory, type Directory } from "./net/directory.ts";
import { ActLine, type RoomPhase } from "./panels/act.ts";
import { AffectPanel } from "./panels/affect.ts";
import { CameraPanel } from "./panels/camera.ts";
import { GesturePanel } from "./panels/gestures.ts";
import { Inspector } from "./panels/inspector.ts";
import { LogPanel } from "./panels/log.ts";
import { Notice } from "./panels/notice.ts";
import { PlayPanel } from "./panels/play.ts";
import { RoomPanel } from "./panels/room.ts";
import { Counters, StatusStrip } from "./panels/status.ts";
import { TimelinePanel } from "./panels/timeline.ts";
import type { Place } from "./place.ts";
import { clipsOf } from "./play/clips.ts";
import { Recorded, recordingsOf, type RecordedState } from "./play/recorded.ts";
import { StandIn, type StandInState } from "./play/stand_in.ts";
import { jsonCodec } from "./protocol/codec.ts";
import { Actor } from "./room/actor.ts";
import { enter, hasHeadset } from "./room/headset.ts";
import type { RoomView } from "./room/view.ts";
import { History } from "./state/history.ts";
import type { Row } from "./state/log.ts";
import { Playhead } from "./state/playhead.ts";
import { Store, type Moment } from "./state/store.ts";
import { summaryOf, type Summary } from "./state/summary.ts";
import { affectNow, decisionNow, isFresh, problemOf, sensorState } from "./state/view.ts";
import { nextState } from "./state/states.ts";
import { sentenceCase } from "./state/words.ts";
import type { Stage } from "./scene3d/stage.ts";
import { need, setAttribute, setState, setText } from "./ui/dom.ts";

declare const __PAGE_VERSION__: string;

const DIRECTORY_EVERY_MS = 2_500;
/** Panels follow new telemetry at once, and time alone this often. */
const REFRESH_MS = 200;
/** Who the made-up person is. */
const STAND_IN_SEED = 1;

const byId = (id: string): HTMLElement => need<HTMLElement>(`#${id}`);

export class App {
  readonly #place: Place;
  readonly #stage: Stage | null;
  readonly #store = new Store();
  readonly #history = new History();
  readonly #head = new Playhead();
  readonly #timeline: TimelinePanel;
  readonly #connection: Connection;
  readonly #strip = new StatusStrip(byId("session"), byId("lamps"), byId("gauges"));
  readonly #counters = new Counters(byId("counters"), byId("server"));
  readonly #gestures = new GesturePanel(byId("bars"), byId("gesture-now"));
  readonly #affect = new AffectPanel(byId("affect"), byId("gate-mode"));
  readonly #cameraPanel = new CameraPanel(byId("camera"));
  readonly #camera: Camera;
  readonly #room = new RoomPanel(byId("room"), byId("modes"), (object) => this.toggle(object));
  readonly #actLine = new ActLine(byId("act"));
  readonly #play = new PlayPanel(byId("play"));
  readonly #standIn: StandIn;
  readonly #recorded: Recorded;
  readonly #client: Client;
  #roomPhase: RoomPhase = "loading";
  #roomView: RoomView | null = null;
  #actor: Actor | null = null;
  readonly #log = new LogPanel(byId("rows"), byId("announcer"), (row) => this.#inspect(row));
  readonly #inspector = new Inspector(byId("inspector"), () => this.#closeInspector());
  readonly #notice = new Notice(byId("notice"), () => this.#connectAgain());
  readonly #spoken = byId("spoken");
  /** Whether a headset draws the room, and not the page. */
  isWorn = false;
  #directory: Directory = { kind: "unknown" };
  #opened: number | null = null;
  #now: number;
  #drawn = { revision: -1, at: Number.NEGATIVE_INFINITY };
  #shownPose: unknown = null;
  #shownForecast: unknown = null;

  /** @param now The page's clock, in milliseconds. */
  constructor(place: Place, stage: Stage | null, now: number) {
    this.#place = place;
    this.#stage = stage;
    this.#now = now;
    document.title = `${place.session} \u2013 Agent server`;
    byId("reset-view").addEventListener("click", () => stage?.resetView());
    const client = {
      name: "agent-server-page",
      version: __PAGE_VERSION__,
      token: place.token,
    };
    this.#client = client;
    this.#camera = new Camera(place, browserHost, client, this.#cameraPanel.video, () =>
      this.#cameraPanel.render(this.#camera, browserHost.now()),
    );
    this.#cameraPanel.connect(this.#camera);
    this.#cameraPanel.render(this.#camera, browserHost.now());
    const headers = bearing(place.token);
    const ask: typeof fetch = (input, init) => fetch(input, { ...init, headers });
    const clips = clipsOf(place.standInUrl, STAND_IN_SEED, ask);
    const recordings = recordingsOf(place.streamsUrl, ask);
    const renderPlay = (): void => this.#play.render(this.#standIn.state, this.#recorded.state);
    this.#recorded = new Recorded(place, client, browserHost, recordings, renderPlay);
    this.#standIn = new StandIn(place, client, browserHost, clips, renderPlay);
    this.#play.connect(this.#standIn, this.#recorded);
    renderPlay();
    // Where there are none the made-up person is left.
    void recordings.names().then((names) => this.#play.offer(names, place.labelUrl), () => {});
    this.#actLine.render(this.#roomPhase, null);
    this.#timeline = new TimelinePanel(byId("timeline"), {
      toggle: () => {
        if (this.#head.isStopped) this.#head.go(this.#now);
        else this.#head.stop(this.#now);
      },
      seek: (time) => this.#head.seek(time, this.#now),
      jump: (direction) => {
        const mark = this.#history.nextMark(this.#head.time(this.#now), direction);
        if (mark !== null) this.#head.seek(mark, this.#now);
      },
      goLive: () => this.#head.goLive(),
    });
    byId("resize-body").addEventListener("click", () => this.#resizeBody());
    const { monitorUrl: url, session } = place;
    this.#connection = new Connection(
      { url, session, role: "monitor", client, codec: jsonCodec },
      browserHost,
      {
        onMessage: (message) => {
          this.#store.apply(message, this.#now);
          this.#history.add(message, this.#now, !this.#head.isLive);
          this.#actor?.hear(message);
        },
        onUnreadable: ({ message, field }) => {
          const code = "unreadable";
          this.#store.apply({ type: "error", code, message, field, fatal: false }, this.#now);
        },
        onStatus: ({ phase }) => {
          this.#drawn.revision = -1;
          if (phase === "live" || phase === "waiting") void this.#readDirectory();
        },
      },
    );
  }

  start(): void {
    this.#connection.start();
    setInterval(() => {
      const isLive = this.#connection.status.phase === "live";
      if (!isLive || this.#sensor !== "live") void this.#readDirectory();
    }, DIRECTORY_EVERY_MS);
  }

  /** The room is there, and the agent in it: it acts for the session from now on. */
  enterRoom(room: RoomView): void {
    this.#roomView = room;
    this.#roomPhase = "ready";
    const actor = new Actor(this.#place, this.#client, browserHost, room, () =>
      this.#actLine.render(this.#roomPhase, actor),
    );
    this.#actor = actor;
    this.#actLine.connect(actor, (isOn) => room.setSound(isOn));
    this.#actLine.render(this.#roomPhase, actor);
    actor.start();
    void hasHeadset().then((isThere) => {
      if (isThere) this.#actLine.offerHeadset(() => void this.#wear(room));
    });
  }

  /** There is no room to see. */
  missRoom(phase: RoomPhase): void {
    this.#roomPhase = phase;
    this.#actLine.render(phase, null);
  }

  /** Somebody changed an object of the room by hand: it takes its next state. */
  toggle(object: string): void {
    const next = nextState(object, this.#store.scene?.value.objects[object]);
    if (next === null) return;
    const { sessionUrl, token } = this.#place;
    const url = new URL(`objects/${encodeURIComponent(object)}`, sessionUrl);
    url.searchParams.set("state", next);
    void fetch(url, { method: "PUT", headers: bearing(token) }).catch(() => {
      // The connection's own notice says what is wrong.
    });
  }

  /** Let the page's clock reach `now`: the panels follow, the pictures are drawn by `draw`. */
  advance(now: number): void {
    const dtMs = Math.max(0, now - this.#now);
    this.#now = now;
    this.#showBody(dtMs);
    this.#roomView?.step(dtMs);
    const { revision } = this.#store;
    if (revision === this.#drawn.revision && now - this.#drawn.at < REFRESH_MS) return;
    this.#drawn = { revision, at: now };
    this.#renderPanels();
  }

  /** Draw the room and the person. */
  draw(): void {
    this.#stage?.draw();
    this.#roomView?.draw();
  }

  summary(): Summary {
    return summaryOf({
      store: this.#store,
      status: this.#connection.status,
      problem: this.#problem,
      sensor: this.#sensor,
      pictures: this.#stage?.pictures ?? null,
      room: {
        phase: this.#roomPhase,
        part: this.#actor?.part ?? null,
        playing: this.#actor?.playing ?? null,
        agent: this.#roomView?.agent ?? null,
        pictures: this.#roomView?.pictures ?? 0,
        counts: this.#roomView?.counts ?? null,
      },
      now: this.#now,
    });
  }

  /** What the page's own camera does. */
  camera(): CameraState {
    return this.#camera.state;
  }

  /** What the made-up person does. */
  standIn(): StandInState {
    return this.#standIn.state;
  }

  /** What the recorded person does. */
  recorded(): RecordedState {
    return this.#recorded.state;
  }

  get #sensor() {
    return sensorState(this.#store, this.#directory, this.#place, this.#now);
  }

  get #problem() {
    const { status } = this.#connection;
    const hasCamera = this.#camera.state.link === "live";
    return problemOf(status, this.#directory, this.#sensor, this.#place, hasCamera);
  }

  /** What was known when the moment came that is looked at. */
  get #moment(): Moment {
    return this.#head.isLive ? this.#store : this.#history.at(this.#head.time(this.#now));
  }

  #showBody(dtMs: number): void {
    const stage = this.#stage;
    if (stage === null) return;
    const { pose, forecast } = this.#moment;
    const time = this.#head.time(this.#now);
    const joints = isFresh(pose, time) ? pose.value.joints : null;
    if (joints !== this.#shownPose) stage.setPose(joints);
    this.#shownPose = joints;
    const motion = joints !== null && isFresh(forecast, time) ? forecast.value : null;
    if (motion !== this.#shownForecast) stage.setForecast(motion);
    this.#shownForecast = motion;
    stage.step(dtMs);
  }

  #renderPanels(): void {
    const store = this.#store;
    const now = this.#now;
    const { status } = this.#connection;
    const moment = this.#moment;
    const time = this.#head.time(now);
    const decision = decisionNow(moment, time);
    const body = decision?.decision ?? null;
    const rate = this.#sensor === "live" ? store.poseRateHz : null;
    const latency = decision?.timing.total_ms ?? null;
    this.#strip.render(this.#place.session, status, this.#sensor, rate, latency);
    this.#gestures.render(store.welcome?.labels ?? [], store.welcome?.decide.enter ?? null, body);
    this.#affect.render(
      store.welcome?.gate ?? null,
      affectNow(moment, time),
      moment.affect,
      body?.gate ?? null,
      time,
    );
    this.#room.render(store.scene?.value ?? null, store.running, store.changedAt, now);
    this.#timeline.render(this.#history, this.#head, now);
    this.#log.render(store.log.rows);
    this.#counters.render(store.stats, store.welcome);
    this.#notice.render(this.#problem, browserHost.now());
    this.#cameraPanel.render(this.#camera, browserHost.now());
    const isHeld = body !== null && body.gesture !== "idle" && body.outcome !== "unsure";
    setText(this.#spoken, isHeld ? sentenceCase(body.gesture) : "");
  }

  async #wear(room: RoomView): Promise<void> {
    if (this.isWorn) return;
    this.isWorn = true;
    const pass = (): void => this.advance(performance.now());
    try {
      await enter(room, this.#place, this.#client, browserHost, pass);
    } catch (error) {
      console.warn("the headset did not come in:", error);
    } finally {
      this.isWorn = false;
    }
  }

  #resizeBody(): void {
    const view = byId("body-view");
    const isLarge = view.dataset["size"] === "large";
    setState(view, "size", isLarge ? "small" : "large");
    const button = byId("resize-body");
    setText(button, isLarge ? "Enlarge" : "Back to the room");
    setAttribute(button, "aria-expanded", `${!isLarge}`);
  }

  /** Somebody does not want to wait, or wants the place back that another client took. */
  #connectAgain(): void {
    if (this.#connection.status.phase === "stopped") this.#connection.start();
    else this.#connection.retryNow();
  }

  #inspect(row: Row): void {
    this.#opened = row.key;
    this.#log.mark(row.key);
    this.#inspector.open(row, this.#store.welcome);
  }

  #closeInspector(): void {
    this.#inspector.close();
    this.#log.mark(null);
    if (this.#opened !== null) this.#log.focus(this.#opened);
    this.#opened = null;
  }

  async #readDirectory(): Promise<void> {
    const { directoryUrl, token } = this.#place;
    const before = this.#directory;
    this.#directory = await readDirectory(directoryUrl, token, (url, init) => fetch(url, init));
    // A server that has just come back need not wait for the next attempt.
    if (before.kind === "unreachable" && this.#directory.kind === "listed") {
      this.#connection.retryNow();
    }
    this.#drawn.revision = -1;
  }
}

/** The header that shows the page's token, where it has one. */
function bearing(token: string | null): HeadersInit {
  return token === null ? {} : { authorization: `Bearer ${token}` };
}
