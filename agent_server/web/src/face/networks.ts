/** Google's face networks in the browser: the server's own bundles, run by onnxruntime-web. */

import * as ort from "onnxruntime-web/wasm";
import runtimeUrl from "onnxruntime-web/ort-wasm-simd-threaded.wasm?url";

import { sigmoid } from "./detector.ts";
import type { FaceNetworks, View } from "./tracker.ts";

const DETECTOR = "face_detector";
const MESH = "face_mesh";

/** The part of a bundle's manifest that matters here. */
interface Manifest {
  /** 1, height, width, 3. */
  readonly input_shape: readonly number[];
  readonly input_range: readonly [number, number];
  readonly files: Readonly<Record<string, string>>;
}

interface Network {
  readonly view: View;
  run(image: Float32Array): Promise<Readonly<Record<string, Float32Array>>>;
}

/**
 * Load both networks, and run each once, so that the first face does not wait.
 *
 * @param modelsUrl Folder of the server's models.
 */
export async function loadNetworks(modelsUrl: string): Promise<FaceNetworks> {
  // More threads would need an isolated page, and the page is content with one.
  ort.env.wasm.numThreads = 1;
  ort.env.wasm.wasmPaths = { wasm: new URL(runtimeUrl, import.meta.url).href };
  const detector = await open(modelsUrl, DETECTOR);
  const mesh = await open(modelsUrl, MESH);
  return {
    detector: {
      ...detector.view,
      async run(image) {
        const found = await detector.run(image);
        return { regressors: output(found, "boxes"), logits: output(found, "scores") };
      },
    },
    mesh: {
      ...mesh.view,
      async run(image) {
        const found = await mesh.run(image);
        return { landmarks: output(found, "points"), presence: sigmoid(output(found, "flag")[0] ?? 0) };
      },
    },
  };
}

async function open(modelsUrl: string, name: string): Promise<Network> {
  const manifest = (await (await fetched(`${modelsUrl}${name}/manifest.json`)).json()) as Manifest;
  // The hash in the address lets the browser keep the file for good.
  const file = `${modelsUrl}${name}/model.onnx?sha256=${manifest.files["model.onnx"] ?? ""}`;
  const model = new Uint8Array(await (await fetched(file)).arrayBuffer());
  const session = await ort.InferenceSession.create(model, { executionProviders: ["wasm"] });
  const given = session.inputNames[0] ?? "given";
  const shape = manifest.input_shape;
  const run = async (image: Float32Array): Promise<Record<string, Float32Array>> => {
    const outputs = await session.run({ [given]: new ort.Tensor("float32", image, shape) });
    return Object.fromEntries(
      Object.entries(outputs).map(([key, { data }]) => [key, data as Float32Array]),
    );
  };
  await run(new Float32Array(shape.reduce((product, length) => product * length, 1)));
  return { view: { side: shape[1] ?? 0, range: manifest.input_range }, run };
}

async function fetched(url: string): Promise<Response> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`the server has no ${url} (${response.status})`);
  return response;
}

function output(found: Readonly<Record<string, Float32Array>>, name: string): Float32Array {
  const values = found[name];
  if (values === undefined) throw new Error(`the network gives no ${name}`);
  return values;
}
