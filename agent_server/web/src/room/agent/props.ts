/** What the agent asks of the room's objects. */

import type { Object3D } from "three";

export interface Props {
  /** The handle of an object, which moves with it; null for one that nobody takes hold of. */
  handleOf(object: string): { readonly place: Object3D } | null;
  /** A hand has led an object this share (0 to 1) of its way to a state. */
  setProgress(object: string, state: string, share: number): void;
}
