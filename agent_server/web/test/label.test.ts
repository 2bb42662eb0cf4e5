import assert from "node:assert/strict";
import { test } from "node:test";
import { Film } from "../src/label/film.ts";
import { actionOf } from "../src/label/keys.ts";
import { Marks, rowsOf } from "../src/label/marks.ts";
import { clockText, Ruler } from "../src/label/ruler.ts";
import { sourceOf } from "../src/label/source.ts";
import { formatTable, parseTable, type Label } from "../src/label/table.ts";
import type { Incoming } from "../src/protocol/codec.ts";

const COLD: Label = {
  gesture: "cold",
  onsetS: 4,
  offsetS: 7.977940438,
  subject: "s01",
  expected: "close_window",
  quiet: false,
};
const QUIET: Label = { ...COLD, gesture: "idle", onsetS: 0, offsetS: 4, expected: null, quiet: true };
const HEADINGS = "gesture,onset_s,offset_s,subject,expected,quiet\n";

test("a table is written and read without a loss", () => {
  const odd = { ...COLD, subject: 'Jane "J", of\nthe lab' };
  const text = formatTable([QUIET, odd]);
  assert.equal(
    text,
    `${HEADINGS}idle,0,4,s01,,yes\ncold,4,7.977940438,"Jane ""J"", of\nthe lab",close_window,no\n`,
  );
  assert.deepEqual(parseTable(text), [QUIET, odd]);
  assert.deepEqual(parseTable(HEADINGS), []);
  assert.throws(() => parseTable("a,b\n"), /expected the columns/);
  assert.throws(() => parseTable(`${HEADINGS}"cold,1,2\n`), /quotation mark/);
});

test("a mark is made from where it begins to where it ends, like the one before it", () => {
  const marks = new Marks([COLD], "hot");
  assert.match(marks.end(9) ?? "", /Press I first/);
  assert.equal(marks.begin(9), null);
  assert.match(marks.end(9) ?? "", /end after it begins/);
  assert.equal(marks.end(11.5), null);
  assert.deepEqual(
    { ...marks.chosen, id: 0 },
    { gesture: "hot", onsetS: 9, offsetS: 11.5, subject: "s01", expected: null, quiet: false, id: 0 },
  );
  assert.equal(marks.begunS, null);
  marks.change({ gesture: "loud", subject: "anna" });
  marks.choose(null);
  marks.begin(1);
  marks.end(2);
  assert.equal(marks.chosen?.gesture, "loud");
  assert.deepEqual(marks.list.map(({ onsetS, subject }) => [onsetS, subject]), [
    [1, "anna"],
    [4, "s01"],
    [9, "anna"],
  ]);
});

test("the chosen mark is moved, changed, deleted, and all is taken back", () => {
  const marks = new Marks([COLD, QUIET], "cold");
  const before = marks.table;
  assert.ok(marks.isSaved);
  marks.chooseNext(1, 0.5);
  assert.equal(marks.chosen?.gesture, "cold");
  marks.chooseNext(-1, 0.5);
  assert.equal(marks.chosen?.gesture, "idle");
  assert.match(marks.begin(4) ?? "", /end after/);
  assert.match(marks.change({ offsetS: Number.NaN }) ?? "", /seconds/);
  assert.equal(marks.table, before);
  assert.equal(marks.begin(1), null);
  assert.equal(marks.end(3), null);
  marks.remove();
  assert.equal(marks.chosen, null);
  assert.deepEqual(parseTable(marks.table), [COLD]);
  assert.ok(!marks.isSaved);
  for (let i = 0; i < 3; i += 1) marks.undo();
  assert.equal(marks.table, before);
  assert.ok(marks.isSaved);
  marks.undo();
  assert.equal(marks.table, before);
});

test("what changes while it is being saved is not taken for saved", () => {
  const marks = new Marks([COLD], "cold");
  marks.chooseNext(1, 0);
  marks.change({ gesture: "hot" });
  const sent = marks.table;
  marks.change({ gesture: "loud" });
  marks.markSaved(sent);
  assert.ok(!marks.isSaved);
});

test("marks that overlap lie in rows of their own", () => {
  const { list } = new Marks([QUIET, COLD, { ...COLD, onsetS: 3 }, { ...COLD, onsetS: 8, offsetS: 9 }], "cold");
  assert.deepEqual([...rowsOf(list).values()], [0, 1, 0, 0]);
});

const pose = (ms: number): Incoming => ({
  type: "pose",
  originating_ns: ms * 1e6,
  body_id: 1,
  joints: [],
});

test("a step goes from frame to frame, and on where nobody is seen", () => {
  const film = new Film([80, 120, 200, 5_000].map(pose), 0, 6);
  const walk = (from: number, direction: -1 | 1, count: number): number[] => {
    const times = [from];
    for (let i = 0; i < count; i += 1) times.push(film.step(times.at(-1) ?? 0, direction));
    return times.slice(1).map((time) => Math.round(time * 1000));
  };
  assert.deepEqual(walk(0, 1, 5), [80, 120, 200, 240, 280]);
  assert.deepEqual(walk(0.25, -1, 5), [200, 120, 80, 40, 0]);
  assert.equal(film.step(0, -1), 0);
  assert.equal(film.step(6, 1), 6);
  assert.equal(film.poseAt(0.13)?.originating_ns, 120e6);
  assert.equal(film.poseAt(0.05), null);
  assert.equal(film.poseAt(1), null);
  // A time that was kept as text still names its frame.
  assert.equal(film.poseAt(Number("0.12"))?.originating_ns, 120e6);
});

test("the time line shows less around a moment and follows it", () => {
  const ruler = new Ruler(0, 64);
  assert.deepEqual(ruler.ticks(10), [0, 10, 20, 30, 40, 50, 60]);
  ruler.zoom(40, 1);
  assert.deepEqual([ruler.fromS, ruler.toS], [24, 56]);
  ruler.follow(30);
  assert.equal(ruler.fromS, 24);
  ruler.follow(55);
  assert.deepEqual([ruler.fromS, ruler.toS], [32, 64]);
  for (let i = 0; i < 9; i += 1) ruler.zoom(40, 1);
  assert.equal(ruler.spanS, 4);
  assert.equal(ruler.timeAt(ruler.share(39)), 39);
  for (let i = 0; i < 9; i += 1) ruler.zoom(40, -1);
  assert.ok(ruler.isWhole);
  assert.deepEqual([4.04, 59.999, 75.25].map((time) => clockText(time)), ["4.04 s", "1:00.00", "1:15.25"]);
  assert.equal(clockText(125, 0), "2:05");
});

test("keys ask for things, but not while a field is filled in", () => {
  const key = (name: string, held: object = {}) => ({
    key: name, shiftKey: false, ctrlKey: false, metaKey: false, altKey: false, ...held,
  });
  assert.deepEqual(actionOf(key("I"), false), { kind: "begin" });
  assert.deepEqual(actionOf(key("ArrowLeft"), false), { kind: "frame", direction: -1 });
  assert.deepEqual(actionOf(key("ArrowRight", { shiftKey: true }), false), { kind: "second", direction: 1 });
  assert.deepEqual(actionOf(key("3"), false), { kind: "gesture", index: 2 });
  for (const name of ["i", "ArrowLeft", "Backspace", "3", " "]) assert.equal(actionOf(key(name), true), null);
  assert.deepEqual(actionOf(key("Escape"), true), { kind: "leave" });
  assert.deepEqual(actionOf(key("s", { metaKey: true }), true), { kind: "save" });
  assert.equal(actionOf(key("z", { ctrlKey: true }), true), null);
  assert.equal(actionOf(key("i", { ctrlKey: true }), false), null);
});

test("labels are saved in the place of those that were read, and a refusal is said", async () => {
  const asked: (readonly [string, RequestInit | undefined])[] = [];
  const answers = [
    new Response(HEADINGS, { headers: { ETag: '"one"' } }),
    new Response(JSON.stringify({ detail: "somebody else has saved" }), { status: 412 }),
    new Response("", { status: 500 }),
  ];
  const source = sourceOf("http://host/v1/streams", async (input, init) => {
    asked.push([`${input}`, init]);
    return answers.shift() ?? Response.error();
  });
  const read = await source.labels("an evening");
  assert.deepEqual(read, { table: HEADINGS, tag: '"one"' });
  await assert.rejects(source.save("an evening", "x", read.tag), /^Error: somebody else has saved$/);
  const [address, init] = asked[1] ?? [];
  assert.equal(address, "http://host/v1/streams/an%20evening/labels");
  assert.equal(init?.method, "PUT");
  assert.equal(new Headers(init?.headers).get("If-Match"), '"one"');
  await assert.rejects(source.save("a", "x", null), /refused \(500\)/);
});
