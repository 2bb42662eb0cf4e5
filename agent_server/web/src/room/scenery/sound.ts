/** What the room sounds like, made from sines and noise: four chords of the hi-fi, and the outside. */

import { hash } from "./noise.ts";

const CHORD_S = 2;
/** Roots and thirds in hertz: A minor 7, F major 7, C major 7, G 6. */
const CHORDS: readonly (readonly number[])[] = [
  [110, 261.63, 329.63, 392, 440],
  [87.31, 261.63, 329.63, 349.23, 440],
  [130.81, 246.94, 329.63, 392, 493.88],
  [98, 246.94, 293.66, 329.63, 392],
];
const LOUD = { low: 0.05, high: 0.32 } as const;
const OUTSIDE_HZ = { closed: 260, open: 3200 } as const;
const OUTSIDE_GAIN = { closed: 0.025, open: 0.07 } as const;
/** How fast levels follow, in seconds. */
const GLIDE_S = 0.08;

interface Desk {
  readonly context: AudioContext;
  readonly music: GainNode;
  readonly air: GainNode;
  readonly wall: BiquadFilterNode;
}

export class RoomSound {
  #desk: Desk | null = null;
  #volume = 1;
  #openness = 1;

  set(isOn: boolean): void {
    if (isOn) {
      this.#desk ??= createDesk();
      void this.#desk.context.resume();
      this.mix(this.#volume, this.#openness);
    } else {
      void this.#desk?.context.suspend();
    }
  }

  /** @param volume Of the hi-fi, 0..1. @param openness Of the window, 0..1. */
  mix(volume: number, openness: number): void {
    this.#volume = volume;
    this.#openness = openness;
    if (this.#desk === null) return;
    const { context, music, air, wall } = this.#desk;
    const now = context.currentTime;
    music.gain.setTargetAtTime(LOUD.low * (LOUD.high / LOUD.low) ** volume, now, GLIDE_S);
    air.gain.setTargetAtTime(
      OUTSIDE_GAIN.closed * (OUTSIDE_GAIN.open / OUTSIDE_GAIN.closed) ** openness,
      now,
      GLIDE_S,
    );
    wall.frequency.setTargetAtTime(
      OUTSIDE_HZ.closed * (OUTSIDE_HZ.open / OUTSIDE_HZ.closed) ** openness,
      now,
      GLIDE_S,
    );
  }
}

function createDesk(): Desk {
  const context = new AudioContext();
  const music = context.createGain();
  const air = context.createGain();
  const wall = context.createBiquadFilter();
  wall.type = "lowpass";
  loop(context, chords(context.sampleRate)).connect(music).connect(context.destination);
  loop(context, breeze(context.sampleRate)).connect(wall).connect(air).connect(context.destination);
  music.gain.value = 0;
  air.gain.value = 0;
  return { context, music, air, wall };
}

function loop(context: AudioContext, samples: Float32Array<ArrayBuffer>): AudioBufferSourceNode {
  const buffer = context.createBuffer(1, samples.length, context.sampleRate);
  buffer.copyToChannel(samples, 0);
  const source = context.createBufferSource();
  source.buffer = buffer;
  source.loop = true;
  source.start();
  return source;
}

/**
 * The hi-fi's loop: struck strings that die away, each running over into the next chord.
 *
 * @returns Samples in -1..1 that join at their ends.
 */
export function chords(rate: number): Float32Array<ArrayBuffer> {
  const length = Math.round(rate * CHORD_S * CHORDS.length);
  const samples = new Float32Array(length);
  for (const [bar, notes] of CHORDS.entries()) {
    for (const [i, hertz] of notes.entries()) {
      const start = Math.round(rate * (bar * CHORD_S + i * 0.045));
      const step = (2 * Math.PI * hertz) / rate;
      for (let n = 0; n < rate * CHORD_S * 1.8; n += 1) {
        const t = n / rate;
        const level =
          0.11 * Math.min(1, t / 0.012) * Math.exp(-1.3 * t) * Math.min(1, (CHORD_S * 1.8 - t) / 0.2);
        const tone = Math.sin(step * n) + 0.35 * Math.exp(-3 * t) * Math.sin(2 * step * n);
        const at = (start + n) % length;
        samples[at] = (samples[at] ?? 0) + level * tone;
      }
    }
  }
  return samples;
}

/** Air outside: soft noise that swells, 6 s long, its ends joined by a fade. */
function breeze(rate: number): Float32Array<ArrayBuffer> {
  const length = Math.round(rate * 6);
  const fade = Math.round(rate * 0.5);
  const raw = new Float32Array(length + fade);
  let slow = 0;
  for (let n = 0; n < raw.length; n += 1) {
    slow += 0.06 * (2 * hash(n, 0, 121) - 1 - slow);
    raw[n] = 3 * slow * (0.75 + 0.25 * Math.sin((2 * Math.PI * n) / length));
  }
  const samples = raw.slice(0, length);
  for (let n = 0; n < fade; n += 1) {
    const share = n / fade;
    samples[n] = (raw[n] ?? 0) * share + (raw[length + n] ?? 0) * (1 - share);
  }
  return samples;
}
