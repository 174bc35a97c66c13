/**
 * The short path for own files: picture, depth, masks, go. The dialog borrows the slots and fields of the settings, so that both always
 * agree, and returns them when it closes. Loaded with its first opening.
 */

import "../style/first-run.css";
import { make, onClosed } from "../dom";
import { Borrowed, STEPS, type Hooks, type StepName, stepsOf } from "./firststeps";
import type { Files } from "./storage";

/** Largest number of earlier masks that undo can restore. */
const MOST_PAST = 20;

export class FirstRun {
  readonly #hooks: Hooks;
  readonly #dialog = make("dialog", { class: "first-run", "aria-labelledby": "first-run-title" });
  readonly #markers: { button: HTMLButtonElement; thumb: HTMLCanvasElement; state: HTMLElement }[];
  readonly #bodies: Record<StepName, HTMLElement>;
  readonly #back = make("button", { type: "button" }, "Back");
  readonly #next = make("button", { type: "button", class: "primary" }, "Next");
  readonly #lacks = make("p", { class: "soft", role: "status" });
  readonly #undoMask = make("button", { type: "button", disabled: true }, "Undo mask");
  readonly #borrowed = new Borrowed();
  readonly #show: (step: StepName) => void;
  #step = 0;
  #pastMasks: Pick<Files, "colourMask" | "depthMask">[] = [];
  #masks: Pick<Files, "colourMask" | "depthMask"> = {};
  #isLate = false;

  constructor(hooks: Hooks) {
    this.#hooks = hooks;
    const { bodies, show } = stepsOf(hooks, this.#borrowed, () => this.#later());
    this.#bodies = bodies;
    this.#show = show;
    this.#markers = STEPS.map(({ title }, index) => {
      const thumb = make("canvas", { width: 1, height: 1, "aria-hidden": "true", hidden: true });
      const state = make("span", { class: "state" });
      const button = make("button", { type: "button" }, thumb, make("span", {}, `${index + 1} ${title}`), state);
      button.addEventListener("click", () => this.#go(index));
      return { button, thumb, state };
    });
    this.#build();
  }

  #build(): void {
    const close = make("button", { type: "button", class: "quiet", "aria-label": "Close; the files stay" }, "×");
    close.addEventListener("click", () => this.#dialog.close());
    this.#back.addEventListener("click", () => this.#go(this.#step - 1));
    this.#next.addEventListener("click", () => this.#forward());
    this.#undoMask.addEventListener("click", () => this.#undo());
    this.#bodies.masks.append(make("p", { class: "row" }, this.#undoMask));
    this.#dialog.append(
      make("div", { class: "head" }, make("h2", { id: "first-run-title" }, "Your own pictures"), close),
      make("ol", { class: "markers" }, ...this.#markers.map(({ button }) => make("li", {}, button))),
      make("div", { class: "bodies" }, ...Object.values(this.#bodies)),
      make("div", { class: "foot" }, this.#lacks, this.#back, this.#next),
    );
    onClosed(this.#dialog, () => this.#borrowed.giveBack());
    // Readings, guesses and thumbnails arrive in the borrowed parts at their own times.
    new MutationObserver(() => this.#later()).observe(this.#bodies.picture.parentElement ?? this.#dialog, {
      ...{ subtree: true, childList: true, attributes: true, attributeFilter: ["hidden", "width"] },
    });
    document.body.append(this.#dialog);
  }

  /** Opens the path where it was left, or at the first step that lacks something. */
  open(): void {
    if (this.#dialog.open) return;
    const { colour, depth } = this.#hooks.files();
    this.#masks = masksOf(this.#hooks.files());
    this.#dialog.showModal();
    this.#go(!colour ? 0 : !depth ? 1 : Math.max(this.#step, 2));
  }

  /** Files have been dropped, chosen, drawn or removed. */
  filesChanged(): void {
    const masks = masksOf(this.#hooks.files());
    const isOther = masks.colourMask !== this.#masks.colourMask || masks.depthMask !== this.#masks.depthMask;
    if (isOther) this.#pastMasks = [...this.#pastMasks, this.#masks].slice(-MOST_PAST);
    this.#masks = masks;
    this.#later();
  }

  #undo(): void {
    const before = this.#pastMasks.pop();
    if (!before) return;
    const { colour, depth } = this.#hooks.files();
    this.#masks = before;
    this.#hooks.replace({ ...(colour && { colour }), ...(depth && { depth }), ...before });
    this.#later();
  }

  #go(step: number): void {
    this.#step = Math.min(Math.max(step, 0), STEPS.length - 1);
    this.#borrowed.giveBack();
    const name = STEPS[this.#step]?.name ?? "picture";
    for (const [each, body] of Object.entries(this.#bodies)) body.hidden = each !== name;
    this.#show(name);
    this.#refresh();
    this.#dialog.querySelector(".bodies")?.scrollTo(0, 0);
  }

  #forward(): void {
    if (this.#step < STEPS.length - 1) return this.#go(this.#step + 1);
    this.#dialog.close();
    this.#hooks.run();
  }

  /** Refreshes the step once per frame, however many parts have changed. */
  #later(): void {
    if (this.#isLate || !this.#dialog.open) return;
    this.#isLate = true;
    requestAnimationFrame(() => {
      this.#isLate = false;
      this.#refresh();
    });
  }

  #refresh(): void {
    const files = this.#hooks.files();
    const sources: (File | undefined)[] = [files.colour, files.depth, files.colourMask ?? files.depthMask, undefined];
    const isReady = files.colour !== undefined && files.depth !== undefined;
    for (const [index, { button, thumb, state }] of this.#markers.entries()) {
      if (index === this.#step) button.setAttribute("aria-current", "step");
      else button.removeAttribute("aria-current");
      const isThere = index === 3 ? isReady : sources[index] !== undefined;
      state.textContent = isThere ? (index === 3 ? "ready" : "there") : index === 2 ? "optional" : "open";
      button.toggleAttribute("data-there", isThere);
      this.#hooks.thumbnail(index, thumb);
    }
    const lacking = !files.colour ? "a picture" : !files.depth ? "a depth map" : "";
    const isLast = this.#step === STEPS.length - 1;
    const trouble = isLast && !lacking ? this.#hooks.trouble() : "";
    this.#lacks.textContent = isLast && lacking ? `Still needs ${lacking}.` : trouble;
    this.#next.textContent = isLast ? "Run" : this.#step === 2 && !sources[2] ? "Next, without masks" : "Next";
    this.#next.disabled = isLast && (lacking !== "" || trouble !== "");
    this.#back.disabled = this.#step === 0;
    this.#undoMask.disabled = this.#pastMasks.length === 0;
  }
}

const masksOf = ({ colourMask, depthMask }: Files): Pick<Files, "colourMask" | "depthMask"> => ({
  ...(colourMask && { colourMask }),
  ...(depthMask && { depthMask }),
});
