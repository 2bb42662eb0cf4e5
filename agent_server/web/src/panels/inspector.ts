/** The full reasons of one decision, over the live panels; it stays while the log moves on. */

import type {
  AckTelemetry,
  CommandBody,
  CommandMessage,
  DecisionMessage,
  ErrorMessage,
  Timing,
  Welcome,
} from "../protocol/messages.ts";
import type { Row } from "../state/log.ts";
import { endOf } from "../state/running.ts";
import {
  count,
  endText,
  endWord,
  errorWord,
  level,
  milliseconds,
  missedText,
  outcomeWord,
  percent,
  sentenceCase,
  sessionTime,
} from "../state/words.ts";
import { h, setState } from "../ui/dom.ts";
import { Bars } from "./gestures.ts";
import { stepWords } from "./room.ts";

type Fact = readonly [name: string, value: string | Node];

const STAGES: readonly (readonly [keyof Timing & string, string])[] = [
  ["wait_ms", "wait"],
  ["predict_ms", "predict"],
  ["classify_ms", "classify"],
  ["decide_ms", "decide"],
];

export class Inspector {
  readonly #root: HTMLElement;
  readonly #close: HTMLButtonElement;
  readonly #content = h("div", { class: "inspector-body", tabindex: "0", role: "group" });
  readonly #title = h("h2", { id: "inspector-title" });
  readonly #subtitle = h("p", { class: "hint" });

  constructor(root: HTMLElement, onClose: () => void) {
    this.#root = root;
    this.#close = h("button", { type: "button", class: "quiet-button" }, "Close");
    this.#content.setAttribute("aria-labelledby", "inspector-title");
    this.#close.addEventListener("click", onClose);
    root.addEventListener("keydown", (event) => {
      if (event.key === "Escape") onClose();
    });
    root.append(
      h("div", { class: "panel-head" }, h("div", {}, this.#title, this.#subtitle), this.#close),
      this.#content,
    );
  }

  open(row: Row, welcome: Welcome | null): void {
    this.#root.hidden = false;
    this.#content.scrollTop = 0;
    if (row.kind === "command") this.#showCommand(row.command);
    else if (row.kind === "error") this.#showError(row.error, row.count);
    else if (row.kind === "end") this.#showEnd(row.ack, row.reaction);
    else if (row.kind === "missed") this.#showMissed(row.topics);
    else this.#showDecision(row.last, row.count, welcome);
    this.#close.focus();
  }

  close(): void {
    this.#root.hidden = true;
  }

  #showCommand(command: CommandMessage): void {
    setState(this.#root, "outcome", "command");
    this.#title.textContent = sentenceCase(command.reaction);
    this.#subtitle.textContent = `${sessionTime(command.issued_ns)}, no decision`;
    this.#content.replaceChildren(
      h("p", { class: "reason-lead" }, `Because of ${command.cause.replaceAll("_", " ")}.`),
      commandSection(command),
    );
  }

  #showError(error: ErrorMessage, times: number): void {
    setState(this.#root, "outcome", "error");
    this.#title.textContent = errorWord(error.code);
    this.#subtitle.textContent = times > 1 ? `the latest of ${times} in a row` : "";
    this.#content.replaceChildren(
      h("p", { class: "reason-lead" }, sentenceCase(error.message)),
      section("Details", facts([["Code", h("code", {}, error.code)], ["Field", error.field ?? "none"]])),
    );
  }

  #showEnd(ack: AckTelemetry, reaction: string | null): void {
    const end = endOf(ack);
    setState(this.#root, "outcome", end);
    this.#title.textContent = endWord(end);
    this.#subtitle.textContent = "";
    this.#content.replaceChildren(
      h("p", { class: "reason-lead" }, `${endText(ack, reaction)}.`),
      section(
        "Command",
        facts([
          ["Id", h("code", {}, ack.command_id)],
          ["Last step", ack.step === null ? "none" : `${ack.step + 1}`],
          ["Reason given", ack.reason ?? "none"],
        ]),
      ),
    );
  }

  #showMissed(topics: Readonly<Record<string, number>>): void {
    setState(this.#root, "outcome", "missed");
    this.#title.textContent = "Missed";
    this.#subtitle.textContent = "";
    this.#content.replaceChildren(
      h("p", { class: "reason-lead" }, `${missedText(topics)}: only the latest of each kind waits.`),
      section("Messages", facts(Object.entries(topics).map(([topic, n]): Fact => [sentenceCase(topic), count(n)]))),
    );
  }

  #showDecision({ decision, timing }: DecisionMessage, times: number, welcome: Welcome | null): void {
    const { gate, scene, quality, command } = decision;
    setState(this.#root, "outcome", decision.outcome);
    this.#title.textContent =
      command === null ? outcomeWord(decision.outcome) : sentenceCase(command.reaction);
    this.#subtitle.textContent =
      `${sessionTime(decision.end_ns)}, decision ${decision.id}` +
      (times > 1 ? `, the latest of ${times} alike` : "");

    const bars = new Bars();
    bars.render(
      welcome?.labels ?? Object.keys(decision.probabilities),
      welcome?.decide.enter ?? null,
      decision.probabilities,
      decision.gesture,
    );
    const sections = [
      h("p", { class: "reason-lead" }, sentenceCase(decision.reason)),
      section("Gesture", bars.root),
      section(
        "Affect gate",
        facts([
          ["Says", `${gate.is_open ? "open" : "closed"}: ${gate.reason}`],
          ["Valence, arousal", `${levelOr(gate.valence)}, ${levelOr(gate.arousal)}`],
          ["Age of the face", gate.age_ms === null ? "no face" : milliseconds(gate.age_ms)],
          ["Mode", gate.mode],
        ]),
      ),
      section(
        "Room",
        scene === null
          ? h("p", { class: "fact-note" }, "The room was not asked.")
          : facts([
              ["Says", scene.reason],
              ["Rule", scene.rule ?? "none"],
              ["Precondition", scene.precondition === null ? "none" : `${scene.precondition}: ${scene.met ? "met" : "not met"}`],
              ["Agent", scene.mode],
            ]),
      ),
    ];
    if (command !== null) sections.push(commandSection(command));
    sections.push(
      section("Time", timeBar(timing)),
      section(
        "Window and models",
        facts([
          ["Window", `${decision.window}, from ${sessionTime(decision.start_ns)} to ${sessionTime(decision.end_ns)}`],
          ["Body", `${decision.body_id}`],
          ["Joints", `${percent(quality.measured)} measured, ${percent(quality.filled)} filled in`],
          ["Bone lengths", `up to ${percent(quality.bone_deviation)} off${quality.warnings.length > 0 ? `; ${quality.warnings.join(", ")}` : ""}`],
          ["Forecast", decision.forecast + (decision.forecast_failure === null ? "" : `: ${decision.forecast_failure}`)],
          ...Object.entries(decision.models).map(([name, hash]): Fact => [name, h("code", {}, hash)]),
        ]),
      ),
    );
    this.#content.replaceChildren(...sections);
  }
}

function section(title: string, ...content: Node[]): HTMLElement {
  return h("section", { class: "facts" }, h("h3", {}, title), ...content);
}

function facts(list: readonly Fact[]): HTMLElement {
  return h("dl", {}, ...list.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));
}

function levelOr(value: number | null): string {
  return value === null ? "\u2013" : level(value);
}

function commandSection(command: CommandBody): HTMLElement {
  const steps = command.steps.map((step) => h("li", {}, `${stepWords(step)}, ${step.duration_s} s`));
  return section(
    "Command",
    h("ol", { class: "fact-steps" }, ...steps),
    facts([
      ["Id", h("code", {}, command.id)],
      ["Priority", `${command.priority}`],
      ["Worth starting for", `${(command.ttl_ms / 1000).toFixed(1)} s`],
      ["Cuts short", command.preempts ?? "nothing"],
    ]),
  );
}

/** One bar of the decision's total time, cut into its stages; what is left over is unnamed. */
function timeBar(timing: Timing): HTMLElement {
  const total = Math.max(timing.total_ms, 1e-6);
  const bar = h("div", { class: "time-bar", "aria-hidden": "true" });
  const legend = h("dl", { class: "time-legend" });
  for (const [key, name] of STAGES) {
    const value = Number(timing[key]);
    const part = h("span", { "data-stage": name });
    part.style.width = `${Math.min(100, (100 * value) / total)}%`;
    bar.append(part);
    legend.append(h("div", { "data-stage": name }, h("dt", {}, name), h("dd", {}, `${value.toFixed(2)} ms`)));
  }
  return h(
    "div",
    {},
    bar,
    legend,
    facts([
      ["Total", `${timing.total_ms.toFixed(2)} ms`],
      ["Made", timing.wall],
    ]),
  );
}
