/** What the made-up person can do, as the server makes it. */

import type { Skeleton } from "../protocol/messages.ts";

/** One thing that is done, from rest to rest; stamps count from its start. */
export interface Clip {
  readonly gesture: string;
  readonly frames: readonly Skeleton[];
}

export type ClipSource = (gesture: string, take: number) => Promise<Clip>;

/**
 * Clips of one person from the server.
 *
 * @param url Address of `v1/stand-in`.
 * @param seed Who it is.
 */
export function clipsOf(url: string, seed: number, fetcher: typeof fetch): ClipSource {
  return async (gesture, take) => {
    const address = new URL(url);
    address.search = new URLSearchParams({ gesture, seed: `${seed}`, take: `${take}` }).toString();
    const response = await fetcher(address);
    if (!response.ok) throw new Error(`the server has no ${gesture} to play (${response.status})`);
    const { frames } = (await response.json()) as Pick<Clip, "frames">;
    if (!Array.isArray(frames) || frames.length === 0) throw new Error(`${gesture} came empty`);
    return { gesture, frames };
  };
}
