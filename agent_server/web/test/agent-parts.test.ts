import assert from "node:assert/strict";
import { test } from "node:test";
import { Quaternion, Vector3, Group } from "three";
import { AngleChannel, PlaceChannel } from "../src/room/agent/channel.ts";
import { Foot } from "../src/room/agent/foot.ts";
import { Idle, ROOM_IDLE } from "../src/room/agent/idle.ts";
import { Aim, bound, softReach, twistAbout, twoBone } from "../src/room/agent/ik.ts";
import { ankleOf } from "../src/room/agent/leg.ts";
import { Chance, Spring, coasts, remains, wrap } from "../src/room/agent/maths.ts";
import { Path, type Going } from "../src/room/agent/path.ts";
import { BY_CHAIR, spotOf } from "../src/room/agent/places.ts";
import { Rig, SIDES } from "../src/room/agent/rig.ts";
import { clearanceAt, route } from "../src/room/agent/route.ts";
import { agentAt, steady } from "./agent-measure.ts";
import { mannequin } from "./agent-mannequin.ts";
import { readRules } from "./agent-room.ts";

const near = (a: number, b: number, tolerance: number, what = "") =>
  assert.ok(Math.abs(a - b) <= tolerance, `${what} ${a} is not within ${tolerance} of ${b}`);
const still = (x: number, z: number, heading: number): Going => ({
  x,
  z,
  heading,
  speedX: 0,
  speedZ: 0,
  turning: 0,
});

test("a spring goes the same way in one step and in many", () => {
  const [coarse, fine] = [new Spring(1), new Spring(1)];
  coarse.speed = fine.speed = -3;
  coarse.step(0.2, 9, 0.25);
  for (let i = 0; i < 250; i += 1) fine.step(0.2, 9, 0.001);
  near(coarse.value, fine.value, 1e-9);
  near(coarse.speed, fine.speed, 1e-9);
});

test("what remains of a movement, and what speed adds, begin and end smoothly", () => {
  const slope = (f: (u: number) => number, u: number) => (f(u + 1e-5) - f(u - 1e-5)) / 2e-5;
  assert.equal(remains(0), 1);
  assert.equal(remains(1), 0);
  assert.equal(coasts(0), 0);
  near(coasts(1), 0, 1e-12);
  near(slope(coasts, 1e-5), 1, 1e-3);
  near(slope(coasts, 1 - 1e-5), 0, 1e-3);
  near(slope(remains, 1e-5), 0, 1e-3);
});

test("an angle that changes its source keeps value and speed, and arrives on time", () => {
  const channel = new AngleChannel();
  const dt = 1 / 120;
  for (let t = 0; t < 1; t += dt) channel.follow(Math.sin(3 * t), dt);
  let [value, speed] = [channel.value, channel.speed];
  channel.change(0.5);
  for (let i = 0; i < 61; i += 1) {
    channel.follow(2, dt);
    assert.ok(Math.abs(channel.value - value) < 0.08, "no jump");
    assert.ok(Math.abs(channel.speed - speed) < 0.7, "no jerk");
    [value, speed] = [channel.value, channel.speed];
  }
  near(channel.value, 2, 1e-9);
});

test("a place that changes to a moving source meets it", () => {
  const channel = new PlaceChannel();
  const source = new Vector3();
  channel.set(new Vector3(0, 1, 0));
  channel.change(0.4);
  for (let t = 0; t < 0.45; t += 1 / 60) channel.follow(source.set(1 + t, 1, 2 * t), 0.5 * t, 1 / 60);
  assert.ok(channel.isThere);
  near(channel.value.distanceTo(source), 0, 1e-9);
});

test("two bones keep their lengths, reach the target and bend to the pole", () => {
  const chance = new Chance(3);
  const vector = () => new Vector3(chance.between(-1, 1), chance.between(-1, 1), chance.between(-1, 1));
  const [middle, end, normal] = [new Vector3(), new Vector3(), new Vector3()];
  for (let i = 0; i < 200; i += 1) {
    const [root, pole] = [vector(), vector()];
    const target = root.clone().add(vector().setLength(chance.between(0.1, 0.52)));
    twoBone(root, target, 0.3, 0.25, pole, 0.97, middle, end, normal);
    near(middle.distanceTo(root), 0.3, 1e-9);
    near(end.distanceTo(middle), 0.25, 1e-9);
    near(end.distanceTo(target), 0, 1e-9);
    const bend = middle.clone().sub(root).cross(end.clone().sub(root));
    assert.ok(bend.dot(normal) <= 1e-9, "it bends out to the side of the pole");
  }
});

test("a limb comes softly to its full length", () => {
  let before = softReach(0.4, 0.5, 0.9);
  for (let d = 0.401; d < 2; d += 0.001) {
    const reach = softReach(d, 0.5, 0.9);
    assert.ok(reach >= before && reach - before <= 0.001 + 1e-12 && reach < 0.5);
    before = reach;
  }
});

test("an aim turns the rest direction onto the given one", () => {
  const aim = new Aim(new Vector3(0, -1, 0.1), new Vector3(0, 0, 1));
  const direction = new Vector3(0.3, -0.5, 0.8);
  const turn = aim.turn(direction, new Vector3(1, 0, 0), new Quaternion());
  const turned = new Vector3(0, -1, 0.1).normalize().applyQuaternion(turn);
  near(turned.angleTo(direction), 0, 1e-6);
});

test("a bounded turn keeps within its bounds, and a twist beyond half a turn does not flip", () => {
  const [axis, hinge] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0)];
  const bounds = { twist: 1.2, swing: 0.9, swingAcross: 0.3 };
  let asked = 0;
  for (let angle = 0; angle < 4; angle += 0.1) {
    const turn = new Quaternion().setFromAxisAngle(hinge, 1.5);
    turn.multiply(new Quaternion().setFromAxisAngle(axis, angle));
    asked = bound(turn, axis, hinge, bounds, asked);
    near(twistAbout(turn, axis), Math.min(angle, 1.2), 1e-6);
    const swung = axis.clone().applyQuaternion(turn).angleTo(axis);
    near(swung, 0.9, 1e-6);
  }
});

test("the same posture results whatever the bones' own axes, names and rest pose", () => {
  const places = (options: Parameters<typeof mannequin>[0]) => {
    const { rig } = mannequin(options);
    const { agent } = agentAt(rig, "seated", 1, steady(60));
    agent.play({ steps: [{ action: "walk_to", target: "hifi", duration_s: 2 }] });
    for (let i = 0; i < 90; i += 1) agent.step(1000 / 60);
    rig.root.updateWorldMatrix(true, true);
    // From the bones themselves, so that what was written to them is right, too.
    return rig.all.map(({ object }) => object.getWorldPosition(new Vector3()));
  };
  const plain = places({});
  const odd = places({ seed: 5, prefix: "mixamorig" });
  for (const [i, place] of plain.entries()) near(place.distanceTo(odd[i] ?? new Vector3()), 0, 1e-6);
  const aPose = places({ armsDown: 0.8, prefix: "" });
  const { rig } = mannequin();
  for (const side of SIDES) {
    const hand = rig.all.indexOf(rig.joints[`${side}Hand`]);
    near(plain[hand]?.distanceTo(aPose[hand] ?? new Vector3()) ?? 1, 0, 0.03, "hand");
  }
});

test("a skeleton without arms is refused by the names of its bones", () => {
  const { root } = mannequin();
  root.traverse((object) => {
    if (object.name === "mixamorig:LeftHand") object.name = "Claw";
  });
  assert.throws(() => new Rig(root), /lacks LeftHand$/);
  assert.throws(() => new Rig(new Group()), /lacks Hips, Spine/);
});

test("heel and ball stay where they are as a foot rolls", () => {
  const { rig } = mannequin();
  const leg = rig.legs.Left;
  const ankle = new Vector3();
  const foot = { x: 0.4, z: -0.2, yaw: 0.7, lift: 0, pitch: 0 };
  for (const pitch of [-0.7, -0.2, 0.2, 0.4]) {
    ankleOf(leg, { ...foot, pitch }, ankle);
    const isOnBall = pitch < 0;
    const point = new Vector3(0, isOnBall ? leg.ballHeight - leg.ankleHeight : -leg.ankleHeight, isOnBall ? leg.ball : -leg.heel);
    point.applyAxisAngle(new Vector3(1, 0, 0), -pitch).applyAxisAngle(new Vector3(0, 1, 0), foot.yaw).add(ankle);
    const ahead = isOnBall ? leg.ball : -leg.heel;
    near(point.x, foot.x + ahead * Math.sin(foot.yaw), 1e-9);
    near(point.z, foot.z + ahead * Math.cos(foot.yaw), 1e-9);
    near(point.y, isOnBall ? leg.ballHeight : 0, 1e-9);
  }
});

test("a swing that is diverted lands at its new end, at the same time", () => {
  const foot = new Foot();
  foot.set(0, 0, 0);
  foot.swingTo(0, 0.6, 0, { duration: 0.4, lift: 0.05, landing: 0.2 });
  let before = 0;
  let seconds = 0;
  while (!foot.isPlanted) {
    if (Math.abs(seconds - 0.2) < 1e-9) foot.divert(0.1, 0.5, 0.3);
    foot.step(0.01);
    seconds += 0.01;
    assert.ok(foot.lift >= 0 && Math.abs(foot.z - before) < 0.04);
    before = foot.z;
  }
  near(seconds, 0.4, 0.011);
  near(foot.x, 0.1, 1e-9);
  near(foot.z, 0.5, 1e-9);
  near(foot.yaw, 0.3, 1e-9);
});

test("ways lead around desk, chair and cabinet", () => {
  const ends = [BY_CHAIR.Left, BY_CHAIR.Right, spotOf("window", "Left"), spotOf("curtain", "Left"), spotOf("hifi", "Left")];
  for (const from of ends) {
    for (const to of ends) {
      const path = new Path();
      path.plan(still(...from.at, from.heading), route(from.at, to.at), to);
      assert.ok(path.duration < 4);
      const going = still(0, 0, 0);
      for (let t = 0; t <= path.duration; t += 0.02) {
        const { x, z, speedX, speedZ } = path.at(t, going);
        assert.ok(clearanceAt([x, z]) > 0.08, `${from.at} to ${to.at}: ${x}, ${z}`);
        assert.ok(Math.hypot(speedX, speedZ) < 1.5);
      }
      path.at(path.duration, going);
      near(Math.hypot(going.x - to.at[0], going.z - to.at[1]), 0, 0.01);
      near(wrap(going.heading - to.heading), 0, 0.03);
    }
  }
});

test("idle behaviour is that of the rule file, in its proportions", () => {
  assert.deepEqual(readRules().idle, ROOM_IDLE);
  const idle = new Idle({ working: { "look_at screen": 3, "look_at notebook": 1 }, attention: {} }, new Chance(2));
  idle.begin("working");
  const counts: Record<string, number> = {};
  for (let i = 0; i < 20_000; i += 1) {
    if (idle.step(0.5)) counts[idle.target ?? ""] = (counts[idle.target ?? ""] ?? 0) + 1;
  }
  near((counts["screen"] ?? 0) / (counts["notebook"] ?? 1), 3, 0.25);
});
