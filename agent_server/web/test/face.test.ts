import assert from "node:assert/strict";
import { test } from "node:test";
import { ANCHORS, PER_ANCHOR, detectionsOf, overlap } from "../src/face/detector.ts";
import { faultOf } from "../src/face/eye.ts";
import { seen, wholePicture, type Picture } from "../src/face/picture.ts";
import { cropMap, regionOfPoints, toPicture } from "../src/face/region.ts";
import { FaceTracker, type FaceNetworks } from "../src/face/tracker.ts";
import { faceMessage } from "../src/face/wire.ts";

const SIDE = 128;

/** A picture whose red grows to the right and whose green grows downwards. */
function ramp(width: number, height: number): Picture {
  const data = new Uint8Array(width * height * 4);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) data.set([x, y, 7, 255], (y * width + x) * 4);
  }
  return { width, height, data };
}

/** Two anchors that see one face, and one that sees another. */
function answers(): { regressors: Float32Array; logits: Float32Array } {
  const regressors = new Float32Array(ANCHORS.length * PER_ANCHOR);
  const logits = new Float32Array(ANCHORS.length).fill(-9);
  const put = (anchor: number, side: number, logit: number): void => {
    regressors.set([0, 0, side, side, -side / 4, 0, side / 4, 0], anchor * PER_ANCHOR);
    logits[anchor] = logit;
  };
  put(0, 20, 2);
  put(1, 20, 3);
  put(600, 60, 1);
  return { regressors, logits };
}

test("there are 896 anchors, two a place of the fine grid and six of the coarse one", () => {
  assert.equal(ANCHORS.length, 896);
  assert.deepEqual(ANCHORS[0], [1 / 32, 1 / 32]);
  assert.deepEqual(ANCHORS[1], [1 / 32, 1 / 32]);
  assert.deepEqual(ANCHORS[2], [3 / 32, 1 / 32]);
  assert.deepEqual(ANCHORS[512], [1 / 16, 1 / 16]);
  assert.deepEqual(ANCHORS[895], [15 / 16, 15 / 16]);
});

test("boxes of one face become one, the largest face comes first, in pixels of the picture", () => {
  const { regressors, logits } = answers();
  const map = wholePicture(640, 480, SIDE);
  const faces = detectionsOf(regressors, logits, SIDE, map);
  assert.equal(faces.length, 2);
  const [large, small] = faces;
  assert.ok(large !== undefined && small !== undefined);
  assert.equal(Math.round(large.box.right - large.box.left), 300);
  assert.equal(Math.round(small.box.right - small.box.left), 100);
  assert.ok(Math.abs(small.score - 1 / (1 + Math.exp(-3))) < 1e-6);
  // A letterbox of 4:3 has bars above and below: the first anchor lies above the picture.
  assert.ok(small.box.top < 0);
});

test("boxes overlap by what they share", () => {
  const box = { left: 0, top: 0, right: 2, bottom: 2 };
  assert.equal(overlap(box, box), 1);
  assert.equal(overlap(box, { left: 1, top: 0, right: 3, bottom: 2 }), 1 / 3);
  assert.equal(overlap(box, { left: 5, top: 5, right: 6, bottom: 6 }), 0);
});

test("a view of the whole picture goes corner to corner", () => {
  const map = wholePicture(256, 128, SIDE);
  const pixels = seen(ramp(256, 128), map, SIDE, [0, 255], "black");
  const at = (i: number, j: number): number[] => [...pixels.slice((j * SIDE + i) * 3).slice(0, 3)];
  assert.deepEqual(at(10, 0), [0, 0, 0]);
  assert.deepEqual(at(10, 32), [20, 0, 7]);
  assert.deepEqual(at(100, 80), [200, 96, 7]);
});

test("beyond the picture its edge goes on where that is asked for", () => {
  const map = { a: 1, b: 0, c: -5, d: 0, e: 1, f: -5 };
  const pixels = seen(ramp(20, 20), map, 8, [0, 1], "edge");
  assert.ok(Math.abs((pixels[2] ?? 0) - 7 / 255) < 1e-6);
});

test("points of a crop go back to where they were", () => {
  const region = { x: 300, y: 200, size: 180, angle: 0.4 };
  const { a, b, c, d, e, f } = cropMap(region, 256);
  // The middle of the crop is the middle of the region.
  assert.ok(Math.abs(a * 128 + b * 128 + c - 300) < 1e-9);
  assert.ok(Math.abs(d * 128 + e * 128 + f - 200) < 1e-9);
  const [x = 0, y = 0, z = 0] = toPicture(new Float32Array([256, 128, 25.6]), region, 256);
  assert.ok(Math.abs(x - (300 + 90 * Math.cos(0.4))) < 1e-3);
  assert.ok(Math.abs(y - (200 + 90 * Math.sin(0.4))) < 1e-3);
  assert.ok(Math.abs(z - 18) < 1e-4);
});

test("the region of the next picture is half as large again as the points, eyes level", () => {
  const points = new Float32Array(478 * 3).fill(50);
  points.set([40, 60, 0], 33 * 3);
  points.set([80, 100, 0], 263 * 3);
  const region = regionOfPoints(points);
  assert.deepEqual([region.x, region.y, region.size], [60, 75, 75]);
  assert.ok(Math.abs(region.angle - Math.PI / 4) < 1e-6);
});

test("the detector is asked again only when the face is gone", async () => {
  let detected = 0;
  let presence = 0.9;
  const networks: FaceNetworks = {
    detector: {
      side: SIDE,
      range: [-1, 1],
      run: () => {
        detected += 1;
        return Promise.resolve(answers());
      },
    },
    mesh: {
      side: 16,
      range: [0, 1],
      run: () => Promise.resolve({ landmarks: new Float32Array(478 * 3).fill(8), presence }),
    },
  };
  const tracker = new FaceTracker(networks);
  const picture = ramp(200, 200);
  for (let i = 0; i < 3; i++) assert.notEqual(await tracker.find(picture), null);
  assert.equal(detected, 1);
  presence = 0.4;
  assert.equal(await tracker.find(picture), null);
  assert.equal(detected, 2);
});

test("landmarks are rounded to a sixteenth of a pixel, and no face is no message", () => {
  const looked = { kind: "looked", capturedAt: 2, width: 640, height: 480, tookMs: 1 } as const;
  assert.equal(faceMessage({ ...looked, points: null }), null);
  const message = faceMessage({ ...looked, points: new Float32Array([1.01, 2.04, -3.1]) });
  assert.deepEqual(message?.points, [[1, 2.0625, -3.125]]);
  assert.equal(message?.originating_ns, 2_000_000);
});

test("what a browser throws is told apart", () => {
  const named = (name: string): Error => Object.assign(new Error(name), { name });
  assert.equal(faultOf(named("NotAllowedError")), "refused");
  assert.equal(faultOf(named("NotFoundError")), "missing");
  assert.equal(faultOf(named("NotReadableError")), "busy");
  assert.equal(faultOf(named("Whatever")), "unknown");
  assert.equal(faultOf(null), "unknown");
});
