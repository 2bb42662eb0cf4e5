/** The room through a headset, where the browser has WebXR: the head looks, and its gaze is sent. */

import { Vector3 } from "three";
import type { Client } from "../net/connection.ts";
import type { Host } from "../net/host.ts";
import type { Place } from "../place.ts";
import { GazeSender } from "./gaze_sender.ts";
import type { RoomView } from "./view.ts";

const MODE = "immersive-vr";

/** Whether there is a headset to enter the room with. */
export async function hasHeadset(): Promise<boolean> {
  try {
    return (await navigator.xr?.isSessionSupported(MODE)) ?? false;
  } catch {
    // Browsers refuse to say where a page may not ask.
    return false;
  }
}

/**
 * Enter the room; ends when the wearer leaves.
 *
 * @param onFrame Lets the page's time pass, before each picture.
 * @throws DOMException where the browser or the wearer does not want it.
 */
export async function enter(
  room: RoomView,
  place: Place,
  client: Client,
  host: Host,
  onFrame: () => void,
): Promise<void> {
  const session = await navigator.xr?.requestSession(MODE, { requiredFeatures: ["local-floor"] });
  if (session === undefined) return;
  const gaze = new GazeSender(place, client, host);
  const agent = new Vector3();
  const over = new Promise<void>((resolve) => session.addEventListener("end", () => resolve()));
  try {
    await room.wear(session, () => {
      onFrame();
      gaze.look(room.eye, room.headOfAgent(agent));
    });
    await over;
  } finally {
    gaze.close();
  }
}
