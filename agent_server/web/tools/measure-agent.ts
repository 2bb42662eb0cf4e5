/**
 * Measures how the agent moves, over all reactions of the rule file, and prints the worst of each.
 *
 *     node tools/measure-agent.ts --json
 *     node tools/measure-agent.ts --json --body public/human.glb
 */

import { existsSync } from "node:fs";
import { parseArgs } from "node:util";
import { mannequin } from "../test/agent-mannequin.ts";
import { readRig } from "../test/agent-glb.ts";
import { cutAndGoOn, jittery, nothing, perform, steady, type Start } from "../test/agent-measure.ts";
import { readRules } from "../test/agent-room.ts";

const { values: given } = parseArgs({
  options: {
    body: { type: "string" },
    cuts: { type: "string", default: "50" },
    json: { type: "boolean" },
  },
});
const HUMAN = new URL("../public/human.glb", import.meta.url);
const body = given.body ?? (existsSync(HUMAN) ? HUMAN : null);
const makeRig = () => (body === null ? mannequin().rig : readRig(body));
const { reactions } = readRules();
const rates = { "60": () => steady(60), "15..60": () => jittery(7) };
const starts: readonly Start[] = ["seated", "standing"];
const round = (value: unknown): unknown =>
  typeof value === "number" && Number.isFinite(value) ? Number(value.toFixed(4)) : value;
const rounded = (values: object): object =>
  Object.fromEntries(Object.entries(values).map(([key, value]) => [key, round(value)]));

const result: Record<string, unknown> = { body: body === null ? "mannequin" : `${body}`.split("/").at(-1) };
for (const [rate, makeFrames] of Object.entries(rates)) {
  const worst = nothing();
  const seconds: Record<string, unknown> = {};
  let slowest = 0;
  let latest = 0;
  for (const [name, steps] of Object.entries(reactions)) {
    for (const start of starts) {
      const played = perform(makeRig, start, name, steps, makeFrames, worst);
      seconds[`${name} ${start}`] = round(played.seconds);
      slowest = Math.max(slowest, played.seconds);
      latest = Math.max(latest, played.first_motion_s);
    }
  }
  const cut = nothing();
  let slowestCut = 0;
  for (let i = 0; i < Number(given.cuts); i += 1) {
    slowestCut = Math.max(slowestCut, cutAndGoOn(makeRig, reactions, 100 + i, makeFrames(), cut));
  }
  result[`at ${rate} Hz`] = {
    first_motion_s: round(latest),
    longest_s: round(slowest),
    ...rounded(worst),
    seconds,
    cuts: { longest_s: round(slowestCut), ...rounded(cut) },
  };
}
process.stdout.write(`${JSON.stringify(result, null, given.json === true ? undefined : 2)}\n`);
