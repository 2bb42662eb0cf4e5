/** Where the server's websockets are. */

import type { Role } from "../protocol/messages.ts";

/**
 * @param server Address of the server, or of the folder that it serves: `http:`, `https:`, `ws:`
 *   or `wss:`.
 */
export function socketUrl(server: string | URL, session: string, role: Role): string {
  const base = new URL(server);
  const url = new URL(`v1/sessions/${encodeURIComponent(session)}/${role}`, base);
  url.protocol = base.protocol === "https:" || base.protocol === "wss:" ? "wss:" : "ws:";
  return url.href;
}
