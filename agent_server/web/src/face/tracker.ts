/**
 * Follows one face from picture to picture: the landmarks of one say where to look in the next,
 * and the detector is asked only while no face is known.
 */

import { detectionsOf } from "./detector.ts";
import { seen, wholePicture, type Picture, type Range } from "./picture.ts";
import { cropMap, regionOfDetection, regionOfPoints, toPicture, type Region } from "./region.ts";

/** What a network wants to see. */
export interface View {
  readonly side: number;
  readonly range: Range;
}

/** The networks of the face pipeline; images are RGB, side x side x 3, in the view's range. */
export interface FaceNetworks {
  readonly detector: View & {
    run(image: Float32Array): Promise<{ regressors: Float32Array; logits: Float32Array }>;
  };
  readonly mesh: View & {
    /** @returns x, y, z of 478 landmarks in pixels of the image, and how surely it is a face. */
    run(image: Float32Array): Promise<{ landmarks: Float32Array; presence: number }>;
  };
}

/** Below this it is no face any more, and the detector is asked again. */
const MIN_PRESENCE = 0.5;

export class FaceTracker {
  readonly #networks: FaceNetworks;
  #region: Region | null = null;

  constructor(networks: FaceNetworks) {
    this.#networks = networks;
  }

  /** @returns x, y, z of each landmark in pixels of the picture, or null without a face. */
  async find(picture: Picture): Promise<Float32Array | null> {
    const known = this.#region;
    const points = known === null ? null : await this.#look(picture, known);
    if (points !== null) return points;
    const found = await this.#detect(picture);
    return found === null ? null : this.#look(picture, found);
  }

  async #detect(picture: Picture): Promise<Region | null> {
    const { detector } = this.#networks;
    const { side, range } = detector;
    const map = wholePicture(picture.width, picture.height, side);
    const { regressors, logits } = await detector.run(seen(picture, map, side, range, "black"));
    const [largest] = detectionsOf(regressors, logits, side, map);
    return largest === undefined ? null : regionOfDetection(largest);
  }

  async #look(picture: Picture, region: Region): Promise<Float32Array | null> {
    const { mesh } = this.#networks;
    const { side, range } = mesh;
    const { landmarks, presence } = await mesh.run(
      seen(picture, cropMap(region, side), side, range, "edge"),
    );
    const points = presence < MIN_PRESENCE ? null : toPicture(landmarks, region, mesh.side);
    this.#region = points === null ? null : regionOfPoints(points);
    return points;
  }
}
