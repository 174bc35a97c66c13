/** Connects to a robot and shows how the verdict improves with each view. */

import "../style/rig-recordings.css";
import { make } from "../dom";
import type { Live, LiveState } from "./live";
import { labelled, press } from "./parts";
import type { Rig } from "./rig";
import { TopicTable } from "./topictable";

const USUAL = "ws://localhost:8765";
const VERDICTS: Record<string, string> = {
  consistent: "consistent",
  off: "off",
  undecided: "undecided so far",
  doubtful: "undecided, see warnings",
  estimated: "estimated, no calibration given",
};

function says({ state, views, progress, name }: Live): string {
  const taken = `${views} ${views === 1 ? "view" : "views"} taken`;
  const words: Record<LiveState, string> = {
    off: "",
    connecting: "Connecting and reading the topics",
    connected: views > 0 ? `Connected; ${taken}.` : `Connected to ${name || "the bridge"}.`,
    looking:
      views > 0
        ? `${taken}. Turn the robot or the object in front of it, then keep still.`
        : "Waiting for the first view",
    checking: `${taken}, checking${progress ? `: ${progress}` : ""}`,
    done: `${taken}; no more are needed.`,
    lost: "",
  };
  return words[state];
}

export class LiveCard {
  readonly element = make("div", { class: "rig-live" });
  readonly #live: Live;
  readonly #address = make("input", { type: "text", value: USUAL, autocomplete: "off", spellcheck: "false" });
  readonly #connect: HTMLButtonElement;
  readonly #table: TopicTable;
  readonly #start: HTMLButtonElement;
  readonly #stop: HTMLButtonElement;
  readonly #leave: HTMLButtonElement;
  readonly #see: HTMLButtonElement;
  readonly #status = make("p", { class: "rig-status soft", role: "status" });
  readonly #error = make("p", { class: "rig-error", role: "alert", hidden: true });
  readonly #missing = make("p", { class: "rig-missing", hidden: true });
  readonly #steps = make("tbody");
  readonly #history: HTMLElement;
  readonly #rig: Rig;

  constructor(rig: Rig, seeVerdict: () => void) {
    const { live } = rig;
    this.#rig = rig;
    this.#live = live;
    this.#connect = press("Connect", () => void live.connect(this.#address.value), { class: "primary" });
    this.#address.addEventListener("keydown", ({ key }) => key === "Enter" && this.#connect.click());
    this.#table = new TopicTable("the robot", (chosen) => live.choose(chosen));
    this.#start = press("Take views and check", () => void live.start(), { class: "primary" });
    this.#stop = press("Stop", () => live.stop());
    this.#leave = press("Disconnect", () => live.disconnect());
    this.#see = press("See the verdict", seeVerdict);
    const heads = ["Views", "Calibration", "Expected error of the best fit, px (95 %)"];
    this.#history = make(
      "div",
      { class: "rig-scroll", hidden: true },
      make(
        "table",
        { "aria-label": "The verdict, view by view" },
        make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))),
        this.#steps,
      ),
    );
    this.element.append(
      make(
        "p",
        { class: "soft" },
        "The page opens a WebSocket to the address entered here and to no other: a foxglove_bridge that runs on the robot or on your computer. It receives images from there and sends only the names of the requested topics.",
      ),
      make(
        "div",
        { class: "rig-row rig-bottom" },
        labelled("Address of the bridge", this.#address),
        this.#connect,
        this.#leave,
      ),
      this.#error,
      this.#table.element,
      make("div", { class: "rig-row" }, this.#start, this.#stop, this.#see, this.#status),
      this.#missing,
      this.#history,
    );
  }

  show(): void {
    const live = this.#live;
    const { state, topics, chosen, error, steps } = live;
    const isOn = state !== "off" && state !== "connecting" && state !== "lost";
    this.#connect.disabled = state === "connecting" || isOn;
    this.#connect.textContent = state === "lost" ? "Try again" : "Connect";
    this.#address.disabled = this.#connect.disabled;
    this.#leave.hidden = !isOn;
    this.#error.textContent = error;
    this.#error.hidden = error === "";
    this.#table.element.hidden = !isOn;
    if (isOn) this.#table.show(topics, chosen);
    this.#start.hidden = !isOn || live.isRunning || state === "done";
    this.#start.disabled = chosen.colour === "" || chosen.depth === "";
    this.#stop.hidden = !live.isRunning;
    this.#see.hidden = steps.length === 0;
    const words = says(live);
    if (this.#status.textContent !== words) this.#status.textContent = words;
    const { missing } = this.#rig;
    this.#missing.hidden = !live.isRunning || live.views === 0 || missing.length === 0;
    this.#missing.textContent = `Still missing: ${missing.join("; ")}.`;
    this.#history.hidden = steps.length === 0;
    this.#steps.replaceChildren(
      ...steps.map(({ views, verdict, pixels, interval: [from, to] }) =>
        make(
          "tr",
          {},
          make("th", { scope: "row" }, String(views)),
          make("td", {}, VERDICTS[verdict] ?? verdict),
          make("td", {}, `${pixels.toFixed(2)} (${from.toFixed(2)} to ${to.toFixed(2)})`),
        ),
      ),
    );
  }
}
