/**
 * What somebody with a headset looks at, as a sensor sends it: a ray from the head, ten times a
 * second. The headset hides the face, and the gaze takes its place.
 *
 * The frame is that of a sensor in the agent's head that looks at the person: metres, y up, z from
 * the agent to the person, which is the room's frame moved to the agent's head.
 */

import { Vector3, type Matrix4 } from "three";
import { SensorLink } from "../face/link.ts";
import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import type { Gaze, Point } from "../protocol/messages.ts";

const EVERY_MS = 100;

/**
 * @param head The head in the room, which looks along its -z.
 * @param agent The agent's head in the room.
 */
export function gazeOf(head: Matrix4, agent: Vector3): Pick<Gaze, "origin" | "direction"> {
  const origin = new Vector3().setFromMatrixPosition(head).sub(agent);
  const direction = new Vector3(0, 0, -1).transformDirection(head);
  return { origin: pointOf(origin), direction: pointOf(direction) };
}

export class GazeSender {
  readonly #host: Host;
  readonly #link: SensorLink;
  readonly #startedAt: number;
  #sentAt = Number.NEGATIVE_INFINITY;

  constructor(place: Place, client: Client, host: Host) {
    this.#host = host;
    this.#startedAt = host.now();
    this.#link = new SensorLink(place, client, "gaze", true, host, {
      onState: () => {},
      onCalibration: () => {},
      onRefusal: () => {},
    });
    this.#link.start();
  }

  /** The head is here now. */
  look(head: Matrix4, agent: Vector3): void {
    const now = this.#host.now();
    if (now - this.#sentAt < EVERY_MS) return;
    this.#sentAt = now;
    const originating_ns = Math.round((now - this.#startedAt) * 1e6);
    this.#link.post({ type: "gaze", originating_ns, ...gazeOf(head, agent) });
  }

  close(): void {
    this.#link.close();
  }
}

function pointOf({ x, y, z }: Vector3): Point {
  return [x, y, z];
}
