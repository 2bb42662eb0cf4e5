/** Shapes of furniture: indexed, in metres, with texture coordinates in metres along their faces. */

import {
  BoxGeometry,
  BufferGeometry,
  CatmullRomCurve3,
  CylinderGeometry,
  Float32BufferAttribute,
  LatheGeometry,
  Matrix4,
  SphereGeometry,
  TorusGeometry,
  TubeGeometry,
  Vector2,
  Vector3,
} from "three";

export interface Bevel {
  /** Radius of the edges, in metres. */
  readonly radius: number;
  readonly segments: number;
}

/** Sawn and sanded: what most edges are. */
export const SANDED: Bevel = { radius: 0.004, segments: 1 };

const corner = new Vector3();
const at = new Vector3();

/** A box about the origin, its edges round; u runs along its longest side. */
export function box(
  width: number,
  height: number,
  depth: number,
  bevel: Bevel = SANDED,
): BufferGeometry {
  const steps = bevel.segments * 2 + 1;
  const geometry = new BoxGeometry(1, 1, 1, steps, steps, steps);
  const half = 0.5 / steps;
  const radius = Math.min(bevel.radius, width / 2, height / 2, depth / 2);
  const { position, normal, uv } = geometry.attributes;
  if (position === undefined || normal === undefined || uv === undefined) return geometry;
  const longest = width >= height && width >= depth ? 0 : height >= depth ? 1 : 2;
  const perFace = position.count / 6;
  for (let i = 0; i < position.count; i += 1) {
    const [x, y, z] = [position.getX(i), position.getY(i), position.getZ(i)];
    // Away from the middle of the steps that become the round edge.
    corner.set(x - Math.sign(x) * half, y - Math.sign(y) * half, z - Math.sign(z) * half).normalize();
    normal.setXYZ(i, corner.x, corner.y, corner.z);
    at.set(
      Math.sign(x) * (width / 2 - radius) + corner.x * radius,
      Math.sign(y) * (height / 2 - radius) + corner.y * radius,
      Math.sign(z) * (depth / 2 - radius) + corner.z * radius,
    );
    position.setXYZ(i, at.x, at.y, at.z);
    const [along, across] = alongFace(Math.floor(i / perFace / 2), longest);
    uv.setXY(i, at.getComponent(along), at.getComponent(across));
  }
  return geometry;
}

/** @returns The axes that u and v run along on a face across `axis`. */
function alongFace(axis: number, longest: number): readonly [number, number] {
  const [first, second] = axis === 0 ? [1, 2] : axis === 1 ? [0, 2] : [0, 1];
  return second === longest ? [second, first] : [first, second];
}

/** A box of sharp edges, for what is too small for more. */
export function block(width: number, height: number, depth: number): BufferGeometry {
  const geometry = new BoxGeometry(width, height, depth);
  const uv = geometry.getAttribute("uv");
  for (let i = 0; i < uv.count; i += 1)
    uv.setXY(i, uv.getX(i) * Math.max(width, depth), uv.getY(i) * height);
  return geometry;
}

/** A round bar along y about the origin; u runs along it. */
export function bar(
  topRadius: number,
  bottomRadius: number,
  height: number,
  sides = 14,
): BufferGeometry {
  const geometry = new CylinderGeometry(topRadius, bottomRadius, height, sides);
  const uv = geometry.getAttribute("uv");
  const around = 2 * Math.PI * bottomRadius;
  for (let i = 0; i < uv.count; i += 1) uv.setXY(i, uv.getY(i) * height, uv.getX(i) * around);
  return geometry;
}

/** A round bar between two points. */
export function rod(
  from: readonly number[],
  to: readonly number[],
  radius: number,
  sides = 10,
): BufferGeometry {
  const start = new Vector3(...from);
  const way = new Vector3(...to).sub(start);
  const geometry = bar(radius, radius, way.length(), sides);
  const turn = new Matrix4().lookAt(new Vector3(), way, Math.abs(way.y) > 0.99 * way.length() ? X : Y);
  return geometry
    .rotateX(Math.PI / 2)
    .applyMatrix4(turn)
    .translate(start.x + way.x / 2, start.y + way.y / 2, start.z + way.z / 2);
}

const X = new Vector3(1, 0, 0);
const Y = new Vector3(0, 1, 0);

/** A round bar bent smoothly through points. */
export function hose(
  points: readonly (readonly [number, number, number])[],
  radius: number,
): BufferGeometry {
  return new TubeGeometry(
    new CatmullRomCurve3(points.map((point) => new Vector3(...point))),
    18,
    radius,
    8,
  );
}

/** Turned about y; `profile` is radius and height, up the outside and down the inside. */
export function turned(profile: readonly (readonly [number, number])[], sides = 28): BufferGeometry {
  return new LatheGeometry(
    profile.map(([radius, height]) => new Vector2(radius, height)),
    sides,
  );
}

export function ball(radius: number, sides = 16): BufferGeometry {
  return new SphereGeometry(radius, sides, Math.ceil(sides * 0.7));
}

export function ring(radius: number, thickness: number, sides = 20): BufferGeometry {
  return new TorusGeometry(radius, thickness, 8, sides);
}

/** A rectangle facing +z, its texture between u0 and u1. */
export function sheet(width: number, height: number, u0 = 0, u1 = 1): BufferGeometry {
  const geometry = new BufferGeometry();
  const x = width / 2;
  const y = height / 2;
  geometry.setAttribute(
    "position",
    new Float32BufferAttribute([-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0], 3),
  );
  geometry.setAttribute("normal", new Float32BufferAttribute([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1], 3));
  geometry.setAttribute("uv", new Float32BufferAttribute([u0, 0, u1, 0, u1, 1, u0, 1], 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return geometry;
}
