/** Where in time the page looks: at the present, behind it by a while, or at one moment. */

type Position =
  | { readonly kind: "now" }
  | { readonly kind: "behind"; readonly byMs: number }
  | { readonly kind: "stopped"; readonly at: number; readonly end: number };

export class Playhead {
  #position: Position = { kind: "now" };

  get isLive(): boolean {
    return this.#position.kind === "now";
  }

  get isStopped(): boolean {
    return this.#position.kind === "stopped";
  }

  /** The moment that is looked at. */
  time(now: number): number {
    const position = this.#position;
    switch (position.kind) {
      case "now":
        return now;
      case "behind":
        return now - position.byMs;
      case "stopped":
        return position.at;
    }
  }

  /** The right end of the time line: it stands still while one looks at one moment. */
  end(now: number): number {
    return this.#position.kind === "stopped" ? this.#position.end : now;
  }

  seek(at: number, now: number): void {
    const end = this.end(now);
    this.#position = { kind: "stopped", at: Math.min(at, end), end };
  }

  stop(now: number): void {
    this.seek(this.time(now), now);
  }

  /** Go on from the moment that is looked at, in real time. */
  go(now: number): void {
    const byMs = now - this.time(now);
    this.#position = byMs < 1 ? { kind: "now" } : { kind: "behind", byMs };
  }

  goLive(): void {
    this.#position = { kind: "now" };
  }
}
