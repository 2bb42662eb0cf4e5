/** What `GET v1/sessions` says: which sessions there are and which of them have a sensor. */

/** One session in the answer. */
export interface SessionInfo {
  readonly id: string;
  readonly sensor: boolean;
}

export type Directory =
  | { readonly kind: "unknown" }
  | { readonly kind: "unreachable" }
  | { readonly kind: "refused"; readonly status: number }
  | { readonly kind: "listed"; readonly sessions: readonly SessionInfo[] };

export type Fetch = (url: string, init: RequestInit) => Promise<Response>;

const TIMEOUT_MS = 4_000;

/** Ask the server once; never throws, since not getting an answer is an answer here. */
export async function readDirectory(
  url: string,
  token: string | null,
  fetcher: Fetch,
): Promise<Directory> {
  try {
    const response = await fetcher(url, {
      headers: token === null ? {} : { authorization: `Bearer ${token}` },
      signal: AbortSignal.timeout(TIMEOUT_MS),
      cache: "no-store",
    });
    if (!response.ok) return { kind: "refused", status: response.status };
    const body: unknown = await response.json();
    return { kind: "listed", sessions: sessionsOf(body) };
  } catch {
    return { kind: "unreachable" };
  }
}

function sessionsOf(body: unknown): SessionInfo[] {
  if (typeof body !== "object" || body === null || !("sessions" in body)) return [];
  const { sessions } = body;
  if (!Array.isArray(sessions)) return [];
  return sessions.flatMap((entry: unknown) =>
    typeof entry === "object" && entry !== null && "id" in entry && typeof entry.id === "string"
      ? [{ id: entry.id, sensor: "sensor" in entry && entry.sensor === true }]
      : [],
  );
}
