/** Where the page was opened: which session it asks for, and where its server is. */

import { socketUrl } from "./net/address.ts";

export interface Place {
  readonly session: string;
  readonly token: string | null;
  /** Whether time passes only in `window.agentPage.step`. */
  readonly isStepped: boolean;
  /** Whether the camera's pictures are sent even where the page could read the face itself. */
  readonly sendsPictures: boolean;
  /** Folder of the page on its server. */
  readonly serverUrl: string;
  readonly monitorUrl: string;
  readonly sensorUrl: string;
  readonly directoryUrl: string;
  /** What belongs to the session. */
  readonly sessionUrl: string;
  /** Where the made-up person's clips are. */
  readonly standInUrl: string;
  /** Where the recordings are that the page may play. */
  readonly streamsUrl: string;
  /** Where recordings are labelled, with the page's token. */
  readonly labelUrl: string;
  /** Folder of the networks that read a face. */
  readonly modelsUrl: string;
}

/**
 * Read the address of the page: `?session=NAME`, `?step`, `?camera=jpeg`, `#token=SECRET`. The
 * server's paths are relative to the page's own folder, so that both may live under any prefix.
 */
export function placeOf(address: string): Place {
  const page = new URL(address);
  const session = page.searchParams.get("session") || "demo";
  return {
    session,
    token: new URLSearchParams(page.hash.slice(1)).get("token"),
    isStepped: page.searchParams.has("step"),
    sendsPictures: page.searchParams.get("camera") === "jpeg",
    serverUrl: new URL(".", page).href,
    monitorUrl: socketUrl(page, session, "monitor"),
    sensorUrl: socketUrl(page, session, "sensor"),
    sessionUrl: new URL(`v1/sessions/${encodeURIComponent(session)}/`, page).href,
    directoryUrl: new URL("v1/sessions", page).href,
    standInUrl: new URL("v1/stand-in", page).href,
    streamsUrl: new URL("v1/streams", page).href,
    labelUrl: new URL(`label.html${page.hash}`, page).href,
    modelsUrl: new URL("v1/models/", page).href,
  };
}
