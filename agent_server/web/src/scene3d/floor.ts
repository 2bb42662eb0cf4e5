/** A grid under the body that fades out, and a soft shadow where the body is. */

import {
  BufferGeometry,
  CircleGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  ShaderMaterial,
  type Color,
} from "three";

const CELL_M = 0.25;
const REACH_M = 2;
/** Lines are cut into pieces of this length, each with its own brightness. */
const PIECE_M = 0.25;

export class Floor {
  readonly group = new Group();

  constructor(line: Color) {
    this.group.add(grid(line), shadow());
  }
}

function grid(color: Color): LineSegments {
  const positions: number[] = [];
  const colors: number[] = [];
  const vertex = (x: number, z: number): void => {
    const fade = Math.max(0, 1 - Math.hypot(x, z) / REACH_M) ** 1.5;
    positions.push(x, 0, z);
    colors.push(color.r, color.g, color.b, fade);
  };
  for (let across = -REACH_M; across <= REACH_M + 1e-9; across += CELL_M) {
    for (let along = -REACH_M; along < REACH_M - 1e-9; along += PIECE_M) {
      vertex(across, along);
      vertex(across, along + PIECE_M);
      vertex(along, across);
      vertex(along + PIECE_M, across);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
  const material = new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });
  return new LineSegments(geometry, material);
}

function shadow(): Mesh {
  const material = new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    vertexShader: /* glsl */ `
      varying vec2 vPlace;
      void main() {
        vPlace = uv * 2.0 - 1.0;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      varying vec2 vPlace;
      void main() {
        float near = max(0.0, 1.0 - length(vPlace));
        gl_FragColor = vec4(0.0, 0.0, 0.0, 0.35 * near * near);
      }`,
  });
  const mesh = new Mesh(new CircleGeometry(0.4, 40), material);
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.y = 0.002;
  return mesh;
}
