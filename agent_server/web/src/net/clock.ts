/** The server's clock, as pings and pongs tell it. */

const SAMPLES = 8;
/** The estimate follows the best sample by one part in so many. */
const GAIN = 4;
const TOLERANCE_NS = 50e6;
/** So many samples in a row beyond the tolerance, to the same side, are a jump. */
const OUTLIERS = 3;

interface Sample {
  readonly roundTripNs: number;
  readonly offsetNs: number;
}

/** Round trip and offset of one connection, smoothed; the best of the last eight samples counts. */
export class ClockEstimate {
  /** The server's clock less the own one, or null before the first pong. */
  offsetNs: number | null = null;
  /** Smallest round trip of late, or null before the first pong. */
  roundTripNs: number | null = null;
  #samples: readonly Sample[] = [];
  /** Outliers in a row; negative for those below the estimate. */
  #outliers = 0;

  /**
   * Take a pong. A pong from before its ping is passed over.
   *
   * @param sentNs The own clock when it pinged.
   * @param timeNs The server's clock when it answered.
   * @param nowNs The own clock now.
   * @returns By how much the offset has jumped, or null if it has not.
   */
  push(sentNs: number, timeNs: number, nowNs: number): number | null {
    const roundTripNs = nowNs - sentNs;
    if (roundTripNs < 0) return null;
    const halfNs = Math.floor(roundTripNs / 2);
    const sample = { roundTripNs, offsetNs: timeNs + halfNs - nowNs };
    if (this.offsetNs === null) {
      this.#begin(sample);
      return null;
    }
    const awayNs = sample.offsetNs - this.offsetNs;
    if (Math.abs(awayNs) <= TOLERANCE_NS + halfNs + this.#offByNs) {
      this.#outliers = 0;
      this.#follow(sample, this.offsetNs);
      return null;
    }
    const side = Math.sign(awayNs);
    this.#outliers = Math.sign(this.#outliers) === side ? this.#outliers + side : side;
    if (Math.abs(this.#outliers) < OUTLIERS) return null;
    this.#begin(sample);
    return awayNs;
  }

  /** How far the estimate may be off, by the sample that it goes by. */
  get #offByNs(): number {
    return Math.floor((this.roundTripNs ?? 0) / 2);
  }

  #begin(sample: Sample): void {
    this.#outliers = 0;
    this.#samples = [sample];
    this.offsetNs = sample.offsetNs;
    this.roundTripNs = sample.roundTripNs;
  }

  #follow(sample: Sample, offsetNs: number): void {
    this.#samples = [...this.#samples, sample].slice(-SAMPLES);
    const best = this.#samples.reduce((a, b) => (b.roundTripNs < a.roundTripNs ? b : a));
    this.roundTripNs = best.roundTripNs;
    const followedNs = offsetNs + Math.floor((best.offsetNs - offsetNs) / GAIN);
    const [lowestNs, highestNs] = [best.offsetNs - this.#offByNs, best.offsetNs + this.#offByNs];
    this.offsetNs = Math.min(Math.max(followedNs, lowestNs), highestNs);
  }
}
