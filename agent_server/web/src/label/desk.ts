/** Where recordings are labelled: one is open, the keys go to what they ask for. */

import type { Stage } from "../scene3d/stage.ts";
import { h, need, setAttribute, setState, setText } from "../ui/dom.ts";
import { Film } from "./film.ts";
import { actionOf, type Action } from "./keys.ts";
import { Marks } from "./marks.ts";
import { Panel } from "./panel.ts";
import { clockText, Ruler } from "./ruler.ts";
import type { About, Source } from "./source.ts";
import { decisionWords, Strip } from "./strip.ts";
import { parseTable, type Label } from "./table.ts";

/** A decision is told of for so long after its window. */
const TOLD_S = 1.5;

interface Open {
  readonly name: string;
  readonly about: About;
  readonly film: Film;
  readonly ruler: Ruler;
  readonly marks: Marks;
  tag: string | null;
}

export class Desk {
  readonly #source: Source;
  readonly #stage: Stage | null;
  readonly #pick = need<HTMLSelectElement>("#recording");
  readonly #said = need<HTMLElement>("#said");
  readonly #save = need<HTMLButtonElement>("#save");
  readonly #download = need<HTMLButtonElement>("#download");
  readonly #play = need<HTMLButtonElement>("#play");
  readonly #time = need<HTMLElement>("#time");
  readonly #decision = need<HTMLElement>("#decision");
  readonly #caption = need<HTMLElement>("#caption");
  readonly #strip = new Strip({
    seek: (timeS) => this.#seek(timeS),
    choose: (id) => this.#choose(id),
  });
  readonly #panel = new Panel({
    choose: (id) => this.#choose(id),
    change: (change) => this.#change(change),
    remove: () => this.#act({ kind: "remove" }),
  });
  #open: Open | null = null;
  #timeS = 0;
  #isPlaying = false;
  #isSaving = false;
  #turn = 0;
  #shownPose: unknown = null;

  constructor(source: Source, stage: Stage | null) {
    this.#source = source;
    this.#stage = stage;
    this.#pick.addEventListener("change", () => this.#leaveFor(this.#pick.value));
    this.#save.addEventListener("click", () => this.#act({ kind: "save" }));
    this.#download.addEventListener("click", () => this.#keep());
    const actions: readonly (readonly [string, Action])[] = [
      ["#back", { kind: "frame", direction: -1 }],
      ["#play", { kind: "play" }],
      ["#forth", { kind: "frame", direction: 1 }],
      ["#out", { kind: "zoom", direction: -1 }],
      ["#in", { kind: "zoom", direction: 1 }],
    ];
    for (const [button, action] of actions) {
      need(button).addEventListener("click", () => this.#act(action));
    }
    document.addEventListener("keydown", (event) => this.#hear(event));
    addEventListener("resize", () => this.#render());
    addEventListener("beforeunload", (event) => {
      if (this.#hasChanges) event.preventDefault();
    });
  }

  /** Offer the server's recordings, and open one. */
  async start(wanted: string | null): Promise<void> {
    try {
      const names = await this.#source.names();
      this.#pick.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
      const first = wanted !== null && names.includes(wanted) ? wanted : names[0];
      if (first === undefined) this.#tell("The server offers no recording: name a folder as streams in [server].");
      else await this.#load(first);
    } catch (error) {
      this.#tell(wordsOf(error), true);
    }
  }

  /** Let time pass, and draw. */
  advance(dtMs: number): void {
    const open = this.#open;
    if (this.#isPlaying && open !== null) {
      this.#timeS = open.film.within(this.#timeS + dtMs / 1000);
      this.#isPlaying = this.#timeS < open.about.end_s;
      this.#render();
    }
    this.#stage?.step(dtMs);
    this.#stage?.draw();
  }

  get #hasChanges(): boolean {
    return this.#open !== null && !this.#open.marks.isSaved;
  }

  #leaveFor(name: string): void {
    const question = "Leave this recording? Its labels have not been saved.";
    if (this.#hasChanges && !confirm(question)) this.#pick.value = this.#open?.name ?? name;
    else void this.#load(name);
  }

  async #load(name: string): Promise<void> {
    this.#turn += 1;
    const turn = this.#turn;
    this.#open = null;
    this.#isPlaying = false;
    this.#pick.value = name;
    this.#tell("Loading\u2026");
    try {
      const [about, messages, saved] = await Promise.all([
        this.#source.about(name),
        this.#source.motion(name),
        this.#source.labels(name),
      ]);
      if (turn !== this.#turn) return;
      const labels = parseTable(saved.table);
      this.#panel.open(about, labels);
      this.#open = {
        name,
        about,
        film: new Film(messages, about.start_s, about.end_s),
        ruler: new Ruler(about.start_s, about.end_s),
        marks: new Marks(labels, about.gestures[0] ?? "idle"),
        tag: saved.tag,
      };
      this.#timeS = about.start_s;
      const address = new URL(location.href);
      address.searchParams.set("recording", name);
      history.replaceState(null, "", address);
      this.#tell("");
      this.#pick.blur();
      this.#render();
    } catch (error) {
      if (turn === this.#turn) this.#tell(wordsOf(error), true);
    }
  }

  #hear(event: KeyboardEvent): void {
    const target = event.target as Element;
    const isTyping = target.matches("select, input:not([type=range])");
    const isPress = [" ", "Enter"].includes(event.key);
    // Buttons are pressed with these keys, and the view is turned with others.
    if (isPress && target.matches("a, button:not(.mark)")) return;
    if (target.matches("canvas") && !isPress && !/^[io]$/i.test(event.key)) return;
    const action = actionOf(event, isTyping);
    if (action === null) return;
    event.preventDefault();
    this.#act(action);
  }

  #act(action: Action): void {
    const open = this.#open;
    if (open === null) return;
    const { film, marks, ruler, about } = open;
    switch (action.kind) {
      case "play":
        this.#isPlaying = !this.#isPlaying;
        if (this.#isPlaying && this.#timeS >= about.end_s) this.#timeS = about.start_s;
        break;
      case "frame":
        this.#go(film.step(this.#timeS, action.direction));
        break;
      case "second":
        this.#go(film.within(this.#timeS + action.direction));
        break;
      case "edge":
        this.#go(action.direction === 1 ? about.end_s : about.start_s);
        break;
      case "zoom":
        ruler.zoom(this.#timeS, action.direction);
        break;
      case "mark":
        marks.chooseNext(action.direction, this.#timeS);
        this.#goToChosen();
        break;
      case "begin":
        this.#tell(marks.begin(rounded(this.#timeS)) ?? "");
        break;
      case "end":
        this.#tell(marks.end(rounded(this.#timeS)) ?? "");
        this.#panel.reveal(marks.chosenId);
        break;
      case "gesture": {
        const gesture = about.gestures[action.index];
        if (gesture !== undefined) this.#change({ gesture });
        break;
      }
      case "edit":
        this.#panel.focus();
        break;
      case "remove":
        marks.remove();
        break;
      case "undo":
        marks.undo();
        break;
      case "leave":
        this.#leave();
        break;
      case "save":
        void this.#put(open);
        break;
    }
    this.#render();
  }

  #seek(timeS: number): void {
    const film = this.#open?.film;
    if (film !== undefined) this.#go(film.within(timeS));
    this.#render();
  }

  #go(timeS: number): void {
    this.#isPlaying = false;
    this.#timeS = timeS;
  }

  #choose(id: number): void {
    this.#open?.marks.choose(id);
    this.#goToChosen();
    this.#render();
  }

  /** Unless the moment lies within the chosen mark, go where that begins. */
  #goToChosen(): void {
    const chosen = this.#open?.marks.chosen ?? null;
    if (chosen === null) return;
    if (this.#timeS < chosen.onsetS || this.#timeS > chosen.offsetS) this.#go(chosen.onsetS);
    this.#panel.reveal(chosen.id);
  }

  #change(change: Partial<Label>): void {
    this.#tell(this.#open?.marks.change(change) ?? "");
    this.#render();
  }

  /** Out of the fields first, then away from the chosen mark. */
  #leave(): void {
    const field = document.activeElement;
    if (field instanceof HTMLElement && field.closest("form") !== null) field.blur();
    else this.#open?.marks.choose(null);
  }

  /** Save into the recording. */
  async #put(open: Open): Promise<void> {
    if (this.#isSaving || open.about.refusal !== null || open.marks.isSaved) return;
    this.#isSaving = true;
    const { table } = open.marks;
    this.#tell("Saving\u2026");
    try {
      const saved = await this.#source.save(open.name, table, open.tag);
      open.tag = saved.tag;
      open.marks.markSaved(table);
      this.#tell("Saved.");
    } catch (error) {
      this.#tell(`Not saved: ${wordsOf(error)}`, true);
    } finally {
      this.#isSaving = false;
      this.#render();
    }
  }

  /** Keep the labels as a file. */
  #keep(): void {
    const open = this.#open;
    if (open === null) return;
    const url = URL.createObjectURL(new Blob([open.marks.table], { type: "text/csv" }));
    h("a", { href: url, download: `${open.name}.csv` }).click();
    URL.revokeObjectURL(url);
  }

  /** Say what has just happened; nothing leaves what holds anyway. */
  #tell(words: string, isTrouble = false): void {
    const said = words === "" ? this.#standing : words;
    setText(this.#said, said);
    setState(this.#said, "trouble", `${isTrouble}`);
    setAttribute(this.#said, "title", said);
  }

  get #standing(): string {
    const refusal = this.#open?.about.refusal ?? null;
    return refusal === null ? "" : `Labels cannot be saved here: ${refusal}.`;
  }

  #render(): void {
    const open = this.#open;
    const canSave = open !== null && open.about.refusal === null && !open.marks.isSaved;
    this.#save.disabled = !canSave || this.#isSaving;
    this.#download.disabled = open === null;
    if (open === null) return;
    const { film, ruler, marks, about } = open;
    const timeS = this.#timeS;
    ruler.follow(timeS);
    const pose = film.poseAt(timeS)?.joints ?? null;
    if (pose !== this.#shownPose) this.#stage?.setPose(pose);
    this.#shownPose = pose;
    setText(this.#caption, pose !== null ? "" : "Nobody is seen here");
    setText(this.#time, `${clockText(timeS)} of ${clockText(about.end_s)}`);
    setText(this.#play, this.#isPlaying ? "\u275a\u275a" : "\u25b6");
    setAttribute(this.#play, "aria-label", this.#isPlaying ? "Stop" : "Play");
    const decision = film.decisions.findLast(({ end_ns }) => end_ns / 1e9 <= timeS + 1e-6);
    const isTold = decision !== undefined && timeS - decision.end_ns / 1e9 <= TOLD_S;
    setText(this.#decision, isTold ? decisionWords(decision) : "");
    this.#strip.render(ruler, film, marks, timeS);
    this.#panel.render(marks);
    const mark = marks.isSaved ? "" : "\u2022 ";
    document.title = `${mark}${open.name} \u2013 Labels`;
  }
}

/** Times are kept to the millisecond. */
function rounded(timeS: number): number {
  return Math.round(timeS * 1000) / 1000;
}

function wordsOf(error: unknown): string {
  return error instanceof Error ? error.message : `${error}`;
}
