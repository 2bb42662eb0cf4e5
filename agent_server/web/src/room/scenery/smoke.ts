/**
 * A thread of smoke that rises, wavers and thins out.
 *
 * Each puff's path follows from its age alone, so that the graphics card does all the work: nothing
 * but the time is passed to it.
 */

import {
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  PlaneGeometry,
  ShaderMaterial,
  Vector3,
} from "three";
import { hash } from "./noise.ts";

const PUFFS = 220;
const LIFE_S = 5.5;

export class Smoke {
  readonly mesh: Mesh;
  readonly #time = { value: 0 };
  readonly #amount = { value: 1 };
  readonly #light = { value: 1 };
  readonly #origin = { value: new Vector3() };

  constructor() {
    const quad = new PlaneGeometry(1, 1);
    const geometry = new InstancedBufferGeometry();
    geometry.index = quad.index;
    geometry.setAttribute("position", quad.getAttribute("position"));
    const phases = new Float32Array(PUFFS * 2);
    for (let i = 0; i < PUFFS; i += 1) {
      phases[2 * i] = (i + 0.7 * hash(i, 0, 111)) / PUFFS;
      phases[2 * i + 1] = hash(i, 1, 111);
    }
    geometry.setAttribute("puff", new InstancedBufferAttribute(phases, 2));
    geometry.instanceCount = PUFFS;
    const material = new ShaderMaterial({
      transparent: true,
      depthWrite: false,
      uniforms: { time: this.#time, amount: this.#amount, light: this.#light, origin: this.#origin },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    this.show(0, 1, new Vector3());
  }

  /**
   * @param amount How much there is, 0..1.
   * @param origin Where it comes from, in the room. Copied.
   */
  show(amount: number, light: number, origin: Vector3): void {
    this.#amount.value = amount;
    this.#light.value = light;
    this.#origin.value.copy(origin);
    this.mesh.visible = amount > 0.002;
  }

  rise(seconds: number): void {
    this.#time.value = seconds / LIFE_S;
  }
}

const VERTEX = /* glsl */ `
  attribute vec2 puff; // phase of its life, chance
  uniform float time;
  uniform float amount;
  uniform vec3 origin;
  varying vec2 vAt;
  varying float vDensity;

  void main() {
    float lives = puff.x + time;
    float age = fract(lives);
    // When it was born, in lives: puffs born together take the same way.
    float born = (time - age) * 5.5;
    float height = 0.62 * age * (1.25 - 0.25 * age);
    float loose = smoothstep(0.12, 0.75, age);
    vec3 way = vec3(
      0.055 * sin(born * 1.7 + 2.0 * age) + 0.03 * sin(born * 4.3 + 9.0 * age) + 0.05 * (puff.y - 0.5) * loose,
      height,
      0.045 * sin(born * 1.3 + 1.0) + 0.02 * sin(born * 5.1 + 7.0 * age)
    );
    way.xz *= 0.06 + loose * 1.15;
    way.x -= 0.07 * age * age;
    float size = mix(0.009, 0.11, smoothstep(0.05, 1.0, age));
    vAt = position.xy * 2.0;
    vDensity = amount * mix(0.42, 0.085, smoothstep(0.0, 0.35, age)) * smoothstep(0.0, 0.02, age) * (1.0 - smoothstep(0.55, 1.0, age));
    vec4 seen = viewMatrix * vec4(origin + way, 1.0);
    seen.xy += position.xy * size;
    gl_Position = projectionMatrix * seen;
  }`;

const FRAGMENT = /* glsl */ `
  uniform float light;
  varying vec2 vAt;
  varying float vDensity;

  void main() {
    float near = max(0.0, 1.0 - dot(vAt, vAt));
    gl_FragColor = vec4(vec3(0.6, 0.66, 0.75) * light, vDensity * near * near);
    #include <tonemapping_fragment>
    #include <colorspace_fragment>
  }`;
