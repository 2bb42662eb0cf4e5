/**
 * The page as the session's renderer: the agent carries out what is commanded and says how far it
 * is. Where another renderer acts, the agent does the same for show, and says nothing.
 */

import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import { RendererClient } from "../net/renderer.ts";
import type { Place } from "../place.ts";
import type { Incoming } from "../protocol/codec.ts";
import type { CommandMessage, PoseStreamMessage, SceneState } from "../protocol/messages.ts";
import type { Mode } from "./agent/agent.ts";
import type { PlayCallbacks } from "./agent/director.ts";

/** What the actor needs of the room. */
export interface Theatre {
  show(objects: Readonly<Record<string, string>>, animate: boolean): void;
  setMode(mode: Mode): void;
  play(command: CommandMessage, callbacks: PlayCallbacks): void;
  move(stretch: PoseStreamMessage): void;
  cut(): void;
}

export type Part =
  /** Not connected yet, or for the moment. */
  | "waiting"
  /** The page's agent is the one that counts. */
  | "acting"
  /** Another renderer acts, and the page's agent follows. */
  | "watching";

/** Ends that a watching page learns of, after which the agent is not to go on. */
const CUT_SHORT: ReadonlySet<string> = new Set(["failed", "expired", "preempted", "timed_out"]);

export class Actor {
  part: Part = "waiting";

  readonly #theatre: Theatre;
  readonly #place: Place;
  readonly #client: Client;
  readonly #host: Host;
  readonly #onChange: () => void;
  #renderer: RendererClient;
  #scene: SceneState | null = null;
  #isShown = false;
  #playing: CommandMessage | null = null;

  constructor(place: Place, client: Client, host: Host, theatre: Theatre, onChange: () => void) {
    this.#place = place;
    this.#client = client;
    this.#host = host;
    this.#theatre = theatre;
    this.#onChange = onChange;
    this.#renderer = this.#join(false);
  }

  /** Id of the command that the agent is at, or null. */
  get playing(): string | null {
    return this.#playing?.id ?? null;
  }

  start(): void {
    this.#renderer.open();
  }

  /** Push aside the renderer that acts. */
  takeOver(): void {
    this.#renderer.close();
    this.#enter("waiting");
    this.#renderer = this.#join(true);
    this.#renderer.open();
  }

  /** What the page hears as a monitor: all there is to go by while another renderer acts. */
  hear(message: Incoming): void {
    if (this.part === "acting") return;
    switch (message.type) {
      case "welcome":
        this.#setScene(message.scene);
        break;
      case "scene":
        this.#setScene(message);
        break;
      case "command":
        if (this.part === "watching") this.#follow(message);
        break;
      case "ack_state":
        if (message.command_id === this.playing && CUT_SHORT.has(message.status)) this.#cut();
        break;
    }
  }

  #join(takesOver: boolean): RendererClient {
    const renderer: RendererClient = new RendererClient(
      {
        server: this.#place.serverUrl,
        session: this.#place.session,
        client: this.#client,
        // Whoever brings a renderer of their own need not close this page first.
        capabilities: ["stand_in", "pose_stream"],
        takesOver,
      },
      this.#host,
      {
        onCommand: (command) => {
          if (!renderer.start(command.id)) return;
          this.#play(command, {
            onProgress: (step) => renderer.progress(command.id, step),
            onDone: () => {
              this.#playing = null;
              renderer.done(command.id);
            },
          });
        },
        onMotion: (stretch) => this.#theatre.move(stretch),
        onCancel: () => this.#cut(),
        onScene: (scene) => this.#setScene(scene),
        onStatus: ({ phase, fault }) => {
          if (phase === "live") this.#enter("acting");
          else if (phase === "stopped" && fault !== null) this.#enter("watching");
          else if (this.part === "acting") this.#enter("waiting");
        },
      },
    );
    return renderer;
  }

  #follow(command: CommandMessage): void {
    if (command.id === this.playing) return;
    this.#play(command, { onDone: () => (this.#playing = null) });
  }

  #play(command: CommandMessage, callbacks: PlayCallbacks): void {
    this.#playing = command;
    this.#theatre.play(command, callbacks);
  }

  #cut(): void {
    this.#playing = null;
    this.#theatre.cut();
    this.#showScene();
  }

  #setScene(scene: SceneState): void {
    this.#scene = scene;
    this.#showScene();
  }

  #showScene(): void {
    const scene = this.#scene;
    if (scene === null) return;
    // What the agent's hand leads is where the hand has it; the server learns of it at the end.
    const led = new Set(this.#playing?.steps.map(({ target }) => target));
    const objects = Object.entries(scene.objects).filter(([name]) => !led.has(name));
    this.#theatre.show(Object.fromEntries(objects), this.#isShown);
    this.#isShown = true;
    const { mode } = scene;
    if (mode === "working" || mode === "attention" || mode === "reacting") {
      this.#theatre.setMode(mode);
    }
  }

  #enter(part: Part): void {
    if (this.part === part) return;
    this.part = part;
    this.#onChange();
  }
}
