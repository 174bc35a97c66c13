/** The topics of a recording or of a robot: their content, and which of them belong to the two cameras. */

import { make } from "../dom";
import { choose, fill, labelled } from "./parts";
import type { Topic } from "./recordings";

const KINDS: Record<Topic["kind"], string> = {
  picture: "pictures",
  cloud: "points",
  camera: "intrinsics",
  transforms: "transforms",
  other: "not used",
};

const bytesInWords = (bytes: number): string =>
  bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;

const rateInWords = (rate: number): string => (rate === 0 ? "" : `${rate.toFixed(rate < 10 ? 1 : 0)} Hz`);

/** Used topics come first, unused ones last. */
const ORDER: readonly Topic["kind"][] = ["picture", "cloud", "camera", "transforms", "other"];

export interface Chosen {
  colour: string;
  depth: string;
}

function row(topic: Topic, chosen: Chosen): HTMLElement {
  const { name, type, kind, messages, rate, stored = "", bytes, unread } = topic;
  const use = name === chosen.colour ? "colour images" : name === chosen.depth ? "depth" : (unread ?? KINDS[kind]);
  return make(
    "tr",
    name === chosen.colour || name === chosen.depth ? { "data-chosen": true } : {},
    make("th", { scope: "row" }, name),
    make("td", {}, type.replace("/msg/", "/")),
    make("td", {}, bytes === undefined ? "" : `${stored}, ${bytesInWords(bytes)}`),
    make("td", { class: "rig-figure" }, messages > 0 ? String(messages) : ""),
    make("td", { class: "rig-figure" }, rateInWords(rate)),
    make("td", {}, use),
  );
}

/** A table with two choices below it. */
export class TopicTable {
  readonly element = make("div", { class: "rig-topics" });
  readonly #body = make("tbody");
  readonly #selects: Record<keyof Chosen, HTMLSelectElement>;
  #shown = "";

  constructor(of: string, onChoice: (chosen: Partial<Chosen>) => void) {
    this.#selects = {
      colour: choose([], "", (colour) => onChoice({ colour })),
      depth: choose([], "", (depth) => onChoice({ depth })),
    };
    const heads = ["Topic", "Type", "Size", "Messages", "Rate", "Use"];
    this.element.append(
      make(
        "div",
        { class: "rig-scroll", tabindex: "0", role: "region", "aria-label": `Topics of ${of}` },
        make(
          "table",
          {},
          make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))),
          this.#body,
        ),
      ),
      make(
        "div",
        { class: "rig-row rig-bottom" },
        labelled("Colour images of", this.#selects.colour),
        labelled("Depth of", this.#selects.depth),
      ),
    );
  }

  show(topics: readonly Topic[], chosen: Chosen): void {
    for (const role of ["colour", "depth"] as const) {
      const names = topics.filter((topic) => topic.role === role).map(({ name }) => ({ value: name, label: name }));
      fill(this.#selects[role], chosen[role] === "" ? [{ value: "", label: "none" }, ...names] : names, chosen[role]);
    }
    const now = JSON.stringify([topics, chosen]);
    if (now === this.#shown) return;
    this.#shown = now;
    const sorted = [...topics].sort((a, b) => ORDER.indexOf(a.kind) - ORDER.indexOf(b.kind));
    this.#body.replaceChildren(...sorted.map((topic) => row(topic, chosen)));
  }
}
