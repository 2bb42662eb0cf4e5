/** The valence/arousal plane with the gate drawn into it, and what the gate says. */

import type { AffectTelemetry, GateLevels, GateBody } from "../protocol/messages.ts";
import type { Timed } from "../state/store.ts";
import type { Affect } from "../state/view.ts";
import { level, sentenceCase, sourceWord } from "../state/words.ts";
import { h, setState, setText, svg } from "../ui/dom.ts";

const LIMIT = 10;
/** Half the side of the plane in the drawing's own units. */
const HALF = 100;
const TRAIL_DOTS = 24;
const TRAIL_MS = 4_000;

const at = (value: number): number => (value / LIMIT) * HALF;

export class AffectPanel {
  readonly #mode: HTMLElement;
  readonly #body: HTMLElement;
  readonly #gate = svg("g");
  readonly #trail = svg("g", { class: "trail" });
  readonly #point = svg("circle", { class: "point", r: 6 });
  readonly #spread = svg("ellipse", { class: "spread" });
  readonly #halo = svg("circle", { class: "halo", r: 12 });
  readonly #verdict = h("p", { class: "verdict" });
  readonly #reason = h("p", { class: "reason" });
  readonly #valence = h("dd");
  readonly #arousal = h("dd");
  readonly #source = h("dd");
  #drawn = "";

  constructor(root: HTMLElement, mode: HTMLElement) {
    this.#mode = mode;
    this.#body = root;
    for (let i = 0; i < TRAIL_DOTS; i++) this.#trail.append(svg("circle"));
    const plane = svg(
      "svg",
      {
        class: "plane",
        viewBox: "-101 -101 202 202",
        role: "img",
        "aria-label": "Plane of valence, left to right, and arousal, bottom to top",
      },
      hatch(),
      svg("rect", { class: "ground", x: -HALF, y: -HALF, width: 2 * HALF, height: 2 * HALF, rx: 6 }),
      this.#gate,
      svg("path", { class: "axis", d: `M${-HALF} 0H${HALF}M0 ${-HALF}V${HALF}` }),
      label(-HALF + 6, -6, "start", "unpleasant"),
      label(HALF - 6, -6, "end", "pleasant"),
      label(6, -HALF + 18, "start", "excited"),
      label(6, HALF - 8, "start", "calm"),
      this.#spread,
      this.#trail,
      this.#halo,
      this.#point,
    );
    root.append(
      plane,
      h(
        "div",
        { class: "affect-words" },
        this.#verdict,
        this.#reason,
        h(
          "dl",
          { class: "levels" },
          h("div", {}, h("dt", {}, "Valence"), this.#valence),
          h("div", {}, h("dt", {}, "Arousal"), this.#arousal),
          h("div", {}, h("dt", {}, "Read from"), this.#source),
        ),
      ),
    );
  }

  render(
    levels: GateLevels | null,
    affect: Affect | null,
    trail: readonly Timed<AffectTelemetry>[],
    verdict: GateBody | null,
    now: number,
  ): void {
    const mode = verdict?.mode ?? levels?.mode ?? null;
    setText(this.#mode, mode === null ? "" : `mode: ${mode}`);
    if (levels !== null) this.#drawGate({ ...levels, mode: mode ?? levels.mode });
    setState(this.#body, "gate", verdict === null ? "unknown" : verdict.is_open ? "open" : "closed");
    setState(this.#body, "face", affect?.isFresh === true ? "seen" : "none");
    this.#drawPoint(affect, trail, now);
    setText(
      this.#verdict,
      verdict === null ? "Waiting" : verdict.is_open ? "Open" : "Closed",
    );
    setText(
      this.#reason,
      verdict === null ? "No decision at the moment." : `${sentenceCase(verdict.reason)}.`,
    );
    const isSeen = affect !== null && affect.isFresh;
    setText(this.#valence, isSeen ? level(affect.valence) : "no face");
    setText(this.#arousal, isSeen ? level(affect.arousal) : "no face");
    setText(this.#source, isSeen ? sourceWord(affect.source) : "\u2013");
  }

  #drawPoint(affect: Affect | null, trail: readonly Timed<AffectTelemetry>[], now: number): void {
    const visible = affect === null ? "hidden" : "visible";
    for (const circle of [this.#point, this.#halo]) {
      circle.setAttribute("visibility", visible);
      if (affect === null) continue;
      circle.setAttribute("cx", at(affect.valence).toFixed(1));
      circle.setAttribute("cy", at(-affect.arousal).toFixed(1));
    }
    this.#drawSpread(affect);
    // Evenly thinned, so that a fast face and a slow one leave trails of the same length in time.
    const recent = trail.filter((sample) => now - sample.at <= TRAIL_MS);
    const stride = Math.max(1, recent.length / TRAIL_DOTS);
    for (const [i, dot] of [...this.#trail.children].entries()) {
      const sample = recent[Math.floor(recent.length - 1 - i * stride)];
      if (sample === undefined) {
        dot.setAttribute("r", "0");
        continue;
      }
      const youth = 1 - (now - sample.at) / TRAIL_MS;
      dot.setAttribute("cx", at(sample.value.valence).toFixed(1));
      dot.setAttribute("cy", at(-sample.value.arousal).toFixed(1));
      dot.setAttribute("r", (0.8 + 2.2 * youth).toFixed(2));
      dot.setAttribute("opacity", (0.7 * youth).toFixed(2));
    }
  }

  /** One standard deviation to each side. */
  #drawSpread(affect: Affect | null): void {
    const spread = affect !== null && affect.isFresh ? affect.spread : null;
    this.#spread.setAttribute("visibility", spread === null ? "hidden" : "visible");
    if (affect === null || spread === null) return;
    this.#spread.setAttribute("cx", at(affect.valence).toFixed(1));
    this.#spread.setAttribute("cy", at(-affect.arousal).toFixed(1));
    this.#spread.setAttribute("rx", at(spread.valence).toFixed(1));
    this.#spread.setAttribute("ry", at(spread.arousal).toFixed(1));
  }

  #drawGate(levels: GateLevels): void {
    const shape = JSON.stringify(levels);
    if (shape === this.#drawn) return;
    this.#drawn = shape;
    this.#gate.replaceChildren();
    if (levels.mode === "off") return;
    const right = at(levels.enter_valence);
    const inner = at(levels.enter_arousal);
    const width = right + HALF;
    const height = HALF - inner;
    this.#gate.append(
      svg("rect", { class: "shut", x: 0, y: -HALF, width: HALF, height: 2 * HALF }),
      svg("rect", { class: "open", x: -HALF, y: -HALF, width, height }),
      svg("rect", { class: "open", x: -HALF, y: inner, width, height }),
      label(-HALF + 8, -HALF + 20, "start", "opens", "open-label"),
    );
    const leaveRight = at(levels.leave_valence);
    const leaveInner = at(levels.leave_arousal);
    if (leaveRight === right && leaveInner === inner) return;
    this.#gate.append(
      svg("path", {
        class: "leave",
        d:
          `M${-HALF} ${-leaveInner}H${leaveRight}V${-HALF}` +
          `M${-HALF} ${leaveInner}H${leaveRight}V${HALF}`,
      }),
    );
  }
}

/** Fills the pleasant half, where the gate never opens. */
function hatch(): SVGPatternElement {
  return svg(
    "pattern",
    { id: "closed-half", width: 7, height: 7, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" },
    svg("path", { class: "hatch", d: "M0 0V7" }),
  );
}

function label(x: number, y: number, anchor: string, text: string, name = "axis-label") {
  const element = svg("text", { class: name, x, y, "text-anchor": anchor });
  element.textContent = text;
  return element;
}
