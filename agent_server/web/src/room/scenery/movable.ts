/** What every object that changes its state has in common. */

import type { Box3, Object3D } from "three";

export interface Movable {
  readonly root: Object3D;
  /** Where a hand takes hold; it moves with the object. */
  readonly place: Object3D;
  /** Boxes around it in the room, for a click; they follow the object. */
  readonly bounds: readonly Box3[];
  /** @param share 0 in the first of its states, 1 in the second. */
  show(share: number): void;
}
