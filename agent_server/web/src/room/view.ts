/** The room on a canvas: scenery, light and the agent, stepped and drawn from outside. */

import {
  type Matrix4,
  Mesh,
  type Object3D,
  PCFShadowMap,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { Agent, type AgentState, type Mode } from "./agent/agent.ts";
import type { Play, PlayCallbacks } from "./agent/director.ts";
import { loadBody } from "./agent/load.ts";
import type { Props } from "./agent/props.ts";
import type { PoseStreamMessage } from "../protocol/messages.ts";
import { VIEW } from "./layout.ts";
import { EXPOSURE, Scenery, TONE_MAPPING, type MovableName } from "./scenery/scenery.ts";

export interface RoomViewOptions {
  readonly isCalm: boolean;
  readonly pixelRatio: number;
  /** Whether the picture is drawn coarser where the machine is slow. */
  readonly adapts: boolean;
  /** An object was clicked, by its name in the rule file. */
  readonly onPick: (object: string) => void;
}

const MOVABLE: ReadonlySet<string> = new Set<MovableName>(["window", "curtain", "hifi", "cigarette"]);
const HEAD = "mixamorigHead";
/** A picture narrower than this, width to height, shows less of the sides and more height; one that
 * is wider comes nearer. */
const FULL_ASPECT = 1.6;
const ZOOM = { least: 0.55, most: 1.3 } as const;
/** How far the pointer turns the view, radians to each side. */
const SWAY = { yaw: 0.16, pitch: 0.05 } as const;
/** Share of the way to where the pointer wants the view that is made in a second, at most. */
const SWAY_RATE = 3;
/** Pictures are drawn coarser when so many in a row took longer than this on average. */
const SLOW = { pictures: 30, ms: 45, coarser: 0.7, coarsest: 0.4 } as const;

export class RoomView {
  /** Pictures drawn so far. */
  pictures = 0;

  readonly #element: HTMLElement;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(VIEW.fov, 1, 0.1, 40);
  readonly #scenery: Scenery;
  readonly #raycaster = new Raycaster();
  readonly #pointer = new Vector2();
  readonly #target = new Vector3(...VIEW.to);
  readonly #offset = new Vector3(...VIEW.from).sub(this.#target);
  readonly #swayGoal = { yaw: 0, pitch: 0 };
  readonly #sway = { yaw: 0, pitch: 0 };
  readonly #isCalm: boolean;
  readonly #adapts: boolean;
  #pixelRatio: number;
  #watched = { pictures: 0, ms: 0 };
  #agent: Agent | null = null;
  #head: Object3D | null = null;

  /**
   * @param element The box that the canvas fills.
   * @throws Error where the browser has no WebGL.
   */
  constructor(element: HTMLElement, options: RoomViewOptions) {
    this.#element = element;
    this.#isCalm = options.isCalm;
    this.#adapts = options.adapts;
    this.#pixelRatio = options.pixelRatio;
    this.#renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.#renderer.setPixelRatio(options.pixelRatio);
    this.#renderer.toneMapping = TONE_MAPPING;
    this.#renderer.toneMappingExposure = EXPOSURE;
    this.#renderer.shadowMap.enabled = true;
    this.#renderer.shadowMap.type = PCFShadowMap;
    const canvas = this.#renderer.domElement;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
      "aria-label",
      "The agent's room. The buttons of the panel Room change window, curtain, hi-fi and cigarette.",
    );
    element.append(canvas);
    this.#scenery = new Scenery({ isCalm: options.isCalm });
    this.#scene.environment = this.#scenery.environment;
    this.#scene.add(this.#scenery.root);
    this.#listen(canvas, options.onPick);
    new ResizeObserver(() => this.#resize()).observe(element);
    this.#resize();
  }

  /**
   * Bring the agent in.
   *
   * @throws Error when its body cannot be loaded; the room goes on without it.
   */
  async load(url: string): Promise<void> {
    const { root, rig } = await loadBody(url);
    const props: Props = {
      handleOf: (object) => (isMovable(object) ? this.#scenery.handleOf(object) : null),
      setProgress: (object, state, share) => {
        if (isMovable(object)) this.#scenery.setProgress(object, state, share);
      },
    };
    root.traverse((object) => {
      object.castShadow = true;
      object.receiveShadow = true;
    });
    const agent = new Agent(rig, props);
    // The first picture already shows somebody who sits at work.
    for (let i = 0; i < 60; i++) agent.step(1000 / 60);
    this.#scene.add(root);
    this.#agent = agent;
    this.#head = root.getObjectByName(HEAD) ?? null;
  }

  /** Draw the first picture, which would stop the page for as long as its shaders take. */
  async prepare(): Promise<void> {
    await this.#renderer.compileAsync(this.#scene, this.#camera);
    this.draw();
  }

  get isPeopled(): boolean {
    return this.#agent !== null;
  }

  get agent(): AgentState | null {
    return this.#agent?.state ?? null;
  }

  /** Triangles that are there, and draw calls of the last picture with its shadows. */
  get counts(): { readonly triangles: number; readonly drawCalls: number } {
    let triangles = 0;
    this.#scene.traverseVisible((object) => {
      if (!(object instanceof Mesh)) return;
      const { index, attributes } = (object as Mesh).geometry;
      triangles += (index?.count ?? attributes["position"]?.count ?? 0) / 3;
    });
    return { triangles, drawCalls: this.#renderer.info.render.calls };
  }

  /** Show objects in these states; with `animate` they go there by themselves. */
  show(objects: Readonly<Record<string, string>>, animate: boolean): void {
    this.#scenery.apply(objects, { animate });
  }

  setMode(mode: Mode): void {
    this.#agent?.setMode(mode);
  }

  play(command: Play, callbacks: PlayCallbacks): void {
    this.#agent?.play(command, callbacks);
  }

  /** More of a motion that is made while it plays. */
  move(stretch: PoseStreamMessage): void {
    this.#agent?.move(stretch);
  }

  cut(): void {
    this.#agent?.cut();
  }

  /**
   * Draw for a headset until its session ends: the wearer stands where the picture is seen from.
   *
   * @param onFrame Called before each picture.
   */
  async wear(session: XRSession, onFrame: () => void): Promise<void> {
    const { xr } = this.#renderer;
    xr.enabled = true;
    xr.setReferenceSpaceType("local-floor");
    session.addEventListener("end", () => {
      this.#renderer.setAnimationLoop(null);
      xr.enabled = false;
      this.#agent?.lookAt(VIEW.from);
    });
    await xr.setSession(session);
    const [x, , z] = VIEW.from;
    const here = xr.getReferenceSpace()?.getOffsetReferenceSpace(new XRRigidTransform({ x: -x, z: -z }));
    if (here !== undefined) xr.setReferenceSpace(here);
    const eye = new Vector3();
    this.#renderer.setAnimationLoop(() => {
      onFrame();
      this.draw();
      const { x: eyeX, y: eyeY, z: eyeZ } = eye.setFromMatrixPosition(this.#camera.matrixWorld);
      this.#agent?.lookAt([eyeX, eyeY, eyeZ]);
    });
  }

  /** Where the room is seen from, as of the last picture: with a headset the wearer's head. */
  get eye(): Matrix4 {
    return this.#camera.matrixWorld;
  }

  /** Where the agent's head is in the room, as of the last picture. */
  headOfAgent(head: Vector3): Vector3 {
    return this.#head === null ? head : head.setFromMatrixPosition(this.#head.matrixWorld);
  }

  setSound(isOn: boolean): void {
    this.#scenery.setVolumeSound(isOn);
  }

  /** Let time pass. */
  step(dtMs: number): void {
    this.#agent?.step(dtMs);
    this.#scenery.step(dtMs);
    this.#swayBy(dtMs / 1000);
    if (this.#adapts) this.#adapt(dtMs);
  }

  draw(): void {
    this.#scene.environmentIntensity = this.#scenery.environmentIntensity;
    if (this.#agent !== null) this.#scenery.moveShadows();
    this.#renderer.render(this.#scene, this.#camera);
    this.pictures += 1;
  }

  /** Draw coarser where pictures take too long; a machine does not become faster again. */
  #adapt(dtMs: number): void {
    this.#watched.pictures += 1;
    this.#watched.ms += dtMs;
    if (this.#watched.pictures < SLOW.pictures) return;
    const isSlow = this.#watched.ms / this.#watched.pictures > SLOW.ms;
    this.#watched = { pictures: 0, ms: 0 };
    if (!isSlow || this.#pixelRatio <= SLOW.coarsest) return;
    this.#pixelRatio = Math.max(SLOW.coarsest, this.#pixelRatio * SLOW.coarser);
    this.#renderer.setPixelRatio(this.#pixelRatio);
    this.#resize();
  }

  #listen(canvas: HTMLCanvasElement, onPick: (object: string) => void): void {
    const aim = (event: PointerEvent): void => {
      const box = canvas.getBoundingClientRect();
      this.#pointer.set(
        ((event.clientX - box.left) / box.width) * 2 - 1,
        1 - ((event.clientY - box.top) / box.height) * 2,
      );
    };
    const picked = (): string | null => {
      this.#raycaster.setFromCamera(this.#pointer, this.#camera);
      const name = this.#scenery.pick(this.#raycaster.ray);
      return name !== null && isMovable(name) ? name : null;
    };
    canvas.addEventListener("pointermove", (event) => {
      aim(event);
      canvas.style.cursor = picked() === null ? "" : "pointer";
      if (this.#isCalm || event.pointerType === "touch") return;
      this.#swayGoal.yaw = -this.#pointer.x * SWAY.yaw;
      this.#swayGoal.pitch = this.#pointer.y * SWAY.pitch;
    });
    canvas.addEventListener("pointerleave", () => {
      this.#swayGoal.yaw = 0;
      this.#swayGoal.pitch = 0;
    });
    canvas.addEventListener("click", (event) => {
      aim(event as PointerEvent);
      const name = picked();
      if (name !== null) onPick(name);
    });
  }

  #swayBy(dt: number): void {
    const share = Math.min(1, SWAY_RATE * dt);
    this.#sway.yaw += (this.#swayGoal.yaw - this.#sway.yaw) * share;
    this.#sway.pitch += (this.#swayGoal.pitch - this.#sway.pitch) * share;
    const { x, y, z } = this.#offset;
    const sin = Math.sin(this.#sway.yaw);
    const cos = Math.cos(this.#sway.yaw);
    this.#camera.position.set(
      this.#target.x + x * cos + z * sin,
      this.#target.y + y + this.#sway.pitch * z,
      this.#target.z + z * cos - x * sin,
    );
    this.#camera.lookAt(this.#target);
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#element;
    if (width === 0 || height === 0) return;
    const aspect = width / height;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = aspect;
    this.#camera.zoom = Math.min(ZOOM.most, Math.max(ZOOM.least, aspect / FULL_ASPECT));
    this.#camera.updateProjectionMatrix();
  }
}

function isMovable(name: string): name is MovableName {
  return MOVABLE.has(name);
}
