/** Recordings on the server, as somebody sees who labels them. */

import { jsonCodec, type Incoming } from "../protocol/codec.ts";

/** How long a recording is, and what may be written in a label. */
export interface About {
  readonly start_s: number;
  readonly end_s: number;
  readonly gestures: readonly string[];
  readonly reactions: readonly string[];
  /** Why labels cannot be saved, or null. */
  readonly refusal: string | null;
}

/** A table of labels, and the tag of that state of it. */
export interface Saved {
  readonly table: string;
  readonly tag: string | null;
}

export interface Source {
  names(): Promise<readonly string[]>;
  about(name: string): Promise<About>;
  motion(name: string): Promise<readonly Incoming[]>;
  labels(name: string): Promise<Saved>;
  /** Put other labels in the place of those that `tag` stands for. */
  save(name: string, table: string, tag: string | null): Promise<Saved>;
}

/** The recordings that the server offers at `url`. */
export function sourceOf(url: string, fetcher: typeof fetch): Source {
  const ask = async (path: string, init: RequestInit = {}): Promise<Response> => {
    const response = await fetcher(`${url}${path}`, { cache: "no-store", ...init });
    if (!response.ok) throw new Error(await reasonOf(response));
    return response;
  };
  const at = (name: string, what: string): string => `/${encodeURIComponent(name)}/${what}`;
  const savedIn = async (response: Response): Promise<Saved> => ({
    table: await response.text(),
    tag: response.headers.get("ETag"),
  });
  return {
    names: async () => ((await (await ask("")).json()) as { streams: readonly string[] }).streams,
    about: async (name) => (await (await ask(at(name, "about"))).json()) as About,
    motion: async (name) => {
      const lines = (await (await ask(at(name, "motion"))).text()).split("\n");
      const messages = lines.filter((line) => line !== "").map((line) => jsonCodec.decodeServer(line));
      return messages.filter((message) => message !== null);
    },
    labels: async (name) => savedIn(await ask(at(name, "labels"))),
    save: async (name, table, tag) => {
      const headers = { "Content-Type": "text/csv", ...(tag === null ? {} : { "If-Match": tag }) };
      return savedIn(await ask(at(name, "labels"), { method: "PUT", body: table, headers }));
    },
  };
}

async function reasonOf(response: Response): Promise<string> {
  const said: unknown = await response.json().catch(() => null);
  if (typeof said === "object" && said !== null && "detail" in said) return String(said.detail);
  return `the server refused (${response.status})`;
}
