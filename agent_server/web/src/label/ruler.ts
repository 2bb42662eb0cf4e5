/** Which part of a recording the time line shows, and the figures along it. */

const SHORTEST_S = 4;
/** So near to an edge the part moves along, as a share of it. */
const EDGE = 0.08;
const STEPS_S = [0.2, 0.5, 1, 2, 5, 10, 30, 60, 300, 600] as const;

export class Ruler {
  fromS: number;
  toS: number;
  readonly #startS: number;
  readonly #endS: number;

  constructor(startS: number, endS: number) {
    this.#startS = this.fromS = startS;
    this.#endS = this.toS = Math.max(endS, startS + 1);
  }

  get isWhole(): boolean {
    return this.spanS >= this.#endS - this.#startS;
  }

  get spanS(): number {
    return this.toS - this.fromS;
  }

  /** Show half as much around a time, or twice as much. */
  zoom(timeS: number, direction: -1 | 1): void {
    const wholeS = this.#endS - this.#startS;
    const spanS = direction === 1 ? this.spanS / 2 : this.spanS * 2;
    this.#show(timeS - spanS / 2, Math.min(wholeS, Math.max(Math.min(SHORTEST_S, wholeS), spanS)));
  }

  /** Keep a time in view. */
  follow(timeS: number): void {
    const at = this.share(timeS);
    if (this.isWhole || (at >= EDGE && at <= 1 - EDGE)) return;
    this.#show(timeS - this.spanS / 2, this.spanS);
  }

  /** Where a time lies: 0 at the left edge, 1 at the right one. */
  share(timeS: number): number {
    return (timeS - this.fromS) / this.spanS;
  }

  /** The time at a share of the width. */
  timeAt(share: number): number {
    return this.fromS + share * this.spanS;
  }

  /** Round times in view, at most `most` of them. */
  ticks(most: number): readonly number[] {
    const stepS = STEPS_S.find((step) => this.spanS / step <= most) ?? 3600;
    const first = Math.ceil(this.fromS / stepS);
    const last = Math.floor(this.toS / stepS);
    return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * stepS);
  }

  #show(fromS: number, spanS: number): void {
    this.fromS = Math.max(this.#startS, Math.min(fromS, this.#endS - spanS));
    this.toS = this.fromS + spanS;
  }
}

/** `75.25` -> `1:15.25`; below a minute `4.04 s`. */
export function clockText(timeS: number, decimals = 2): string {
  const rounded = Number(timeS.toFixed(decimals));
  if (rounded < 60) return `${rounded.toFixed(decimals)} s`;
  const minutes = Math.floor(rounded / 60);
  const width = decimals === 0 ? 2 : decimals + 3;
  return `${minutes}:${(rounded - 60 * minutes).toFixed(decimals).padStart(width, "0")}`;
}
