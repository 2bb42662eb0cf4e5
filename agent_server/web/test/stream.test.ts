import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { test } from "node:test";
import { Vector3 } from "three";
import type { Point, PoseStreamMessage } from "../src/protocol/messages.ts";
import { MotionStream } from "../src/room/agent/stream.ts";
import { readRig } from "./agent-glb.ts";
import { mannequin } from "./agent-mannequin.ts";
import { Probe, agentAt, nothing, steady, type Start } from "./agent-measure.ts";
import { readRules } from "./agent-room.ts";

const HUMAN = new URL("../public/human.glb", import.meta.url);
const BODIES = {
  mannequin: () => mannequin({ seed: 4 }).rig,
  ...(existsSync(HUMAN) && { human: () => readRig(HUMAN) }),
};
const JOINTS = ["torso", "neck"].concat(
  ["left", "right"].flatMap((side) => ["shoulder", "elbow", "hand"].map((part) => `${side}_${part}`)),
);
const STRETCH = 5;

/** A body whose right arm is straight, at an angle forwards from hanging; its trunk leans. */
function pose(angle: number, lean = 0): Point[] {
  const arm = (x: number, turned: number): Point[] =>
    [0, 0.28, 0.56].map((down) => [x, 1.4 - down * Math.cos(turned), down * Math.sin(turned)]);
  return [[0, 1.1, 0], [0, 1.1 + 0.3 * Math.cos(lean), 0.3 * Math.sin(lean)], ...arm(0.2, 0), ...arm(-0.2, angle)];
}

/** Two seconds in which the arm goes up to the horizontal and stays there. */
function stretches(frames = 50, lean = 0): PoseStreamMessage[] {
  const positions = Array.from({ length: frames }, (_, i) => pose(Math.min(1, i / 20) * 1.5, lean));
  return Array.from({ length: frames / STRETCH }, (_, i) => ({
    type: "pose_stream",
    command_id: "c",
    first_frame: i * STRETCH,
    rate_hz: 25,
    joints: JOINTS,
    positions: positions.slice(i * STRETCH, (i + 1) * STRETCH),
    is_last: (i + 1) * STRETCH === frames,
    fallback: null,
  }));
}

test("a hand is led while it is raised, and its pose is in lengths of the arm", () => {
  const stream = new MotionStream();
  for (const stretch of stretches(50, 0.2)) stream.push(stretch);
  stream.step(0.1);
  assert.ok(!stream.leads("Right"));
  stream.step(1);
  assert.ok(stream.leads("Right") && !stream.leads("Left"));
  const { reach, fore } = stream.arms.Right;
  assert.ok(reach.distanceTo(new Vector3(0, -Math.cos(1.5), Math.sin(1.5))) < 1e-6);
  assert.ok(fore.distanceTo(reach) < 1e-6);
  assert.ok(Math.abs(stream.lean - 0.2) < 1e-6);
  stream.step(1);
  assert.ok(!stream.isPlaying && !stream.leads("Right"));
  assert.equal(stream.lean, 0);
});

test("it plays what has come, waits a little for more, and stops where frames are missing", () => {
  const [one, two, three] = stretches();
  const stream = new MotionStream();
  if (one === undefined || two === undefined || three === undefined) return;
  stream.push(one);
  for (let t = 0; t < 0.5; t += 0.1) stream.step(0.1);
  assert.ok(stream.isPlaying);
  stream.push(two);
  stream.step(0.1);
  assert.ok(stream.isPlaying);
  for (let t = 0; t < 1; t += 0.1) stream.step(0.1);
  assert.ok(!stream.isPlaying, "nothing came for a while");
  stream.clear();
  stream.push(one);
  stream.push(three);
  stream.push(two);
  stream.step(0.21);
  assert.ok(!stream.isPlaying, "what comes after a gap is not played");
});

test("a motion without a joint that is needed, or without frames, is not played", () => {
  const [one] = stretches();
  if (one === undefined) return;
  for (const broken of [
    { ...one, joints: JOINTS.map((name) => name.replace("neck", "tail")) },
    { ...one, positions: [], is_last: true, fallback: "an arm reaches too far" },
  ]) {
    const stream = new MotionStream();
    stream.push(broken);
    stream.step(0.1);
    assert.ok(!stream.isPlaying);
  }
});

const { greet = [] } = readRules().reactions;

for (const [body, makeRig] of Object.entries(BODIES)) {
  for (const start of ["seated", "standing"] satisfies Start[]) {
    test(`${body}, ${start}: the hand goes out while it is led, within what bodies can do, and comes back`, () => {
      const rig = makeRig();
      const { agent } = agentAt(rig, start, 1, steady(60));
      const worst = nothing();
      const probe = new Probe(rig, agent, worst);
      const { hand, upper } = rig.arms.Right;
      const ahead = () => hand.place.distanceTo(upper.place) * Math.sign(hand.place.y - upper.place.y + 0.35);
      const coming = stretches();
      agent.setMode("reacting");
      agent.play({ steps: greet });
      let [wasLed, farthest] = [0, -1];
      for (let frame = 0; frame < 240; frame += 1) {
        // It comes while it plays, faster than it is played.
        const next = frame % 6 === 0 ? coming.shift() : undefined;
        if (next !== undefined) agent.move(next);
        if (frame === 180) agent.setMode("attention");
        agent.step(1000 / 60);
        probe.look(1000 / 60);
        if (!agent.state.hands.Right.led) continue;
        wasLed += 1;
        farthest = Math.max(farthest, ahead());
      }
      const told = JSON.stringify(worst);
      assert.ok(wasLed > 60 && wasLed < 130, `led for ${wasLed} frames`);
      assert.ok(farthest > 0.4, `the hand is ${farthest} m from the shoulder`);
      assert.ok(!agent.state.hands.Right.led);
      assert.ok(worst.slide_m < 0.005 && worst.sunk_m < 0.002, told);
      assert.ok(worst.beyond_range_deg < 3, told);
      assert.ok(worst.joint_speed_deg_s < 900, told);
    });

    test(`${body}, ${start}: a command that comes in between cuts the motion short`, () => {
      const { agent } = agentAt(makeRig(), start, 1, steady(60));
      agent.play({ steps: greet });
      for (const stretch of stretches()) agent.move(stretch);
      for (let frame = 0; frame < 60; frame += 1) agent.step(1000 / 60);
      assert.ok(agent.state.hands.Right.led);
      agent.play({ steps: greet });
      agent.step(1000 / 60);
      assert.ok(!agent.state.hands.Right.led);
    });
  }
}
