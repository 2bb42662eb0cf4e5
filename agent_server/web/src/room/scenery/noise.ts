/** Chance that is the same every time: hashed lattices for textures, sequences for furniture. */

/** @returns A number in [0, 1) that belongs to a lattice point. */
export function hash(x: number, y: number, seed: number): number {
  let h = Math.imul(x, 374761393) ^ Math.imul(y, 668265263) ^ Math.imul(seed, 2147483629);
  h = Math.imul(h ^ (h >>> 15), 2246822519);
  h = Math.imul(h ^ (h >>> 13), 3266489917);
  return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
}

/**
 * Smooth noise in [0, 1).
 *
 * @param x In lattice steps, not negative.
 * @param y In lattice steps, not negative.
 * @param periodX After how many steps it repeats; a whole number.
 */
export function noise(x: number, y: number, periodX: number, periodY: number, seed: number): number {
  const x0 = Math.floor(x);
  const y0 = Math.floor(y);
  const fx = x - x0;
  const fy = y - y0;
  const sx = fx * fx * (3 - 2 * fx);
  const sy = fy * fy * (3 - 2 * fy);
  const left = (x0 | 0) % periodX;
  const right = ((x0 | 0) + 1) % periodX;
  const low = (y0 | 0) % periodY;
  const high = ((y0 | 0) + 1) % periodY;
  const a = hash(left, low, seed);
  const b = hash(right, low, seed);
  const c = hash(left, high, seed);
  const d = hash(right, high, seed);
  return a + (b - a) * sx + (c - a + (a - b - c + d) * sx) * sy;
}

/** Noise summed over octaves, each twice as fine and half as strong, in [0, 1). */
export function fractal(x: number, y: number, period: number, octaves: number, seed: number): number {
  let sum = 0;
  let weight = 0.5;
  let total = 0;
  for (let octave = 0; octave < octaves; octave += 1) {
    const times = 1 << octave;
    sum += weight * noise(x * times, y * times, period * times, period * times, seed + octave);
    total += weight;
    weight /= 2;
  }
  return sum / total;
}

/** @returns A source of numbers in [0, 1) that begins anew for every seed. */
export function sequence(seed: number): () => number {
  let count = 0;
  return () => hash((count += 1), 17, seed);
}

export function mix(from: number, to: number, share: number): number {
  return from + (to - from) * share;
}

/** 0 up to `low`, 1 from `high` on, smooth in between. */
export function smooth(low: number, high: number, value: number): number {
  const share = Math.min(1, Math.max(0, (value - low) / (high - low)));
  return share * share * (3 - 2 * share);
}
