/** The visitor's recordings: their topics, the topics to take frames from, and the progress. */

import "../style/rig-recordings.css";
import { make } from "../dom";
import { Keyed, choose, fill, labelled, press } from "./parts";
import type { Item, Rig } from "./rig";
import { TopicTable } from "./topictable";

const COUNTS = ["3", "5", "10", "20"].map((value) => ({ value, label: value }));

export class RecordingList {
  readonly element = make("div", { class: "rig-recordings", hidden: true });
  readonly #rig: Rig;
  readonly #rows: Keyed<Item>;

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#rows = new Keyed(this.element, (item) => this.#row(item));
  }

  show(): void {
    const recordings = this.#rig.items.filter(({ summary }) => summary?.kind === "recording");
    this.#rows.show(recordings);
    this.element.hidden = recordings.length === 0;
  }

  #row(item: Item): { element: HTMLElement; show(item: Item): void } {
    const { takings } = this.#rig;
    const table = new TopicTable(item.name, (chosen) => void takings.take(item, chosen));
    const count = choose(COUNTS, "10", (frames) => void takings.take(item, { frames: Number(frames) }));
    const status = make("p", { class: "rig-status soft", role: "status" });
    const progress = make("progress", { max: 1, value: 0, "aria-label": `Frames of ${item.name}` });
    const error = make("p", { class: "rig-error", role: "alert", hidden: true });
    const remove = press("×", () => this.#rig.remove(item), {
      class: "icon",
      "aria-label": `Remove the recording ${item.name}`,
    });
    const element = make(
      "section",
      { class: "rig-card rig-recording" },
      make("div", { class: "rig-row" }, make("h3", {}, item.name), remove),
      make("p", { class: "soft" }, item.summary?.says ?? ""),
      table.element,
      make("div", { class: "rig-row rig-bottom" }, labelled("Frames, at most", count), status, progress),
      error,
    );
    return {
      element,
      show: () => {
        const { taking, summary } = item;
        table.show(summary?.topics ?? [], { colour: taking?.colour ?? "", depth: taking?.depth ?? "" });
        fill(count, COUNTS, String(taking?.frames ?? 10));
        const isBusy = taking?.state === "reading";
        progress.value = taking?.share ?? 0;
        progress.toggleAttribute("data-idle", !isBusy);
        const words = isBusy ? "Looking for frames that differ" : taking?.state === "read" ? this.#taken(item) : "";
        if (status.textContent !== words) status.textContent = words;
        error.textContent = taking?.error ?? "";
        error.hidden = taking?.state !== "failed";
      },
    };
  }

  #taken({ id }: Item): string {
    const files = new Set(this.#rig.items.filter(({ recording }) => recording === id).map((each) => each.id));
    const frames = this.#rig.frames.filter(({ depth = 0 }) => files.has(depth)).length;
    return `${frames} ${frames === 1 ? "frame" : "frames"} taken`;
  }
}
